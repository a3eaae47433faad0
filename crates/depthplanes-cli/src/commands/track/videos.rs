//! What the words stand for: videos, and the names of their folders of results.

use crate::failure::{Failure, Outcome};
use crate::inputs::{file_name_of, shortened};
use crate::manifest::Named;
use depthplanes_video::{natural, path_and_topic};
use std::path::{Component, Path, PathBuf};

/// One of several videos.
#[derive(Debug)]
pub(super) struct Source {
    /// As it is opened.
    pub(super) word: String,
    /// Its folder among the results: what it is called, below the folders that a pattern left open.
    pub(super) folder: PathBuf,
}

impl Named for Source {
    fn name(&self) -> String {
        self.word.clone()
    }

    fn path(&self) -> Option<&Path> {
        Some(path_and_topic(&self.word).0)
    }
}

/// All videos that the words stand for, in the order given; patterns in natural order.
///
/// # Errors
/// A pattern without a match, standard input, two videos with the same folder of results.
pub(super) fn expand(words: &[String]) -> Outcome<Vec<Source>> {
    let mut videos = Vec::new();
    for word in words {
        if word == "-" {
            let message =
                "-: standard input has no name for a folder of results; give it alone, with --out instead of --out-dir";
            return Err(Failure::request(message));
        }
        let is_pattern = word.contains(['*', '?', '[']) && !word.starts_with("scene:");
        if is_pattern && !path_and_topic(word).0.exists() {
            videos.extend(matching(word)?);
        } else {
            videos.push(Source { folder: folder_of(word, Path::new("")), word: word.clone() });
        }
    }
    refuse_same(&videos)?;
    Ok(videos)
}

/// What a pattern matches, with the same topic as it has.
fn matching(word: &str) -> Outcome<Vec<Source>> {
    let (pattern, topic) = path_and_topic(word);
    let topic = topic.map_or(String::new(), |topic| format!(":{topic}"));
    let wrong = |error: glob::PatternError| Failure::request(format!("{word}: not a pattern: {error}"));
    let mut found: Vec<PathBuf> = glob::glob(&pattern.to_string_lossy()).map_err(wrong)?.flatten().collect();
    found.retain(|path| !path.file_name().is_some_and(|name| name.to_string_lossy().starts_with('.')));
    if found.is_empty() {
        return Err(Failure::request(format!("{word}: no file or folder matches this pattern")));
    }
    found.sort_by(|a, b| natural::compare(&a.to_string_lossy(), &b.to_string_lossy()));
    let is_plain = |part: &Component<'_>| !part.as_os_str().to_string_lossy().contains(['*', '?', '[']);
    let fixed: PathBuf = pattern.components().take_while(is_plain).collect();
    let video = |path: PathBuf| {
        let text =
            path.to_str().ok_or_else(|| Failure::request(format!("{}: the name is no UTF-8", path.display())))?;
        let below = path.strip_prefix(&fixed).ok().and_then(Path::parent).unwrap_or(Path::new("")).to_path_buf();
        let word = format!("{text}{topic}");
        Ok(Source { folder: folder_of(&word, &below), word })
    };
    found.into_iter().map(video).collect()
}

/// The folder of a video's results.
fn folder_of(word: &str, below: &Path) -> PathBuf {
    if word.starts_with("scene:") {
        return shortened(file_name_of(word)).into();
    }
    let (path, topic) = path_and_topic(word);
    let path = if path.file_name().is_some() { path.to_path_buf() } else { path.canonicalize().unwrap_or_default() };
    let name = if path.is_dir() { path.file_name() } else { path.file_stem() };
    let topic = topic.map_or(String::new(), file_name_of);
    below.join(shortened(format!("{}{topic}", name.unwrap_or_default().to_string_lossy())))
}

/// Refuses videos whose results would be in one folder, or in a folder of each other's.
fn refuse_same(videos: &[Source]) -> Outcome {
    let mut sorted: Vec<&Source> = videos.iter().collect();
    sorted.sort_by(|a, b| a.folder.cmp(&b.folder));
    match sorted.windows(2).find(|pair| pair[1].folder.starts_with(&pair[0].folder)) {
        Some([a, b]) => Err(Failure::request(format!(
            "{} and {} would both have their results in {}; a pattern keeps the folders that it leaves open, such as 'data/*/depth': \
             data/a/depth has its results in a/depth",
            a.word,
            b.word,
            a.folder.display()
        ))),
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn videos_have_folders_by_their_names() {
        for (word, folder) in [
            ("walks/a.mcap", "a"),
            ("walks/a.b.mcap:/depth/image", "a.b_depth_image"),
            ("scene:boxes:size=64x48,frames=2", "scene_boxes_size_64x48_frames_2"),
            ("no/such/folder/", "folder"),
        ] {
            assert_eq!(folder_of(word, Path::new("")), Path::new(folder), "{word}");
        }
        assert_eq!(folder_of("data/a/depth", Path::new("a")), Path::new("a/depth"));
    }

    #[test]
    fn videos_with_one_folder_are_refused() {
        let words = |words: &[&str]| words.iter().map(|word| word.to_string()).collect::<Vec<_>>();
        for wrong in [&["a/x.mcap", "b/x.mcap"][..], &["x", "x"], &["-", "x"]] {
            assert!(expand(&words(wrong)).is_err(), "{wrong:?}");
        }
        let videos = expand(&words(&["a/x.mcap", "b/y.mcap", "x.mcap:/a"])).unwrap();
        let folders: Vec<&Path> = videos.iter().map(|video| video.folder.as_path()).collect();
        assert_eq!(folders, [Path::new("x"), Path::new("y"), Path::new("x_a")]);
    }
}
