//! What reaches the player: frames that were read, and what pages ask for.

use crate::reader::Read;
use depthplanes_video::VideoFrame;

/// What reaches the player.
pub(crate) enum Event {
    Read(Read),
    /// Somebody has opened a page.
    Opened,
    Play(bool),
    /// One frame on, or back.
    Step {
        back: bool,
    },
    Seek(u64),
    Set {
        name: String,
        value: f64,
    },
    /// All parameters as they were in the beginning.
    Reset,
    /// Shows a file instead of the source.
    Show(Box<VideoFrame>),
    /// Shows the source again.
    Return,
    Stop,
}
