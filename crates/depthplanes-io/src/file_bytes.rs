//! The bytes of a file, up to a limit: maps, label images, cameras and tables of noise are all read so.

use std::fs::{self, File, FileType};
use std::io::{self, Read};
use std::path::Path;

use crate::error::{Error, Result};

/// Bytes of a stream that are looked at before the others are read.
const FIRST: u64 = 1 << 16;

/// So many bytes may follow a map in a pipe: what programs append or fill up with, which readers skip.
const BEYOND: u64 = 1 << 20;

/// Where what begins with these bytes ends; none if it cannot be known.
pub(crate) type Ends<'a> = &'a dyn Fn(&[u8]) -> Result<Option<u64>>;

/// The bytes of a file.
///
/// # Errors
/// [`Error::Io`], also for what is no file; [`Error::Limit`] for more than `most` bytes, before they are read;
/// [`Error::Memory`].
pub(crate) fn read_bytes(path: &Path, most: usize) -> Result<Vec<u8>> {
    read_known(path, most, &|_| Ok(None))
}

/// The bytes of a file. What may have no end, as pipes and devices, is read no further than to where it `ends` by the bytes
/// so far, and somewhat beyond.
///
/// # Errors
/// As [`read_bytes`], and that of `ends`; [`Error::Endless`] for what goes on beyond its end.
pub(crate) fn read_known(path: &Path, most: usize, ends: Ends<'_>) -> Result<Vec<u8>> {
    let name = path.display().to_string();
    let io = |source| Error::Io { path: name.clone(), source };
    // Before it is opened: a disk is none of our business.
    let kind = fs::metadata(path).map_err(io)?.file_type();
    if let Some(what) = no_file(kind) {
        return Err(io(io::Error::other(format!("this is {what}, a file is needed"))));
    }
    let file = File::open(path).map_err(io)?;
    if !kind.is_file() {
        return read_stream(file, &name, most, ends);
    }
    let length = file.metadata().map_err(io)?.len();
    if length > most as u64 {
        return Err(too_long(length, most).in_file(&name));
    }
    let mut bytes = Vec::new();
    bytes
        .try_reserve_exact(length as usize + 1)
        .map_err(|_| Error::Memory { what: "memory", bytes: length }.in_file(&name))?;
    read_to(file, &mut bytes, most).map_err(|error| error.named(&name))?;
    Ok(bytes)
}

/// The bytes of something that may have no end.
///
/// # Errors
/// As [`read_known`]; `name` is for messages only.
pub(crate) fn read_stream(mut source: impl Read, name: &str, most: usize, ends: Ends<'_>) -> Result<Vec<u8>> {
    let mut read = || {
        let mut bytes = Vec::new();
        let mut wanted = FIRST;
        loop {
            let missing = wanted - bytes.len() as u64;
            read_to(source.by_ref().take(missing), &mut bytes, most)?;
            if (bytes.len() as u64) < wanted {
                return Ok(bytes);
            }
            match ends(&bytes)? {
                None => {
                    read_to(source.by_ref(), &mut bytes, most)?;
                    return Ok(bytes);
                }
                Some(end) if end > most as u64 => return Err(too_long(end, most)),
                Some(end) if end.saturating_add(BEYOND) <= wanted => return Err(Error::Endless { end }),
                Some(end) => wanted = end + BEYOND,
            }
        }
    };
    read().map_err(|error: Error| error.named(name))
}

/// Adds what there is to the bytes, up to `most` in all.
fn read_to(source: impl Read, bytes: &mut Vec<u8>, most: usize) -> Result<()> {
    let room = (most - bytes.len().min(most)) as u64 + 1;
    match source.take(room).read_to_end(bytes) {
        Ok(_) if bytes.len() > most => Err(too_long(bytes.len() as u64, most)),
        Ok(_) => Ok(()),
        Err(error) if error.kind() == io::ErrorKind::OutOfMemory => {
            Err(Error::Memory { what: "memory", bytes: bytes.len() as u64 })
        }
        Err(source) => Err(Error::Io { path: String::new(), source }),
    }
}

fn too_long(given: u64, most: usize) -> Error {
    Error::Limit { what: "size of the file in bytes", given, limit: most as u64 }
}

/// What is not read, in words.
fn no_file(kind: FileType) -> Option<&'static str> {
    #[cfg(unix)]
    {
        use std::os::unix::fs::FileTypeExt;
        if kind.is_block_device() {
            return Some("a disk");
        }
        if kind.is_socket() {
            return Some("a socket");
        }
    }
    kind.is_dir().then_some("a folder")
}
