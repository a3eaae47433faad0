//! The message of a frame of the video.

use crate::pipeline::Found;
use axum::body::Bytes;
use depthplanes_io::page::{Shown, frame_message};
use depthplanes_video::VideoFrame;
use serde_json::json;
use std::time::Instant;

/// What is known of a frame beside what was found in it.
pub(crate) struct About {
    /// One more for each message that is made.
    pub(crate) serial: u64,
    /// The number of its rays.
    pub(crate) camera: Option<u64>,
    /// Milliseconds that it took to read.
    pub(crate) read_ms: f64,
    /// What a person should know of it.
    pub(crate) notes: Vec<String>,
}

/// Makes the message of a frame.
pub(crate) fn message(about: About, video: &VideoFrame, found: &Found<'_>) -> Bytes {
    let start = Instant::now();
    let Found { detection, outlines, tracks, ground, .. } = *found;
    let shown = Shown { frame: &video.frame, detection, outlines, tracks: Some(tracks), ground };
    let message = frame_message(&shown).expect("it was looked at before");
    let mut stages = vec![("read", about.read_ms)];
    stages.extend(&found.stages);
    stages.push(("message", start.elapsed().as_secs_f64() * 1e3));
    let head = json!({
        "serial": about.serial,
        "index": video.index,
        "name": video.name,
        "time_s": video.time_s,
        "has_pose": video.pose.is_some(),
        "camera": about.camera,
        "notes": about.notes,
        "stages": stages,
    });
    message.with(head).into_bytes().into()
}
