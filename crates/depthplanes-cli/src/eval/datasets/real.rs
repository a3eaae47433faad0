//! Frames of real depth cameras with surfaces labelled by hand, each with its own camera and sensor; truths are partial.
//!
//! A frame's JSON file states how it is read, in the flags of `detect`, and its sensor's preset. `real` reads it by the
//! flags alone, as somebody does who knows the camera and nothing of the noise; `real-presets` adds the preset.

use super::dataset::{Dataset, Item, Load, TruthOf};
use super::folder::{files, name_of, needed, reading};
use crate::args::Reading;
use crate::failure::{Failure, Outcome};
use crate::load;
use depthplanes_io::formats::DecodeOptions;
use depthplanes_io::{ReadOptions, read_labels};
use serde::Deserialize;
use std::path::{Path, PathBuf};

const FOLDER: &str = "gt_real";
const LAYOUT: &str = "NAME.depth.png, NAME.labels.png (16 bit, 0 = not labelled, 65535 = not planar) and NAME.json: flags of \
                      detect, preset, coplanar (lists of labels that are one plane)";

pub(super) const DATASET: Dataset = Dataset {
    name: "real",
    about: "Frames of real cameras (Kinect v1 and v2, Xtion, RealSense, stereo), some surfaces labelled by hand.",
    folder: FOLDER,
    layout: LAYOUT,
    items: |folder| items(folder, DATASET.name, false),
};

pub(super) const WITH_PRESETS: Dataset = Dataset {
    name: "real-presets",
    about: "The same frames, each with its sensor's preset.",
    folder: FOLDER,
    layout: LAYOUT,
    items: |folder| items(folder, WITH_PRESETS.name, true),
};

/// What a frame's JSON file says that is used; it says more for people.
#[derive(Deserialize)]
struct About {
    /// How the map is read, as words of the command line.
    flags: Vec<String>,
    /// Its sensor's preset.
    preset: String,
    /// Labels that are one plane.
    coplanar: Vec<Vec<u16>>,
}

fn items(folder: &Path, dataset: &str, with_preset: bool) -> Outcome<Vec<Item>> {
    let item = |depth: PathBuf| {
        let name = name_of(&depth).replace(".depth.png", "");
        let labels = needed(depth.with_file_name(format!("{name}.labels.png")), &depth)?;
        let about = depth.with_file_name(format!("{name}.json"));
        let told = read_about(&about)?;
        let mut options = options(&told, folder).map_err(|failure| failure.of_input(&about.display().to_string()))?;
        options.preset = with_preset.then_some(told.preset);
        let frame = reading(depth, options);
        Ok(Item { dataset: dataset.into(), name, frame, truth: Some(truth(labels, told.coplanar)), is_sequence: false })
    };
    files(folder, |name| name.ends_with(".depth.png"))?.into_iter().map(item).collect()
}

fn read_about(path: &Path) -> Outcome<About> {
    let name = path.display();
    let text =
        std::fs::read_to_string(path).map_err(|error| Failure::request(format!("{name}: cannot be read: {error}")))?;
    let accepted = "it needs flags (words), preset (a word) and coplanar (lists of labels)";
    serde_json::from_str(&text).map_err(|error| Failure::request(format!("{name}: {error}; {accepted}")))
}

/// How the frame is read; a camera file is looked for beside it.
fn options(about: &About, folder: &Path) -> Outcome<ReadOptions> {
    let mut reading = Reading::from_words(&about.flags).map_err(Failure::request)?;
    reading.camera = reading.camera.map(|camera| folder.join(camera));
    load::options(&reading)
}

fn truth(path: PathBuf, coplanar: Vec<Vec<u16>>) -> Load<TruthOf> {
    Box::new(move || {
        let labels = read_labels(&path, &DecodeOptions::default())?;
        Ok(TruthOf { labels, from: 1, planes: Vec::new(), partial: Some(coplanar.clone()) })
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use depthplanes::ValueKind;
    use depthplanes_io::outputs::grey16_png;

    /// A folder with one frame and its JSON file.
    fn folder(name: &str, json: &str) -> PathBuf {
        let folder = std::env::temp_dir().join(format!("depthplanes-real-{name}-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        std::fs::write(folder.join("a.depth.png"), grey16_png(2, 1, &[5000, 7000])).unwrap();
        std::fs::write(folder.join("a.labels.png"), grey16_png(2, 1, &[1, 65535])).unwrap();
        std::fs::write(folder.join("a.json"), json).unwrap();
        folder
    }

    #[test]
    fn a_frame_is_read_by_its_own_flags_and_by_its_preset_if_that_is_asked_for() {
        let json = r#"{"flags": ["--intrinsics=500,501,1,0.5", "--scale", "1000", "--missing", "7000"],
                       "preset": "kinect1", "coplanar": [[1, 2]], "sensor": "a camera", "unsure": []}"#;
        let folder = folder("flags", json);
        let read = |with_preset| {
            let items = items(&folder, "real", with_preset).unwrap();
            assert_eq!(items.len(), 1);
            let frame = (items[0].frame)().unwrap();
            assert_eq!(frame.sensor.value_kind, ValueKind::Depth { metres: 0.001 });
            assert_eq!((frame.sensor.intrinsics.unwrap().fy, frame.missing), (501.0, Some(7000.0)));
            assert_eq!((items[0].truth.as_ref().unwrap())().unwrap().partial, Some(vec![vec![1, 2]]));
            frame.sensor.smooth_noise.is_some()
        };
        assert_eq!((read(false), read(true)), (false, true));
        std::fs::remove_dir_all(folder).unwrap();
    }

    #[test]
    fn flags_that_nobody_knows_and_other_json_are_refused() {
        let refused = |name: &str, json: &str| {
            let folder = folder(name, json);
            let message = items(&folder, "real", false).err().expect("it is wrong").to_string();
            std::fs::remove_dir_all(folder).unwrap();
            message
        };
        let message = refused("unknown", r#"{"flags": ["--nothing", "3"], "preset": "kinect1", "coplanar": []}"#);
        assert!(message.contains("a.json: ") && message.contains("'--nothing'"), "{message}");
        let message = refused("word", r#"{"flags": ["map.png"], "preset": "kinect1", "coplanar": []}"#);
        assert!(message.contains("'map.png'"), "{message}");
        let message = refused("value", r#"{"flags": ["--scale", "much"], "preset": "kinect1", "coplanar": []}"#);
        assert!(message.contains("`much` is not a number"), "{message}");
        let message = refused("lacks", r#"{"flags": []}"#);
        assert!(message.contains("it needs flags"), "{message}");
    }
}
