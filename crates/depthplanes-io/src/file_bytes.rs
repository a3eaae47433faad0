//! The bytes of a file, up to a limit: maps, label images, cameras and tables of noise are all read so.

use std::fs::File;
use std::io::Read;
use std::path::Path;

use crate::error::{Error, Result};

/// The bytes of a file.
///
/// # Errors
/// [`Error::Io`]; [`Error::Limit`] for more than `most` bytes, before they are read.
pub(crate) fn read_bytes(path: &Path, most: usize) -> Result<Vec<u8>> {
    let name = path.display().to_string();
    let io = |source| Error::Io { path: name.clone(), source };
    let file = File::open(path).map_err(io)?;
    let length = file.metadata().map_err(io)?.len();
    let too_long = |given| Error::Limit { what: "size of the file in bytes", given, limit: most as u64 }.in_file(&name);
    if length > most as u64 {
        return Err(too_long(length));
    }
    let mut bytes = Vec::with_capacity(length as usize + 1);
    file.take(most as u64 + 1).read_to_end(&mut bytes).map_err(io)?;
    if bytes.len() > most {
        return Err(too_long(bytes.len() as u64));
    }
    Ok(bytes)
}
