//! The records of MCAP: in: their bytes. Out: what they say, or nothing if they are not whole.

/// The first and the last bytes of a file.
pub(super) const MAGIC: [u8; 8] = *b"\x89MCAP0\r\n";
/// Bytes of a record before its content: what it is, and how long.
pub(super) const HEAD: u64 = 9;

/// What records are.
pub(super) mod op {
    pub(in crate::mcap) const HEADER: u8 = 1;
    pub(in crate::mcap) const FOOTER: u8 = 2;
    pub(in crate::mcap) const SCHEMA: u8 = 3;
    pub(in crate::mcap) const CHANNEL: u8 = 4;
    pub(in crate::mcap) const MESSAGE: u8 = 5;
    pub(in crate::mcap) const CHUNK: u8 = 6;
    pub(in crate::mcap) const MESSAGE_INDEX: u8 = 7;
    pub(in crate::mcap) const CHUNK_INDEX: u8 = 8;
    pub(in crate::mcap) const STATISTICS: u8 = 11;
    pub(in crate::mcap) const DATA_END: u8 = 15;
}

/// Little-endian fields one after the other.
#[derive(Clone, Copy)]
pub(super) struct Fields<'a>(pub(super) &'a [u8]);

impl<'a> Fields<'a> {
    pub(super) fn take(&mut self, count: u64) -> Option<&'a [u8]> {
        let (taken, rest) = self.0.split_at_checked(usize::try_from(count).ok()?)?;
        self.0 = rest;
        Some(taken)
    }

    fn array<const N: usize>(&mut self) -> Option<[u8; N]> {
        self.take(N as u64)?.try_into().ok()
    }

    pub(super) fn u8(&mut self) -> Option<u8> {
        self.array::<1>().map(|[byte]| byte)
    }

    pub(super) fn u16(&mut self) -> Option<u16> {
        self.array().map(u16::from_le_bytes)
    }

    pub(super) fn u32(&mut self) -> Option<u32> {
        self.array().map(u32::from_le_bytes)
    }

    pub(super) fn u64(&mut self) -> Option<u64> {
        self.array().map(u64::from_le_bytes)
    }

    /// Bytes behind their number.
    pub(super) fn bytes(&mut self) -> Option<&'a [u8]> {
        let count = self.u32()?;
        self.take(count.into())
    }

    pub(super) fn text(&mut self) -> Option<&'a str> {
        std::str::from_utf8(self.bytes()?).ok()
    }

    /// Channels, each with a number.
    fn by_channel(&mut self) -> Option<Vec<(u16, u64)>> {
        let mut pairs = Fields(self.bytes()?);
        let mut all = Vec::new();
        while !pairs.0.is_empty() {
            all.push((pairs.u16()?, pairs.u64()?));
        }
        Some(all)
    }
}

/// The records in some bytes, each with the place of its content; those behind one that is not whole are left out.
pub(super) fn records(bytes: &[u8]) -> impl Iterator<Item = (u8, usize, &[u8])> {
    let mut at = 0;
    std::iter::from_fn(move || {
        let mut fields = Fields(&bytes[at..]);
        let op = fields.u8()?;
        let length = fields.u64()?;
        let content = fields.take(length)?;
        let place = at + HEAD as usize;
        at = place + content.len();
        Some((op, place, content))
    })
}

/// What the messages of a topic are.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Channel {
    pub(crate) topic: String,
    /// How they are encoded: `cdr`, `protobuf`, `json` ...
    pub(crate) encoding: String,
    /// The name of their type; empty if the file does not say it.
    pub(crate) schema: String,
}

/// The number and the name of a type.
pub(super) fn schema(content: &[u8]) -> Option<(u16, String)> {
    let mut fields = Fields(content);
    Some((fields.u16()?, fields.text()?.to_string()))
}

/// The number of a channel, that of its type, topic and encoding.
pub(super) fn channel(content: &[u8]) -> Option<(u16, u16, String, String)> {
    let mut fields = Fields(content);
    Some((fields.u16()?, fields.u16()?, fields.text()?.to_string(), fields.text()?.to_string()))
}

/// Bytes of a message before its data.
pub(super) const MESSAGE_HEAD: usize = 22;

/// Channel and log time of a message, nanoseconds.
pub(super) fn message(content: &[u8]) -> Option<(u16, u64)> {
    let mut fields = Fields(content.get(..MESSAGE_HEAD)?);
    let channel = fields.u16()?;
    fields.u32()?;
    Some((channel, fields.u64()?))
}

/// A chunk as the summary tells of it.
pub(super) struct ChunkIndex {
    pub(super) start: u64,
    pub(super) end: u64,
    pub(super) at: u64,
    pub(super) length: u64,
    /// Where the times of each channel's messages stand.
    pub(super) indexes: Vec<(u16, u64)>,
}

pub(super) fn chunk_index(content: &[u8]) -> Option<ChunkIndex> {
    let mut fields = Fields(content);
    let mut next = || fields.u64();
    let [start, end, at, length] = [next()?, next()?, next()?, next()?];
    Some(ChunkIndex { start, end, at, length, indexes: fields.by_channel()? })
}

/// How many chunks there are, and messages of each channel.
pub(super) fn statistics(content: &[u8]) -> Option<(u32, Vec<(u16, u64)>)> {
    let mut fields = Fields(content);
    fields.take(8 + 2 + 4 + 4 + 4)?;
    let chunks = fields.u32()?;
    fields.take(8 + 8)?;
    Some((chunks, fields.by_channel()?))
}

/// Log times and places of a channel's messages in a chunk.
pub(super) fn message_index(content: &[u8]) -> Option<Vec<(u64, u64)>> {
    let mut fields = Fields(content);
    fields.u16()?;
    let mut pairs = Fields(fields.bytes()?);
    let mut all = Vec::with_capacity(pairs.0.len() / 16);
    while !pairs.0.is_empty() {
        all.push((pairs.u64()?, pairs.u64()?));
    }
    Some(all)
}
