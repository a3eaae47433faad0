//! What a method made of a map, as a line of JSON; and the file of such lines that an interrupted evaluation goes on from.

use crate::failure::{Failure, Outcome};
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, HashMap};
use std::fs::{File, OpenOptions};
use std::io::{Read, Seek, SeekFrom, Write};
use std::path::Path;

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
    /// Opens the file, or begins one. A last line that is cut off, as by an interruption, goes.
    ///
    /// # Errors
    /// A file that cannot be read or written, or that holds something else.
    pub(crate) fn open(path: &Path) -> Outcome<Self> {
        let failed = |error| Failure::machine(format!("{}: {error}", path.display()));
        let mut file =
            OpenOptions::new().read(true).write(true).create(true).truncate(false).open(path).map_err(failed)?;
        let mut text = String::new();
        file.read_to_string(&mut text).map_err(failed)?;
        let whole = text.rfind('\n').map_or(0, |end| end + 1);
        let mut rows = HashMap::new();
        for (number, line) in text[..whole].lines().enumerate() {
            let row: Row = serde_json::from_str(line).map_err(|error| {
                let message = "is no row of an evaluation; take another folder, or move the file away";
                Failure::request(format!("{}: line {}: {message} ({error})", path.display(), number + 1))
            })?;
            rows.insert(row.key.clone(), row);
        }
        file.set_len(whole as u64).map_err(failed)?;
        file.seek(SeekFrom::End(0)).map_err(failed)?;
        Ok(Store { file, rows })
    }

    /// The row of a key, if it was made.
    pub(crate) fn get(&self, key: &Key) -> Option<&Row> {
        self.rows.get(key)
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
    fn rows_come_back_and_a_line_that_was_cut_off_goes() {
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
        std::fs::write(&path, "not a row\n").unwrap();
        assert!(Store::open(&path).is_err());
        std::fs::remove_dir_all(&folder).unwrap();
    }
}
