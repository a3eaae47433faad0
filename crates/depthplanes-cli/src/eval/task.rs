//! One map by one method: found, timed, scored, its labels written.

use super::datasets::{Item, TruthOf};
use super::machine;
use super::peers::Peer;
use super::rows::{Found, Key, Made, Row, Store};
use crate::checksum::fnv;
use crate::failure::{Failure, Outcome};
use crate::run::{Recipe, Runner};
use depthplanes::Detection;
use depthplanes::metrics::{Contingency, Tolerance, evops, partial, plane_errors, segcomp};
use depthplanes_io::Frame;
use depthplanes_io::measures::{MEASURES, Scores, of_surfaces};
use depthplanes_io::outputs::{Spread, grey16_png, write_file};
use std::collections::BTreeMap;
use std::path::Path;

/// Folder of the label images within the report's.
pub(super) const LABELS: &str = "labels";

/// A map and a method.
pub(super) struct Task<'a> {
    pub(super) item: &'a Item,
    pub(super) maker: Maker<'a>,
    pub(super) key: Key,
}

/// Who finds the planes.
pub(super) enum Maker<'a> {
    Recipe(&'a Recipe),
    Peer(&'a Peer),
}

impl Maker<'_> {
    /// What it finds and how long it takes, or why it refuses.
    ///
    /// # Errors
    /// A peer that does not work.
    fn detect(&self, frame: &Frame, repeat: usize) -> Outcome<Result<(Detection, Spread), String>> {
        match self {
            Maker::Recipe(recipe) => {
                let found = Runner::new(recipe).detect(frame, repeat);
                Ok(found
                    .map(|found| (found.detection, found.times.unwrap_or_default().total))
                    .map_err(|f| f.to_string()))
            }
            Maker::Peer(peer) => peer.detect(frame, repeat),
        }
    }
}

/// SegComp tolerances of the curve.
const TOLERANCES: [f64; 10] = [0.51, 0.55, 0.6, 0.65, 0.7, 0.75, 0.8, 0.85, 0.9, 0.95];

impl Task<'_> {
    /// Whether its row is there, and its labels are and no other's.
    pub(super) fn is_done(&self, store: &Store, folder: &Path) -> bool {
        store.get(&self.key).is_some_and(|row| match &row.outcome {
            Made::Found(found) => folder.join(&found.labels).is_file() && store.has_own_labels(row),
            Made::Refused(_) => true,
        })
    }

    /// Its row.
    ///
    /// # Errors
    /// A map or a truth that cannot be read, a disk that refuses, a peer that does not work; not what the method itself
    /// refuses.
    pub(super) fn run(&self, folder: &Path, machine: &str, jobs: usize) -> Outcome<Row> {
        let frame = (self.item.frame)().map_err(|failure| failure.of_input(&self.item.name))?;
        let valid_pixels = valid_pixels(&frame)?;
        let found = self.maker.detect(&frame, self.key.repeat).map_err(|failure| failure.of_input(&self.item.name))?;
        let outcome = match found {
            Ok((detection, times)) => {
                let labels = self.labels_file();
                write_file(&folder.join(&labels), &grey16_png(frame.width, frame.height, &detection.labels))?;
                let mut made = Found {
                    planes: detection.planes.len(),
                    labelled_pixels: detection.labels.iter().filter(|&&label| label > 0).count(),
                    median_ms: times.median,
                    least_ms: times.min,
                    labels,
                    scores: BTreeMap::new(),
                    correct_at: Vec::new(),
                    normal_error_deg: None,
                };
                if let Some(truth) = &self.item.truth {
                    score(&truth()?, &detection, &mut made).map_err(|failure| failure.of_input(&self.item.name))?;
                }
                Made::Found(made)
            }
            Err(why) => Made::Refused(why),
        };
        let size = [frame.width, frame.height];
        let (key, machine, date) = (self.key.clone(), machine.to_string(), machine::today());
        Ok(Row { key, machine, date, jobs, size, valid_pixels, outcome })
    }

    /// Within the report's folder.
    fn labels_file(&self) -> String {
        format!("{LABELS}/{}", labels_name(&self.key))
    }
}

/// Names longer than this are cut; file systems take 255 bytes.
const LONGEST: usize = 120;

/// The name of the label image of a key, which no other key has: what is not lower-case ASCII is replaced, and a
/// checksum of the whole tells names apart that are alike then, also where capitals are not told apart.
fn labels_name(key: &Key) -> String {
    let Key { dataset, map, method, parameters, .. } = key;
    let is_plain = |c: char| matches!(c, 'a'..='z' | '0'..='9' | '-' | '_' | '.');
    let whole = format!("{dataset}.{map}.{method}");
    let mut name: String =
        whole.chars().take(LONGEST).map(|c| if is_plain(c) || c.is_ascii_uppercase() { c } else { '_' }).collect();
    // Dots part the name; the map may have some of its own.
    if name != whole || !whole.chars().all(is_plain) || dataset.contains('.') || method.contains('.') {
        name += &format!(".{:016x}", fnv(format!("{dataset}\n{map}\n{method}")));
    }
    format!("{name}.{:08x}.png", fnv(parameters) as u32)
}

fn valid_pixels(frame: &Frame) -> Outcome<usize> {
    Ok(depthplanes::with_view!(frame.view()?, view => view.valid_pixels()))
}

/// Adds what the measures say.
fn score(truth: &TruthOf, detection: &Detection, made: &mut Found) -> Outcome {
    let (size, own) = ([truth.labels.width, truth.labels.height], [detection.width, detection.height]);
    if size != own {
        return Err(Failure::request(format!(
            "the truth is {} x {}, the map {} x {}",
            size[0], size[1], own[0], own[1]
        )));
    }
    let table = Contingency::new(&truth.labels.labels, &detection.labels)?.truth_from(truth.from);
    if let Some(coplanar) = &truth.partial {
        made.scores = of_surfaces(&partial(&table, coplanar));
        return Ok(());
    }
    let scores = Scores::of(&table, Tolerance::default());
    let value = |measure: &depthplanes_io::measures::Measure| {
        Some((format!("{}.{}", measure.family, measure.name), measure.value(&scores)?))
    };
    made.scores = MEASURES.iter().filter_map(value).collect();
    let correct = |tolerance| Ok((tolerance, segcomp(&table, Tolerance::new(tolerance)?).correct.len()));
    made.correct_at = TOLERANCES.iter().map(|&tolerance| correct(tolerance)).collect::<Outcome<_>>()?;
    made.normal_error_deg = normal_error(truth, detection, &table);
    Ok(())
}

/// Median angle between the normals of matched planes, degrees; none without a match or without planes in space.
fn normal_error(truth: &TruthOf, detection: &Detection, table: &Contingency) -> Option<f64> {
    let known = |label: u16| truth.planes.iter().find(|plane| plane.label == label).map(|plane| plane.plane);
    let found = |label: u16| detection.planes.get(usize::from(label) - 1)?.metric.map(|metric| metric.plane);
    let mut errors: Vec<f64> =
        plane_errors(&evops(table).matched, known, found).iter().map(|(_, error)| error.normal_deg).collect();
    errors.sort_by(f64::total_cmp);
    errors.get(errors.len() / 2).copied()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn key(dataset: &str, map: &str) -> Key {
        let [method, parameters, version] = ["planar", "min-pixels 100", "v"].map(str::to_string);
        Key { dataset: dataset.into(), map: map.into(), label: method.clone(), method, parameters, version, repeat: 1 }
    }

    #[test]
    fn every_map_has_a_label_file_of_its_own_and_plain_names_are_as_they_are() {
        assert_eq!(labels_name(&key("scenes", "room-1.a_b")), "scenes.room-1.a_b.planar.9e2b4020.png");
        let long = "x".repeat(240);
        let other = format!("{long}y");
        let maps =
            ["x<depth", "x>depth", "x_depth", "X_depth", "x_Depth", "x depth", "xä", "xö", "\\xff", &long, &other];
        let mut names: Vec<String> = maps.iter().map(|map| labels_name(&key("kinect", map)).to_lowercase()).collect();
        names.push(labels_name(&key("kinect.x", "y")));
        names.push(labels_name(&key("kinect", "x.y")));
        assert!(names.iter().all(|name| name.len() < 200 && name.is_ascii()), "{names:?}");
        names.sort();
        names.dedup();
        assert_eq!(names.len(), maps.len() + 2, "{names:?}");
    }
}
