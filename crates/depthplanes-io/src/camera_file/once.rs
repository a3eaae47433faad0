//! Keys of a camera file that stand once: of two values for one key nobody knows which is meant.

use std::fmt;

use serde::de::{Deserialize, Deserializer, MapAccess, SeqAccess, Visitor};
use serde_json::{Map, Value};

/// Adds a value; refuses another one for the same key.
pub(super) fn insert_once(map: &mut Map<String, Value>, key: &str, value: Value) -> Result<(), String> {
    match map.get(key) {
        Some(other) if *other != value => {
            let shown: String = key.chars().take(60).collect();
            Err(format!("the key `{shown}` stands twice with different values"))
        }
        _ => {
            map.insert(key.to_string(), value);
            Ok(())
        }
    }
}

/// A tree of JSON, or the key that stands twice in it.
pub(super) struct OnceKeys(pub(super) Result<Value, String>);

impl<'de> Deserialize<'de> for OnceKeys {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(Tree)
    }
}

struct Tree;

impl<'de> Visitor<'de> for Tree {
    type Value = OnceKeys;

    fn expecting(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str("JSON")
    }

    fn visit_bool<E>(self, value: bool) -> Result<OnceKeys, E> {
        Ok(OnceKeys(Ok(value.into())))
    }

    fn visit_i64<E>(self, value: i64) -> Result<OnceKeys, E> {
        Ok(OnceKeys(Ok(value.into())))
    }

    fn visit_u64<E>(self, value: u64) -> Result<OnceKeys, E> {
        Ok(OnceKeys(Ok(value.into())))
    }

    fn visit_f64<E>(self, value: f64) -> Result<OnceKeys, E> {
        Ok(OnceKeys(Ok(value.into())))
    }

    fn visit_str<E>(self, value: &str) -> Result<OnceKeys, E> {
        Ok(OnceKeys(Ok(value.into())))
    }

    fn visit_unit<E>(self) -> Result<OnceKeys, E> {
        Ok(OnceKeys(Ok(Value::Null)))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut items: A) -> Result<OnceKeys, A::Error> {
        let mut all = Ok(Vec::new());
        while let Some(OnceKeys(item)) = items.next_element()? {
            all = all.and_then(|mut all: Vec<Value>| {
                all.push(item?);
                Ok(all)
            });
        }
        Ok(OnceKeys(all.map(Value::Array)))
    }

    fn visit_map<A: MapAccess<'de>>(self, mut entries: A) -> Result<OnceKeys, A::Error> {
        let mut all = Ok(Map::new());
        while let Some((key, OnceKeys(value))) = entries.next_entry::<String, OnceKeys>()? {
            all = all.and_then(|mut all| insert_once(&mut all, &key, value?).map(|()| all));
        }
        Ok(OnceKeys(all.map(Value::Object)))
    }
}
