//! Peers: other people's methods on the same maps, through a program that runs them.
//!
//! In: a command, which is started once and asked line by line. Out: [`Peer`]s, each of which makes a detection of a map,
//! as our methods do; what is scored, timed and shown of it is the same. docs/eval.md says how a program becomes one.

mod exchange;
mod process;

use crate::failure::{Failure, Outcome};
use depthplanes::Detection;
use depthplanes::methods::METHODS;
use depthplanes_io::Frame;
use depthplanes_io::outputs::Spread;
use process::Process;
use serde::{Deserialize, Serialize};
use std::sync::{Arc, Mutex, PoisonError};

/// Somebody else's method.
pub(super) struct Peer {
    pub(super) listed: Listed,
    /// Shared by all methods that one program has.
    process: Arc<Mutex<Process>>,
}

/// What a program says of a method that it has.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Listed {
    pub(super) name: String,
    /// Package and version, as in `open3d 0.20.0`.
    pub(super) version: String,
    /// Every parameter with its value, as it is to be read in the report.
    pub(super) parameters: String,
}

/// What a program answers to `{"list":true}`.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct List {
    peers: Vec<Listed>,
}

/// What is asked of a program for each map; the map is in the folder.
#[derive(Serialize)]
struct Question<'a> {
    peer: &'a str,
    folder: &'a str,
    camera: exchange::Camera,
    metric: bool,
    repeat: usize,
}

/// What it answers.
#[derive(Deserialize)]
#[serde(untagged)]
enum Answer {
    Found {
        /// File of the label image, within the folder.
        labels: String,
        median_ms: f64,
        least_ms: f64,
    },
    Refused {
        refused: String,
    },
}

const LIST: &str = r#"{"peers":[{"name":"NAME","version":"PACKAGE 1.0","parameters":"theta 1"}, ..]}"#;
const ANSWER: &str = r#"{"labels":"FILE","median_ms":1.5,"least_ms":1.2} or {"refused":"WHY"}"#;

/// The peers of some commands; programs may use so many threads for each map.
///
/// # Errors
/// A command that cannot be started or is no such program, two methods of one name.
pub(super) fn find(commands: &[String], threads: usize) -> Outcome<Vec<Peer>> {
    let mut peers: Vec<Peer> = Vec::new();
    for command in commands {
        let mut process = Process::start(command, threads)?;
        let List { peers: listed } = process.ask(r#"{"list":true}"#, "its methods", LIST)?;
        let process = Arc::new(Mutex::new(process));
        for listed in listed {
            let taken =
                peers.iter().map(|peer| peer.listed.name.as_str()).chain(METHODS.iter().map(|method| method.name));
            if taken.into_iter().any(|name| name == listed.name) {
                let message = "is the name of another method; every method of a report needs a name of its own";
                return Err(Failure::request(format!("--peers {command}: `{}` {message}", listed.name)));
            }
            peers.push(Peer { listed, process: process.clone() });
        }
    }
    Ok(peers)
}

impl Peer {
    /// What it makes of a frame and how long it takes, or why it refuses.
    ///
    /// # Errors
    /// A program that has ended or answers something else, labels that are not of this map.
    pub(super) fn detect(&self, frame: &Frame, repeat: usize) -> Outcome<Result<(Detection, Spread), String>> {
        let mut process = self.process.lock().unwrap_or_else(PoisonError::into_inner);
        let name = &self.listed.name;
        let folder = process.empty_folder()?;
        let (camera, metric) = exchange::put(frame, &folder)?;
        let question = Question { peer: name, folder: &folder.to_string_lossy(), camera, metric, repeat };
        let question = serde_json::to_string(&question).expect("a question is plain values");
        match process.ask(&question, &format!("the planes by {name}"), ANSWER)? {
            Answer::Refused { refused } => Ok(Err(refused)),
            Answer::Found { labels, median_ms, least_ms } => {
                let detection =
                    exchange::take(frame, &folder.join(labels)).map_err(|failure| failure.of_input(name))?;
                Ok(Ok((detection, Spread { median: median_ms, min: least_ms })))
            }
        }
    }
}
