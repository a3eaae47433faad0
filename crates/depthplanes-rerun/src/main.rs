//! The program `depthplanes-rerun`: planes of depth video as a recording of Rerun.
//!
//! In: a source of frames, as of `depthplanes track`. Out: a file that Rerun's viewer opens, with the map, the ids of the planes in
//! it, their outlines and normals in space, the camera and its pose, and what is floor and what is in the way.

mod args;
mod depth;
mod failure;
mod names;
mod recording;
mod run;
mod scene;

use failure::{Failure, Outcome};
use run::Summary;
use signal_hook::consts::{SIGINT, SIGTERM};
use std::process::ExitCode;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

fn main() -> ExitCode {
    match record() {
        Ok(exit_code) => exit_code,
        Err(failure) => {
            eprintln!("error: {failure}");
            ExitCode::from(failure.exit_code)
        }
    }
}

fn record() -> Outcome<ExitCode> {
    let wanted = args::parse()?;
    let stop = Arc::new(AtomicBool::new(false));
    for signal in [SIGINT, SIGTERM] {
        let heard = signal_hook::flag::register(signal, Arc::clone(&stop));
        heard.map_err(|error| Failure::machine(error.to_string()))?;
    }
    let Summary { frames, failed } = run::run(&wanted, &stop)?;
    eprintln!("{}: {frames} frames, {failed} failed; `rerun {0}` shows it", wanted.out.display());
    let is_interrupted = stop.load(Ordering::Relaxed);
    Ok(match (is_interrupted, failed) {
        (true, _) => ExitCode::from(130),
        (false, 0) => ExitCode::SUCCESS,
        _ => ExitCode::from(2),
    })
}
