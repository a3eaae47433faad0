//! A synthetic camera that moves through a scene: `scene:room:sensor=kinect,frames=300`.

use crate::error::{Error, Result};
use crate::frame::VideoFrame;
use crate::source::{Source, SourceInfo, SourceOptions};
use depthplanes::scene::Walk;
use depthplanes_io::{Frame, ReadOptions};

pub(super) const SCENE: SourceInfo = SourceInfo {
    name: "scene",
    about: "scene:SPEC for a synthetic moving camera; beside a scene's keys frames=, speed= and pose=none",
    is: |word| word.starts_with(PREFIX),
    open,
};

const PREFIX: &str = "scene:";
/// Frames a second.
const RATE: f64 = 30.0;

/// A synthetic camera as a source.
#[derive(Debug)]
struct Moving {
    walk: Walk,
    frames: u64,
    next: u64,
    tells_pose: bool,
    options: ReadOptions,
}

fn open(word: &str, options: &SourceOptions) -> Result<Box<dyn Source>> {
    let text = &word[PREFIX.len()..];
    let (name, keys) = text.split_once(':').unwrap_or((text, ""));
    let (mut frames, mut speed, mut tells_pose, mut others) = (Walk::LOOP, 1.0, true, Vec::new());
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
            _ => others.push(key),
        }
    }
    let spec = format!("{name}:{}", others.join(",")).parse()?;
    Ok(Box::new(Moving { walk: Walk::new(spec, speed), frames, next: 0, tells_pose, options: options.read.clone() }))
}

impl Moving {
    fn read(&self, index: u64) -> Result<VideoFrame> {
        let mut frame = Frame::from(self.walk.frame(index)?);
        (frame.sensor.noise, frame.sensor.smooth_noise) = (self.options.noise, self.options.smooth_noise);
        let pose = self.tells_pose.then(|| self.walk.pose(index)).transpose()?;
        let time_s = Some(index as f64 / RATE);
        Ok(VideoFrame { index, name: format!("frame-{index:06}"), time_s, pose, up: None, frame })
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
