//! The last frames, which can be asked about after newer ones have come.

use depthplanes_video::VideoFrame;
use std::collections::VecDeque;
use std::sync::{Arc, Mutex, PoisonError};

/// Frames that are kept.
const MOST: usize = 4;

/// A frame that can be explained.
#[derive(Clone, Debug)]
pub(crate) struct Recent {
    pub(crate) serial: u64,
    pub(crate) video: Arc<VideoFrame>,
    /// A value for each parameter of the method.
    pub(crate) values: Vec<f64>,
    /// The ids of its labels.
    pub(crate) ids: Vec<u32>,
}

/// The last frames.
#[derive(Debug, Default)]
pub(crate) struct Recents(Mutex<VecDeque<Recent>>);

impl Recents {
    pub(crate) fn keep(&self, frame: Recent) {
        let mut frames = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        frames.push_back(frame);
        if frames.len() > MOST {
            frames.pop_front();
        }
    }

    /// The frame of that number, if it is kept.
    pub(crate) fn find(&self, serial: u64) -> Option<Recent> {
        let frames = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        frames.iter().find(|frame| frame.serial == serial).cloned()
    }
}
