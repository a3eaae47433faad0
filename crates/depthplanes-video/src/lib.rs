//! Depth video: the frames of folders, data sets, recordings, pipes and synthetic cameras, one after the other.
//!
//! ```
//! use depthplanes_video::{SourceOptions, open};
//! let mut source = open("scene:room:size=160x120,frames=3", &SourceOptions::default())?;
//! while let Some(frame) = source.next_frame() {
//!     let frame = frame?; // an error is of that frame alone
//!     assert_eq!((frame.frame.width, frame.frame.height), (160, 120));
//!     assert!(frame.pose.is_some()); // a synthetic camera knows where it is
//! }
//! # Ok::<(), depthplanes_video::Error>(())
//! ```
#![forbid(unsafe_code)]

mod drawn;
mod error;
mod finder;
mod frame;
mod gravity;
pub mod mcap;
mod messages;
pub mod natural;
mod pose_text;
pub mod ros;
mod source;
mod sources;
mod stated_up;
mod tracked;
mod word;

pub use drawn::{DrawnPlane, POSE_AHEAD, drawn_planes};
pub use error::{Error, Result};
pub use finder::{Finder, Found};
pub use frame::VideoFrame;
pub use source::{Source, SourceInfo, SourceOptions};
pub use sources::{SOURCES, open};
pub use stated_up::StatedUp;
pub use tracked::{Tracked, failed_record};
pub use word::path_and_topic;

/// The program of the page on video is a documentation test.
#[cfg(doctest)]
#[doc = include_str!("../../../docs/video.md")]
struct Page;
