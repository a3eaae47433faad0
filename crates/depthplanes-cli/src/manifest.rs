//! What came of each input, kept beside the results: a run that ended, however it ended, goes on where it was.
//!
//! The manifest is a file of lines. The first says what was asked for; each other one stands for an input, and is written in one
//! piece when the input is done. So of what a killed run has begun only inputs without a line, or without their outputs, are done
//! again, under the same names.

use crate::checksum::fnv;
use crate::failure::{Failure, Outcome, note};
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
    /// What the input was then: bytes, and nanoseconds since 1970 of its last change; of a folder those of all files in it. None
    /// of what is neither.
    #[serde(skip_serializing_if = "Option::is_none")]
    file: Option<(u64, u64)>,
    #[serde(flatten)]
    counts: Option<Counts>,
    /// The files and folders that it has in the folder of results.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    outputs: Vec<PathBuf>,
    /// What it adds to the table.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    rows: String,
    #[serde(skip_serializing_if = "Option::is_none")]
    error: Option<String>,
}

/// How much was found.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Counts {
    pub(crate) planes: usize,
    /// Of a video.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) frames: Option<u64>,
    /// Those of a video that could not be read.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) failed_frames: Option<u64>,
}

/// What came of an input that is done.
pub(crate) struct Entry<'a> {
    pub(crate) counts: Counts,
    /// Its files and folders.
    pub(crate) written: &'a [PathBuf],
    /// What it adds to the table.
    pub(crate) rows: &'a str,
}

/// What an input is known by.
pub(crate) trait Named {
    /// Its name, as given.
    fn name(&self) -> String;
    /// Its file or folder, if it is one.
    fn path(&self) -> Option<&Path>;
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
pub(crate) struct Manifest {
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
    pub(crate) fn open(folder: &Path, shard: Option<Shard>, settings: &Value) -> Outcome<Self> {
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
            end = read(path, of, settings, &mut lines)?; // that of this run comes last
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

    /// Whether an input needs no more work: it is what it was then, and its results are there.
    fn is_done(&self, input: &impl Named) -> Outcome<bool> {
        let Some(line) = self.line(&input.name())? else { return Ok(false) };
        let are_there = || line.outputs.iter().all(|output| self.folder.join(output).exists());
        Ok(line.status == Status::Done && line.file == Seen::of(input).0 && are_there())
    }

    /// The inputs that are to be worked on. A note says how many are not.
    ///
    /// # Errors
    /// What the machine says.
    pub(crate) fn due<'a, T: Named>(&self, inputs: &'a [T]) -> Outcome<Vec<&'a T>> {
        let mut due = Vec::new();
        for input in inputs {
            if !self.is_done(input)? {
                due.push(input);
            }
        }
        if due.len() < inputs.len() {
            note(&format!("--resume: {} of {} inputs are done already", inputs.len() - due.len(), inputs.len()));
        }
        Ok(due)
    }

    /// Whether anything came of an input before, by whichever settings its file had.
    pub(crate) fn knows(&self, input: &impl Named) -> bool {
        self.own.lock().unwrap_or_else(PoisonError::into_inner).lines.contains_key(&input.name())
    }

    /// Notes what came of an input, which was as `seen` says before it was read: what changes meanwhile is done again.
    ///
    /// # Errors
    /// What the machine says.
    pub(crate) fn add(&self, input: &impl Named, seen: Seen, outcome: Result<&Entry<'_>, &Failure>) -> Outcome {
        let outputs = |entry: &Entry<'_>| {
            let below = entry.written.iter().filter_map(|path| path.strip_prefix(&self.folder).ok());
            below.map(Path::to_path_buf).collect()
        };
        let (done, error) = (outcome.ok(), outcome.err().map(ToString::to_string));
        let line = Line {
            input: input.name(),
            status: if done.is_some() { Status::Done } else { Status::Failed },
            file: seen.0,
            counts: done.map(|done| done.counts),
            outputs: done.map(outputs).unwrap_or_default(),
            rows: done.map(|done| done.rows.to_string()).unwrap_or_default(),
            error,
        };
        let text = serde_json::to_string(&line).expect("text and numbers are always JSON") + "\n";
        let mut own = self.own.lock().unwrap_or_else(PoisonError::into_inner);
        own.file.write_all(text.as_bytes()).map_err(|error| {
            // Half a line would keep the others from being read; where it cannot be taken back it stays.
            let _ = own.file.set_len(own.end);
            Failure::machine(format!("{}: {error}", self.paths[0].display()))
        })?;
        let place = Place { of: 0, start: own.end, bytes: text.len() };
        own.end += text.len() as u64;
        own.lines.insert(line.input, place);
        Ok(())
    }

    /// What an input adds to the table, and how many planes it has; none if it is not done.
    pub(crate) fn rows(&self, input: &impl Named) -> Outcome<Option<(String, usize)>> {
        let line = self.line(&input.name())?.filter(|line| line.status == Status::Done);
        Ok(line.map(|line| (line.rows, line.counts.map_or(0, |counts| counts.planes))))
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
    // A killed run may have begun the first line; nobody else's file begins so.
    let first = json!({"schema": SCHEMA}).to_string();
    let alike = first.bytes().take(first.len() - 1).zip(&text).all(|(own, byte)| own == *byte);
    if !alike && !text.contains(&b'\n') {
        return Err(no_manifest(path, "it has no line"));
    }
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

/// Checksums of files that results depend on, by name: with other numbers in them the words mean something else.
pub(crate) fn checksums<'a>(files: impl IntoIterator<Item = &'a Path>) -> Value {
    let of = |path: &Path| Some((path.display().to_string(), format!("{:016x}", fnv(fs::read(path).ok()?)).into()));
    Value::Object(files.into_iter().filter_map(of).collect())
}

fn no_manifest(path: &Path, why: &str) -> Failure {
    Failure::request(format!("{}: not a manifest ({why}); move it away, or use another --out-dir", path.display()))
}

/// What an input was when it was looked at: bytes and last change of its file, or of all files of its folder.
#[derive(Clone, Copy)]
pub(crate) struct Seen(Option<(u64, u64)>);

impl Seen {
    /// What it is now.
    pub(crate) fn of(input: &impl Named) -> Self {
        Seen(state(input))
    }
}

fn state(input: &impl Named) -> Option<(u64, u64)> {
    let path = input.path()?;
    let (mut bytes, mut newest) = (0, 0);
    let mut due = vec![path.to_path_buf()];
    while let Some(path) = due.pop() {
        let about = fs::metadata(&path).ok()?;
        if about.is_dir() {
            for entry in fs::read_dir(&path).ok()?.flatten() {
                // Folders behind links may lead back.
                if !entry.path().is_dir() || entry.file_type().is_ok_and(|kind| kind.is_dir()) {
                    due.push(entry.path());
                }
            }
        } else {
            let changed = about.modified().ok()?.duration_since(UNIX_EPOCH).ok()?;
            bytes += about.len();
            newest = newest.max(changed.as_nanos() as u64);
        }
    }
    Some((bytes, newest))
}
