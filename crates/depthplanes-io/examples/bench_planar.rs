//! Times `planar` on recorded frames and on synthetic ones of several sizes, on one thread and on two, and a copy of the
//! frame, in turn, so that the machine's drift meets all of them alike. Every answer is held against the first.
//!
//! `bench_planar ROUNDS DATA [PROGRAM]` writes one CSV row for each frame and number of threads: medians in microseconds,
//! of the whole, of each stage, of the planes' outlines and of the ground (which are not part of the whole), and of the copy.
//! DATA: the folder of recorded frames. PROGRAM: another state of `depthplanes`, whose `detect --repeat` is timed in turn on the recorded ones.

use depthplanes::ground::{Ground, GroundFinder};
use depthplanes::map::AnyView;
use depthplanes::outline::Outliner;
use depthplanes::scene::Spec;
use depthplanes::{Detection, Detector, Intrinsics, Sensor};
use depthplanes_io::ReadOptions;
use std::hint::black_box;
use std::process::Command;
use std::time::{Duration, Instant};

/// Recorded frames: file, encoding, fx, fy, cx, cy.
const RECORDED: [(&str, &str, [f64; 4]); 6] = [
    ("gt_real/k7_000.depth.png", "millimetre", [585.0, 585.0, 320.0, 240.0]),
    ("video_7scenes/frame-000020.depth.png", "millimetre", [585.0, 585.0, 320.0, 240.0]),
    ("gt_real/tsdf_150.depth.png", "millimetre", [585.0, 585.0, 320.0, 240.0]),
    ("gt_real/o3d_tum.depth.png", "tum", [525.0, 525.0, 319.5, 239.5]),
    ("gt_real/lpvo_hall_125.depth.png", "millimetre", [525.0, 525.0, 319.5, 239.5]),
    ("gt_real/mosd_learn9.depth.png", "millimetre", [525.0, 525.0, 319.5, 239.5]),
];
/// Synthetic frames: sensor, columns, rows. The first with white noise alone.
const SYNTHETIC: [(&str, usize, usize); 5] = [
    ("kinect_white", 640, 480),
    ("kinect", 640, 480),
    ("kinect", 1280, 720),
    ("kinect", 1920, 1080),
    ("kinect", 4096, 3000),
];
const THREADS: [usize; 2] = [1, 2];
/// How long frames are looked at before times are taken: of threads that slept, a kernel may wake two on one core, and
/// parts them some milliseconds later.
const WARM_UP: Duration = Duration::from_millis(30);
/// Frames that the other program is timed on at a time.
const REPEATS: &str = "20";
/// Tolerance of the outlines, pixels.
const TOLERANCE: f64 = 1.5;

type Outcome<T> = Result<T, Box<dyn std::error::Error>>;

fn main() -> Outcome<()> {
    let mut arguments = std::env::args().skip(1);
    let usage = "usage: bench_planar ROUNDS DATA [PROGRAM]";
    let rounds: usize = arguments.next().ok_or(usage)?.parse()?;
    let data = arguments.next().ok_or(usage)?;
    let program = arguments.next();
    let stages = depthplanes::methods::find("planar")?.stages;
    println!(
        "frame,width,height,threads,planes,total_us,{},outlines_us,ground_us,copy_us,copies_of_the_frame,ns_per_pixel,times_one_thread,other_us,times_other",
        stages.iter().map(|stage| format!("{stage}_us")).collect::<Vec<_>>().join(",")
    );
    for (file, encoding, [fx, fy, cx, cy]) in RECORDED {
        let path = format!("{data}/{file}");
        let camera = Intrinsics::new(fx, fy, cx, cy)?;
        let options =
            ReadOptions { encoding: Some(encoding.into()), intrinsics: Some(camera), ..ReadOptions::default() };
        let frame = depthplanes_io::read(&path, &options)?;
        let other = program.as_ref().map(|program| {
            let mut command = Command::new(program);
            command.args(["detect", &path, "--encoding", encoding]);
            command.args([&format!("--intrinsics={fx},{fy},{cx},{cy}"), "--repeat", REPEATS, "--threads", "1"]);
            command
        });
        bench(&Frame { name: file, view: frame.view()?, sensor: frame.sensor }, rounds, other)?;
    }
    for (sensor, width, height) in SYNTHETIC {
        let spec = format!("random:sensor={sensor},size={width}x{height}");
        let frame = spec.parse::<Spec>()?.frame()?;
        // Large frames take long, and their times vary less.
        let rounds = if width * height > 2_000_000 { rounds.div_ceil(4) } else { rounds };
        bench(&Frame { name: &format!("scene:{spec}"), view: frame.view(), sensor: frame.sensor }, rounds, None)?;
    }
    Ok(())
}

struct Frame<'a> {
    name: &'a str,
    view: AnyView<'a>,
    sensor: Sensor,
}

/// Times a frame, and writes its rows.
fn bench(frame: &Frame<'_>, rounds: usize, mut other: Option<Command>) -> Outcome<()> {
    let mut runs = THREADS.map(|threads| Run::new(frame, threads));
    let (mut copies, mut others) = (Vec::new(), Vec::new());
    let expected = runs[0].detector.detect(frame.view)?.clone();
    for _ in 0..rounds {
        for run in &mut runs {
            run.round(frame, &expected)?;
        }
        copies.push(copied(frame));
        if let Some(other) = &mut other {
            others.push(median_of(other)?);
        }
    }
    let copy = median(&mut copies);
    let one_thread = median(&mut runs[0].totals);
    let [width, height] = [expected.width, expected.height];
    for run in &mut runs {
        let total = median(&mut run.totals);
        let per_stage: Vec<String> = run.stages.iter_mut().map(|times| format!("{:.1}", median(times))).collect();
        let against = match (others.is_empty(), run.threads) {
            (false, 1) => format!("{:.1},{:.2}", median(&mut others), median(&mut others) / total),
            _ => ",".to_string(),
        };
        println!(
            "\"{}\",{width},{height},{},{},{total:.1},{},{:.1},{:.1},{copy:.1},{:.1},{:.2},{:.2},{against}",
            frame.name,
            run.threads,
            expected.planes.len(),
            per_stage.join(","),
            median(&mut run.outlines),
            median(&mut run.ground),
            total / copy,
            1000.0 * total / (width * height) as f64,
            one_thread / total
        );
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
    finder: GroundFinder,
    ground: Vec<f64>,
}

impl Run {
    fn new(frame: &Frame<'_>, threads: usize) -> Self {
        Run {
            threads,
            detector: Detector::default().sensor(frame.sensor).threads(threads),
            outliner: Outliner::new(TOLERANCE).expect("a positive tolerance"),
            totals: Vec::new(),
            stages: Vec::new(),
            outlines: Vec::new(),
            finder: GroundFinder::default(),
            ground: Vec::new(),
        }
    }

    /// Untimed calls, which bring caches, clock and threads back from what ran before, and three timed ones.
    fn round(&mut self, frame: &Frame<'_>, expected: &Detection) -> Outcome<()> {
        let begin = Instant::now();
        while begin.elapsed() < WARM_UP {
            self.detector.detect(frame.view)?;
        }
        for _ in 0..3 {
            let mut ends = Vec::with_capacity(16);
            let start = Instant::now();
            let found = self.detector.detect_observed(black_box(frame.view), &mut |_| ends.push(start.elapsed()))?;
            self.totals.push(start.elapsed().as_secs_f64() * 1e6);
            if found != expected {
                return Err(format!("{}: another answer on {} threads", frame.name, self.threads).into());
            }
            self.stages.resize_with(ends.len(), Vec::new);
            let mut last = 0.0;
            for (times, end) in self.stages.iter_mut().zip(&ends) {
                let end = end.as_secs_f64() * 1e6;
                times.push(end - last);
                last = end;
            }
        }
        let found = self.detector.detect(frame.view)?;
        let start = Instant::now();
        black_box(self.outliner.outline(found, frame.sensor.intrinsics.as_ref())?);
        self.outlines.push(start.elapsed().as_secs_f64() * 1e6);
        // Its memory is there from the first call on, as in a video.
        let first: Ground = self.finder.find(frame.view, found, &frame.sensor)?.clone();
        let start = Instant::now();
        let ground = black_box(self.finder.find(frame.view, found, &frame.sensor)?);
        self.ground.push(start.elapsed().as_secs_f64() * 1e6);
        if *ground != first {
            return Err(format!("{}: another ground of the same frame", frame.name).into());
        }
        Ok(())
    }
}

/// Microseconds of a frame by another program, the median that it prints.
fn median_of(program: &mut Command) -> Outcome<f64> {
    let out = String::from_utf8(program.output()?.stdout)?;
    let time = out.split("time: ").nth(1).and_then(|rest| rest.split(" ms median").next());
    Ok(1000.0 * time.ok_or_else(|| format!("the other program printed no time:\n{out}"))?.parse::<f64>()?)
}

/// Microseconds of a copy of the frame.
fn copied(frame: &Frame<'_>) -> f64 {
    let AnyView::U16(view) = frame.view else { unreachable!("all frames are of 16 bits") };
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
