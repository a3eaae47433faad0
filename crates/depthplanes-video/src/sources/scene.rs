//! A synthetic camera that moves through a scene: `scene:room:sensor=kinect,frames=300`.

use crate::error::{Error, Result};
use crate::frame::VideoFrame;
use crate::source::{Source, SourceInfo, SourceOptions};
use depthplanes::scene::Walk;
use depthplanes_io::{Frame, ReadOptions};

pub(super) const SCENE: SourceInfo = SourceInfo {
    name: "scene",
    about: "scene:SPEC for a synthetic moving camera; beside a scene's keys frames=, speed=, pose=none and up=known",
    is: |word| word.starts_with(PREFIX),
    open,
};

const PREFIX: &str = "scene:";
/// Frames a second.
const RATE: f64 = 30.0;
/// Up in the world of scenes.
const WORLD_UP: [f64; 3] = [0.0, 0.0, 1.0];

/// A synthetic camera as a source.
#[derive(Debug)]
struct Moving {
    walk: Walk,
    frames: u64,
    next: u64,
    tells_pose: bool,
    /// Whether it says what is up, as a camera with an accelerometer does.
    tells_up: bool,
    options: ReadOptions,
}

fn open(word: &str, options: &SourceOptions) -> Result<Box<dyn Source>> {
    let text = &word[PREFIX.len()..];
    let (name, keys) = text.split_once(':').unwrap_or((text, ""));
    let (mut frames, mut speed, mut others) = (Walk::LOOP, 1.0, Vec::new());
    let (mut tells_pose, mut tells_up) = (true, false);
    for key in keys.split(',').filter(|key| !key.is_empty()) {
        let wrong = |accepted: &str| Error::source(word, format!("`{key}`"), accepted);
        match key.split_once('=') {
            Some(("frames", value)) => frames = value.parse().map_err(|_| wrong("frames=N, a whole number"))?,
            Some(("speed", value)) => {
                let finite = value.parse().ok().filter(|speed: &f64| speed.is_finite());
                speed = finite.ok_or_else(|| wrong("speed=X, loops in 300 frames, 0 to stand still"))?;
            }
            Some(("pose", "none")) => tells_pose = false,
            Some(("pose", _)) => return Err(wrong("pose=none, or nothing: the poses are known")),
            Some(("up", "known")) => tells_up = true,
            Some(("up", _)) => return Err(wrong("up=known, or nothing: up is estimated")),
            _ => others.push(key),
        }
    }
    let spec = format!("{name}:{}", others.join(",")).parse()?;
    let (walk, options) = (Walk::new(spec, speed), options.read.clone());
    Ok(Box::new(Moving { walk, frames, next: 0, tells_pose, tells_up, options }))
}

impl Moving {
    fn read(&self, index: u64) -> Result<VideoFrame> {
        let mut frame = Frame::from(self.walk.frame(index)?);
        (frame.sensor.noise, frame.sensor.smooth_noise) = (self.options.noise, self.options.smooth_noise);
        let pose = self.walk.pose(index)?;
        let up = self.tells_up.then(|| pose.to_camera(WORLD_UP));
        let (pose, time_s) = (self.tells_pose.then_some(pose), Some(index as f64 / RATE));
        Ok(VideoFrame { index, name: format!("frame-{index:06}"), time_s, pose, up, frame })
    }
}

impl Source for Moving {
    fn next_frame(&mut self) -> Option<Result<VideoFrame>> {
        let index = self.next;
        (index < self.frames).then(|| {
            self.next += 1;
            self.read(index)
        })
    }

    fn frames(&self) -> Option<u64> {
        Some(self.frames)
    }

    fn seek(&mut self, index: u64) -> bool {
        self.next = index.min(self.frames);
        true
    }
}
