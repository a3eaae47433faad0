//! `depthplanes track`: planes that keep their ids over the frames of a video.
//!
//! In: a source of frames. Out: a line of JSON for each frame, label images, pictures. One thread reads and decodes, some
//! find planes, each in a frame of its own, and one gives them their ids and writes, frame after frame. The queues between
//! them are short, so that the slowest sets the pace.

mod find;
mod folders;
mod follow;
mod pace;
mod queue;
mod stall;
mod watch;
mod writer;

use crate::args::Track;
use crate::failure::{Failure, Outcome, note, say};
use crate::load;
use crate::run::Recipe;
use crate::signals;
use depthplanes::noise::SensorNoise;
use depthplanes_video::{Source, SourceOptions, open};
use find::{Finder, Read, Searched};
use follow::Follower;
use pace::Pace;
use queue::{Came, Closing, InTurn, Queue, Taken, Taking};
use stall::Stall;
use std::io::Write;
use std::sync::atomic::{AtomicI32, Ordering};
use std::time::{Duration, Instant};
use writer::Writer;

/// Frames that wait to be searched.
const WAITING: usize = 2;
/// Frames that may be done before the one that is next, while that one is searched.
const AHEAD: u64 = 2;
/// Threads that find planes where no number is stated: more than these wait for the one that reads, since finding takes
/// about twice as long as decoding.
const MOST_JOBS: usize = 4;
/// Frames that fail of which is said why; the lines say it of all.
const MOST_SAID: u64 = 5;
/// How often an interruption and a source that stalls are looked for.
const BEAT: Duration = Duration::from_millis(100);
/// How often the pace is said.
const EVERY: Duration = Duration::from_secs(1);

pub(super) fn run(wanted: &Track, out: &mut dyn Write) -> Outcome {
    let recipe = Recipe::new(wanted.method, &wanted.parameters, 1)?;
    let mut options = load::options(&wanted.reading)?;
    options.noise = load::noise_table(wanted.noise_table.as_deref())?.map(SensorNoise::Table);
    let options = SourceOptions::default().read(options);
    folders::check(wanted)?;
    let mut source = open(&wanted.source, &options)?;
    let frames = source.frames().map(|frames| wanted.frames.map_or(frames, |most| most.min(frames)));
    let cores = std::thread::available_parallelism().map_or(1, |cores| cores.get());
    let finders = (0..wanted.jobs.unwrap_or(cores.min(MOST_JOBS))).map(|_| Finder::new(wanted, &recipe));
    let finders = finders.collect::<Outcome<Vec<_>>>()?;
    let mut follower = Follower::new(wanted);
    let interruption = signals::interruption(); // before there is anything to finish
    let mut writer = Writer::new(wanted)?;
    let (read, done, stall) = (Queue::new(WAITING, wanted.live), InTurn::new(finders.len(), AHEAD), Stall::default());
    std::thread::scope(|scope| {
        // However this ends, the other threads do.
        let (_read, _done) = (Closing(&read), Closing(&Taking(&done)));
        for finder in finders {
            let (read, done) = (&read, &done);
            thread(scope, move || find_all(finder, read, done))?;
        }
        thread(scope, || read_all(source.as_mut(), wanted.frames, &stall, &read))?;
        write_all(&mut follower, &mut writer, &done, &stall, interruption, frames, out)
    })
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

fn write_all(
    follower: &mut Follower,
    writer: &mut Writer<'_>,
    done: &InTurn<Searched>,
    stall: &Stall,
    interruption: &AtomicI32,
    frames: Option<u64>,
    out: &mut dyn Write,
) -> Outcome {
    let (mut pace, mut said) = (Pace::new(), Instant::now());
    let (mut failed, mut dropped) = (0u64, 0u64);
    loop {
        let signal = interruption.load(Ordering::Relaxed);
        if signal != 0 {
            // The reading thread may wait for its source for ever: nobody waits for it.
            writer.end(out)?;
            say(&format!("interrupted after {} frames: {}", pace.frames, pace.line()));
            std::process::exit(128 + signal);
        }
        let searched = match done.take_within(BEAT) {
            Came::Element(searched) => searched,
            Came::Nothing => {
                stall.look();
                continue;
            }
            Came::End => break,
        };
        let index = searched.index;
        match follower.follow(searched) {
            Ok(frame) => {
                dropped = frame.dropped;
                writer.write(&frame, out)?;
                pace.add(frame.start.elapsed());
            }
            Err(failure) => {
                failed += 1;
                writer.write_failed(index, &failure.to_string(), out)?;
                if failed <= MOST_SAID {
                    failure.report();
                }
            }
        }
        if said.elapsed() >= EVERY {
            said = Instant::now();
            let of = frames.map_or(String::new(), |frames| format!(" of {frames}"));
            say(&format!("frame {}{of}: {}", pace.frames + failed, pace.line()));
        }
    }
    follower.watch.end();
    writer.end(out)?;
    say(&format!("{} frames: {}", pace.frames, pace.line()));
    if dropped > 0 {
        note(&format!("{dropped} frames were dropped, since the newest ones are wanted (--live)"));
    }
    let many = if failed == 1 { "frame" } else { "frames" };
    match (failed, pace.frames) {
        (0, 0) => Err(Failure::request("no frame came from the source")),
        (0, _) => Ok(()),
        (failed, 0) => Err(Failure::request(format!("{failed} {many} failed, and no other came from the source"))),
        (failed, _) => Err(Failure::request(format!("{failed} {many} failed; the others are done"))),
    }
}
