//! Protobuf's wire format (<https://protobuf.dev/programming-guides/encoding>): messages, field by field.

/// A message that is being made.
#[derive(Default)]
pub(super) struct Proto(Vec<u8>);

impl Proto {
    /// Seven bits a byte, the lowest first.
    fn varint(mut self, mut value: u64) -> Self {
        while value >= 0x80 {
            self.0.push(value as u8 | 0x80);
            value >>= 7;
        }
        self.0.push(value as u8);
        self
    }

    /// A whole number: `int64`, `uint32`, an `enum`, a `bool`.
    pub(super) fn number(self, field: u64, value: u64) -> Self {
        self.varint(field << 3).varint(value)
    }

    pub(super) fn fixed32(mut self, field: u64, value: u32) -> Self {
        self = self.varint(field << 3 | 5);
        self.0.extend(value.to_le_bytes());
        self
    }

    pub(super) fn double(mut self, field: u64, value: f64) -> Self {
        self = self.varint(field << 3 | 1);
        self.0.extend(value.to_le_bytes());
        self
    }

    pub(super) fn bytes(mut self, field: u64, bytes: &[u8]) -> Self {
        self = self.varint(field << 3 | 2).varint(bytes.len() as u64);
        self.0.extend(bytes);
        self
    }

    pub(super) fn text(self, field: u64, text: &str) -> Self {
        self.bytes(field, text.as_bytes())
    }

    pub(super) fn message(self, field: u64, message: Proto) -> Self {
        self.bytes(field, &message.0)
    }

    /// A repeated field of numbers.
    pub(super) fn doubles(self, field: u64, values: &[f64]) -> Self {
        self.bytes(field, &values.iter().flat_map(|value| value.to_le_bytes()).collect::<Vec<u8>>())
    }

    /// Fields 1, 2, .. are these numbers, as those of `Point3`, `Color` and `Quaternion` are.
    pub(super) fn of(values: &[f64]) -> Self {
        (1..).zip(values).fold(Proto::default(), |message, (field, value)| message.double(field, *value))
    }

    pub(super) fn into_bytes(self) -> Vec<u8> {
        self.0
    }
}
