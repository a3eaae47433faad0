//! MCAP, the container of recorded messages (<https://mcap.dev/spec>): what is read of it, and a writer.
//!
//! A file is a row of records. Messages stand in chunks, which are compressed, or by themselves; a summary at the end says
//! where the chunks are. Where there is none, since the recorder was killed, the records are gone over once instead.
//!
//! This is own code and not the crate `mcap`, which needs `paste`, a crate that nobody keeps up, and brings 16 more.
//! Chunks are unpacked by `ruzstd` and `lz4_flex`, which are Rust alone, so that the static program needs no compiler of C.

mod chunk;
mod input;
mod layout;
mod reader;
mod records;
mod writer;

pub(crate) use reader::{Message, Reader};
pub(crate) use records::Channel;
pub use writer::{Topic, Writer};
