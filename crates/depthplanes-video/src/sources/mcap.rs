//! MCAP: depth maps of a topic of ROS 2 or Foxglove, with the camera of the topic beside it, and up by an inertial sensor.

use super::topics::{self, Choice};
use crate::error::{Error, Result};
use crate::frame::VideoFrame;
use crate::gravity::Gravity;
use crate::mcap::{Message, Reader};
use crate::messages::{self, Content, Kind, type_of};
use crate::source::{Source, SourceInfo, SourceOptions};
use crate::word::{self, path_and_topic as split};
use depthplanes_io::ReadOptions;
use depthplanes_io::camera_file::{CameraFile, parse};
use std::path::{Path, PathBuf};

pub(super) const MCAP: SourceInfo = SourceInfo {
    name: "mcap",
    about: "an MCAP file of ROS 2 or Foxglove; FILE.mcap:/topic if it has several depth topics, FILE.mcap:/topic:/imu if several \
            inertial sensors",
    is: |word| split(word).0.is_file() && is_mcap(split(word).0),
    open: |word, options| {
        let (path, topic) = split(word);
        Ok(Box::new(Recording::open(vec![path.into()], topic, options)?))
    },
};

/// Frames before the one that is sought whose readings of the inertial sensor are taken: a third of a second.
const LEAD: u64 = 10;

/// By its name, also where the whole file is compressed, which is refused with what to do.
pub(super) fn is_mcap(path: &Path) -> bool {
    path.file_name().is_some_and(|name| name.to_string_lossy().to_lowercase().contains(".mcap"))
}

/// The messages of one topic in files that follow each other.
#[derive(Debug)]
pub(super) struct Recording {
    files: Vec<PathBuf>,
    /// Frames of each file, if its summary says it.
    counts: Vec<Option<u64>>,
    /// The file that is read, and how many of its frames came so far.
    at: usize,
    of_file: u64,
    reader: Reader,
    choice: Choice,
    /// The camera as the latest message has it, and that message's content.
    camera: Option<(String, std::result::Result<CameraFile, String>)>,
    /// What says where gravity is, if there is something; or why it does not.
    gravity: std::result::Result<Option<Gravity>, String>,
    next: u64,
    /// Frames that are passed over, for what stands between them.
    passed: u64,
    options: ReadOptions,
    is_over: bool,
}

impl Recording {
    /// Opens files, of which there is one at least.
    ///
    /// # Errors
    /// Of the first file; and [`Error::Source`] where there is no depth topic, or several and none is stated.
    pub(super) fn open(files: Vec<PathBuf>, topic: Option<&str>, options: &SourceOptions) -> Result<Self> {
        let mut reader = Reader::open(&files[0], options.read.decode.limits.max_bytes)?;
        let mut looked = topics::look(&mut reader);
        let choice = looked.choose(&word::topics(topic), &files[0])?;
        let gravity = looked.gravity(&choice, &mut reader);
        let most = options.read.decode.limits.max_bytes;
        // What is wrong with a further file is said when it is its turn.
        let further = files[1..].iter().map(|file| Reader::open(file, most).ok()?.count(&choice.topic));
        let counts = [reader.count(&choice.topic)].into_iter().chain(further).collect();
        let mut recording = Recording {
            files,
            counts,
            at: 0,
            of_file: 0,
            reader,
            choice,
            camera: None,
            gravity,
            next: 0,
            passed: 0,
            options: options.read.clone(),
            is_over: false,
        };
        if let Some(camera) = looked.camera_of(&recording.choice) {
            recording.take_camera(camera);
        }
        recording.reader.rewind(recording.choice.topics());
        Ok(recording)
    }

    /// Goes on with a file, from its beginning.
    fn go_to(&mut self, file: usize) -> Result<()> {
        self.reader = Reader::open(&self.files[file], self.options.decode.limits.max_bytes)?;
        self.reader.rewind(self.choice.topics());
        (self.at, self.of_file) = (file, 0);
        Ok(())
    }

    /// Begins anew and passes over so many frames, where nobody says where they stand; whether the first file is still there.
    fn pass_over(&mut self, frames: u64) -> bool {
        let is_there = self.go_to(0).is_ok();
        if is_there {
            self.gravity.iter_mut().flatten().for_each(Gravity::forget);
            (self.next, self.passed, self.is_over) = (frames, frames, false);
        }
        is_there
    }

    fn take_camera(&mut self, text: String) {
        if self.camera.as_ref().is_none_or(|(known, _)| *known != text) {
            let camera = parse(&text).map_err(|error| error.to_string());
            self.camera = Some((text, camera));
        }
    }

    /// The frame of a message; none if it has something else, which is kept.
    fn take(&mut self, message: &Message) -> Option<Result<VideoFrame>> {
        let channel = self.reader.channel(message.channel)?;
        let row = type_of(&channel.schema, &channel.encoding)?;
        let is_passed = row.kind == Kind::Picture && self.passed > 0;
        if is_passed {
            self.passed -= 1;
            self.of_file += 1;
            return None;
        }
        let log_time_s = message.log_time as f64 * 1e-9;
        let read = (row.read)(message.data());
        match (row.kind, read) {
            (Kind::Picture, read) => {
                let (index, name) = (self.next, format!("{}#{}", channel.topic, self.next));
                self.next += 1;
                self.of_file += 1;
                let wrong = |wrong| Error::source(&name, wrong, format!("a whole {}", row.schema));
                Some(read.map_err(wrong).and_then(|read| self.frame(&read, index, &name, log_time_s)))
            }
            (Kind::Camera, Ok(messages::Message { content: Content::Camera(text), .. })) => {
                self.take_camera(text);
                None
            }
            (Kind::Camera, Err(wrong)) => {
                self.camera = Some((String::new(), Err(wrong)));
                None
            }
            (Kind::Imu, Ok(messages::Message { content: Content::Imu(reading), .. })) => {
                // By the clock of the recorder, which frames have as well.
                self.gravity.iter_mut().flatten().for_each(|gravity| gravity.add(log_time_s, &reading));
                None
            }
            _ => None,
        }
    }

    fn frame(&self, read: &messages::Message<'_>, index: u64, name: &str, log_time_s: f64) -> Result<VideoFrame> {
        let mut frame = self.map(&read.content, name)?;
        let (up, note) = match &self.gravity {
            Ok(gravity) => {
                let up = gravity.as_ref().and_then(|gravity| gravity.up(log_time_s));
                (up, gravity.as_ref().and_then(Gravity::note))
            }
            Err(wrong) => (None, Some(wrong.clone())),
        };
        frame.warnings.extend(note);
        let time_s = Some(read.stamp_s.unwrap_or(log_time_s));
        Ok(VideoFrame { index, name: name.into(), time_s, pose: None, up, frame })
    }

    fn map(&self, content: &Content<'_>, name: &str) -> Result<depthplanes_io::Frame> {
        let read = |options: &ReadOptions| messages::frame(content, name, options);
        if self.options.intrinsics.is_some() || self.options.camera_file.is_some() {
            return read(&self.options);
        }
        match &self.camera {
            Some((_, Ok(camera))) => read(&self.options.clone().camera(camera)),
            Some((_, Err(wrong))) => {
                let mut frame = read(&self.options)?;
                frame.warnings.push(format!("the camera of the recording is not used: {wrong}"));
                Ok(frame)
            }
            None => read(&self.options),
        }
    }

    /// What is wrong with a file that came to its end with fewer or more frames than its summary says.
    fn lacks(&self) -> Option<Error> {
        let stated = self.counts[self.at].filter(|count| *count != self.of_file)?;
        let wrong = format!("{} frames of {} that the summary tells of", self.of_file, stated);
        let accepted = "a whole MCAP file; `mcap recover FILE` writes what can be saved into another one";
        Some(Error::source(self.files[self.at].display(), wrong, accepted))
    }
}

impl Source for Recording {
    fn next_frame(&mut self) -> Option<Result<VideoFrame>> {
        while !self.is_over {
            match self.reader.next() {
                Some(Ok(message)) => {
                    if let Some(frame) = self.take(&message) {
                        return Some(frame);
                    }
                }
                Some(Err(error)) => {
                    self.is_over = true;
                    return Some(Err(error));
                }
                None => {
                    self.is_over = self.at + 1 == self.files.len();
                    let lacks = self.lacks();
                    let gone_on = if self.is_over { Ok(()) } else { self.go_to(self.at + 1) };
                    if let Some(error) = lacks.or(gone_on.err()) {
                        self.is_over = true;
                        return Some(Err(error));
                    }
                }
            }
        }
        None
    }

    fn frames(&self) -> Option<u64> {
        self.counts.iter().copied().sum()
    }

    fn seek(&mut self, index: u64) -> bool {
        let Some(frames) = self.frames() else { return self.pass_over(index) };
        let (mut file, mut of_file) = (0, index.min(frames));
        while file + 1 < self.files.len() && of_file >= self.counts[file].unwrap_or(0) {
            of_file -= self.counts[file].unwrap_or(0);
            file += 1;
        }
        let is_there = file == self.at || self.go_to(file).is_ok();
        // What is up is known by readings before the frame.
        let lead = if let Ok(Some(gravity)) = &mut self.gravity {
            gravity.forget();
            LEAD.min(of_file)
        } else {
            0
        };
        if !is_there || !self.reader.seek(&self.choice.topic, of_file - lead).unwrap_or(false) {
            return false;
        }
        (self.next, self.of_file, self.passed, self.is_over) = (index.min(frames), of_file - lead, lead, false);
        true
    }
}
