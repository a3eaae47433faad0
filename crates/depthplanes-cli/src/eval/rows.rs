//! What a method made of a map, as a line of JSON; and the file of such lines that an interrupted evaluation goes on from.

use super::claim::refuse_no_file;
use crate::failure::{Failure, Outcome, note};
use depthplanes::methods;
use depthplanes_io::outputs::write_file;
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, HashMap};
use std::fs::{File, OpenOptions};
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

/// Which map and which method with which parameters: what makes a row the same when it is made again.
#[derive(Clone, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
pub(crate) struct Key {
    pub(crate) dataset: String,
    pub(crate) map: String,
    /// What the method with these parameters is called in the report.
    pub(crate) label: String,
    pub(crate) method: String,
    /// Every parameter with its value, as they are written.
    pub(crate) parameters: String,
    pub(crate) version: String,
    /// Runs that were timed after a warm-up.
    pub(crate) repeat: usize,
}

/// What a method made of a map.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Row {
    #[serde(flatten)]
    pub(crate) key: Key,
    /// The machine's processor and how many of it there are.
    pub(crate) machine: String,
    /// When it was made, UTC.
    pub(crate) date: String,
    /// Maps that were worked on at the same time, which makes times longer.
    pub(crate) jobs: usize,
    /// Columns and rows of the map.
    pub(crate) size: [usize; 2],
    pub(crate) valid_pixels: usize,
    pub(crate) outcome: Made,
}

/// How it came out.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum Made {
    Found(Found),
    /// Why the method could not do it.
    Refused(String),
}

/// What was found and how good it is.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Found {
    pub(crate) planes: usize,
    pub(crate) labelled_pixels: usize,
    /// Median and least time of a run, milliseconds.
    pub(crate) median_ms: f64,
    pub(crate) least_ms: f64,
    /// File of its labels, within the report's folder.
    pub(crate) labels: String,
    /// By `family.name` of the measures, where there is a truth.
    pub(crate) scores: BTreeMap<String, f64>,
    /// Truth planes found, by the SegComp tolerance.
    pub(crate) correct_at: Vec<(f64, usize)>,
    /// Median angle between normals of planes that match, degrees, where the truth's are known.
    pub(crate) normal_error_deg: Option<f64>,
}

/// The file of rows, one a line.
pub(crate) struct Store {
    file: File,
    rows: HashMap<Key, Row>,
}

impl Store {
    /// Opens the file, or begins one. Lines that are torn, as by an interruption or by two writers, go to a file beside it,
    /// and a note says so.
    ///
    /// # Errors
    /// A file that cannot be read or written, or that holds something else.
    pub(crate) fn open(path: &Path) -> Outcome<Self> {
        let failed = |error| Failure::machine(format!("{}: {error}", path.display()));
        for path in [path, &beside(path)] {
            refuse_no_file(path)?;
        }
        let mut file =
            OpenOptions::new().read(true).write(true).create(true).truncate(false).open(path).map_err(failed)?;
        let mut bytes = Vec::new();
        file.read_to_end(&mut bytes).map_err(failed)?;
        let (mut rows, mut whole, mut torn) = (HashMap::new(), Vec::new(), Vec::new());
        for (number, line) in (1..).zip(bytes.split_inclusive(|&byte| byte == b'\n')) {
            match serde_json::from_slice::<Row>(line) {
                Ok(mut row) => {
                    row.key.parameters = by_names(&row.key);
                    whole.extend([line.trim_ascii_end(), b"\n"].concat());
                    rows.insert(row.key.clone(), row);
                }
                Err(error) => torn.push((number, line, error)),
            }
        }
        if let (Some((number, _, error)), true, true) = (torn.first(), rows.is_empty(), bytes.contains(&b'\n')) {
            let message = "is no row of an evaluation; take another folder, or move the file away";
            return Err(Failure::request(format!("{}: line {number}: {message} ({error})", path.display())));
        }
        if !torn.is_empty() {
            set_aside(path, &torn.iter().map(|(_, line, _)| *line).collect::<Vec<_>>()).map_err(failed)?;
            let numbers: Vec<String> = torn.iter().map(|(number, ..)| number.to_string()).collect();
            note(&format!(
                "{}: torn, and no row: line {}; set aside in {}, and what is missing is done anew",
                path.display(),
                numbers.join(", "),
                beside(path).display()
            ));
        }
        if whole != bytes {
            write_file(path, &whole)?;
            file = OpenOptions::new().read(true).write(true).open(path).map_err(failed)?;
        }
        file.seek(SeekFrom::End(0)).map_err(failed)?;
        Ok(Store { file, rows })
    }

    /// The row of a key, if it was made.
    pub(crate) fn get(&self, key: &Key) -> Option<&Row> {
        self.rows.get(key)
    }

    /// Whether no row of another map or method names the label image of this one.
    pub(crate) fn has_own_labels(&self, row: &Row) -> bool {
        let Made::Found(Found { labels, .. }) = &row.outcome else { return true };
        let what = |row: &Row| {
            let Key { dataset, map, method, parameters, .. } = row.key.clone();
            [dataset, map, method, parameters]
        };
        let is_same = |other: &Row| matches!(&other.outcome, Made::Found(found) if found.labels == *labels);
        !self.rows.values().any(|other| is_same(other) && what(other) != what(row))
    }

    /// Adds a row; when this returns it is on the disk.
    ///
    /// # Errors
    /// A disk that refuses.
    pub(crate) fn add(&mut self, row: Row) -> Outcome {
        let mut line = serde_json::to_string(&row).expect("a row is plain values");
        line.push('\n');
        let written = self.file.write_all(line.as_bytes()).and_then(|()| self.file.sync_data());
        written.map_err(|error| Failure::machine(format!("a row cannot be written: {error}")))?;
        self.rows.insert(row.key.clone(), row);
        Ok(())
    }
}

/// The parameters of a row by their names: those that are written by an alias, and a method's of another program as they are.
fn by_names(Key { method, parameters, .. }: &Key) -> String {
    let Ok(method) = methods::find(method) else { return parameters.clone() };
    let by_name = |one: &str| match one.split_once(' ') {
        Some((name, value)) => {
            let name = method.position(name).map_or(name, |at| method.params[at].name);
            format!("{name} {value}")
        }
        None => one.to_string(),
    };
    parameters.split(", ").map(by_name).collect::<Vec<_>>().join(", ")
}

/// Where torn lines of a file go: `rows.torn.jsonl` for `rows.jsonl`.
fn beside(path: &Path) -> PathBuf {
    path.with_extension("torn.jsonl")
}

/// Adds lines to the file beside.
fn set_aside(path: &Path, lines: &[&[u8]]) -> io::Result<()> {
    let mut file = OpenOptions::new().append(true).create(true).open(beside(path))?;
    for line in lines {
        file.write_all(line)?;
        file.write_all(if line.ends_with(b"\n") { b"" } else { b"\n" })?;
    }
    file.sync_all()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(map: &str) -> Row {
        let [dataset, label, method, version] = ["d", "l", "m", "v"].map(str::to_string);
        let key = Key { dataset, map: map.into(), label, method, parameters: String::new(), version, repeat: 1 };
        let outcome = Made::Refused("no camera".into());
        Row { key, machine: String::new(), date: String::new(), jobs: 1, size: [4, 3], valid_pixels: 12, outcome }
    }

    #[test]
    fn a_row_that_names_a_parameter_by_its_alias_is_that_of_its_name() {
        let folder = std::env::temp_dir().join(format!("depthplanes-alias-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        let path = folder.join("rows.jsonl");
        let of = |method: &str, parameters: &str| {
            let (method, parameters) = (method.to_string(), parameters.to_string());
            Row { key: Key { method, parameters, ..row("a").key }, ..row("a") }
        };
        let mut store = Store::open(&path).unwrap();
        store.add(of("ngaf", "theta 1, min 32")).unwrap();
        store.add(of("somebody's", "theta 1, min 32, of this kind")).unwrap();
        drop(store);
        let store = Store::open(&path).unwrap();
        assert!(store.get(&of("ngaf", "theta 1, min-pixels 32").key).is_some());
        assert!(store.get(&of("somebody's", "theta 1, min 32, of this kind").key).is_some());
        std::fs::remove_dir_all(&folder).unwrap();
    }

    #[test]
    fn rows_come_back_and_a_line_that_was_cut_off_is_set_aside() {
        let folder = std::env::temp_dir().join(format!("depthplanes-rows-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        let path = folder.join("rows.jsonl");
        let mut store = Store::open(&path).unwrap();
        store.add(row("a")).unwrap();
        store.add(row("b")).unwrap();
        drop(store);
        let whole = std::fs::read_to_string(&path).unwrap();
        std::fs::write(&path, &whole[..whole.len() - 5]).unwrap();
        let mut store = Store::open(&path).unwrap();
        assert_eq!(store.get(&row("a").key), Some(&row("a")));
        assert_eq!(store.get(&row("b").key), None);
        store.add(row("b")).unwrap();
        drop(store);
        assert_eq!(std::fs::read_to_string(&path).unwrap(), whole);
        let torn = std::fs::read_to_string(folder.join("rows.torn.jsonl")).unwrap();
        assert!(whole.contains(torn.trim_end()) && torn.ends_with('\n'), "{torn}");
        std::fs::write(&path, "not a row\n").unwrap();
        assert!(Store::open(&path).is_err());
        std::fs::remove_dir_all(&folder).unwrap();
    }
}
