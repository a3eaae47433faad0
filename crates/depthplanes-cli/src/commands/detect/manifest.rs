//! What came of each input, kept beside the results: a run that ended, however it ended, goes on where it was.
//!
//! The manifest is a file of lines. The first says what was asked for; each other one stands for an input, and is written in one
//! piece when the files of the input have their names. So of what a killed run has begun only inputs without a line are done
//! again, under the same names.

use super::done::Done;
use crate::failure::{Failure, Outcome};
use crate::inputs::Input;
use crate::shard::Shard;
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};
use std::collections::HashMap;
use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};
use std::time::UNIX_EPOCH;

/// The name and version of the form of a manifest.
const SCHEMA: &str = "depthplanes.manifest/1";

/// What came of an input.
#[derive(Serialize, Deserialize)]
struct Line {
    input: String,
    status: Status,
    /// What the input was then: bytes, and nanoseconds since 1970 of its last change; none of what is no file.
    #[serde(skip_serializing_if = "Option::is_none")]
    file: Option<(u64, u64)>,
    #[serde(skip_serializing_if = "Option::is_none")]
    planes: Option<usize>,
    /// The files that it has in the folder of results.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    outputs: Vec<PathBuf>,
    /// What it adds to the table.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    rows: String,
    #[serde(skip_serializing_if = "Option::is_none")]
    error: Option<String>,
}

#[derive(Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
enum Status {
    Done,
    Failed,
}

/// A line of one of the manifests in the folder.
#[derive(Clone, Copy)]
struct Place {
    /// Which of them.
    of: usize,
    start: u64,
    bytes: usize,
}

/// The manifests of a folder of results: that of this run, and those of other shards.
pub(super) struct Manifest {
    folder: PathBuf,
    /// That of this run is the first.
    paths: Vec<PathBuf>,
    own: Mutex<Own>,
}

struct Own {
    file: File,
    /// Where its next line begins.
    end: u64,
    /// The newest line of each input.
    lines: HashMap<String, Place>,
}

impl Manifest {
    /// Opens the folder's manifests, or begins one. `settings` is all that results depend on.
    ///
    /// # Errors
    /// Results of other settings; another run at work on the same ones; what the machine says.
    pub(super) fn open(folder: &Path, shard: Option<Shard>, settings: &Value) -> Outcome<Self> {
        let name = shard
            .map_or("manifest.jsonl".into(), |Shard { index, count }| format!("manifest.{index}-of-{count}.jsonl"));
        let path = folder.join(name);
        let machine = |error| Failure::machine(format!("{}: {error}", path.display()));
        let options = OpenOptions::new().read(true).append(true).create(true).clone();
        let mut file = options.open(&path).map_err(machine)?;
        if let Err(TryLockError::WouldBlock) = file.try_lock() {
            let message = "another run is at work on these inputs; wait for it, or take another --out-dir or --shard";
            return Err(Failure::request(format!("{}: {message}", path.display())));
        }
        let mut paths = vec![path.clone()];
        paths.extend(others(folder, &path).map_err(machine)?);
        let mut lines = HashMap::new();
        let mut end = 0;
        for (of, path) in paths.iter().enumerate().rev() {
            let whole = read(path, of, settings, &mut lines)?;
            end = whole; // that of this run comes last
        }
        // A line that a killed run has begun.
        file.set_len(end).map_err(machine)?;
        if end == 0 {
            let head = json!({"schema": SCHEMA, "settings": settings}).to_string() + "\n";
            file.write_all(head.as_bytes()).map_err(machine)?;
            end = head.len() as u64;
        }
        Ok(Manifest { folder: folder.into(), paths, own: Mutex::new(Own { file, end, lines }) })
    }

    /// Whether an input needs no more work: it is the file that it was then, and its results are there.
    pub(super) fn is_done(&self, input: &Input) -> Outcome<bool> {
        let Some(line) = self.line(&input.name())? else { return Ok(false) };
        let are_there = || line.outputs.iter().all(|output| self.folder.join(output).is_file());
        Ok(line.status == Status::Done && line.file == state(input) && are_there())
    }

    /// Notes what came of an input.
    ///
    /// # Errors
    /// What the machine says.
    pub(super) fn add(&self, input: &Input, outcome: &Outcome<Done>) -> Outcome {
        let outputs = |done: &Done| {
            let below = done.written.iter().filter_map(|path| path.strip_prefix(&self.folder).ok());
            below.map(Path::to_path_buf).collect()
        };
        let (done, error) = (outcome.as_ref().ok(), outcome.as_ref().err().map(ToString::to_string));
        let line = Line {
            input: input.name(),
            status: if done.is_some() { Status::Done } else { Status::Failed },
            file: state(input),
            planes: done.map(|done| done.planes),
            outputs: done.map(outputs).unwrap_or_default(),
            rows: done.map(|done| done.rows.clone()).unwrap_or_default(),
            error,
        };
        let text = serde_json::to_string(&line).expect("text and numbers are always JSON") + "\n";
        let mut own = self.own.lock().unwrap_or_else(PoisonError::into_inner);
        let written = own.file.write_all(text.as_bytes());
        written.map_err(|error| Failure::machine(format!("{}: {error}", self.paths[0].display())))?;
        let place = Place { of: 0, start: own.end, bytes: text.len() };
        own.end += text.len() as u64;
        own.lines.insert(line.input, place);
        Ok(())
    }

    /// What an input adds to the table, and how many planes it has; none if it is not done.
    pub(super) fn rows(&self, input: &Input) -> Outcome<Option<(String, usize)>> {
        let line = self.line(&input.name())?.filter(|line| line.status == Status::Done);
        Ok(line.map(|line| (line.rows, line.planes.unwrap_or(0))))
    }

    fn line(&self, input: &str) -> Outcome<Option<Line>> {
        let place = self.own.lock().unwrap_or_else(PoisonError::into_inner).lines.get(input).copied();
        let Some(Place { of, start, bytes }) = place else { return Ok(None) };
        let path = &self.paths[of];
        let read = || {
            let (mut file, mut text) = (File::open(path)?, vec![0; bytes]);
            file.seek(SeekFrom::Start(start))?;
            file.read_exact(&mut text)?;
            Ok(serde_json::from_slice(&text)?)
        };
        read().map(Some).map_err(|error: std::io::Error| Failure::machine(format!("{}: {error}", path.display())))
    }
}

/// The manifests of other shards.
fn others(folder: &Path, own: &Path) -> std::io::Result<Vec<PathBuf>> {
    let mut paths = Vec::new();
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        if name.starts_with("manifest.") && name.ends_with(".jsonl") && path != own {
            paths.push(path.clone());
        }
    }
    paths.sort();
    Ok(paths)
}

/// Takes in the lines of a manifest; returns how many bytes of whole lines it has.
fn read(path: &Path, of: usize, settings: &Value, lines: &mut HashMap<String, Place>) -> Outcome<u64> {
    let text = fs::read(path).map_err(|error| Failure::machine(format!("{}: {error}", path.display())))?;
    let mut start = 0;
    for line in text.split_inclusive(|&byte| byte == b'\n').filter(|line| line.ends_with(b"\n")) {
        if start == 0 {
            check_head(path, line, settings)?;
        } else {
            let line_of: Line = serde_json::from_slice(line).map_err(|error| no_manifest(path, &error.to_string()))?;
            lines.insert(line_of.input, Place { of, start: start as u64, bytes: line.len() });
        }
        start += line.len();
    }
    Ok(start as u64)
}

fn check_head(path: &Path, line: &[u8], settings: &Value) -> Outcome {
    let head: Value = serde_json::from_slice(line).map_err(|error| no_manifest(path, &error.to_string()))?;
    if head["schema"] != SCHEMA {
        return Err(no_manifest(path, &format!("its schema is {}, and {SCHEMA} is known", head["schema"])));
    }
    let differs = settings.as_object().into_iter().flatten().find(|(key, value)| head["settings"][key] != **value);
    differs.map_or(Ok(()), |(key, value)| {
        let before = &head["settings"][key];
        Err(Failure::request(format!(
            "{}: the results there were made with another {key}: {before} instead of {value}; use the same words, or another --out-dir",
            path.display()
        )))
    })
}

fn no_manifest(path: &Path, why: &str) -> Failure {
    Failure::request(format!("{}: not a manifest ({why}); move it away, or use another --out-dir", path.display()))
}

/// Bytes and last change of an input's file.
fn state(input: &Input) -> Option<(u64, u64)> {
    let Input::File { path, .. } = input else { return None };
    let about = fs::metadata(path).ok()?;
    let changed = about.modified().ok()?.duration_since(UNIX_EPOCH).ok()?;
    Some((about.len(), changed.as_nanos() as u64))
}
