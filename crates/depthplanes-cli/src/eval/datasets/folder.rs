//! What sets have in their folders: maps and label images by their names, and how they are read.

use super::dataset::{Item, Load, TruthOf};
use crate::failure::{Failure, Outcome};
use depthplanes::Intrinsics;
use depthplanes::noise::SensorNoise;
use depthplanes_io::formats::DecodeOptions;
use depthplanes_io::{Frame, ReadOptions, read_labels};
use depthplanes_video::natural;
use std::path::{Path, PathBuf};

/// The files of a folder for which `is_wanted` holds of the name, in natural order.
pub(super) fn files(folder: &Path, is_wanted: impl Fn(&str) -> bool) -> Outcome<Vec<PathBuf>> {
    let failed = |error| Failure::request(format!("{}: cannot be listed: {error}", folder.display()));
    let mut found = Vec::new();
    for entry in folder.read_dir().map_err(failed)? {
        let path = entry.map_err(failed)?.path();
        if is_wanted(&name_of(&path)) {
            found.push(path);
        }
    }
    found.sort_by(|a, b| natural::compare(&a.to_string_lossy(), &b.to_string_lossy()));
    Ok(found)
}

/// Maps in 1/5000 m beside their label images, by the endings of the two names, and all of one camera: fx, fy, cx, cy.
pub(super) fn beside_labels(
    dataset: &str,
    folder: &Path,
    [depth_ends, labels_end]: [&str; 2],
    [fx, fy, cx, cy]: [f64; 4],
) -> Outcome<Vec<Item>> {
    let camera = Intrinsics::new(fx, fy, cx, cy)?;
    let item = |depth: PathBuf| {
        let name = name_of(&depth).replace(depth_ends, "");
        let labels = needed(depth.with_file_name(format!("{name}{labels_end}")), &depth)?;
        let options = ReadOptions { intrinsics: Some(camera), ..options(Some("tum"), None) };
        Ok(Item {
            dataset: dataset.into(),
            name,
            frame: reading(depth, options),
            truth: Some(truth(labels, 1)),
            is_sequence: false,
        })
    };
    files(folder, |name| name.ends_with(depth_ends))?.into_iter().map(item).collect()
}

/// A path's last part; bytes that are no text are written as `\xff`, so that two names stay two.
pub(super) fn name_of(path: &Path) -> String {
    let name = path.file_name().unwrap_or_default().as_encoded_bytes();
    let chunk = |chunk: std::str::Utf8Chunk<'_>| {
        let rest: String = chunk.invalid().iter().map(|byte| format!("\\x{byte:02x}")).collect();
        format!("{}{rest}", chunk.valid())
    };
    name.utf8_chunks().map(chunk).collect()
}

/// A file that has to be there beside another.
pub(super) fn needed(path: PathBuf, beside: &Path) -> Outcome<PathBuf> {
    let lacks = || Failure::request(format!("{}: its truth {} is not there", beside.display(), path.display()));
    if path.is_file() { Ok(path) } else { Err(lacks()) }
}

/// Reads a map file so.
pub(in super::super) fn reading(path: PathBuf, options: ReadOptions) -> Load<Frame> {
    Box::new(move || Ok(depthplanes_io::read(&path, &options)?))
}

/// Reads a map in an encoding, of a sensor of that noise, if it is known.
pub(super) fn options(encoding: Option<&str>, noise: Option<SensorNoise>) -> ReadOptions {
    ReadOptions { encoding: encoding.map(str::to_string), noise, ..ReadOptions::default() }
}

/// A label image whose planes are `from` and up.
pub(super) fn truth(path: PathBuf, from: u16) -> Load<TruthOf> {
    Box::new(move || {
        let labels = read_labels(&path, &DecodeOptions::default())?;
        Ok(TruthOf { labels, from, planes: Vec::new(), partial: None })
    })
}
