//! OpenCV's FileStorage as XML, as the tree that its YAML would give: elements by name, their text where they have no
//! others.

use serde_json::{Map, Value};

/// Deeper trees than any camera file's are refused.
const DEEPEST: usize = 32;

/// The tree of a text; says what it stumbled over. Attributes and comments are left out.
pub(super) fn parse(text: &str) -> Result<Value, String> {
    let mut open: Vec<(String, Map<String, Value>, String)> = vec![(String::new(), Map::new(), String::new())];
    let mut rest = text;
    while let Some((before, after)) = rest.split_once('<') {
        if let Some((_, _, words)) = open.last_mut() {
            words.push_str(before);
        }
        let end = if after.starts_with("!--") { "-->" } else { ">" };
        let (tag, next) = after.split_once(end).ok_or("a tag is not closed")?;
        rest = next;
        let name = tag.trim_matches('/').split_whitespace().next().unwrap_or("");
        if tag.starts_with(['?', '!']) || tag.ends_with('/') {
            continue;
        }
        if !tag.starts_with('/') {
            if open.len() > DEEPEST {
                return Err("it is nested too deeply".into());
            }
            open.push((name.to_string(), Map::new(), String::new()));
            continue;
        }
        let Some((own, inner, words)) = open.pop().filter(|(own, ..)| own == name && !name.is_empty()) else {
            return Err(format!("`</{name}>` closes nothing"));
        };
        let value = if inner.is_empty() { Value::String(words.trim().to_string()) } else { Value::Object(inner) };
        let Some((_, above, _)) = open.last_mut() else { return Err("it has no root".into()) };
        above.entry(own).or_insert(value);
    }
    match open.pop() {
        Some((_, root, _)) if open.is_empty() && !root.is_empty() => Ok(Value::Object(root)),
        _ => Err("an element is not closed".into()),
    }
}
