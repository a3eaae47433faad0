//! Random maps through random methods, parameters, cameras and noise: nothing panics, takes long or gives a number that
//! is none; labels keep their contract; the answer is the same on any number of threads and in the next frame.
//!
//! Each run depends on its seed alone. `make stress RUNS=100000` makes more runs than the tests do, and
//! `make stress SEED=17 RUNS=1` repeats one.

mod case;
mod checks;
mod maps;
mod sensors;
#[expect(dead_code, reason = "only its frame and its report are taken here")]
#[path = "../support/mod.rs"]
mod support;

use case::Case;
use checks::Tally;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Mutex;
use std::time::{Duration, Instant};

/// Runs that the tests make.
const RUNS: u64 = 2000;
/// Longest time that a run may take: 5 s for each of its four detections.
const LIMIT: Duration = Duration::from_secs(20);
/// A run that takes as long as this never ends; the test gives its seed and stops.
const ENDLESS: Duration = Duration::from_secs(120);

/// The run that is being made, and since when.
static CURRENT: Mutex<Option<(u64, Instant)>> = Mutex::new(None);

fn number(name: &str, default: u64) -> u64 {
    std::env::var(name)
        .ok()
        .filter(|text| !text.is_empty())
        .map_or(default, |text| text.parse().unwrap_or_else(|_| panic!("{name} is `{text}`; accepted: a whole number")))
}

/// Makes one run; returns what is wrong with it.
fn failure(seed: u64, tally: &mut Tally) -> Option<String> {
    let case = Case::new(seed);
    let describe = |what: &str| format!("seed {seed}: {what}\n  {case}");
    let started = Instant::now();
    *CURRENT.lock().unwrap() = Some((seed, started));
    let outcome = catch_unwind(AssertUnwindSafe(|| checks::run(&case, tally)));
    let elapsed = started.elapsed();
    match outcome {
        Ok(Ok(())) if elapsed > LIMIT => Some(describe(&format!("took {:.1} s", elapsed.as_secs_f64()))),
        Ok(Ok(())) => None,
        Ok(Err(wrong)) => Some(describe(&wrong)),
        Err(_) => Some(describe("panicked, see above")),
    }
}

/// Ends the test where a run does not end.
fn watch() {
    std::thread::spawn(|| {
        loop {
            std::thread::sleep(Duration::from_secs(1));
            if let Some((seed, started)) = *CURRENT.lock().unwrap()
                && started.elapsed() > ENDLESS
            {
                eprintln!("seed {seed} does not end: {}", Case::new(seed));
                std::process::exit(1);
            }
        }
    });
}

#[test]
fn random_maps_methods_cameras_and_noise_give_finite_numbers_in_time() {
    let (first, runs) = (number("STRESS_SEED", 1), number("STRESS_RUNS", RUNS));
    watch();
    let started = Instant::now();
    let (mut failures, mut tally) = (0u64, Tally::default());
    for seed in first..first + runs {
        if let Some(failure) = failure(seed, &mut tally) {
            eprintln!("{failure}");
            failures += 1;
        }
        let done = seed - first + 1;
        if done % 10_000 == 0 {
            eprintln!("{done} runs in {:.0} s, {failures} failed", started.elapsed().as_secs_f64());
        }
    }
    *CURRENT.lock().unwrap() = None;
    eprintln!("{runs} runs in {:.1} s, {failures} failed; {tally:?}", started.elapsed().as_secs_f64());
    assert_eq!(failures, 0, "runs failed; `make stress SEED=<seed> RUNS=1` repeats one");
}
