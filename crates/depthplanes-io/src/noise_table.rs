//! A sensor's noise from a file.
//!
//! In: CSV text of two columns, range and standard deviation of depth in metres, by increasing range; a first line of
//! words is a heading, `#` begins a comment, empty lines do not count. Out: a [`NoiseTable`].

use std::path::Path;

use depthplanes::noise::NoiseTable;

use crate::error::{Error, Result};
use crate::file_bytes::read_bytes;

const MAX_BYTES: usize = 1 << 16;

/// Reads a table of a sensor's noise.
///
/// # Errors
/// [`Error::Io`], [`Error::Limit`] above 64 KiB, and those of [`parse`].
pub fn read_noise_table(path: impl AsRef<Path>) -> Result<NoiseTable> {
    let bytes = read_bytes(path.as_ref(), MAX_BYTES)?;
    let text = std::str::from_utf8(&bytes).map_err(|_| unreadable("it is not text"));
    text.and_then(parse).map_err(|error| error.in_file(&path.as_ref().display().to_string()))
}

/// Reads the text of a table.
///
/// ```
/// let table = depthplanes_io::noise_table::parse("range_m,sigma_m\n1,0.002\n3,0.012  # a wall\n")?;
/// assert_eq!(table.sigma_m(2.0), 0.007);
/// # Ok::<(), depthplanes_io::Error>(())
/// ```
///
/// # Errors
/// [`Error::Unreadable`] for a line that is not two numbers, [`Error::Library`] for numbers that are no table.
pub fn parse(text: &str) -> Result<NoiseTable> {
    let lines = text.lines().map(|line| line.split('#').next().unwrap_or_default().trim());
    let mut rows = Vec::new();
    for (number, line) in (1..).zip(lines).filter(|(_, line)| !line.is_empty()) {
        match numbers(line) {
            Some(row) => rows.push(row),
            None if rows.is_empty() && is_heading(line) => (),
            None => return Err(unreadable(format!("line {number} is `{line}`"))),
        }
    }
    Ok(NoiseTable::new(&rows)?)
}

const BETWEEN: [char; 3] = [',', ';', '\t'];

fn is_heading(line: &str) -> bool {
    line.contains(BETWEEN) && !line.contains(|c: char| c.is_ascii_digit())
}

fn numbers(line: &str) -> Option<[f64; 2]> {
    let (range, sigma) = line.split_once(BETWEEN)?;
    Some([range.trim().parse().ok()?, sigma.trim().parse().ok()?])
}

fn unreadable(wrong: impl Into<String>) -> Error {
    let accepted = "lines of a range and a standard deviation in metres, such as 2.5,0.009";
    Error::Unreadable { format: "table of noise", wrong: wrong.into(), accepted }
}
