//! Binary messages: a head of JSON and arrays of numbers behind it.
//!
//! `[length of the head, u32 little endian][head][arrays]`. The head is padded with spaces so that the arrays start at a
//! multiple of 8, and each array is padded to one. The head's `arrays` say of each its `type` (`u8`, `u16`, `f32`, all little
//! endian), where it starts (`at`, bytes after the head), and how many numbers it has (`length`).

use axum::body::Bytes;
use serde_json::{Map, Value, json};

/// Where arrays start.
const ALIGNED: usize = 8;

/// A message while it is made.
#[derive(Default)]
pub(crate) struct Arrays {
    listed: Map<String, Value>,
    bytes: Vec<u8>,
}

impl Arrays {
    pub(crate) fn add_u8(&mut self, name: &str, numbers: &[u8]) {
        self.add(name, "u8", numbers, |number| [*number]);
    }

    pub(crate) fn add_u16(&mut self, name: &str, numbers: &[u16]) {
        self.add(name, "u16", numbers, |number| number.to_le_bytes());
    }

    pub(crate) fn add_f32(&mut self, name: &str, numbers: &[f32]) {
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

    /// The whole message. The head is an object.
    pub(crate) fn message(self, mut head: Value) -> Bytes {
        head["arrays"] = self.listed.into();
        let mut text = head.to_string().into_bytes();
        text.resize((text.len() + 4).next_multiple_of(ALIGNED) - 4, b' ');
        let length = (text.len() as u32).to_le_bytes();
        [&length, text.as_slice(), &self.bytes].concat().into()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn arrays_start_where_the_head_says() {
        let mut arrays = Arrays::default();
        arrays.add_u8("marks", &[1, 2, 3]);
        arrays.add_f32("rays", &[0.5, -2.0]);
        let message = arrays.message(json!({"type": "frame"}));
        let length = u32::from_le_bytes(message[..4].try_into().unwrap()) as usize;
        let head: Value = serde_json::from_slice(&message[4..4 + length]).unwrap();
        let start = 4 + length;
        assert_eq!(start % ALIGNED, 0);
        assert_eq!(head["arrays"]["marks"], json!({"type": "u8", "at": 0, "length": 3}));
        let at = start + head["arrays"]["rays"]["at"].as_u64().unwrap() as usize;
        assert_eq!(at % ALIGNED, 0);
        assert_eq!(message[at..at + 8], [0, 0, 0, 63, 0, 0, 0, 192]);
    }
}
