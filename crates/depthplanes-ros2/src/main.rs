//! The program `depthplanes-ros2`.

mod args;

use depthplanes_ros2::{Node, note};
use signal_hook::consts::{SIGINT, SIGTERM};
use std::process::ExitCode;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

fn main() -> ExitCode {
    match run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            note(&format!("the node ends: {message}"));
            ExitCode::from(2)
        }
    }
}

fn run() -> Result<(), String> {
    let options = args::parse()?;
    let stop = Arc::new(AtomicBool::new(false));
    for signal in [SIGINT, SIGTERM] {
        signal_hook::flag::register(signal, Arc::clone(&stop)).map_err(|error| error.to_string())?;
    }
    let node = Node::new(options).map_err(|error| error.to_string())?;
    node.run(&stop).map_err(|error| error.to_string())
}
