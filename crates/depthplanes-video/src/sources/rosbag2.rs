//! rosbag2: a folder with `metadata.yaml` and MCAP files, in the order that it lists; or MCAP files alone, which a recorder leaves
//! that was killed.

use super::files::{names_in, text};
use super::mcap::{Recording, is_mcap};
use crate::error::{Error, Result};
use crate::source::{SourceInfo, SourceOptions};
use crate::word::path_and_topic;
use std::path::{Path, PathBuf};

pub(super) const ROSBAG2: SourceInfo = SourceInfo {
    name: "rosbag2",
    about: "a folder of rosbag2 with MCAP files; FOLDER:/topic if it has several depth topics",
    is: |word| is_bag(path_and_topic(word).0),
    open: |word, options| {
        let (folder, topic) = path_and_topic(word);
        open(folder, topic, options)
    },
};

/// A bag in SQLite, which is no recording that is read here.
fn is_sqlite(path: &Path) -> bool {
    path.file_name().is_some_and(|name| name.to_string_lossy().contains(".db3"))
}

fn is_bag(path: &Path) -> bool {
    let of_bag = |name: &String| is_mcap(Path::new(name)) || is_sqlite(Path::new(name));
    path.is_file() && is_sqlite(path)
        || path.is_dir()
            && (is_metadata(&path.join(METADATA)) || names_in(path).is_ok_and(|names| names.iter().any(of_bag)))
}

const METADATA: &str = "metadata.yaml";

fn is_metadata(path: &Path) -> bool {
    text(path).is_ok_and(|text| text.contains("rosbag2_bagfile_information"))
}

fn open(folder: &Path, topic: Option<&str>, options: &SourceOptions) -> Result<Box<dyn crate::source::Source>> {
    let listed = folder.join(METADATA);
    let files = if is_metadata(&listed) { files_of(folder, &text(&listed)?) } else { None };
    let files = match files {
        Some(files) => files,
        None if folder.is_file() => vec![folder.into()],
        None => names_in(folder)?
            .into_iter()
            .filter(|name| !name.ends_with(".yaml"))
            .map(|name| folder.join(name))
            .collect(),
    };
    let files: Vec<PathBuf> = files.into_iter().filter(|file| is_mcap(file) || is_sqlite(file)).collect();
    if files.iter().any(|file| is_sqlite(file)) {
        return Err(Error::source(folder.display(), "a bag in SQLite", to_convert(folder)));
    }
    let gone = files.iter().find(|file| !file.is_file());
    if let Some(gone) = gone {
        let wrong = format!("there is no file {}", gone.display());
        return Err(Error::source(listed.display(), wrong, "the files of the bag beside their list"));
    }
    if files.is_empty() {
        return Err(Error::source(listed.display(), "no MCAP file in it", "files under relative_file_paths"));
    }
    Ok(Box::new(Recording::open(files, topic, options)?))
}

/// The files of a bag in order; none if the text does not list any.
fn files_of(folder: &Path, metadata: &str) -> Option<Vec<PathBuf>> {
    let mut lines = metadata.lines().map(str::trim).skip_while(|line| *line != "relative_file_paths:");
    lines.next()?;
    let names = lines.map_while(|line| line.strip_prefix("- "));
    let names: Vec<PathBuf> = names.map(|name| PathBuf::from(name.trim().trim_matches(['"', '\'']))).collect();
    // Old bags name their folder as well, and nothing outside of it is read.
    let file = |name: &PathBuf| folder.join(name.file_name().unwrap_or_default());
    (!names.is_empty()).then(|| names.iter().map(file).collect())
}

/// What makes an MCAP bag of another one.
fn to_convert(bag: &Path) -> String {
    let bag = bag.display().to_string();
    let out = format!("{}_mcap", bag.trim_end_matches(['/', '\\']).trim_end_matches(".db3"));
    format!(
        "MCAP; type printf 'output_bags: [{{uri: {out}, storage_id: mcap, all: true}}]' > mcap.yaml && ros2 bag convert -i {bag} -o \
         mcap.yaml"
    )
}
