//! The paper's maps: where each file is, how it is read, and the synthetic map that stands in for it.

use super::super::datasets::{Item, reading};
use super::super::report::Section;
use super::super::report::table::Table;
use crate::failure::{Failure, Outcome};
use crate::load;
use depthplanes_io::ReadOptions;
use std::path::{Path, PathBuf};

pub(super) const MIDDLEBURY: &str = "Middlebury";
pub(super) const KINECT: &str = "Kinect";

/// A map of the paper.
pub(super) struct Map {
    pub(super) set: &'static str,
    pub(super) name: &'static str,
    /// Within the folder of maps.
    file: &'static str,
    /// The camera that depth is of; none for disparity.
    preset: Option<&'static str>,
    /// What stands in for it.
    scene: &'static str,
}

const fn disparity(name: &'static str, file: &'static str, scene: &'static str) -> Map {
    Map { set: MIDDLEBURY, name, file, preset: None, scene }
}

const fn depth(name: &'static str, file: &'static str, preset: &'static str, scene: &'static str) -> Map {
    Map { set: KINECT, name, file, preset: Some(preset), scene }
}

/// All maps. The paper's own Kinect frames are not public; these are others.
#[rustfmt::skip]
const MAPS: [Map; 11] = [
    disparity("Sawtooth", "middlebury/sawtooth/disp2.pgm", "planes3:sensor=disparity,size=434x380"),
    disparity("Venus", "middlebury/venus/disp2.pgm", "stairs:sensor=disparity,size=434x383"),
    disparity("Cones", "middlebury/cones/disp2.png", "curved:sensor=disparity,size=450x375"),
    disparity("Teddy", "middlebury/teddy/disp2.png", "random:seed=3,sensor=disparity,size=450x375"),
    disparity("Books", "middlebury/Books/disp1.png", "boxes:sensor=disparity,size=463x370"),
    depth("CAPE", "kinect_v1/cape_depth_0.png", "kinect1", "corridor:sensor=kinect_white"),
    depth("Tutorial 1", "kinect_v1/gx_partIII_data_depth1.png", "kinect1", "room:seed=1,sensor=kinect_white"),
    depth("Tutorial 2", "kinect_v1/gx_partIII_data_depth2.png", "kinect1", "room:seed=2,sensor=kinect_white"),
    depth("TUM fr3", "tum/deplex_fr3_1341848230.910894.png", "tum-fr3", "boxes:sensor=kinect_white"),
    depth("7-Scenes 0", "video_7scenes/frame-000000.depth.png", "7-scenes", "random:seed=1,sensor=kinect_white"),
    depth("TSDF 150", "video_tsdf_fusion/frame-000150.depth.png", "kinect1", "random:seed=2,sensor=kinect_white"),
];

/// Where a map comes from.
pub(super) struct Source {
    pub(super) map: &'static Map,
    /// None if it is synthetic.
    pub(super) file: Option<PathBuf>,
}

impl Source {
    fn name(&self) -> String {
        let synthetic = if self.file.is_none() { " (synthetic)" } else { "" };
        format!("{}{synthetic}", self.map.name)
    }

    fn item(&self) -> Item {
        let Map { set, preset, scene, .. } = *self.map;
        let frame = match &self.file {
            Some(file) => {
                let (preset, disparity) = (preset.map(str::to_string), preset.is_none());
                reading(file.clone(), ReadOptions { preset, disparity, ..ReadOptions::default() })
            }
            None => Box::new(move || load::scene(scene)),
        };
        Item { dataset: set.into(), name: self.name(), frame, truth: None, is_sequence: false }
    }
}

/// The folder of maps: as given, or `shared/data` beside the checkout of this project that the working folder is in.
///
/// # Errors
/// A folder that is not there.
pub(super) fn folder(given: Option<&Path>) -> Outcome<Option<PathBuf>> {
    match given {
        Some(folder) if folder.is_dir() => Ok(Some(folder.into())),
        Some(folder) => {
            let message =
                "no such folder; give one that holds the paper's maps, or an empty one for synthetic maps alone";
            Err(Failure::request(format!("--data {}: {message}", folder.display())))
        }
        None => {
            let here = std::env::current_dir().unwrap_or_default();
            let checkout = here.ancestors().find(|folder| folder.join("crates/depthplanes/Cargo.toml").is_file());
            let beside = checkout.and_then(Path::parent).map(|parent| parent.join("shared/data"));
            Ok(beside.filter(|data| data.is_dir()))
        }
    }
}

/// Where each map comes from.
pub(super) fn sources(data: Option<&Path>) -> Vec<Source> {
    let file = |map: &Map| data.map(|data| data.join(map.file)).filter(|file| file.is_file());
    MAPS.iter().map(|map| Source { map, file: file(map) }).collect()
}

/// The maps of a set.
pub(super) fn items(sources: &[Source], set: &str) -> Vec<Item> {
    sources.iter().filter(|source| source.map.set == set).map(Source::item).collect()
}

/// Which maps were used.
pub(super) fn section(sources: &[Source]) -> Section {
    let title = "Maps";
    let synthetic = sources.iter().filter(|source| source.file.is_none()).count();
    let which = match synthetic {
        0 => String::new(),
        all if all == sources.len() => "\n\nAll maps here are synthetic: none of the files is at hand.".into(),
        some => format!("\n\n{some} of the files are not at hand; synthetic maps stand in for them."),
    };
    let text = format!(
        "The paper's five maps of Middlebury are true disparities, of the left view, in grey levels; theta is 1 there and \
         nothing is filled (sections 3b, 3c). Its own frames of a Kinect are not public; these are others, in the units \
         of their files, with theta 2 and gaps filled by a window of 5. A plane has more than min-pixels pixels; \
         the paper calls it min and takes 32, 64, 128 or 256 (section 3d). All methods get the same min and have their \
         defaults otherwise. The other methods know a Kinect's nominal camera and noise for recorded frames, the camera \
         alone for synthetic ones.{which}"
    );
    let line = |source: &Source| {
        let Map { set, file, scene, .. } = source.map;
        let stand_in = if source.file.is_some() { "-".into() } else { format!("scene:{scene}") };
        vec![source.name(), set.to_string(), file.to_string(), stand_in]
    };
    let head = ["map", "set", "file", "stand-in"].map(str::to_string).to_vec();
    let table = Table { title: title.into(), head, rows: sources.iter().map(line).collect() };
    Section { title: title.into(), text, tables: vec![table], ..Section::default() }
}
