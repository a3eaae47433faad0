//! The thread that finds planes: it plays the source at its own pace, and does at once what pages ask for.

use crate::event::Event;
use crate::head::{self, About};
use crate::hub::{Hub, Shown};
use crate::pipeline::Pipeline;
use crate::rays::Rays;
use crate::reader::{Read, Reader};
use crate::recent::Recent;
use crate::state::State;
use depthplanes_io::doubts;
use depthplanes_io::outputs::Report;
use depthplanes_video::VideoFrame;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, RecvTimeoutError};
use std::time::{Duration, Instant};

/// The pace of sources that do not say when their frames were taken.
const NOMINAL: Duration = Duration::from_nanos(33_333_333);
/// Longest time between two frames: recordings have gaps.
const LONGEST: Duration = Duration::from_secs(1);
/// Frames that can be asked for one by one before the first of them is shown.
const MOST_STEPS: u32 = 100;

/// Plays one source.
pub(crate) struct Player {
    pipeline: Pipeline,
    reader: Reader,
    first_values: Vec<f64>,
    hub: Arc<Hub>,
    state: State,
    /// A frame that is ready to be shown, or the end.
    next: Option<Read>,
    /// Whether it plays again after a file.
    resumes: bool,
    /// The frame that was shown before a file.
    left: Option<(Arc<VideoFrame>, f64)>,
    /// Frames that are to be shown even though it does not play.
    steps: u32,
    /// The frame that is shown, with how long it took to read.
    current: Option<(Arc<VideoFrame>, f64)>,
    /// Whether the parameters have changed since it was looked at.
    is_stale: bool,
    shown_at: Instant,
    rays: Option<Arc<Rays>>,
    serial: u64,
    cameras: u64,
    /// Whether any frame came since the start of the source.
    has_shown: bool,
}

impl Player {
    pub(crate) fn new(pipeline: Pipeline, reader: Reader, hub: Arc<Hub>) -> Self {
        let mut state = State::new(pipeline.values());
        (state.frames, state.can_seek) = (reader.frames, reader.can_seek);
        Player {
            first_values: pipeline.values().to_vec(),
            pipeline,
            reader,
            hub,
            state,
            next: None,
            resumes: false,
            left: None,
            steps: 0,
            current: None,
            is_stale: false,
            shown_at: Instant::now(),
            rays: None,
            serial: 0,
            cameras: 0,
            has_shown: false,
        }
    }

    /// Plays until it is told to stop.
    pub(crate) fn run(mut self, events: &Receiver<Event>) {
        self.tell();
        loop {
            let event = match self.wait() {
                Some(wait) => events.recv_timeout(wait),
                None => events.recv().map_err(|_| RecvTimeoutError::Disconnected),
            };
            // All that has come meanwhile is done before the next frame: of a slider's values the last one counts.
            if matches!(event, Err(RecvTimeoutError::Disconnected)) {
                return;
            }
            for event in event.into_iter().chain(events.try_iter()) {
                if matches!(event, Event::Stop) {
                    return;
                }
                self.obey(event);
            }
            if self.is_due() {
                self.advance();
            } else if self.is_stale {
                self.look(false);
            }
            self.tell();
        }
    }

    /// How long nothing is to be done; `None` until something comes.
    fn wait(&self) -> Option<Duration> {
        let plays = self.plays() && self.next.is_some();
        if self.steps > 0 && self.next.is_some() || self.is_stale {
            return Some(Duration::ZERO);
        }
        plays.then(|| self.due().saturating_duration_since(Instant::now()))
    }

    fn is_due(&self) -> bool {
        self.next.is_some() && (self.steps > 0 || self.plays() && self.due() <= Instant::now())
    }

    /// Whether time goes on. What can be asked for again rests after its first frame while nobody looks.
    fn plays(&self) -> bool {
        let is_watched = || self.hub.shown.receiver_count() > 0;
        self.state.is_playing && (!self.reader.can_seek || self.current.is_none() || is_watched())
    }

    /// When the next frame is to be shown: as long after the one before as it was taken after it.
    fn due(&self) -> Instant {
        if !self.reader.can_seek {
            return self.shown_at; // what cannot be asked for again comes at its own pace
        }
        let time = |read: &Read| read.frame.as_ref()?.as_ref().ok()?.time_s;
        let before = self.current.as_ref().and_then(|(video, _)| video.time_s);
        let between = self.next.as_ref().and_then(time).zip(before).map(|(next, before)| next - before);
        let between = between.filter(|&seconds| seconds > 0.0 && seconds.is_finite());
        let between = between.and_then(|seconds| Duration::try_from_secs_f64(seconds).ok());
        self.shown_at + between.unwrap_or(NOMINAL).min(LONGEST)
    }

    fn obey(&mut self, event: Event) {
        match event {
            Event::Read(read) if self.reader.is_newest(&read) => self.next = Some(read),
            Event::Read(_) | Event::Opened | Event::Stop => (),
            Event::Play(plays) => {
                self.leave_file();
                self.state.is_playing = plays && !self.state.has_ended;
            }
            Event::Step { back } => {
                let was_file = self.leave_file();
                self.state.is_playing = false;
                match self.state.index {
                    _ if was_file => (),
                    Some(index) if back => self.seek(index.saturating_sub(1)),
                    _ => self.steps = (self.steps + 1).min(MOST_STEPS),
                }
            }
            Event::Seek(index) => {
                self.leave_file();
                self.seek(index);
            }
            Event::Set { name, value } => {
                let outcome = self.pipeline.set(&name, value);
                self.parameters_changed(outcome);
            }
            Event::Reset => {
                let outcome = self.pipeline.set_all(self.first_values.clone());
                self.parameters_changed(outcome);
            }
            Event::Show(video) => {
                if self.state.file.is_none() {
                    (self.resumes, self.left) = (self.state.is_playing, self.current.take());
                }
                (self.state.is_playing, self.steps) = (false, 0);
                self.state.file = Some(video.name.clone());
                self.pipeline.forget();
                self.current = Some((Arc::new(*video), 0.0));
                self.look(true);
            }
            Event::Return => drop(self.leave_file()),
        }
    }

    fn parameters_changed(&mut self, outcome: depthplanes::Result<()>) {
        self.state.values = self.pipeline.values().to_vec();
        self.state.error = outcome.err().map(|error| error.to_string());
        self.is_stale = self.current.is_some();
    }

    /// Back from a file to the frame of the source that was shown before it; whether a file was shown.
    fn leave_file(&mut self) -> bool {
        let was_shown = self.state.file.take().is_some();
        if was_shown {
            self.pipeline.forget();
            self.state.is_playing = self.resumes;
            self.current = self.left.take();
            self.look(true);
        }
        was_shown
    }

    fn seek(&mut self, index: u64) {
        if !self.reader.can_seek {
            self.state.error = Some("this source can only be read from its start to its end".into());
            return;
        }
        let last = self.state.frames.map_or(u64::MAX, |frames| frames.saturating_sub(1));
        (self.next, self.steps, self.state.has_ended) = (None, 1, false);
        self.reader.ask(Some(index.min(last)));
    }

    /// Shows the next frame, and asks for the one after it.
    fn advance(&mut self) {
        let Some(Read { index, frame, ms, .. }) = self.next.take() else { return };
        match frame {
            None => return self.end(),
            Some(Ok(video)) => {
                self.current = Some((Arc::from(video), ms));
                self.look(true);
            }
            Some(Err(error)) => {
                self.state.error = Some(error.to_string());
                self.state.index = Some(index);
            }
        }
        self.steps = self.steps.saturating_sub(1);
        self.has_shown = true;
        self.shown_at = Instant::now();
        self.reader.ask(None);
    }

    /// The end of the source: it begins anew where that can be.
    fn end(&mut self) {
        if self.reader.can_seek && self.has_shown {
            self.has_shown = false;
            self.state.frames = self.state.frames.or(self.state.index.map(|last| last + 1));
            self.pipeline.forget();
            self.reader.ask(Some(0));
            return;
        }
        (self.state.is_playing, self.state.has_ended, self.steps) = (false, true, 0);
        if !self.has_shown {
            self.state.error = Some("no frame came from the source".into());
        }
    }

    /// Finds planes in the current frame and shows them. Of a new frame the error is that of its own.
    fn look(&mut self, is_new: bool) {
        self.is_stale = false;
        let Some((video, read_ms)) = self.current.clone() else { return };
        if is_new {
            self.state.error = None;
            self.state.index = self.state.file.is_none().then_some(video.index).or(self.state.index);
        }
        let rays = self.rays_of(&video);
        let (method, values) = (self.pipeline.method, self.pipeline.values().to_vec());
        let found = match self.pipeline.find(&video) {
            Ok(found) => found,
            Err(error) => {
                self.state.error = Some(format!("{}: {error}", video.name));
                return;
            }
        };
        let mut notes = video.frame.warnings.clone();
        if self.state.file.is_some() {
            notes.extend(doubts(&Report::new(&video.name, &video.frame, method, &values, found.detection)));
        }
        self.serial += 1;
        let about = About { serial: self.serial, camera: rays.as_ref().map(|rays| rays.number), read_ms, notes };
        let message = head::message(about, &video, &found);
        let ids = found.tracks.ids.clone();
        self.hub.recent.keep(Recent { serial: self.serial, video, values, ids });
        self.hub.shown.send_replace(Some(Arc::new(Shown { message, rays })));
    }

    /// The rays of a frame, those of the one before if the camera is the same.
    fn rays_of(&mut self, video: &VideoFrame) -> Option<Arc<Rays>> {
        let (width, height, sensor) = (video.frame.width, video.frame.height, &video.frame.sensor);
        if !self.rays.as_ref().is_some_and(|rays| rays.are_of(width, height, sensor)) {
            self.cameras += 1;
            self.rays = Rays::new(self.cameras, width, height, sensor).map(Arc::new);
        }
        self.rays.clone()
    }

    /// Tells the pages how it stands, if that has changed.
    fn tell(&self) {
        let text = serde_json::to_string(&self.state).expect("plain values become text");
        self.hub.state.send_if_modified(|known| {
            let is_new = **known != *text;
            if is_new {
                *known = text.into();
            }
            is_new
        });
    }
}
