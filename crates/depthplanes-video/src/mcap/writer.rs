//! Writes MCAP: a chunk for each frame, handed on as soon as it is made, so that whatever ends the program leaves whole ones.

use super::records::{HEAD, MAGIC, op};
use lz4_flex::frame::FrameEncoder;
use std::collections::BTreeMap;
use std::io::{self, Write};

/// What a topic is.
#[derive(Clone, Copy, Debug)]
pub struct Topic<'a> {
    /// Its name, such as `/depth`.
    pub name: &'a str,
    /// How its messages are encoded: `protobuf`, `json` ...
    pub encoding: &'a str,
    /// The name of their type.
    pub schema: &'a str,
    /// How the type is described: `protobuf`, `jsonschema` ...
    pub schema_encoding: &'a str,
    /// The description.
    pub description: &'a [u8],
}

/// Writes messages, a chunk at a time.
///
/// ```
/// use depthplanes_video::mcap::{Topic, Writer};
/// let topic = Topic { name: "/said", encoding: "json", schema: "said", schema_encoding: "jsonschema", description: b"{}" };
/// let mut writer = Writer::new(Vec::new(), &[topic])?;
/// writer.chunk(&[(0, 1_000_000_000, b"{\"text\": \"a second\"}")])?;
/// let file = writer.finish()?;
/// assert!(file.starts_with(b"\x89MCAP"));
/// # Ok::<(), std::io::Error>(())
/// ```
#[derive(Debug)]
pub struct Writer<W: Write> {
    out: W,
    /// Bytes so far.
    at: u64,
    /// The records of types and channels, which are written twice.
    topics: Vec<u8>,
    /// The records of the summary that tell where the chunks are.
    chunks: Vec<u8>,
    chunk_count: u32,
    /// Messages of each topic.
    counts: Vec<u64>,
    /// The first and the last log time, nanoseconds.
    times: [u64; 2],
}

impl<W: Write> Writer<W> {
    /// Writes the beginning of a file with these topics.
    ///
    /// # Errors
    /// Those of `out`.
    pub fn new(out: W, topics: &[Topic<'_>]) -> io::Result<Self> {
        let mut known = Vec::new();
        for (id, topic) in (0u16..).zip(topics) {
            let schema = [&(id + 1).to_le_bytes()[..], &text(topic.schema), &text(topic.schema_encoding)];
            record(&mut known, op::SCHEMA, &[schema.concat(), bytes(topic.description)].concat());
            let numbers = [id.to_le_bytes(), (id + 1).to_le_bytes()].concat();
            let metadata = 0u32.to_le_bytes();
            let channel = [&numbers[..], &text(topic.name), &text(topic.encoding), &metadata].concat();
            record(&mut known, op::CHANNEL, &channel);
        }
        let mut start = MAGIC.to_vec();
        record(&mut start, op::HEADER, &[text(""), text("depthplanes")].concat());
        start.extend(&known);
        let counts = vec![0; topics.len()];
        let mut writer =
            Writer { out, at: 0, topics: known, chunks: Vec::new(), chunk_count: 0, counts, times: [u64::MAX, 0] };
        writer.write(&start)?;
        Ok(writer)
    }

    fn write(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.out.write_all(bytes)?;
        self.at += bytes.len() as u64;
        self.out.flush()
    }

    /// Writes messages as one chunk: the topic of each, counted from 0, its log time in nanoseconds, and its bytes.
    ///
    /// # Errors
    /// Those of `out`.
    ///
    /// # Panics
    /// For a topic that there is not.
    pub fn chunk(&mut self, messages: &[(u16, u64, &[u8])]) -> io::Result<()> {
        let (mut records, mut indexes) = (Vec::new(), Vec::new());
        let mut places: BTreeMap<u16, Vec<u8>> = BTreeMap::new();
        for &(topic, time, data) in messages {
            let count = &mut self.counts[usize::from(topic)];
            *count += 1;
            let place = [time.to_le_bytes(), (records.len() as u64).to_le_bytes()].concat();
            places.entry(topic).or_default().extend(place);
            let numbers = [&topic.to_le_bytes()[..], &(*count as u32).to_le_bytes(), &time.to_le_bytes()].concat();
            head(&mut records, op::MESSAGE, numbers.len() + 8 + data.len());
            records.extend(numbers);
            records.extend(time.to_le_bytes());
            records.extend(data);
        }
        let times = || messages.iter().map(|message| message.1);
        let (start, end) = (times().min().unwrap_or(0), times().max().unwrap_or(0));
        let mut packed = FrameEncoder::new(Vec::new());
        packed.write_all(&records)?;
        let packed = packed.finish().map_err(io::Error::other)?;
        let mut written = Vec::with_capacity(packed.len() + 1024);
        let sizes = [records.len() as u64, packed.len() as u64];
        head(&mut written, op::CHUNK, 8 + 8 + 8 + 4 + 7 + 8 + packed.len());
        [start, end, sizes[0]].iter().for_each(|number| written.extend(number.to_le_bytes()));
        written.extend(crc32fast::hash(&records).to_le_bytes());
        written.extend(text("lz4"));
        written.extend(sizes[1].to_le_bytes());
        written.extend(&packed);
        let length = written.len() as u64;
        for (topic, places) in places {
            indexes.extend(topic.to_le_bytes());
            indexes.extend((self.at + written.len() as u64).to_le_bytes());
            record(&mut written, op::MESSAGE_INDEX, &[&topic.to_le_bytes()[..], &bytes(&places)].concat());
        }
        let mut index = Vec::new();
        [start, end, self.at, length].iter().for_each(|number| index.extend(number.to_le_bytes()));
        index.extend(bytes(&indexes));
        index.extend((written.len() as u64 - length).to_le_bytes());
        index.extend(text("lz4"));
        [sizes[1], sizes[0]].iter().for_each(|number| index.extend(number.to_le_bytes()));
        record(&mut self.chunks, op::CHUNK_INDEX, &index);
        self.chunk_count += 1;
        self.times = [self.times[0].min(start), self.times[1].max(end)];
        self.write(&written)
    }

    /// Writes the summary and the end; gives back what it was written to.
    ///
    /// # Errors
    /// Those of `out`.
    pub fn finish(mut self) -> io::Result<W> {
        let mut end = Vec::new();
        record(&mut end, op::DATA_END, &0u32.to_le_bytes());
        let summary_at = self.at + end.len() as u64;
        let mut summary = std::mem::take(&mut self.topics);
        record(&mut summary, op::STATISTICS, &self.statistics());
        summary.append(&mut self.chunks);
        head(&mut summary, op::FOOTER, 8 + 8 + 4);
        summary.extend(summary_at.to_le_bytes());
        summary.extend(0u64.to_le_bytes()); // no offsets of groups
        summary.extend(crc32fast::hash(&summary).to_le_bytes());
        end.extend(summary);
        end.extend(MAGIC);
        self.write(&end)?;
        Ok(self.out)
    }

    fn statistics(&self) -> Vec<u8> {
        let topics = self.counts.len();
        let [start, end] = if self.chunk_count == 0 { [0; 2] } else { self.times };
        let counts = (0u16..)
            .zip(&self.counts)
            .flat_map(|(id, count)| id.to_le_bytes().into_iter().chain(count.to_le_bytes()).collect::<Vec<u8>>());
        [
            &self.counts.iter().sum::<u64>().to_le_bytes()[..],
            &(topics as u16).to_le_bytes(),
            &(topics as u32).to_le_bytes(),
            &[0; 8], // attachments and metadata
            &self.chunk_count.to_le_bytes(),
            &start.to_le_bytes(),
            &end.to_le_bytes(),
            &bytes(&counts.collect::<Vec<u8>>()),
        ]
        .concat()
    }
}

fn head(out: &mut Vec<u8>, op: u8, length: usize) {
    out.reserve(HEAD as usize + length);
    out.push(op);
    out.extend((length as u64).to_le_bytes());
}

fn record(out: &mut Vec<u8>, op: u8, content: &[u8]) {
    head(out, op, content.len());
    out.extend(content);
}

/// Bytes behind their number.
fn bytes(bytes: &[u8]) -> Vec<u8> {
    [&(bytes.len() as u32).to_le_bytes()[..], bytes].concat()
}

fn text(text: &str) -> Vec<u8> {
    bytes(text.as_bytes())
}
