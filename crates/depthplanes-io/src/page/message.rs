//! Binary messages: a head of JSON and arrays of numbers behind it.
//!
//! `[length of the head, u32 little endian][head][arrays]`. The head is padded with spaces so that the arrays start at a
//! multiple of 8, and each array is padded to one. The head's `arrays` say of each its `type` (`u8`, `u16`, `f32`, all little
//! endian), where it starts (`at`, bytes after the head), and how many numbers it has (`length`).

use serde_json::{Map, Value, json};

/// Where arrays start.
const ALIGNED: usize = 8;

/// A message while it is made.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Message {
    head: Map<String, Value>,
    listed: Map<String, Value>,
    bytes: Vec<u8>,
}

impl Message {
    /// Of a head that is an object; of another value it is empty.
    pub fn new(head: Value) -> Self {
        Message::default().with(head)
    }

    /// The same with the fields of an object in its head.
    #[must_use]
    pub fn with(mut self, fields: Value) -> Self {
        if let Value::Object(fields) = fields {
            self.head.extend(fields);
        }
        self
    }

    /// Adds an array of bytes.
    pub fn add_u8(&mut self, name: &str, numbers: &[u8]) {
        self.add(name, "u8", numbers, |number| [*number]);
    }

    /// Adds an array of 16-bit numbers.
    pub fn add_u16(&mut self, name: &str, numbers: &[u16]) {
        self.add(name, "u16", numbers, |number| number.to_le_bytes());
    }

    /// Adds an array of floating-point numbers.
    pub fn add_f32(&mut self, name: &str, numbers: &[f32]) {
        self.add(name, "f32", numbers, |number| number.to_le_bytes());
    }

    fn add<T, const N: usize>(&mut self, name: &str, kind: &str, numbers: &[T], bytes: impl Fn(&T) -> [u8; N]) {
        let at = self.bytes.len();
        self.listed.insert(name.into(), json!({"type": kind, "at": at, "length": numbers.len()}));
        self.bytes.resize((at + N * numbers.len()).next_multiple_of(ALIGNED), 0);
        for (place, number) in self.bytes[at..].chunks_exact_mut(N).zip(numbers) {
            place.copy_from_slice(&bytes(number));
        }
    }

    /// The whole message.
    pub fn into_bytes(mut self) -> Vec<u8> {
        self.head.insert("arrays".into(), self.listed.into());
        let mut text = Value::from(self.head).to_string().into_bytes();
        text.resize((text.len() + 4).next_multiple_of(ALIGNED) - 4, b' ');
        let length = (text.len() as u32).to_le_bytes();
        [&length, text.as_slice(), &self.bytes].concat()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn arrays_start_where_the_head_says() {
        let mut message = Message::new(json!({"type": "frame"}));
        message.add_u8("marks", &[1, 2, 3]);
        message.add_f32("rays", &[0.5, -2.0]);
        let message = message.into_bytes();
        let length = u32::from_le_bytes(message[..4].try_into().unwrap()) as usize;
        let head: Value = serde_json::from_slice(&message[4..4 + length]).unwrap();
        let start = 4 + length;
        assert_eq!((start % ALIGNED, &head["type"]), (0, &json!("frame")));
        assert_eq!(head["arrays"]["marks"], json!({"type": "u8", "at": 0, "length": 3}));
        let at = start + head["arrays"]["rays"]["at"].as_u64().unwrap() as usize;
        assert_eq!(at % ALIGNED, 0);
        assert_eq!(message[at..at + 8], [0, 0, 0, 63, 0, 0, 0, 192]);
    }
}
