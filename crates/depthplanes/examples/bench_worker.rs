//! Measures stages of `ngaf` on one frame, told by another program when to do what, so that it can
//! be interleaved with rivals in one run (`benchmarks/run.py`).
//!
//! `bench_worker WIDTH HEIGHT TYPE THETA MIN_PIXELS THREADS KERNEL FILE`: FILE holds raw little-endian
//! pixels, TYPE is u8, u16 or f32, KERNEL is a kernel's name or `best`. Commands on stdin, one a
//! line, answered by one line: `detect N` (nanoseconds of N times group + select + labels, after
//! a warm-up), `copy N` (the same of a copy of the frame), `stages` (the three times of `detect`), `runs` (how many
//! runs the frame has), `labels FILE` (writes the label image, raw u16).

use depthplanes::DepthView;
use depthplanes::internals::{Compiles, ConnectedComponents, Connectivity, Kernel, Selection, kernels};
use std::hint::black_box;
use std::io::BufRead;
use std::time::{Duration, Instant};

struct Job {
    width: usize,
    height: usize,
    theta: f64,
    min_pixels: u32,
    threads: usize,
    kernel: &'static Kernel,
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let [width, height, kind, theta, min_pixels, threads, kernel, file] = &args[..] else {
        return Err("usage: bench_worker WIDTH HEIGHT TYPE THETA MIN_PIXELS THREADS KERNEL FILE".into());
    };
    let job = Job {
        width: width.parse()?,
        height: height.parse()?,
        theta: theta.parse()?,
        min_pixels: min_pixels.parse()?,
        threads: threads.parse()?,
        kernel: match kernel.as_str() {
            "best" => depthplanes::internals::best(),
            name => kernels().find(|kernel| kernel.name() == name).ok_or("no such kernel on this processor")?,
        },
    };
    let bytes = std::fs::read(file)?;
    match kind.as_str() {
        "u8" => serve(&job, bytes),
        "u16" => serve(&job, bytes.chunks_exact(2).map(|b| u16::from_le_bytes([b[0], b[1]])).collect()),
        "f32" => serve(&job, bytes.chunks_exact(4).map(|b| f32::from_le_bytes([b[0], b[1], b[2], b[3]])).collect()),
        _ => Err("TYPE is u8, u16 or f32".into()),
    }
}

fn serve<T: Compiles>(job: &Job, pixels: Vec<T>) -> Result<(), Box<dyn std::error::Error>> {
    let view = DepthView::new(&pixels, job.width, job.height)?;
    let rule = Connectivity::new(view.validity(), job.theta)?;
    let mut grouper = ConnectedComponents::with_kernel(job.kernel);
    grouper.leave_out_singles(job.min_pixels >= 1);
    let mut selection = Selection::default();
    let mut labels = Vec::new();
    let mut copy = pixels.clone();
    for line in std::io::stdin().lock().lines() {
        let line = line?;
        match line.split_once(' ').unwrap_or((&line, "")) {
            ("detect", times) => print_times(times, || {
                let groups = grouper.group(black_box(&view), &rule, job.threads);
                selection.select(groups, job.min_pixels)?;
                selection.paint(groups, &mut labels);
                black_box(&labels);
                Ok(())
            })?,
            ("copy", times) => print_times(times, || {
                copy.copy_from_slice(black_box(&pixels));
                black_box(&copy);
                Ok(())
            })?,
            ("stages", _) => {
                let start = Instant::now();
                let groups = grouper.group(black_box(&view), &rule, job.threads);
                let grouped = start.elapsed();
                selection.select(groups, job.min_pixels)?;
                let selected = start.elapsed();
                selection.paint(groups, &mut labels);
                println!("{:?} {:?} {:?}", grouped, selected - grouped, start.elapsed() - selected);
            }
            ("runs", _) => println!("{}", grouper.groups().run_count()),
            ("labels", file) => {
                let bytes: Vec<u8> = labels.iter().flat_map(|label| label.to_le_bytes()).collect();
                std::fs::write(file, bytes)?;
                println!("{}", job.kernel.name());
            }
            _ => return Err(format!("unknown command `{line}`").into()),
        }
    }
    Ok(())
}

/// Untimed calls come first for this long: a processor that was waiting takes as much to its full speed.
const WARM_UP: Duration = Duration::from_millis(10);

/// Nanoseconds of that many calls, after the warm-up.
fn print_times(
    times: &str,
    mut call: impl FnMut() -> depthplanes::Result<()>,
) -> Result<(), Box<dyn std::error::Error>> {
    let (begin, times) = (Instant::now(), times.parse::<usize>()?);
    let mut taken = Vec::new();
    while taken.len() < times {
        let start = Instant::now();
        call()?;
        if start - begin >= WARM_UP {
            taken.push(start.elapsed().as_nanos().to_string());
        }
    }
    println!("{}", taken.join(" "));
    Ok(())
}
