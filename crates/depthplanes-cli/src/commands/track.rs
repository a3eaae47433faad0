//! `depthplanes track`: planes that keep their ids over the frames of a video.
//!
//! In: a source of frames. Out: a line of JSON for each frame, label images, pictures. Three threads: one reads and decodes,
//! one finds and follows planes, one writes; the queues between them are short, so that the slowest sets the pace.

mod folders;
mod follow;
mod pace;
mod queue;
mod record;
mod watch;
mod writer;

use crate::args::Track;
use crate::failure::{Failure, Outcome, note, say};
use crate::load;
use crate::run::Recipe;
use depthplanes::noise::SensorNoise;
use depthplanes_video::{Source, SourceOptions, open};
use follow::{Followed, Follower, Read};
use pace::Pace;
use queue::{Closing, Queue};
use std::io::Write;
use std::time::{Duration, Instant};
use writer::Writer;

/// Frames that wait between two threads.
const WAITING: usize = 2;
/// Frames that fail of which is said why; the lines say it of all.
const MOST_SAID: u64 = 5;
/// How often the pace is said.
const EVERY: Duration = Duration::from_secs(1);

/// A frame that is done, or could not be read.
type Done = Result<Box<Followed>, (u64, Failure)>;

pub(super) fn run(wanted: &Track, out: &mut dyn Write) -> Outcome {
    let recipe = Recipe::new(wanted.method, &wanted.parameters, 1)?;
    let mut options = load::options(&wanted.reading)?;
    options.noise = load::noise_table(wanted.noise_table.as_deref())?.map(SensorNoise::Table);
    let options = SourceOptions::default().read(options);
    folders::check(wanted)?;
    let mut source = open(&wanted.source, &options)?;
    let frames = source.frames().map(|frames| wanted.frames.map_or(frames, |most| most.min(frames)));
    let mut follower = Follower::new(wanted, &recipe)?;
    let mut writer = Writer::new(wanted)?;
    let (read, done) = (Queue::new(WAITING, wanted.live), Queue::new(WAITING, false));
    std::thread::scope(|scope| {
        scope.spawn(|| read_all(source.as_mut(), wanted.frames, &read));
        scope.spawn(|| follow_all(&mut follower, &read, &done));
        write_all(&mut writer, &done, frames, out)
    })
}

fn read_all(source: &mut dyn Source, most: Option<u64>, read: &Queue<Read>) {
    let _closing = Closing(read);
    for index in 0..most.unwrap_or(u64::MAX) {
        let start = Instant::now();
        let Some(frame) = source.next_frame() else { break };
        if !read.send((start, index, frame)) {
            break;
        }
    }
}

fn follow_all(follower: &mut Follower<'_>, read: &Queue<Read>, done: &Queue<Done>) {
    let (_reading, _closing) = (Closing(read), Closing(done));
    while let Some(((start, index, frame), dropped)) = read.take() {
        let followed = frame.map_err(Failure::from).and_then(|frame| follower.follow(start, frame, dropped));
        if !done.send(followed.map(Box::new).map_err(|failure| (index, failure))) {
            break;
        }
    }
    follower.watch.end();
}

fn write_all(writer: &mut Writer<'_>, done: &Queue<Done>, frames: Option<u64>, out: &mut dyn Write) -> Outcome {
    let _closing = Closing(done);
    let (mut pace, mut said) = (Pace::new(), Instant::now());
    let (mut failed, mut dropped) = (0u64, 0u64);
    while let Some((frame, _)) = done.take() {
        match frame {
            Ok(frame) => {
                dropped = frame.dropped;
                writer.write(&frame, out)?;
                pace.add(frame.start.elapsed());
            }
            Err((index, failure)) => {
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
    writer.end(out)?;
    say(&format!("{} frames: {}", pace.frames, pace.line()));
    if dropped > 0 {
        note(&format!("{dropped} frames were dropped, since the newest ones are wanted (--live)"));
    }
    match (failed, pace.frames) {
        (0, 0) => Err(Failure::request("no frame came from the source")),
        (0, _) => Ok(()),
        (failed, 0) => Err(Failure::request(format!("{failed} frames failed, and no other came from the source"))),
        (failed, _) => Err(Failure::request(format!("{failed} frames failed; the others are done"))),
    }
}
