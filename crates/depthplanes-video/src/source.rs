//! What a source of frames is, and what is asked of it.

use crate::error::Result;
use crate::frame::VideoFrame;
use depthplanes_io::ReadOptions;
use std::fmt::Debug;

/// Frames, one after the other.
pub trait Source: Debug + Send {
    /// The next frame; `None` at the end. An error is of that frame alone, and the next call goes on behind it, unless it
    /// is `None` then.
    fn next_frame(&mut self) -> Option<Result<VideoFrame>>;

    /// How many frames there are in all; `None` if that is not known before the end.
    fn frames(&self) -> Option<u64> {
        None
    }

    /// Makes the frame of that index the next one. Returns whether the source can do that.
    fn seek(&mut self, index: u64) -> bool {
        let _ = index;
        false
    }
}

/// What the user says of a source beside its name. The default says nothing.
#[derive(Clone, Debug, Default)]
#[non_exhaustive]
pub struct SourceOptions {
    /// How each map is read. What a source states of its maps itself counts where nothing is stated here.
    pub read: ReadOptions,
}

impl SourceOptions {
    /// Reads each map like this.
    #[must_use]
    pub fn read(mut self, read: ReadOptions) -> Self {
        self.read = read;
        self
    }
}

/// A kind of source: a row of [`crate::SOURCES`].
pub struct SourceInfo {
    /// Its name.
    pub name: &'static str,
    /// What it is and what it looks like, one line.
    pub about: &'static str,
    /// Whether a word on the command line is one of it.
    pub is: fn(&str) -> bool,
    /// Opens it.
    pub open: fn(&str, &SourceOptions) -> Result<Box<dyn Source>>,
}
