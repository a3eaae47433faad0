//! What the node says to whoever started it, on standard error.

use std::fmt;
use std::io::Write;

/// Why the node did not start, or could not go on.
#[derive(Clone, Debug, PartialEq)]
pub struct Error(String);

impl Error {
    pub(crate) fn new(message: impl Into<String>) -> Self {
        Error(message.into())
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&plain(&self.0))
    }
}

impl std::error::Error for Error {}

/// Says something that a person should know, but that does not end the node.
pub fn note(message: &str) {
    // Where nobody can be told nothing is said.
    let _ = writeln!(std::io::stderr().lock(), "note: {}", plain(message));
}

/// Text of messages cannot steer a terminal: what it would obey or not show is escaped.
fn plain(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '"' | '\'' | '\\' => out.push(c),
            c => out.extend(c.escape_debug()),
        }
    }
    out
}

/// Says each thing once, and no more than a few of them.
#[derive(Default)]
pub(crate) struct Once {
    said: Vec<String>,
}

impl Once {
    /// Things that are said in all.
    const MOST: usize = 20;

    pub(crate) fn note(&mut self, message: &str) {
        if self.said.len() < Self::MOST && !self.said.iter().any(|said| said == message) {
            note(message);
            self.said.push(message.to_string());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::plain;

    #[test]
    fn what_steers_a_terminal_is_escaped() {
        assert_eq!(plain("a \u{1b}[31m 'b' \u{202e} ü\n"), "a \\u{1b}[31m 'b' \\u{202e} ü\\n");
    }
}
