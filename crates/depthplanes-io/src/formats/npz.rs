//! NumPy archives (`.npz`): a ZIP file of `.npy` arrays, stored or deflated.
//!
//! In: an archive and, if it holds several arrays of two axes, the name of one. Out: that array.
//! The reader knows as much of ZIP as numpy writes: one file, no encryption, sizes below 4 GiB.
//! Data are unpacked up to the size that the directory states, and their checksum is checked.

use std::io::Read;

use flate2::Crc;
use flate2::read::DeflateDecoder;

use super::bytes::Cursor;
use super::format::{DecodeOptions, Format, Image, Limits};
use super::npy;
use crate::error::{Error, Result};

pub(super) const FORMAT: Format = Format {
    name: "npz",
    about: "NumPy archive with one array of two axes, or a named one",
    extensions: &["npz"],
    sniff: |bytes| bytes.starts_with(b"PK\x03\x04") || bytes.starts_with(b"PK\x05\x06"),
    ends: |_, _| None,
    decode,
};

const END: &[u8] = b"PK\x05\x06";
/// Deflate packs no more than 1032 bytes into one.
const BEST_RATIO: u64 = 1032;
/// Enough of an array to read its header.
const HEADER_BYTES: u64 = 4096;

fn unreadable(wrong: impl Into<String>) -> Error {
    let accepted = "a whole .npz archive as numpy.savez or savez_compressed writes it";
    Error::Unreadable { format: "npz", wrong: wrong.into(), accepted }
}

/// One array in the archive.
struct Member<'a> {
    name: String,
    packed: &'a [u8],
    deflated: bool,
    size: u64,
    checksum: u32,
}

fn decode(bytes: &[u8], options: &DecodeOptions) -> Result<Image> {
    let members = directory(bytes)?;
    let member = choose(&members, options)?;
    let array = member.unpack(member.size, &options.limits)?;
    let mut crc = Crc::new();
    crc.update(&array);
    if crc.sum() != member.checksum {
        return Err(unreadable(format!("the checksum of `{}` is wrong: the archive is damaged", member.name)));
    }
    let mut image = npy::decode("npz", &array, options)?;
    if members.len() > 1 && options.member.is_none() {
        let others: Vec<_> = members.iter().filter(|other| other.name != member.name).map(Member::shown).collect();
        let name = member.shown();
        image.warnings.push(format!("the array {name} is taken, the only map beside {}", few(&others)));
    }
    Ok(image)
}

/// The member asked for, or the only one that is a map.
fn choose<'a, 'b>(members: &'b [Member<'a>], options: &DecodeOptions) -> Result<&'b Member<'a>> {
    let names = |members: &mut dyn Iterator<Item = &Member>| few(&members.map(Member::shown).collect::<Vec<_>>());
    if let Some(wanted) = &options.member {
        return members
            .iter()
            .find(|member| &member.name == wanted)
            .ok_or_else(|| Error::parameter("--member", wanted, names(&mut members.iter())));
    }
    let small = Limits { max_bytes: options.limits.max_bytes, ..Limits::default() };
    let is_map = |member: &&Member| {
        let start = member.unpack(member.size.min(HEADER_BYTES), &small);
        start.is_ok_and(|start| npy::header("npz", &start).is_ok_and(|array| array.rows > 1 && array.columns > 1))
    };
    let maps: Vec<_> = members.iter().filter(is_map).collect();
    match maps[..] {
        [only] => Ok(only),
        [] if members.len() == 1 => Ok(&members[0]), // Its own reader says what is wrong with it.
        [] => {
            let there = names(&mut members.iter());
            Err(unreadable(format!("none of its {} members is an array of two axes: {there}", members.len())))
        }
        _ => Err(Error::parameter("--member", "not given", names(&mut maps.iter().copied()))),
    }
}

/// Names with commas between, the first of many.
fn few(names: &[String]) -> String {
    const MOST: usize = 20;
    let more = if names.len() > MOST { format!(" and {} more", names.len() - MOST) } else { String::new() };
    format!("{}{more}", names[..names.len().min(MOST)].join(", "))
}

impl Member<'_> {
    /// The name as it may be shown.
    fn shown(&self) -> String {
        format!("`{}`", self.name.escape_debug())
    }

    /// The first `size` bytes of the array.
    fn unpack(&self, size: u64, limits: &Limits) -> Result<Vec<u8>> {
        if size > limits.max_bytes as u64 {
            return Err(Error::Limit {
                what: "size of the array in bytes",
                given: size,
                limit: limits.max_bytes as u64,
            });
        }
        if !self.deflated {
            let stored = self.packed.get(..size as usize);
            return stored.map(<[u8]>::to_vec).ok_or_else(|| unreadable(format!("`{}` is cut off", self.name)));
        }
        if self.size > self.packed.len() as u64 * BEST_RATIO + 64 {
            let (name, size, packed) = (&self.name, self.size, self.packed.len());
            return Err(unreadable(format!("`{name}`: {size} bytes cannot come out of {packed}")));
        }
        let mut array = Vec::with_capacity(size as usize);
        let taken = DeflateDecoder::new(self.packed).take(size).read_to_end(&mut array);
        match taken {
            Ok(_) if array.len() as u64 == size => Ok(array),
            Ok(_) => Err(unreadable(format!("`{}` is {} bytes instead of {size}", self.name, array.len()))),
            Err(error) => Err(unreadable(format!("`{}`: {error}", self.name))),
        }
    }
}

/// All arrays by the archive's central directory.
fn directory(bytes: &[u8]) -> Result<Vec<Member<'_>>> {
    let cut = || unreadable("its directory is missing or cut off");
    // The end record is 22 bytes and a comment of at most 65535.
    let tail = bytes.len().saturating_sub(22 + 65_535);
    let end = tail + bytes[tail..].windows(4).rposition(|window| window == END).ok_or_else(cut)?;
    let mut record = Cursor::new(bytes, end + 10);
    let count = record.u16().ok_or_else(cut)?;
    record.take(4).ok_or_else(cut)?;
    let mut cursor = Cursor::new(bytes, record.u32().ok_or_else(cut)? as usize);
    let mut members = Vec::new();
    for _ in 0..count {
        if let Some(member) = entry(bytes, &mut cursor).ok_or_else(cut)?? {
            members.push(member);
        }
    }
    if members.is_empty() {
        return Err(unreadable("it holds no arrays"));
    }
    Ok(members)
}

/// One entry of the central directory: `None` at its end, `Ok(None)` for a file that is no array.
fn entry<'a>(bytes: &'a [u8], cursor: &mut Cursor<'a>) -> Option<Result<Option<Member<'a>>>> {
    if cursor.take(4)? != b"PK\x01\x02" {
        return None;
    }
    cursor.take(4)?;
    let (flags, method) = (cursor.u16()?, cursor.u16()?);
    cursor.take(4)?;
    let (checksum, packed, size) = (cursor.u32()?, cursor.u32()?, cursor.u32()?);
    let (name, extra, comment) = (cursor.u16()?, cursor.u16()?, cursor.u16()?);
    cursor.take(8)?;
    let local = cursor.u32()? as usize;
    let name = String::from_utf8_lossy(cursor.take(name.into())?).into_owned();
    cursor.take(usize::from(extra) + usize::from(comment))?;
    let Some(array) = name.strip_suffix(".npy") else {
        return Some(Ok(None));
    };
    if flags & 1 != 0 || !matches!(method, 0 | 8) || [packed, size].contains(&u32::MAX) {
        return Some(Err(unreadable(format!("`{array}` is encrypted, above 4 GiB or packed by method {method}"))));
    }
    let mut header = Cursor::new(bytes, local);
    if header.take(4)? != b"PK\x03\x04" {
        return None;
    }
    header.take(22)?;
    let before = usize::from(header.u16()?) + usize::from(header.u16()?);
    header.take(before)?;
    let packed = header.take(packed as usize)?;
    Some(Ok(Some(Member { name: array.to_string(), packed, deflated: method == 8, size: size.into(), checksum })))
}
