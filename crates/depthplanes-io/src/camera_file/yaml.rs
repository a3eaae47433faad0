//! YAML as calibration programs write it, as the tree that JSON would give.
//!
//! Not YAML in general: block and flow collections, scalars, comments, tags (ignored), OpenCV's `%YAML:1.0`, and the first
//! of several documents (`rostopic echo`). No crate for it: those that are kept up refuse OpenCV's header and its tags, and cost
//! more to build than this file.

use serde_json::{Map, Number, Value};

use super::once::insert_once;

/// Deeper trees than any camera file's are refused.
const DEEPEST: usize = 32;

struct Line<'a> {
    indent: usize,
    text: std::borrow::Cow<'a, str>,
}

/// The tree of a text; says what it stumbled over.
pub(super) fn parse(text: &str) -> Result<Value, String> {
    let lines = lines(text);
    let mut at = 0;
    let tree = block(&lines, &mut at, 0, 0)?;
    match lines.get(at) {
        Some(line) => Err(format!("the line `{}` is no YAML of a camera", shown(&line.text))),
        None => Ok(tree),
    }
}

fn shown(text: &str) -> String {
    text.chars().take(60).collect()
}

/// Lines with something on them; those within brackets are joined.
fn lines(text: &str) -> Vec<Line<'_>> {
    let mut lines: Vec<Line<'_>> = Vec::new();
    let mut open = 0i64;
    for raw in text.lines() {
        let line = without_comment(raw);
        let content = line.trim();
        if open <= 0 {
            if content == "---" || content == "..." {
                if lines.is_empty() {
                    continue;
                }
                break;
            }
            if content.is_empty() || content.starts_with('%') {
                continue;
            }
        }
        let brackets = |c: char| match c {
            '[' | '{' => 1,
            ']' | '}' => -1,
            _ => 0,
        };
        let balance: i64 = content.chars().map(brackets).sum();
        match lines.last_mut() {
            Some(last) if open > 0 => {
                last.text.to_mut().push(' ');
                last.text.to_mut().push_str(content);
            }
            _ => lines.push(Line { indent: line.len() - line.trim_start().len(), text: content.into() }),
        }
        open = (open + balance).max(0);
    }
    lines
}

fn without_comment(line: &str) -> &str {
    let mut quote = None;
    let mut before = ' ';
    for (at, c) in line.char_indices() {
        match quote {
            Some(open) if c == open => quote = None,
            None if c == '"' || c == '\'' => quote = Some(c),
            None if c == '#' && before.is_whitespace() => return &line[..at],
            _ => (),
        }
        before = c;
    }
    line
}

/// The block that begins at a line whose indent is at least `least`.
fn block(lines: &[Line<'_>], at: &mut usize, least: usize, depth: usize) -> Result<Value, String> {
    let Some(first) = lines.get(*at).filter(|line| line.indent >= least) else { return Ok(Value::Null) };
    if depth > DEEPEST {
        return Err("it is nested too deeply".into());
    }
    let indent = first.indent;
    if is_item(&first.text) {
        let mut items = Vec::new();
        while let Some(line) = lines.get(*at).filter(|line| line.indent == indent && is_item(&line.text)) {
            items.push(item(lines, at, line, depth)?);
        }
        return Ok(Value::Array(items));
    }
    if key_value(&first.text).is_none() {
        *at += 1;
        return scalar_or_flow(&first.text);
    }
    let mut map = Map::new();
    while let Some(line) = lines.get(*at).filter(|line| line.indent == indent) {
        let (key, value) =
            key_value(&line.text).ok_or_else(|| format!("the line `{}` is no `key: value`", shown(&line.text)))?;
        *at += 1;
        let value = self::value(lines, at, value, indent, depth)?;
        insert_once(&mut map, key, value)?;
    }
    Ok(Value::Object(map))
}

fn is_item(text: &str) -> bool {
    text == "-" || text.starts_with("- ")
}

/// An item of a list: a value, or a block whose first line is that of the dash.
fn item(lines: &[Line<'_>], at: &mut usize, line: &Line<'_>, depth: usize) -> Result<Value, String> {
    let rest = line.text[1..].trim_start();
    let inner = line.indent + line.text.len() - rest.len();
    if rest.is_empty() {
        *at += 1;
        return block(lines, at, line.indent + 1, depth + 1);
    }
    if !is_item(rest) && key_value(rest).is_none() {
        *at += 1;
        return scalar_or_flow(rest);
    }
    // The dash counts as an indent of the lines below.
    let end =
        lines[*at + 1..].iter().position(|other| other.indent <= line.indent).map_or(lines.len(), |n| *at + 1 + n);
    let mut own: Vec<Line<'_>> = vec![Line { indent: inner, text: rest.into() }];
    own.extend(lines[*at + 1..end].iter().map(|line| Line { indent: line.indent, text: line.text.as_ref().into() }));
    let mut here = 0;
    let value = block(&own, &mut here, 0, depth + 1)?;
    if let Some(line) = own.get(here) {
        return Err(format!("the line `{}` is no YAML of a camera", shown(&line.text)));
    }
    *at = end;
    Ok(value)
}

/// What stands behind a key: on its line, or as a block below.
fn value(lines: &[Line<'_>], at: &mut usize, text: &str, indent: usize, depth: usize) -> Result<Value, String> {
    let text = without_tag(text);
    if !text.is_empty() {
        return scalar_or_flow(text);
    }
    let list_at_same_indent = lines.get(*at).is_some_and(|line| line.indent == indent && is_item(&line.text));
    block(lines, at, if list_at_same_indent { indent } else { indent + 1 }, depth + 1)
}

fn without_tag(text: &str) -> &str {
    let text = text.trim();
    if text.starts_with('!') { text.split_once(char::is_whitespace).map_or("", |(_, rest)| rest.trim()) } else { text }
}

/// `key: value`, or `key:value` of old OpenCV files if the key is a plain word.
fn key_value(text: &str) -> Option<(&str, &str)> {
    if text.starts_with(['[', '{']) {
        return None;
    }
    let (key, rest) = match text.strip_prefix('"') {
        Some(quoted) => {
            let (key, rest) = quoted.split_once('"')?;
            (key, rest.trim_start().strip_prefix(':')?)
        }
        None => text.split_once(':')?,
    };
    let key = key.trim().trim_matches('\'');
    (!key.is_empty() && key.len() < 100).then_some((key, rest))
}

fn scalar_or_flow(text: &str) -> Result<Value, String> {
    let text = text.trim();
    if !text.starts_with(['[', '{']) {
        return Ok(scalar(text));
    }
    let mut rest = text;
    let value = flow(&mut rest, 0)?;
    if rest.trim().is_empty() { Ok(value) } else { Err(format!("`{}` is not expected", shown(rest))) }
}

/// A list or a map on one line.
fn flow(rest: &mut &str, depth: usize) -> Result<Value, String> {
    if depth > DEEPEST {
        return Err("it is nested too deeply".into());
    }
    *rest = rest.trim_start();
    let open = rest.chars().next();
    let Some(open @ ('[' | '{')) = open else {
        let end = rest.find([',', ']', '}', ';']).unwrap_or(rest.len());
        let (word, after) = rest.split_at(end);
        *rest = after;
        return Ok(scalar(word));
    };
    *rest = &rest[1..];
    let (mut items, mut map) = (Vec::new(), Map::new());
    loop {
        *rest = rest.trim_start_matches([',', ';', ' ', '\t']);
        match rest.chars().next() {
            None => return Err("a bracket is not closed".into()),
            Some(']') if open == '[' => {
                *rest = &rest[1..];
                return Ok(Value::Array(items));
            }
            Some('}') if open == '{' => {
                *rest = &rest[1..];
                return Ok(Value::Object(map));
            }
            Some(']' | '}') => return Err("brackets do not match".into()),
            Some(_) if open == '{' => {
                let (key, after) = rest.split_once(':').ok_or("a key has no value")?;
                *rest = after;
                let value = flow(rest, depth + 1)?;
                insert_once(&mut map, key.trim().trim_matches(['"', '\'']), value)?;
            }
            Some('[' | '{') => items.push(flow(rest, depth + 1)?),
            Some(_) => match flow(rest, depth + 1)? {
                // `[1 0 2; 0 1 3]`
                Value::String(words) => match super::names::words(&words) {
                    Some(numbers) if numbers.len() > 1 => items.extend(numbers.into_iter().map(number)),
                    _ => items.push(Value::String(words)),
                },
                value => items.push(value),
            },
        }
    }
}

fn number(value: f64) -> Value {
    Number::from_f64(value).map_or(Value::Null, Value::Number)
}

fn scalar(text: &str) -> Value {
    let text = text.trim();
    let is_quoted = |quote: char| text.len() >= 2 && text.starts_with(quote) && text.ends_with(quote);
    if is_quoted('"') || is_quoted('\'') {
        return Value::String(text[1..text.len() - 1].to_string());
    }
    match text.parse::<f64>() {
        Ok(value) if value.is_finite() => number(value),
        _ => Value::String(text.to_string()),
    }
}

#[cfg(test)]
mod tests {
    use super::parse;
    use serde_json::json;

    #[test]
    fn what_calibration_programs_write_is_a_tree() {
        let text = "%YAML:1.0\n---\n# c\nM: !!opencv-matrix\n   rows: 3\n   data: [ 1., 2.,\n      3. ]\nList:\n- 1.0\n- a: 2\n  b: \"x # y\"\n- [1, {c: 2}]\nCamera.fx: 5 # px\n---\nM: 9\n";
        let expected = json!({
            "M": {"rows": 3.0, "data": [1.0, 2.0, 3.0]},
            "List": [1.0, {"a": 2.0, "b": "x # y"}, [1.0, {"c": 2.0}]],
            "Camera.fx": 5.0,
        });
        assert_eq!(parse(text).unwrap(), expected);
        assert_eq!(parse("K: [1 0 2; 0 1 3]").unwrap(), json!({"K": [1.0, 0.0, 2.0, 0.0, 1.0, 3.0]}));
        for wrong in ["a: [1", "a: {b", "a: [}", "a: 1\n  b: 2", "a: 1\nb"] {
            assert!(parse(wrong).is_err(), "{wrong}");
        }
        assert!(parse(&"- ".repeat(5000)).is_err());
        assert!(parse(&format!("a: {}", "[".repeat(5000))).is_err());
    }
}
