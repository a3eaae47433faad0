//! The messages of a file by their log time, a few chunks at a time.

use super::chunk::{Content, unpack};
use super::input::Input;
use super::layout::{Layout, Part};
use super::records::{self, Channel, HEAD, MESSAGE_HEAD, op};
use crate::error::{Error, Result};
use std::cmp::Reverse;
use std::collections::{BTreeMap, BTreeSet, BinaryHeap};
use std::ops::Range;
use std::path::Path;
use std::sync::Arc;

/// Bytes of chunks that are kept at once: chunks overlap in time a little. Where they overlap by more, messages come out of
/// order rather than filling the memory.
const MOST_HELD: usize = 1 << 28;

/// A message, which lends its data from its chunk.
#[derive(Debug)]
pub(crate) struct Message {
    pub(crate) channel: u16,
    /// Nanoseconds.
    pub(crate) log_time: u64,
    part: usize,
    /// Where its content begins among the records of its part.
    place: usize,
    bytes: Arc<Vec<u8>>,
    range: Range<usize>,
}

impl Message {
    pub(crate) fn data(&self) -> &[u8] {
        &self.bytes[self.range.clone()]
    }

    /// What messages are sorted by: log time, part, and place in it.
    fn key(&self) -> (u64, usize, u64) {
        (self.log_time, self.part, self.place as u64)
    }
}

impl PartialEq for Message {
    fn eq(&self, other: &Self) -> bool {
        self.key() == other.key()
    }
}
impl Eq for Message {}
impl PartialOrd for Message {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}
impl Ord for Message {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        self.key().cmp(&other.key())
    }
}

/// Reads the messages of some topics.
#[derive(Debug)]
pub(crate) struct Reader {
    input: Input,
    layout: Layout,
    /// The most bytes of a chunk.
    most: usize,
    /// The topics; all if there are none.
    topics: BTreeSet<String>,
    next: usize,
    waiting: BinaryHeap<Reverse<Message>>,
    /// Bytes of the parts with messages that wait, and how many.
    held: BTreeMap<usize, (usize, usize)>,
    /// Messages before this one are left out.
    from: (u64, usize, u64),
    /// The first place of the file where something is wrong: parts behind it are left out.
    fault: Option<(u64, Error)>,
    is_over: bool,
    /// Bytes of all parts so far.
    pub(crate) bytes_read: u64,
}

impl Reader {
    /// Opens a file; `most`: bytes of a chunk.
    ///
    /// # Errors
    /// [`Error::Io`], and [`Error::Source`] for what is no MCAP file. Faults further on come behind the messages before them.
    pub(crate) fn open(path: &Path, most: usize) -> Result<Self> {
        let mut input = Input::open(path)?;
        let layout = Layout::of(&mut input)?;
        Ok(Reader {
            input,
            layout,
            most,
            topics: BTreeSet::new(),
            next: 0,
            waiting: BinaryHeap::new(),
            held: BTreeMap::new(),
            from: (0, 0, 0),
            fault: None,
            is_over: false,
            bytes_read: 0,
        })
    }

    /// Starts anew, with the messages of these topics alone.
    pub(crate) fn rewind(&mut self, topics: BTreeSet<String>) {
        self.topics = topics;
        self.go_to(0, (0, 0, 0));
    }

    fn go_to(&mut self, part: usize, from: (u64, usize, u64)) {
        (self.next, self.from) = (part, from);
        self.waiting.clear();
        self.held.clear();
        (self.fault, self.is_over) = (None, false);
    }

    /// What is known of the channels so far.
    pub(crate) fn channels(&self) -> impl Iterator<Item = (u16, &Channel)> {
        self.layout.channels.iter().map(|(id, channel)| (*id, channel))
    }

    pub(crate) fn channel(&self, id: u16) -> Option<&Channel> {
        self.layout.channels.get(&id)
    }

    /// Whether a summary tells of all channels.
    pub(crate) fn has_summary(&self) -> bool {
        self.layout.counts.is_some()
    }

    /// How many messages a topic has, if the summary says it.
    pub(crate) fn count(&self, topic: &str) -> Option<u64> {
        let counts = self.layout.counts.as_ref()?;
        let of_topic = self.channels().filter(|(_, channel)| channel.topic == topic);
        Some(of_topic.filter_map(|(id, _)| counts.get(&id)).sum())
    }

    /// The next message; an error is the last that comes.
    pub(crate) fn next(&mut self) -> Option<Result<Message>> {
        while self.wants_a_part() {
            let at = self.layout.parts[self.next].at;
            if self.fault.as_ref().is_some_and(|(fault, _)| at > *fault) {
                self.next += 1;
            } else if let Err(error) = self.open_part() {
                self.fault = Some((at, error));
            }
        }
        if let Some(Reverse(message)) = self.waiting.pop() {
            self.release(message.part);
            return Some(Ok(message));
        }
        if std::mem::replace(&mut self.is_over, true) {
            return None;
        }
        let behind = self.layout.fault.as_ref().map(|(at, wrong)| self.input.fault(*at, wrong));
        self.fault.take().map(|(_, error)| error).or(behind).map(Err)
    }

    /// Whether the next part may have a message before all that wait.
    fn wants_a_part(&self) -> bool {
        let Some(part) = self.layout.parts.get(self.next) else { return false };
        let held: usize = self.held.values().map(|(bytes, _)| bytes).sum();
        let may = |Reverse(first): &Reverse<Message>| part.start <= first.log_time && held < MOST_HELD;
        !self.is_over && self.waiting.peek().is_none_or(may)
    }

    fn is_wanted(&self, channel: u16) -> bool {
        let topic = self.channel(channel).map(|channel| &channel.topic);
        self.topics.is_empty() || topic.is_some_and(|topic| self.topics.contains(topic))
    }

    /// Reads the next part; its messages wait.
    fn open_part(&mut self) -> Result<()> {
        let number = self.next;
        self.next += 1;
        let part = self.layout.parts[number].clone();
        let has_none = |(id, _): &(u16, u64)| self.channel(*id).is_some() && !self.is_wanted(*id);
        if !part.indexes.is_empty() && part.indexes.iter().all(has_none) {
            return Ok(());
        }
        self.bytes_read += part.length;
        let Content { bytes, from, fault } = self.content(&part)?;
        let bytes = Arc::new(bytes);
        let (mut count, mut end) = (0, from);
        for (op, place, content) in records::records(&bytes[from..]) {
            end = from + place + content.len();
            if op != op::MESSAGE {
                self.layout.add(op, content);
                continue;
            }
            let Some((channel, log_time)) = records::message(content) else {
                return Err(self.input.fault(part.at, format!("a message of {} bytes", content.len())));
            };
            // Chunks are ordered by what they say of their times, which no checksum is for.
            if log_time < part.start {
                let wrong = format!("a message of time {log_time} in a chunk that begins at {}", part.start);
                return Err(self.input.fault(part.at, wrong));
            }
            let range = from + place + MESSAGE_HEAD..from + place + content.len();
            let message = Message { channel, log_time, part: number, place, bytes: Arc::clone(&bytes), range };
            if self.is_wanted(channel) && message.key() >= self.from {
                self.waiting.push(Reverse(message));
                count += 1;
            }
        }
        if count > 0 {
            self.held.insert(number, (bytes.len(), count));
        }
        let odd =
            || (end < bytes.len()).then(|| format!("a record that ends behind its chunk, {} bytes in", end - from));
        fault.or_else(odd).map_or(Ok(()), |fault| Err(self.input.fault(part.at, fault)))
    }

    fn content(&mut self, part: &Part) -> Result<Content> {
        // The record of a chunk may be longer than what is in it by a header and what does not compress.
        if part.length > self.most as u64 + (1 << 16) {
            let wrong = format!("{} bytes at once, the limit is {}", part.length, self.most);
            return Err(self.input.fault(part.at, wrong));
        }
        if !part.is_chunk {
            return Ok(Content { bytes: self.input.read(part.at, part.length)?, from: 0, fault: None });
        }
        let head = self.input.read(part.at, HEAD)?;
        let mut fields = records::Fields(&head);
        match (fields.u8(), fields.u64()) {
            (Some(op::CHUNK), Some(_)) => Ok(unpack(self.input.read(part.at + HEAD, part.length - HEAD)?, self.most)),
            _ => Err(self.input.fault(part.at, "no chunk, though the summary says so")),
        }
    }

    /// A part goes with its last message.
    fn release(&mut self, part: usize) {
        if let Some((_, count)) = self.held.get_mut(&part) {
            *count -= 1;
            if *count == 0 {
                self.held.remove(&part);
            }
        }
    }

    /// Makes the message of that index of a topic the next one of it; whether the summary tells enough for that.
    pub(crate) fn seek(&mut self, topic: &str, index: u64) -> Result<bool> {
        let Some(mut keys) = self.keys(topic)? else { return Ok(false) };
        keys.sort_unstable();
        let Some(&key) = keys.get(usize::try_from(index).unwrap_or(usize::MAX)) else {
            self.go_to(self.layout.parts.len(), (u64::MAX, 0, 0));
            self.is_over = true;
            return Ok(true);
        };
        let first = self.layout.parts.iter().position(|part| part.end >= key.0);
        self.go_to(first.unwrap_or(0), key);
        Ok(true)
    }

    /// Times and places of all messages of a topic, by the indexes behind the chunks.
    fn keys(&mut self, topic: &str) -> Result<Option<Vec<(u64, usize, u64)>>> {
        let ids: Vec<u16> = self.channels().filter(|(_, channel)| channel.topic == topic).map(|(id, _)| id).collect();
        let mut keys = Vec::new();
        for number in 0..self.layout.parts.len() {
            let part = &self.layout.parts[number];
            if part.indexes.is_empty() {
                return Ok(None);
            }
            let places: Vec<u64> = part.indexes.iter().filter(|(id, _)| ids.contains(id)).map(|(_, at)| *at).collect();
            for at in places {
                let head = self.input.read(at, HEAD)?;
                let mut fields = records::Fields(&head);
                let (Some(op::MESSAGE_INDEX), Some(length)) = (fields.u8(), fields.u64()) else { return Ok(None) };
                if length > self.most as u64 {
                    return Ok(None);
                }
                let content = self.input.read(at.saturating_add(HEAD), length)?;
                let Some(times) = records::message_index(&content) else { return Ok(None) };
                keys.extend(times.into_iter().map(|(time, place)| (time, number, place + HEAD)));
            }
        }
        Ok(Some(keys))
    }
}
