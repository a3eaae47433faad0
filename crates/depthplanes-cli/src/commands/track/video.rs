//! One video from its source to its outputs.
//!
//! One thread reads and decodes, some find planes, each in a frame of its own, and one gives them their ids and writes, frame
//! after frame. The queues between them are short, so that the slowest sets the pace.

use super::find::{Finder, Read, Searched};
use super::follow::Follower;
use super::pace::Pace;
use super::queue::{Came, Closing, InTurn, Queue, Taken, Taking};
use super::stall::Stall;
use super::writer::Writer;
use crate::args::Track;
use crate::failure::{Failure, Outcome};
use crate::load;
use crate::run::Recipe;
use depthplanes::noise::SensorNoise;
use depthplanes_video::{Source, SourceOptions, open};
use std::io::Write;
use std::time::{Duration, Instant};

/// Frames that wait to be searched.
const WAITING: usize = 2;
/// Frames that may be done before the one that is next, while that one is searched.
const AHEAD: u64 = 2;
/// Threads that find planes in one video where no number is stated: more than these wait for the one that reads, since finding
/// takes about twice as long as decoding.
pub(super) const MOST_JOBS: usize = 4;
/// Frames that fail of which is said why; the lines say it of all.
const MOST_SAID: u64 = 5;
/// How often an interruption and a source that stalls are looked for.
const BEAT: Duration = Duration::from_millis(100);

/// Cores of this machine.
pub(super) fn cores() -> usize {
    std::thread::available_parallelism().map_or(1, |cores| cores.get())
}

/// How videos are read and searched.
pub(super) struct Plan<'a> {
    pub(super) wanted: &'a Track,
    pub(super) recipe: Recipe,
    options: SourceOptions,
}

impl<'a> Plan<'a> {
    /// # Errors
    /// What is wrong with the words.
    pub(super) fn new(wanted: &'a Track) -> Outcome<Self> {
        let recipe = Recipe::new(wanted.method, &wanted.parameters, 1)?;
        let mut options = load::options(&wanted.reading)?;
        options.noise = load::noise_table(wanted.noise_table.as_deref())?.map(SensorNoise::Table);
        Ok(Plan { wanted, recipe, options: SourceOptions::default().read(options) })
    }
}

/// A video that is about to be tracked.
pub(super) struct Video<'a> {
    wanted: &'a Track,
    source: Box<dyn Source>,
    /// How many frames it has, if that is known.
    frames: Option<u64>,
    finders: Vec<Finder>,
    follower: Follower,
}

/// How far the work on a video is.
pub(super) struct Progress {
    pub(super) pace: Pace,
    pub(super) failed: u64,
    pub(super) dropped: u64,
    /// How many planes had an id so far.
    pub(super) planes: u32,
    /// How many frames there are, if that is known.
    pub(super) of: Option<u64>,
}

impl Progress {
    pub(super) fn seen(&self) -> u64 {
        self.pace.frames + self.failed
    }

    /// Failure if frames failed, or none came.
    pub(super) fn outcome(&self) -> Outcome {
        let many = if self.failed == 1 { "frame" } else { "frames" };
        match (self.failed, self.pace.frames) {
            (0, 0) => Err(Failure::request("no frame came from the source")),
            (0, _) => Ok(()),
            (failed, 0) => Err(Failure::request(format!("{failed} {many} failed, and no other came from the source"))),
            (failed, _) => Err(Failure::request(format!("{failed} {many} failed; the others are done"))),
        }
    }
}

impl<'a> Video<'a> {
    /// Opens a source, to be searched by so many threads.
    ///
    /// # Errors
    /// Those of opening it.
    pub(super) fn open(plan: &Plan<'a>, source: &str, jobs: usize) -> Outcome<Self> {
        let wanted = plan.wanted;
        let source = open(source, &plan.options)?;
        let frames = source.frames().map(|frames| wanted.frames.map_or(frames, |most| most.min(frames)));
        let finders = (0..jobs).map(|_| Finder::new(wanted, &plan.recipe)).collect::<Outcome<_>>()?;
        Ok(Video { wanted, source, frames, finders, follower: Follower::new(wanted) })
    }

    /// Tracks all frames; after each frame, and while none comes, `beat` is called.
    ///
    /// # Errors
    /// Those of the outputs and of `beat`. Frames that cannot be read are counted.
    pub(super) fn track(
        mut self,
        writer: &mut Writer,
        out: &mut dyn Write,
        beat: impl FnMut(&Progress, &mut Writer, &mut dyn Write) -> Outcome,
    ) -> Outcome<Progress> {
        let (most, finders) = (self.wanted.frames, std::mem::take(&mut self.finders));
        let (read, stall) = (Queue::new(WAITING, self.wanted.live), Stall::default());
        let done = InTurn::new(finders.len(), AHEAD);
        let Video { source, frames, follower, .. } = &mut self;
        std::thread::scope(|scope| {
            // However this ends, the other threads do.
            let (_read, _done) = (Closing(&read), Closing(&Taking(&done)));
            for finder in finders {
                let (read, done) = (&read, &done);
                thread(scope, move || find_all(finder, read, done))?;
            }
            thread(scope, || read_all(source.as_mut(), most, &stall, &read))?;
            let progress = Progress { pace: Pace::new(), failed: 0, dropped: 0, planes: 0, of: *frames };
            follow_all(progress, follower, &done, &stall, writer, out, beat)
        })
    }
}

/// Starts a thread.
fn thread<'scope>(scope: &'scope std::thread::Scope<'scope, '_>, work: impl FnOnce() + Send + 'scope) -> Outcome {
    let started = std::thread::Builder::new().spawn_scoped(scope, work);
    started.map(drop).map_err(|error| {
        Failure::machine(format!("`track` cannot make its threads ({error}); it needs one, and one for each of --jobs"))
    })
}

fn read_all(source: &mut dyn Source, most: Option<u64>, stall: &Stall, read: &Queue<Read>) {
    let _closing = Closing(read);
    for index in 0..most.unwrap_or(u64::MAX) {
        let Some(frame) = stall.during(|| source.next_frame()) else { break };
        if !read.send(Read { start: Instant::now(), index, frame }) {
            break;
        }
    }
}

fn find_all(mut finder: Finder, read: &Queue<Read>, done: &InTurn<Searched>) {
    let _closing = Closing(done);
    while let Some(Taken { element, turn, dropped }) = read.take() {
        if !done.send(turn, finder.search(element, dropped)) {
            read.close();
        }
    }
}

fn follow_all(
    mut progress: Progress,
    follower: &mut Follower,
    done: &InTurn<Searched>,
    stall: &Stall,
    writer: &mut Writer,
    out: &mut dyn Write,
    mut beat: impl FnMut(&Progress, &mut Writer, &mut dyn Write) -> Outcome,
) -> Outcome<Progress> {
    loop {
        beat(&progress, writer, out)?;
        match done.take_within(BEAT) {
            Came::Element(searched) => follow(&mut progress, follower, searched, writer, out)?,
            Came::Nothing => stall.look(),
            Came::End => break,
        }
    }
    follower.watch.end();
    writer.end(out)?;
    Ok(progress)
}

/// Gives the planes of the next frame their ids, and writes what comes of it.
fn follow(
    progress: &mut Progress,
    follower: &mut Follower,
    searched: Searched,
    writer: &mut Writer,
    out: &mut dyn Write,
) -> Outcome {
    let index = searched.index;
    match follower.follow(searched) {
        Ok(frame) => {
            progress.dropped = frame.dropped;
            progress.planes = frame.last_id().max(progress.planes);
            writer.write(&frame, out)?;
            progress.pace.add(frame.start.elapsed());
        }
        Err(failure) => {
            progress.failed += 1;
            writer.write_failed(index, &failure.to_string(), out)?;
            if progress.failed <= MOST_SAID {
                failure.report();
            }
        }
    }
    Ok(())
}
