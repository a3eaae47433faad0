//! What may reach a terminal: names of files and what stands in files cannot steer it.
//!
//! In: any text. Out: the same with escapes, `\u001b` as in JSON, for whatever a terminal would obey or not show: control
//! characters, marks of writing direction, marks without width. Standard output goes through [`Plain`], messages and
//! single names through [`plain`]; what is JSON stays the same JSON.

use std::borrow::Cow;
use std::fmt::Write as _;
use std::io::{self, Write};

/// A name or a message in one line.
pub(crate) fn plain(text: &str) -> Cow<'_, str> {
    escaped(text, |c| steers(c) || matches!(c, '\n' | '\t'))
}

/// A writer of text that keeps line ends and tabs, and escapes the rest.
pub(crate) struct Plain<W: Write>(pub(crate) W);

impl<W: Write> Write for Plain<W> {
    /// Writes all of it. Callers write whole texts, so that no character is cut in two.
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let text = String::from_utf8_lossy(bytes);
        self.0.write_all(escaped(&text, steers).as_bytes())?;
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        self.0.flush()
    }
}

fn escaped(text: &str, is_wrong: impl Fn(char) -> bool) -> Cow<'_, str> {
    if !text.contains(&is_wrong) {
        return Cow::Borrowed(text);
    }
    let mut out = String::with_capacity(text.len() + 16);
    for c in text.chars() {
        if is_wrong(c) {
            let mut units = [0; 2];
            c.encode_utf16(&mut units).iter().for_each(|unit| write!(out, "\\u{unit:04x}").expect("it is memory"));
        } else {
            out.push(c);
        }
    }
    Cow::Owned(out)
}

/// Whether a character is obeyed by terminals or not seen on them, line ends and tabs apart.
fn steers(c: char) -> bool {
    match c {
        '\n' | '\t' => false,
        c if c.is_control() => true,                                 // C0, DEL, C1
        '\u{ad}' | '\u{34f}' | '\u{61c}' | '\u{180e}' => true,       // soft hyphen, joiner, marks of direction
        '\u{115f}' | '\u{1160}' | '\u{3164}' | '\u{ffa0}' => true,   // letters that are blank
        '\u{200b}'..='\u{200f}' | '\u{2028}'..='\u{202e}' => true,   // without width, line ends, directions
        '\u{2060}'..='\u{206f}' | '\u{feff}' => true,                // more of them
        '\u{fff9}'..='\u{fffb}' | '\u{e0000}'..='\u{e0fff}' => true, // annotations, tags
        _ => false,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_steers_a_terminal_is_escaped_and_letters_of_all_people_are_not() {
        assert_eq!(plain("a\u{1b}[31mb\u{7}\r\n\t\u{7f}"), r"a\u001b[31mb\u0007\u000d\u000a\u0009\u007f");
        assert_eq!(plain("\u{9b}1m \u{202e}txt\u{2066} \u{200b}\u{feff}"), r"\u009b1m \u202etxt\u2066 \u200b\ufeff");
        assert_eq!(plain("\u{e0041}"), r"\udb40\udc41");
        for text in ["", "räum/ß.png", "部屋.png", "غرفة", "खाली", "😀"] {
            assert!(matches!(plain(text), Cow::Borrowed(same) if same == text), "{text}");
        }
    }

    #[test]
    fn json_stays_the_same_json() {
        let value = serde_json::json!({"source": "\u{1b}\u{9b}\u{202e}\u{e0041}\\u\"\n"});
        let mut out = Plain(Vec::new());
        writeln!(out, "{value:#}").unwrap();
        assert!(!String::from_utf8(out.0.clone()).unwrap().contains(steers));
        assert_eq!(serde_json::from_slice::<serde_json::Value>(&out.0).unwrap(), value);
    }
}
