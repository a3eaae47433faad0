//! Sets of maps to run methods over: one file each, and the table that names them.
//!
//! In: a folder. Out: [`Item`]s, each a map and, for most, its truth. A set says how its folder has to look; a folder that
//! does not is refused with what is missing.

mod dataset;
mod evops;
mod folder;
mod kinect;
mod middlebury;
mod nyu_dpd;
mod real;
mod scenes;
mod segcomp_abw;
mod sr4000;
mod synpeb;
mod video;

pub(crate) use dataset::{Dataset, Item, TruthOf};
pub(super) use folder::reading;

use crate::failure::{Failure, Outcome};
use std::path::{Path, PathBuf};

/// All sets.
pub(crate) const DATASETS: &[Dataset] = &[
    real::DATASET,
    real::WITH_PRESETS,
    middlebury::DATASET,
    kinect::DATASET,
    segcomp_abw::DATASET,
    nyu_dpd::DATASET,
    synpeb::DATASET,
    sr4000::DATASET,
    evops::DATASET,
    video::SEVEN_SCENES,
    video::TSDF,
];

/// A word that names a set: `NAME` within the folder of sets, `NAME=DIR`, or `scene:SPEC`.
///
/// # Errors
/// An unknown set, a folder that is not there or lacks something.
pub(crate) fn find(word: &str, data: Option<&Path>) -> Outcome<Vec<Item>> {
    if let Some(spec) = word.strip_prefix("scene:") {
        return scenes::items(spec);
    }
    let (name, folder) =
        word.split_once('=').map_or((word, None), |(name, folder)| (name, Some(PathBuf::from(folder))));
    let names = || DATASETS.iter().map(|dataset| dataset.name).collect::<Vec<_>>().join(", ");
    let dataset = DATASETS.iter().find(|dataset| dataset.name == name).ok_or_else(|| {
        Failure::request(format!("unknown set `{name}`; there are {}, and scene:SPEC for synthetic scenes", names()))
    })?;
    let folder = match (folder, data) {
        (Some(folder), _) => folder,
        (None, Some(data)) => data.join(dataset.folder),
        (None, None) => {
            let message =
                format!("{name}: where is it? Give {name}=DIR, or --data DIR with a folder `{}` in it", dataset.folder);
            return Err(Failure::request(message));
        }
    };
    let lacks =
        |what: &str| Failure::request(format!("{name}: {}: {what}; it needs {}", folder.display(), dataset.layout));
    if !folder.is_dir() {
        return Err(lacks("no such folder"));
    }
    let items = (dataset.items)(&folder)?;
    if items.is_empty() { Err(lacks("no map of this set is in it")) } else { Ok(items) }
}
