//! Several videos: each with a folder of its own for its results, once they are whole.

use super::folders;
use super::unfinished::{Unfinished, remove_all};
use super::video::{MOST_JOBS, Plan, Progress, Video, cores};
use super::videos::{self, Source};
use super::writer::Writer;
use crate::args::Track;
use crate::failure::{Failure, Outcome, say};
use crate::folders::make_folder;
use crate::manifest::{Counts, Entry, Manifest, Seen, checksums};
use crate::may_close::MayClose;
use crate::tally::Tally;
use crate::terminal::plain;
use crate::{pool, shard, signals};
use depthplanes_video::StatedUp;
use serde_json::json;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicI32, Ordering};

pub(super) fn run(wanted: &Track, folder: &Path, out: &mut dyn Write) -> Outcome {
    let plan = Plan::new(wanted)?;
    let mut sources = videos::expand(&wanted.sources)?;
    folders::check_out_dir(folder, &sources)?;
    if let Some(shard) = wanted.shard {
        sources = shard::part(shard, sources);
    }
    make_folder(folder)?;
    let manifest = wanted.resume.then(|| Manifest::open(folder, wanted.shard, &settings(&plan))).transpose()?;
    let due = match &manifest {
        Some(manifest) => manifest.due(&sources)?,
        None => sources.iter().collect(),
    };
    refuse_existing(folder, &due, manifest.as_ref())?;
    let (at_once, jobs) = shares(wanted.jobs.unwrap_or(cores()), due.len());
    let work = Work { plan, folder, manifest, jobs, interruption: signals::interruption() };
    let (mut tally, mut out) = (Tally::default(), MayClose::new(out));
    pool::in_order(
        due.len(),
        at_once,
        || |at: usize| work.track(due[at]).map_err(|failure| failure.of_input(&due[at].word)),
        |at, outcome| match outcome {
            Ok(progress) => tell(&mut out, due[at], folder, &progress, &mut tally),
            Err(failure) => {
                tally.add(&failure);
                Ok(())
            }
        },
    )?;
    tally.outcome(due.len())
}

/// All that results depend on.
fn settings(plan: &Plan<'_>) -> serde_json::Value {
    let Plan { wanted, recipe, .. } = plan;
    let (up, world_up) = match wanted.up {
        StatedUp::Nothing => (None, None),
        StatedUp::Camera(up) => (Some(up), None),
        StatedUp::World(up) => (None, Some(up)),
    };
    json!({
        "command": "track",
        "version": env!("CARGO_PKG_VERSION"),
        "method": recipe.method.name,
        "parameters": recipe.named_values(),
        "reading": wanted.reading.words,
        "noise-table": wanted.noise_table,
        "files": checksums(wanted.reading.camera.iter().chain(&wanted.noise_table).map(PathBuf::as_path)),
        "floor": wanted.floor,
        "up": up,
        "world-up": world_up,
        "camera-height": wanted.camera_height,
        "frames": wanted.frames,
        "kept-frames": wanted.kept_frames,
        "ignore-poses": wanted.ignore_poses,
        "only": wanted.only,
    })
}

/// How many videos are worked on at once, and by how many threads that find planes each.
fn shares(jobs: usize, videos: usize) -> (usize, usize) {
    let at_once = jobs.div_ceil(MOST_JOBS).min(videos).max(1);
    (at_once, jobs.div_ceil(at_once))
}

/// Refuses folders that are there and that no earlier run of these words has made.
fn refuse_existing(folder: &Path, due: &[&Source], manifest: Option<&Manifest>) -> Outcome {
    let is_ours = |source: &Source| manifest.is_some_and(|manifest| manifest.knows(source));
    match due.iter().find(|source| folder.join(&source.folder).exists() && !is_ours(source)) {
        Some(source) => Err(Failure::request(format!(
            "{} is there already, and {} would have its results there; accepted: another --out-dir, or --resume from the first run on, \
             which leaves out what is done",
            folder.join(&source.folder).display(),
            source.word
        ))),
        None => Ok(()),
    }
}

/// What is done with each video.
struct Work<'a> {
    plan: Plan<'a>,
    folder: &'a Path,
    manifest: Option<Manifest>,
    /// Threads that find planes in one video.
    jobs: usize,
    interruption: &'static AtomicI32,
}

impl Work<'_> {
    /// Tracks a video, and notes what came of it while nothing has the name of its results: where they do not get it, they are
    /// not there and the next run makes them again.
    fn track(&self, source: &Source) -> Outcome<Progress> {
        let target = self.folder.join(&source.folder);
        let seen = Seen::of(source); // before it is read
        let done = self.results(source, &target);
        if let Ok((_, unfinished)) = &done {
            unfinished.displace()?;
        }
        if let Some(manifest) = &self.manifest {
            let written = [target];
            let entry = done.as_ref().map(|(progress, _)| {
                let Progress { planes, failed, pace, .. } = progress;
                let counts =
                    Counts { planes: *planes as usize, frames: Some(pace.frames), failed_frames: Some(*failed) };
                Entry { counts, written: &written, rows: "" }
            });
            manifest.add(source, seen, entry.as_ref().map_err(|failure| *failure))?;
        }
        let (progress, unfinished) = done?;
        unfinished.finish()?;
        Ok(progress)
    }

    /// The results of a video without their name.
    fn results(&self, source: &Source, target: &Path) -> Outcome<(Progress, Unfinished)> {
        let video = Video::open(&self.plan, &source.word, self.jobs)?;
        let unfinished = Unfinished::begin(target)?;
        let mut writer = Writer::in_folder(unfinished.folder(), &self.plan.wanted.only)?;
        let progress =
            video.track(&mut writer, &mut io::sink(), |_, _, _| match self.interruption.load(Ordering::Relaxed) {
                0 => Ok(()),
                signal => self.interrupted(signal),
            })?;
        if progress.pace.frames == 0 {
            progress.outcome()?;
        }
        unfinished.sync()?;
        Ok((progress, unfinished))
    }

    fn interrupted(&self, signal: i32) -> Outcome {
        remove_all();
        let next = if self.manifest.is_some() {
            "the same words go on"
        } else {
            "the same words begin again; with --resume, from the first run on, they go on"
        };
        say(&format!("interrupted: videos that were not finished have no results; {next}"));
        std::process::exit(128 + signal);
    }
}

/// Says what came of a video.
fn tell(out: &mut dyn Write, source: &Source, folder: &Path, progress: &Progress, tally: &mut Tally) -> Outcome {
    let pace = progress.pace.frames_per_second();
    let (word, folder) = (plain(&source.word), folder.join(&source.folder).display().to_string());
    let (frames, planes) = (progress.pace.frames, progress.planes);
    writeln!(out, "{word}: {frames} frames, {planes} planes, {pace:.0} frames/s; wrote {}", plain(&folder))?;
    if let Err(failure) = progress.outcome() {
        tally.add_in_part(&failure.of_input(&source.word));
    }
    Ok(out.flush()?)
}

#[cfg(test)]
mod tests {
    use super::shares;

    #[test]
    fn threads_go_to_one_video_before_they_go_to_several() {
        assert_eq!([1, 2, 4, 5, 8, 16].map(|jobs| shares(jobs, 100)), [(1, 1), (1, 2), (1, 4), (2, 3), (2, 4), (4, 4)]);
        assert_eq!((shares(16, 2), shares(16, 1), shares(2, 0)), ((2, 8), (1, 16), (1, 2)));
    }
}
