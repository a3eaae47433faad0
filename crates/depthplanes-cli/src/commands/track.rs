//! `depthplanes track`: planes that keep their ids over the frames of a video.
//!
//! In: a source of frames, or several. Out: a line of JSON for each frame, recordings, label images, pictures. `video.rs` is one
//! video from its source to its outputs.

mod find;
mod folders;
mod follow;
mod many;
mod pace;
mod queue;
mod stall;
mod unfinished;
mod video;
mod videos;
mod watch;
mod writer;

use crate::args::Track;
use crate::failure::{Failure, Outcome, note, say};
use crate::signals;
use std::io::Write;
use std::sync::atomic::Ordering;
use std::time::{Duration, Instant};
use video::{MOST_JOBS, Plan, Progress, Video, cores};
use writer::Writer;

/// How often the pace is said.
const EVERY: Duration = Duration::from_secs(1);

pub(super) fn run(wanted: &Track, out: &mut dyn Write) -> Outcome {
    match (&wanted.out_dir, &wanted.sources[..]) {
        (Some(folder), _) => many::run(wanted, folder, out),
        (None, [source]) => alone(wanted, source, out),
        (None, several) => Err(Failure::request(format!(
            "{} videos were given; accepted: one, or several with --out-dir DIR, which has a folder of results for each",
            several.len()
        ))),
    }
}

/// One video, which may have no end: what was done of it until it is interrupted is kept.
fn alone(wanted: &Track, source: &str, out: &mut dyn Write) -> Outcome {
    let plan = Plan::new(wanted)?;
    folders::check(wanted, source)?;
    let video = Video::open(&plan, source, wanted.jobs.unwrap_or(cores().min(MOST_JOBS)))?;
    let interruption = signals::interruption(); // before there is anything to finish
    let mut writer = Writer::new(wanted)?;
    let mut said = Instant::now();
    let progress = video.track(&mut writer, out, |progress: &Progress, writer, out| {
        let signal = interruption.load(Ordering::Relaxed);
        if signal != 0 {
            // The reading thread may wait for its source for ever: nobody waits for it.
            writer.end(out)?;
            say(&format!("interrupted after {} frames: {}", progress.pace.frames, progress.pace.line()));
            std::process::exit(128 + signal);
        }
        if said.elapsed() >= EVERY && progress.seen() > 0 {
            said = Instant::now();
            let of = progress.of.map_or(String::new(), |frames| format!(" of {frames}"));
            say(&format!("frame {}{of}: {}", progress.seen(), progress.pace.line()));
        }
        Ok(())
    })?;
    say(&format!("{} frames: {}", progress.pace.frames, progress.pace.line()));
    if progress.dropped > 0 {
        note(&format!("{} frames were dropped, since the newest ones are wanted (--live)", progress.dropped));
    }
    progress.outcome()
}
