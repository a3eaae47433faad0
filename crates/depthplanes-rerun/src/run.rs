//! The frames of a source, searched and tracked, into a recording.

use crate::args::Wanted;
use crate::failure::{Failure, Outcome};
use crate::recording::Recording;
use crate::scene::Scene;
use depthplanes::Detector;
use depthplanes::ground::GroundFinder;
use depthplanes::track::Tracker;
use depthplanes_video::{Finder, Source, SourceOptions, Tracked, VideoFrame, open};
use re_log_types::{TimePoint, Timeline};
use std::collections::BTreeSet;
use std::sync::atomic::{AtomicBool, Ordering};

/// Notes that are said; more are in the recording alone.
const MOST_SAID: usize = 5;
/// Seconds since 1970 from which on a time is a date rather than the time since something: 2001 to 2286.
const DATES_S: std::ops::Range<f64> = 1e9..1e10;

/// What came of it.
pub(crate) struct Summary {
    /// Frames that were searched, and frames that could not be.
    pub(crate) frames: u64,
    pub(crate) failed: u64,
}

/// Writes the recording; `stop` ends it early and whole.
///
/// # Errors
/// What is wrong with the request or the source, and what the machine says.
pub(crate) fn run(wanted: &Wanted, stop: &AtomicBool) -> Outcome<Summary> {
    let mut source = open(&wanted.source, &SourceOptions::default().read(wanted.read.clone()))?;
    let mut search = Search::new(wanted)?;
    let mut scene = Scene::new(Recording::new(&wanted.out, &wanted.source)?)?;
    let (mut clock, mut said, mut summary) = (Clock::default(), BTreeSet::new(), Summary { frames: 0, failed: 0 });
    for at in 0..wanted.frames.unwrap_or(u64::MAX) {
        let Some(frame) = next(source.as_mut(), stop) else { break };
        let time_s = frame.as_ref().ok().and_then(|video| video.time_s);
        let time = clock.point(at, time_s);
        let outcome = frame.map_err(Failure::from).and_then(|video| {
            for text in video.frame.warnings.iter().filter(|text| said.insert((*text).clone())) {
                scene.note(&time, text)?;
            }
            search.write(&mut scene, &time, video)
        });
        match outcome {
            Ok(()) => summary.frames += 1,
            Err(failure) if failure.exit_code == 1 => return Err(failure),
            Err(failure) => {
                summary.failed += 1;
                scene.write_failed(&time, &failure.to_string())?;
            }
        }
    }
    scene.finish()?;
    said.iter().take(MOST_SAID).for_each(|text| eprintln!("note: {text}"));
    Ok(summary)
}

/// The next frame, unless somebody ends the program.
fn next(source: &mut dyn Source, stop: &AtomicBool) -> Option<depthplanes_video::Result<VideoFrame>> {
    if stop.load(Ordering::Relaxed) { None } else { source.next_frame() }
}

/// Finds and follows the planes of one frame after the other.
struct Search {
    finder: Finder,
    tracker: Tracker,
    ignores_poses: bool,
}

impl Search {
    fn new(wanted: &Wanted) -> Outcome<Self> {
        let planes = Finder::new(Detector::default().threads(0));
        let ground = GroundFinder::default().camera_height_m(wanted.camera_height_m)?;
        let finder = if wanted.floor { planes.with_ground(ground, wanted.up)? } else { planes };
        let tracker = wanted.kept_frames.map_or_else(Tracker::default, |frames| Tracker::default().kept_frames(frames));
        Ok(Search { finder, tracker, ignores_poses: wanted.ignores_poses })
    }

    fn write(&mut self, scene: &mut Scene, time: &TimePoint, mut video: VideoFrame) -> Outcome {
        let found = self.finder.find(&video)?;
        let pose = video.pose.filter(|_| !self.ignores_poses);
        let (map, sensor) = (video.frame.view()?, &video.frame.sensor);
        let tracks = self.tracker.track_with_map(map, found.detection, sensor, pose.as_ref())?;
        video.pose = pose;
        let tracked = Tracked { video: &video, detection: found.detection, tracks, ground: None, dropped: 0 };
        scene.write(time, &tracked, found.ground)
    }
}

/// The timelines: `frame`, and `time` where the source says it.
#[derive(Default)]
struct Clock {
    /// Whether times are dates, by the first one.
    are_dates: Option<bool>,
}

impl Clock {
    fn point(&mut self, at: u64, time_s: Option<f64>) -> TimePoint {
        let frame = TimePoint::default().with(Timeline::new_sequence("frame"), at as i64);
        let Some(time_s) = time_s else { return frame };
        let are_dates = *self.are_dates.get_or_insert(DATES_S.contains(&time_s));
        let timeline = if are_dates { Timeline::new_timestamp("time") } else { Timeline::new_duration("time") };
        frame.with(timeline, (time_s * 1e9).round() as i64)
    }
}
