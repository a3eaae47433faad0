//! Sets of maps to run methods over: one file each, and the table that names them.
//!
//! In: a folder. Out: [`Item`]s, each a map and, for most, its truth. A set says how its folder has to look; a folder that
//! does not is refused with what is missing.

mod evops;
mod kinect;
mod middlebury;
mod nyu_dpd;
mod real;
mod scenes;
mod segcomp_abw;
mod sr4000;
mod synpeb;
mod video;

use crate::failure::{Failure, Outcome};
use crate::natural;
use depthplanes::Intrinsics;
use depthplanes::noise::SensorNoise;
use depthplanes_io::formats::DecodeOptions;
use depthplanes_io::{Frame, LabelImage, ReadOptions, read_labels};
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

/// One row of [`DATASETS`].
pub(crate) struct Dataset {
    /// Its name on the command line.
    pub(crate) name: &'static str,
    /// One sentence: what it is, and where it is had.
    pub(crate) about: &'static str,
    /// Its usual folder within a folder of sets.
    pub(crate) folder: &'static str,
    /// How its folder has to look.
    pub(crate) layout: &'static str,
    /// Its maps.
    pub(crate) items: fn(&Path) -> Outcome<Vec<Item>>,
}

/// Loads something when it is needed.
type Load<T> = Box<dyn Fn() -> Outcome<T> + Send + Sync>;

/// A map of a set.
pub(crate) struct Item {
    /// The set's name.
    pub(crate) dataset: String,
    /// The map's name within it.
    pub(crate) name: String,
    pub(crate) frame: Load<Frame>,
    pub(crate) truth: Option<Load<TruthOf>>,
    /// Whether the maps of its set are frames of one recording in their order.
    pub(crate) is_sequence: bool,
}

/// The truth of a map.
pub(crate) struct TruthOf {
    pub(crate) labels: LabelImage,
    /// The lowest label that is a plane; lower ones are noise.
    pub(crate) from: u16,
    /// Where the planes are in space, if that is known.
    pub(crate) planes: Vec<depthplanes::scene::TruthPlane>,
    /// Where only some surfaces are labelled: groups of labels that are one plane. Measures that take what is not
    /// labelled for "no plane" make no sense then.
    pub(crate) partial: Option<Vec<Vec<u16>>>,
}

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
        Failure::request(format!("unknown set `{name}`; there are {}, and scene:SPEC for made-up scenes", names()))
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

/// The files of a folder for which `is_wanted` holds of the name, in natural order.
fn files(folder: &Path, is_wanted: impl Fn(&str) -> bool) -> Outcome<Vec<PathBuf>> {
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
fn beside_labels(
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

/// A path's last part.
fn name_of(path: &Path) -> String {
    path.file_name().unwrap_or_default().to_string_lossy().into_owned()
}

/// A file that has to be there beside another.
fn needed(path: PathBuf, beside: &Path) -> Outcome<PathBuf> {
    let lacks = || Failure::request(format!("{}: its truth {} is not there", beside.display(), path.display()));
    if path.is_file() { Ok(path) } else { Err(lacks()) }
}

/// Reads a map file so.
pub(super) fn reading(path: PathBuf, options: ReadOptions) -> Load<Frame> {
    Box::new(move || Ok(depthplanes_io::read(&path, &options)?))
}

/// Reads a map in an encoding, of a sensor of that noise, if it is known.
fn options(encoding: Option<&str>, noise: Option<SensorNoise>) -> ReadOptions {
    ReadOptions { encoding: encoding.map(str::to_string), noise, ..ReadOptions::default() }
}

/// A label image whose planes are `from` and up.
fn truth(path: PathBuf, from: u16) -> Load<TruthOf> {
    Box::new(move || {
        let labels = read_labels(&path, &DecodeOptions::default())?;
        Ok(TruthOf { labels, from, planes: Vec::new(), partial: None })
    })
}
