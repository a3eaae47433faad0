//! Protobuf's wire format (<https://protobuf.dev/programming-guides/encoding>): the fields of a message.

/// The value of a field.
#[derive(Clone, Copy)]
pub(super) enum Wire<'a> {
    Number(u64),
    Fixed64([u8; 8]),
    Bytes(&'a [u8]),
    Fixed32([u8; 4]),
}

impl<'a> Wire<'a> {
    /// What is wrong with a field that should be something else.
    fn not<T>(self, wanted: &str) -> Result<T, String> {
        let what = match self {
            Wire::Number(_) => "a number",
            Wire::Fixed64(_) => "64 bits",
            Wire::Bytes(_) => "bytes",
            Wire::Fixed32(_) => "32 bits",
        };
        Err(format!("{what} in the place of {wanted}"))
    }

    pub(super) fn bytes(self) -> Result<&'a [u8], String> {
        match self {
            Wire::Bytes(bytes) => Ok(bytes),
            other => other.not("bytes"),
        }
    }

    pub(super) fn text(self) -> Result<String, String> {
        let text = std::str::from_utf8(self.bytes()?).map_err(|_| "text that is no UTF-8".to_string())?;
        Ok(text.to_string())
    }

    /// A whole number, fixed or not.
    pub(super) fn u32(self) -> Result<u32, String> {
        match self {
            Wire::Fixed32(bytes) => Ok(u32::from_le_bytes(bytes)),
            Wire::Number(number) => u32::try_from(number).map_err(|_| format!("{number} where 32 bits should be")),
            other => other.not("a number"),
        }
    }

    pub(super) fn number(self) -> Result<u64, String> {
        match self {
            Wire::Number(number) => Ok(number),
            other => other.not("a number"),
        }
    }

    /// Adds one number or a packed list of them.
    pub(super) fn f64s(self, all: &mut Vec<f64>) -> Result<(), String> {
        match self {
            Wire::Fixed64(bytes) => all.push(f64::from_le_bytes(bytes)),
            Wire::Bytes(bytes) if bytes.len() % 8 == 0 => {
                all.extend(bytes.as_chunks::<8>().0.iter().map(|bytes| f64::from_le_bytes(*bytes)));
            }
            other => return other.not("numbers"),
        }
        Ok(())
    }
}

/// The fields of a message with their numbers; an error is the last.
pub(super) fn fields(bytes: &[u8]) -> impl Iterator<Item = Result<(u64, Wire<'_>), String>> {
    let mut rest = bytes;
    std::iter::from_fn(move || {
        (!rest.is_empty()).then(|| {
            let field = field(&mut rest).ok_or_else(|| "a field that is not whole".to_string());
            if field.is_err() {
                rest = &[];
            }
            field
        })
    })
}

fn field<'a>(rest: &mut &'a [u8]) -> Option<(u64, Wire<'a>)> {
    let tag = varint(rest)?;
    let value = match tag & 7 {
        0 => Wire::Number(varint(rest)?),
        1 => Wire::Fixed64(rest.split_off(..8)?.try_into().ok()?),
        2 => {
            let length = usize::try_from(varint(rest)?).ok()?;
            Wire::Bytes(rest.split_off(..length)?)
        }
        5 => Wire::Fixed32(rest.split_off(..4)?.try_into().ok()?),
        _ => return None,
    };
    Some((tag >> 3, value))
}

/// Seven bits a byte, the lowest first.
fn varint(rest: &mut &[u8]) -> Option<u64> {
    let mut value = 0;
    for shift in (0..64).step_by(7) {
        let byte = *rest.split_off_first()?;
        value |= u64::from(byte & 0x7f) << shift;
        if byte < 0x80 {
            return Some(value);
        }
    }
    None
}
