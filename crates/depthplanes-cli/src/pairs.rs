//! Which prediction belongs to which truth: two files, or two folders whose files have the same names.

use crate::failure::{Failure, Outcome, note};
use crate::inputs::files_in;
use depthplanes_video::natural;
use std::collections::BTreeMap;
use std::ffi::OsString;
use std::path::{Path, PathBuf};

/// A truth and its prediction.
pub(crate) struct Pair {
    /// Its name in a table of several.
    pub(crate) name: String,
    pub(crate) truth: Truth,
    pub(crate) prediction: PathBuf,
}

/// Where the truth comes from.
pub(crate) enum Truth {
    File(PathBuf),
    /// A synthetic scene: what follows `scene:`.
    Scene(String),
}

impl Truth {
    /// Its name for people and records: as given.
    pub(crate) fn name(&self) -> String {
        match self {
            Truth::File(path) => path.display().to_string(),
            Truth::Scene(spec) => format!("scene:{spec}"),
        }
    }
}

/// The pair of two files, or all pairs of two folders in natural order.
///
/// # Errors
/// A folder and a file, a truth without a prediction, two files of one name.
pub(crate) fn pairs(truth: &OsString, prediction: &OsString) -> Outcome<Vec<Pair>> {
    let scene = truth.to_str().and_then(|word| word.strip_prefix("scene:"));
    let (truth, prediction) = (Path::new(truth), Path::new(prediction));
    match (scene.is_none() && truth.is_dir(), prediction.is_dir()) {
        (true, true) => of_folders(truth, prediction),
        (false, false) => {
            let source = scene.map_or_else(|| Truth::File(truth.into()), |spec| Truth::Scene(spec.into()));
            Ok(vec![Pair { name: source.name(), truth: source, prediction: prediction.into() }])
        }
        (truth_is_folder, _) => {
            let (folder, other) = if truth_is_folder { (truth, prediction) } else { (prediction, truth) };
            let (folder, other) = (folder.display(), other.display());
            Err(Failure::request(format!(
                "{folder}: this is a folder, but {other} is not; give two files or two folders"
            )))
        }
    }
}

fn of_folders(truth: &Path, prediction: &Path) -> Outcome<Vec<Pair>> {
    let (truths, mut predictions) = (label_images(truth)?, label_images(prediction)?);
    let mut pairs = Vec::new();
    for (name, path) in truths {
        let Some(prediction) = predictions.remove(&name) else {
            let wanted = prediction.join(format!("{name}.labels.png"));
            let message = format!("{}: no prediction for it; {} would be one", path.display(), wanted.display());
            return Err(Failure::request(message));
        };
        pairs.push(Pair { name, truth: Truth::File(path), prediction });
    }
    for path in predictions.values() {
        note(&format!("{}: no truth of this name; it is not scored", path.display()));
    }
    pairs.sort_by(|a, b| natural::compare(&a.name, &b.name));
    Ok(pairs)
}

/// The label images of a folder by name. Where some are named `*.labels.EXTENSION` only these are,
/// so that maps and pictures may lie beside them.
fn label_images(folder: &Path) -> Outcome<BTreeMap<String, PathBuf>> {
    let mut files = files_in(folder)?;
    let named = |path: &PathBuf| stem(path).ends_with(".labels");
    if files.iter().any(named) {
        files.retain(named);
    }
    let mut images = BTreeMap::new();
    for path in files {
        if let Some(other) = images.insert(name(&path), path.clone()) {
            let (path, other) = (path.display(), other.display());
            return Err(Failure::request(format!("{path}: it has the name of {other}; keep one of them")));
        }
    }
    if images.is_empty() {
        return Err(Failure::request(format!("{}: no label image in this folder", folder.display())));
    }
    Ok(images)
}

fn stem(path: &Path) -> String {
    path.file_stem().unwrap_or_default().to_string_lossy().into_owned()
}

/// `0001` for `0001.png`, `0001.labels.png` and what `detect` makes of `0001.depth.png`.
fn name(path: &Path) -> String {
    let stem = stem(path);
    let name = stem.strip_suffix(".labels").unwrap_or(&stem);
    name.strip_suffix(".depth").unwrap_or(name).to_string()
}
