//! Middlebury's stereo maps: those of the paper and others.

use super::dataset::{Dataset, Item};
use super::folder::{files, name_of, options, reading, truth};
use crate::failure::{Failure, Outcome};
use depthplanes_video::natural;
use std::path::{Path, PathBuf};

pub(super) const DATASET: Dataset = Dataset {
    name: "middlebury",
    about: "Middlebury stereo (Scharstein, Szeliski and others 2001 to 2006): true disparities, some with planes from them.",
    folder: "middlebury",
    layout: "a folder for each scene with its left map, disp2.*, disp1.*, disp3.* or disp0.*, and perhaps derived_planes_disp*.png",
    items,
};

/// Names of a scene's left map, the usual first.
const MAPS: [&str; 6] = ["disp2.png", "disp2.pgm", "disp1.png", "disp3.pgm", "disp0.pgm", "disp1.pgm"];

fn items(folder: &Path) -> Outcome<Vec<Item>> {
    let failed = |error| Failure::request(format!("{}: cannot be listed: {error}", folder.display()));
    let mut scenes: Vec<PathBuf> = folder.read_dir().map_err(failed)?.flatten().map(|entry| entry.path()).collect();
    scenes.sort_by(|a, b| natural::compare(&a.to_string_lossy(), &b.to_string_lossy()));
    let mut found = Vec::new();
    for scene in scenes.iter().filter(|path| path.is_dir()) {
        let derived =
            files(scene, |name| name.starts_with("derived_planes_") && name.ends_with(".png"))?.into_iter().next();
        // A scene with a truth has the map that it is of.
        let of_truth =
            derived.as_ref().map(|path| name_of(path).replace("derived_planes_", "").replace(".png", ".pgm"));
        let names = of_truth.iter().map(String::as_str).chain(MAPS);
        let Some(map) = names.map(|name| scene.join(name)).find(|path| path.is_file()) else { continue };
        let mut options = options(None, None);
        options.disparity = true;
        let (frame, truth) = (reading(map, options), derived.map(|path| truth(path, 1)));
        found.push(Item { dataset: DATASET.name.into(), name: name_of(scene), frame, truth, is_sequence: false });
    }
    Ok(found)
}
