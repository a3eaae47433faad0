//! Lines of `key = value`, as settings, TOML, Python and Matlab have them, as the tree that JSON would give; and a table of
//! a line of names and lines of numbers.

use serde_json::{Map, Value};

use super::names::words;
use super::once::insert_once;

/// The tree of a text whose every line is `key = value` or `[section]`, or a key that stands twice; none of another text.
/// Values in brackets may go on below.
pub(super) fn parse(text: &str) -> Option<Result<Value, String>> {
    let (mut root, mut section) = (Map::new(), Vec::new());
    let mut lines = text.lines().map(without_comment).filter(|line| !line.is_empty());
    while let Some(line) = lines.next() {
        if let Some(name) = line.strip_prefix('[').and_then(|rest| rest.strip_suffix(']')) {
            section = name.trim_matches(['[', ']']).split('.').map(|part| part.trim().to_string()).collect();
            continue;
        }
        let mut whole = line.to_string();
        while whole.matches('[').count() > whole.matches(']').count() {
            whole.push(' ');
            whole.push_str(lines.next()?);
        }
        for (key, value) in assignments(&whole)? {
            let path: Vec<&str> = section.iter().map(String::as_str).chain(key.split('.')).collect();
            if let Err(twice) = put(&mut root, &path, value)? {
                return Some(Err(twice));
            }
        }
    }
    (!root.is_empty()).then_some(Ok(Value::Object(root)))
}

fn without_comment(line: &str) -> &str {
    let line = line.split(['#', '%']).next().unwrap_or("").split("//").next().unwrap_or("");
    line.trim().trim_end_matches([';', ',']).trim()
}

fn is_name(text: &str) -> bool {
    text.len() < 60
        && text.starts_with(|c: char| c.is_alphabetic() || c == '_')
        && text.chars().all(|c| c.is_alphanumeric() || "_.- ".contains(c))
}

/// `a = 1`, `a, b = 1, 2` or `a = 1, b = 2`.
fn assignments(line: &str) -> Option<Vec<(String, Value)>> {
    let (key, rest) = line.split_once('=')?;
    let names: Vec<&str> = key.split(',').map(str::trim).collect();
    if !names.iter().all(|name| is_name(name)) {
        return None;
    }
    if names.len() > 1 {
        let numbers = words(rest).filter(|numbers| numbers.len() == names.len())?;
        return Some(names.into_iter().map(str::to_string).zip(numbers.into_iter().map(Value::from)).collect());
    }
    if rest.contains('=') {
        let parts = line.split([',', ';']).map(|part| part.split_once('='));
        let one = |part: Option<(&str, &str)>| {
            let (name, value) = part?;
            is_name(name.trim()).then(|| (name.trim().to_string(), scalar(value)))
        };
        return parts.map(one).collect();
    }
    Some(vec![(key.trim().to_string(), scalar(rest))])
}

/// A number, a list of numbers, or a text.
fn scalar(text: &str) -> Value {
    let text = text.trim();
    match words(text).as_deref() {
        Some(&[number]) if !text.starts_with('[') => Value::from(number),
        Some(numbers) if !numbers.is_empty() => Value::from(numbers.to_vec()),
        _ => match text {
            "true" | "True" => Value::Bool(true),
            "false" | "False" => Value::Bool(false),
            _ => Value::String(text.trim_matches(['"', '\'']).to_string()),
        },
    }
}

fn put(object: &mut Map<String, Value>, path: &[&str], value: Value) -> Option<Result<(), String>> {
    match path {
        [] => None,
        [name] => Some(insert_once(object, name, value)),
        [name, rest @ ..] if rest.len() < 16 => {
            match object.entry(name.to_string()).or_insert_with(|| Value::Object(Map::new())) {
                Value::Object(inner) => put(inner, rest, value),
                _ => None,
            }
        }
        _ => None,
    }
}

/// The rows of a table with names above: `fx,fy,cx,cy` and numbers below.
pub(super) fn table(text: &str) -> Option<Value> {
    let mut lines = text.lines().map(|line| line.trim().trim_start_matches('#').trim()).filter(|line| !line.is_empty());
    let names: Vec<&str> =
        lines.next()?.split([',', ';', '\t', ' ']).map(str::trim).filter(|name| !name.is_empty()).collect();
    if names.len() < 4 || !names.iter().all(|name| is_name(name.trim_matches('"'))) {
        return None;
    }
    let row = |line: &str| {
        let cells: Vec<&str> = line.split([',', ';', '\t', ' ']).filter(|cell| !cell.is_empty()).collect();
        let pairs = names.iter().zip(&cells).map(|(name, cell)| (name.trim_matches('"').to_string(), scalar(cell)));
        (cells.len() == names.len()).then(|| Value::Object(pairs.collect()))
    };
    let rows: Vec<Value> = lines.map(row).collect::<Option<_>>()?;
    (!rows.is_empty()).then_some(Value::Array(rows))
}
