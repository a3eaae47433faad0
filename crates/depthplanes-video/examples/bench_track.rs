//! How much tracking and the ground add to a frame's detection, on the frames of a source.
//!
//! `bench_track ROUNDS SOURCE..`: the frames are read once; then each round times, frame by frame, detection, tracking, with borders that do not flicker and without, and ground,
//! each with its own memory. Prints CSV: source, what, median and least milliseconds a frame. That every round gives the same
//! ids is checked.

use depthplanes::Detector;
use depthplanes::ground::GroundFinder;
use depthplanes::track::Tracker;
use depthplanes_video::{SourceOptions, VideoFrame, open};
use std::error::Error;
use std::time::Instant;

/// What is timed.
const NAMES: [&str; 5] = ["read", "detect", "track", "track with borders", "ground"];

fn main() -> Result<(), Box<dyn Error>> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let [rounds, sources @ ..] = &words[..] else { return Err("bench_track ROUNDS SOURCE..".into()) };
    println!("source,what,median_ms,least_ms");
    for source in sources {
        let mut times: [Vec<f64>; 5] = Default::default();
        let frames = read(source, &mut times[0])?;
        let mut first = None;
        for _ in 0..rounds.parse()? {
            let ids = round(&frames, &mut times)?;
            if *first.get_or_insert_with(|| ids.clone()) != ids {
                return Err(format!("{source}: other ids in another round").into());
            }
        }
        for (name, times) in NAMES.iter().zip(&mut times) {
            times.sort_by(f64::total_cmp);
            println!("{source},{name},{:.3},{:.3}", times[times.len() / 2], times[0]);
        }
    }
    Ok(())
}

/// All frames of a source, and how long each took.
fn read(source: &str, times: &mut Vec<f64>) -> Result<Vec<VideoFrame>, Box<dyn Error>> {
    let mut source = open(source, &SourceOptions::default())?;
    let mut frames = Vec::new();
    loop {
        let start = Instant::now();
        let Some(frame) = source.next_frame() else { return Ok(frames) };
        frames.push(frame?);
        times.push(milliseconds(start));
    }
}

/// The ids of all frames, and how long each step took.
fn round(frames: &[VideoFrame], times: &mut [Vec<f64>; 5]) -> Result<Vec<Vec<u32>>, Box<dyn Error>> {
    let (mut detector, mut finder) = (Detector::default(), GroundFinder::default());
    let (mut tracker, mut steady) = (Tracker::default(), Tracker::default());
    let mut ids = Vec::new();
    for VideoFrame { frame, pose, .. } in frames {
        detector.set_sensor(frame.sensor);
        let start = Instant::now();
        let found = detector.detect(frame.view()?)?;
        times[1].push(milliseconds(start));
        let start = Instant::now();
        let tracks = tracker.track(found, &frame.sensor, pose.as_ref())?;
        times[2].push(milliseconds(start));
        ids.push(tracks.ids.clone());
        let start = Instant::now();
        steady.track_with_map(frame.view()?, found, &frame.sensor, pose.as_ref())?;
        times[3].push(milliseconds(start));
        let start = Instant::now();
        finder.find(frame.view()?, found, &frame.sensor)?;
        times[4].push(milliseconds(start));
    }
    Ok(ids)
}

fn milliseconds(start: Instant) -> f64 {
    start.elapsed().as_secs_f64() * 1e3
}
