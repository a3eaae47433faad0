//! Where the messages of a file stand: by its summary, or by going over all its records once.

use super::input::Input;
use super::records::{self, Channel, HEAD, MAGIC, MESSAGE_HEAD, op, records as all_records};
use crate::error::{Error, Result};
use std::collections::BTreeMap;

/// Messages that stand outside of chunks are read so many bytes at a time.
const SPAN: u64 = 1 << 22;
/// The longest record that is read for what it says of others: types with their definitions.
const LONGEST: u64 = 1 << 24;
/// The longest summary: 100 bytes for each chunk.
const LONGEST_SUMMARY: u64 = 1 << 28;

/// A chunk, or some messages that stand one after the other without one.
#[derive(Clone, Debug)]
pub(super) struct Part {
    /// Where its first record begins, and how many bytes there are.
    pub(super) at: u64,
    pub(super) length: u64,
    pub(super) is_chunk: bool,
    /// Log times of the first and the last message, nanoseconds.
    pub(super) start: u64,
    pub(super) end: u64,
    /// Where the times of each channel's messages stand; empty if nobody says.
    pub(super) indexes: Vec<(u16, u64)>,
}

/// What is known of a file before its messages are read.
#[derive(Debug, Default)]
pub(super) struct Layout {
    /// By their first log time.
    pub(super) parts: Vec<Part>,
    pub(super) channels: BTreeMap<u16, Channel>,
    schemas: BTreeMap<u16, String>,
    /// Messages of each channel, if the summary says it.
    pub(super) counts: Option<BTreeMap<u16, u64>>,
    /// What is wrong behind the parts.
    pub(super) fault: Option<(u64, String)>,
}

impl Layout {
    pub(super) fn of(input: &mut Input) -> Result<Self> {
        let start = input.read(0, MAGIC.len() as u64)?;
        if start != MAGIC {
            let zipped = "a file that was compressed as a whole; type `zstd -d FILE` first";
            let wrong = if start.starts_with(b"\x28\xb5\x2f\xfd") { zipped } else { "this is no MCAP file" };
            return Err(Error::source(input.path.display(), wrong, "a file that begins with \\x89MCAP0\\r\\n"));
        }
        let mut layout = match Self::of_summary(input)? {
            Some(layout) => layout,
            None => Self::of_records(input)?,
        };
        layout.parts.sort_by_key(|part| (part.start, part.at));
        Ok(layout)
    }

    /// Adds what a record says of types and channels.
    pub(super) fn add(&mut self, op: u8, content: &[u8]) {
        if op == op::SCHEMA
            && let Some((id, name)) = records::schema(content)
        {
            self.schemas.entry(id).or_insert(name);
        } else if op == op::CHANNEL
            && let Some((id, schema, topic, encoding)) = records::channel(content)
        {
            let schema = self.schemas.get(&schema).cloned().unwrap_or_default();
            self.channels.entry(id).or_insert(Channel { topic, encoding, schema });
        }
    }

    /// By the summary; none where it is not there, not whole, or does not tell of the chunks.
    fn of_summary(input: &mut Input) -> Result<Option<Self>> {
        const FOOTER: u64 = HEAD + 8 + 8 + 4;
        let Some(footer_at) = input.length.checked_sub(FOOTER + MAGIC.len() as u64) else { return Ok(None) };
        let footer = input.read(footer_at, FOOTER + MAGIC.len() as u64)?;
        let mut records_of_footer = all_records(&footer);
        let Some((op::FOOTER, _, content)) = records_of_footer.next() else { return Ok(None) };
        let mut fields = records::Fields(content);
        let (Some(from), Some(_), Some(crc)) = (fields.u64(), fields.u64(), fields.u32()) else { return Ok(None) };
        let length = footer_at.saturating_sub(from);
        if !footer.ends_with(&MAGIC) || from == 0 || length == 0 || length > LONGEST_SUMMARY {
            return Ok(None);
        }
        let mut bytes = input.read(from, length + FOOTER - 4)?;
        if crc != 0 && crc32fast::hash(&bytes) != crc {
            return Ok(None);
        }
        bytes.truncate(length as usize);
        let (mut layout, mut stated) = (Layout::default(), None);
        for (op, _, content) in all_records(&bytes) {
            match op {
                op::CHUNK_INDEX => {
                    let Some(index) = records::chunk_index(content) else { return Ok(None) };
                    if index.at.checked_add(index.length).is_none_or(|end| end > from) || index.length < HEAD {
                        return Ok(None);
                    }
                    let records::ChunkIndex { start, end, at, length, indexes } = index;
                    layout.parts.push(Part { at, length, is_chunk: true, start, end, indexes });
                }
                op::STATISTICS => stated = records::statistics(content),
                _ => layout.add(op, content),
            }
        }
        if layout.parts.is_empty() || stated.as_ref().is_some_and(|(count, _)| *count as usize != layout.parts.len()) {
            return Ok(None);
        }
        layout.counts = stated.map(|(_, counts)| counts.into_iter().collect());
        Ok(Some(layout))
    }

    /// By the records up to the end of the data, or to what is wrong.
    fn of_records(input: &mut Input) -> Result<Self> {
        let mut layout = Layout::default();
        let mut at = MAGIC.len() as u64;
        loop {
            let bytes = input.read(at, HEAD + MESSAGE_HEAD as u64)?;
            let mut fields = records::Fields(&bytes);
            let (Some(op), Some(length)) = (fields.u8(), fields.u64()) else {
                let wrong = "the file ends without the end of its data; was the recorder killed?";
                layout.fault = Some((at, wrong.into()));
                return Ok(layout);
            };
            if op == op::DATA_END || op == op::FOOTER {
                return Ok(layout);
            }
            let there = input.length - at - HEAD;
            let is_whole = length <= there;
            layout.record(input, op, at, length.min(there), is_whole, fields.0)?;
            if !is_whole {
                let wrong = format!("a record of {length} bytes, of which {there} are there; was the recorder killed?");
                layout.fault = Some((at, wrong));
                return Ok(layout);
            }
            if op == 0 {
                layout.fault = Some((at, "no record begins here".into()));
                return Ok(layout);
            }
            at += HEAD + length;
        }
    }

    /// Takes in a record of the data; `start` are the first bytes of its content, and more may be there.
    fn record(&mut self, input: &mut Input, op: u8, at: u64, length: u64, is_whole: bool, start: &[u8]) -> Result<()> {
        let end = at + HEAD + length;
        match op {
            op::SCHEMA | op::CHANNEL if is_whole && length <= LONGEST => {
                let content = input.read(at + HEAD, length)?;
                self.add(op, &content);
            }
            op::CHUNK => {
                let mut fields = records::Fields(start);
                if let (Some(start), Some(end)) = (fields.u64(), fields.u64()) {
                    let length = HEAD + length;
                    self.parts.push(Part { at, length, is_chunk: true, start, end, indexes: Vec::new() });
                }
            }
            op::MESSAGE if is_whole => {
                let Some((_, time)) = records::message(start) else { return Ok(()) };
                match self.parts.last_mut() {
                    Some(part) if !part.is_chunk && end - part.at <= SPAN => {
                        part.length = end - part.at;
                        (part.start, part.end) = (part.start.min(time), part.end.max(time));
                    }
                    _ => self.parts.push(Part {
                        at,
                        length: end - at,
                        is_chunk: false,
                        start: time,
                        end: time,
                        indexes: Vec::new(),
                    }),
                }
            }
            _ => (),
        }
        Ok(())
    }
}
