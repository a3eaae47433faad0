//! Chunks: their bytes become the records in them.
//!
//! Of a chunk that is cut off there are the records before the cut; one whose checksum is wrong has none.

use super::records::Fields;
use crate::error::short;
use ruzstd::decoding::StreamingDecoder;
use std::io::Read;

/// Bytes that zstd may look back, if the chunk has no more: those of its highest ordinary level.
const WINDOW: u64 = 1 << 23;

/// The records of a chunk, and what is wrong with it.
pub(super) struct Content {
    /// Bytes of which the records are a part.
    pub(super) bytes: Vec<u8>,
    /// Where the records begin.
    pub(super) from: usize,
    pub(super) fault: Option<String>,
}

/// Takes the content of a chunk's record apart. `most`: bytes of the records.
pub(super) fn unpack(bytes: Vec<u8>, most: usize) -> Content {
    let none = |fault: String| Content { bytes: Vec::new(), from: 0, fault: Some(fault) };
    let Some(head) = head(&bytes) else {
        return none("a chunk whose beginning is not whole; was the recorder killed?".into());
    };
    if head.size > most as u64 {
        return none(format!("a chunk of {} bytes, the limit is {most}", head.size));
    }
    let cut = (head.missing > 0).then(|| format!("the file ends {} bytes before the end of this chunk", head.missing));
    let packed = &bytes[head.from..head.end];
    let reader: Box<dyn Read + '_> = match &head.compression[..] {
        "" => return checked(head.from, head.end, head.size, head.crc, cut, bytes),
        "lz4" => Box::new(lz4_flex::frame::FrameDecoder::new(packed)),
        "zstd" => match StreamingDecoder::new_with_max_window_size(packed, head.size.max(WINDOW)) {
            Ok(decoder) => Box::new(decoder),
            Err(error) => return none(cut.unwrap_or_else(|| format!("a chunk that is no zstd: {error}"))),
        },
        other => {
            let other = short(other);
            return none(format!("a chunk with the compression `{other}`; zstd, lz4 and none are known"));
        }
    };
    let mut records = Vec::with_capacity(head.size.min(16 * packed.len() as u64) as usize);
    // One byte more shows that there are too many.
    let read = reader.take(head.size + 1).read_to_end(&mut records);
    let fault = cut.or_else(|| Some(format!("a chunk that cannot be unpacked: {}", read.err()?)));
    let end = records.len();
    checked(0, end, head.size, head.crc, fault, records)
}

struct Head {
    size: u64,
    crc: u32,
    compression: String,
    /// Where the packed records begin and end.
    from: usize,
    end: usize,
    /// How many of their bytes are not there.
    missing: u64,
}

fn head(bytes: &[u8]) -> Option<Head> {
    let mut fields = Fields(bytes);
    fields.take(8 + 8)?;
    let (size, crc) = (fields.u64()?, fields.u32()?);
    let compression = fields.text()?.to_string();
    let packed = fields.u64()?;
    let (from, there) = (bytes.len() - fields.0.len(), fields.0.len() as u64);
    Some(Head {
        size,
        crc,
        compression,
        from,
        end: from + packed.min(there) as usize,
        missing: packed.saturating_sub(there),
    })
}

/// Holds the records against their size and checksum, unless it is known already that they are not whole.
fn checked(from: usize, end: usize, size: u64, crc: u32, fault: Option<String>, mut bytes: Vec<u8>) -> Content {
    bytes.truncate(end);
    let records = &bytes[from..];
    if fault.is_some() {
        return Content { bytes, from, fault };
    }
    let wrong = if records.len() as u64 != size {
        Some(format!("a chunk of {} bytes that should be {size}", records.len()))
    } else if crc != 0 && crc32fast::hash(records) != crc {
        Some("a chunk whose checksum is wrong".to_string())
    } else {
        None
    };
    if wrong.is_some() {
        bytes.truncate(from);
    }
    Content { bytes, from, fault: wrong }
}
