//! Times `planar` on made-up Kinect rooms of several sizes, on one thread and on two, and a copy of the frame, in turn,
//! so that the machine's drift meets all of them alike. Every answer is held against the first.
//!
//! `bench_planar ROUNDS` writes one CSV row for each size and number of threads: medians in microseconds, of the whole,
//! of each stage, of the planes' outlines (which are not part of the whole), and of the copy.

use depthplanes::map::AnyView;
use depthplanes::outline::Outliner;
use depthplanes::scene::{SceneFrame, Spec};
use depthplanes::{Detection, Detector};
use std::hint::black_box;
use std::time::{Duration, Instant};

const SIZES: [[usize; 2]; 4] = [[640, 480], [1280, 720], [1920, 1080], [4096, 3000]];
const THREADS: [usize; 2] = [1, 2];
/// How long frames are looked at before times are taken: of threads that slept, a kernel may wake two on one core, and
/// parts them some milliseconds later.
const WARM_UP: Duration = Duration::from_millis(30);
/// Tolerance of the outlines, pixels.
const TOLERANCE: f64 = 1.5;

type Outcome<T> = Result<T, Box<dyn std::error::Error>>;

fn main() -> Outcome<()> {
    let rounds: usize = std::env::args().nth(1).ok_or("usage: bench_planar ROUNDS")?.parse()?;
    let stages = depthplanes::methods::find("planar")?.stages;
    println!(
        "frame,width,height,threads,planes,total_us,{},outlines_us,copy_us,copies_of_the_frame,ns_per_pixel,times_one_thread",
        stages.iter().map(|stage| format!("{stage}_us")).collect::<Vec<_>>().join(",")
    );
    for [width, height] in SIZES {
        let spec = format!("random:sensor=kinect_white,size={width}x{height}");
        let frame = spec.parse::<Spec>()?.frame()?;
        // Large frames take long, and their times vary less.
        let rounds = if width * height > 2_000_000 { rounds.div_ceil(4) } else { rounds };
        let mut runs = THREADS.map(|threads| Run::new(&frame, threads));
        let mut copies = Vec::new();
        let expected = runs[0].detector.detect(frame.view())?.clone();
        for _ in 0..rounds {
            for run in &mut runs {
                run.round(&frame, &expected)?;
            }
            copies.push(copied(&frame));
        }
        let copy = median(&mut copies);
        let one_thread = median(&mut runs[0].totals);
        for run in &mut runs {
            let total = median(&mut run.totals);
            let per_stage: Vec<String> = run.stages.iter_mut().map(|times| format!("{:.1}", median(times))).collect();
            println!(
                "\"scene:{spec}\",{width},{height},{},{},{total:.1},{},{:.1},{copy:.1},{:.1},{:.2},{:.2}",
                run.threads,
                expected.planes.len(),
                per_stage.join(","),
                median(&mut run.outlines),
                total / copy,
                1000.0 * total / (width * height) as f64,
                one_thread / total
            );
        }
    }
    Ok(())
}

/// A detector on so many threads and its times, microseconds.
struct Run {
    threads: usize,
    detector: Detector,
    outliner: Outliner,
    totals: Vec<f64>,
    stages: Vec<Vec<f64>>,
    outlines: Vec<f64>,
}

impl Run {
    fn new(frame: &SceneFrame, threads: usize) -> Self {
        Run {
            threads,
            detector: Detector::default().sensor(frame.sensor).threads(threads),
            outliner: Outliner::new(TOLERANCE).expect("a positive tolerance"),
            totals: Vec::new(),
            stages: Vec::new(),
            outlines: Vec::new(),
        }
    }

    /// Untimed calls, which bring caches, clock and threads back from what ran before, and three timed ones.
    fn round(&mut self, frame: &SceneFrame, expected: &Detection) -> Outcome<()> {
        let begin = Instant::now();
        while begin.elapsed() < WARM_UP {
            self.detector.detect(frame.view())?;
        }
        for _ in 0..3 {
            let mut ends = Vec::with_capacity(16);
            let start = Instant::now();
            let found = self.detector.detect_observed(black_box(frame.view()), &mut |_| ends.push(start.elapsed()))?;
            self.totals.push(start.elapsed().as_secs_f64() * 1e6);
            if found != expected {
                return Err(format!("another answer on {} threads", self.threads).into());
            }
            self.stages.resize_with(ends.len(), Vec::new);
            let mut last = 0.0;
            for (times, end) in self.stages.iter_mut().zip(&ends) {
                let end = end.as_secs_f64() * 1e6;
                times.push(end - last);
                last = end;
            }
        }
        let camera = frame.sensor.intrinsics;
        let found = self.detector.detect(frame.view())?;
        let start = Instant::now();
        black_box(self.outliner.outline(found, camera.as_ref())?);
        self.outlines.push(start.elapsed().as_secs_f64() * 1e6);
        Ok(())
    }
}

/// Microseconds of a copy of the frame.
fn copied(frame: &SceneFrame) -> f64 {
    let AnyView::U16(view) = frame.view() else { unreachable!("a Kinect's frames are of 16 bits") };
    let mut copy = vec![0u16; view.area()];
    let mut once = || {
        let start = Instant::now();
        for (to, from) in copy.chunks_exact_mut(view.width()).zip(black_box(&view).rows()) {
            to.copy_from_slice(from);
        }
        black_box(&copy);
        start.elapsed().as_secs_f64() * 1e6
    };
    once();
    once()
}

fn median(times: &mut [f64]) -> f64 {
    times.sort_by(f64::total_cmp);
    times[times.len() / 2]
}
