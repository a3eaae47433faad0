//! A folder of maps in natural order. The time is in the names, where they have one.

use super::files::{Entry, Files, PoseOf, names_in};
use crate::error::{Error, Result};
use crate::source::{Source, SourceInfo, SourceOptions};
use depthplanes_io::formats::FORMATS;
use std::path::{Path, PathBuf};

pub(super) const FOLDER: SourceInfo = SourceInfo {
    name: "folder",
    about: "a folder of maps, in natural order",
    is: |word| Path::new(word).is_dir(),
    open,
};

/// Folders in a message.
const MOST_SAID: usize = 4;

fn open(word: &str, options: &SourceOptions) -> Result<Box<dyn Source>> {
    let folder = Path::new(word);
    let names: Vec<String> = names_in(folder)?.into_iter().filter(|name| is_map(name)).collect();
    if names.is_empty() {
        return Err(Error::source(word, "no map in this folder", accepted(folder)));
    }
    let unit = unit_s(&names);
    let entry = |name: String| Entry {
        time_s: unit.and_then(|unit| Some(number_in(&name)? * unit)),
        path: folder.join(name),
        pose: PoseOf::Unknown,
    };
    let entries = names.into_iter().map(entry).collect();
    Ok(Box::new(Files::new(entries, options.read.clone())))
}

/// What is accepted instead of a folder without maps: those folders in it that have some.
fn accepted(folder: &Path) -> String {
    let inner =
        folder.read_dir().into_iter().flatten().flatten().map(|entry| entry.path()).filter(|path| path.is_dir());
    let has_maps = |path: &PathBuf| names_in(path).is_ok_and(|names| names.iter().any(|name| is_map(name)));
    let mut inner: Vec<String> =
        inner.filter(has_maps).take(MOST_SAID).map(|path| path.display().to_string()).collect();
    inner.sort();
    match inner[..] {
        [] => "a folder of maps, such as *.png or *.npy".into(),
        _ => format!("a folder of maps, such as {}", inner.join(" or ")),
    }
}

/// Whether a file is a map by its name, and none of our own results.
pub(super) fn is_map(name: &str) -> bool {
    let extension = Path::new(name).extension().unwrap_or_default();
    let is_ours = depthplanes_io::outputs::OUTPUTS.iter().any(|output| name.ends_with(&format!(".{}", output.file)));
    !is_ours && FORMATS.iter().flat_map(|format| format.extensions).any(|own| extension.eq_ignore_ascii_case(own))
}

/// Seconds of a unit of the numbers in the names, if these are times: they rise, and read as seconds, milli-, micro- or
/// nanoseconds they lie between 2001 and 2286.
fn unit_s(names: &[String]) -> Option<f64> {
    let times: Vec<f64> = names.iter().map(|name| number_in(name)).collect::<Option<_>>()?;
    if times.windows(2).any(|pair| pair[1] <= pair[0]) {
        return None;
    }
    let is_time = |unit: &f64| (1e9..1e10).contains(&(times[0] * unit));
    [1.0, 1e-3, 1e-6, 1e-9].into_iter().find(is_time)
}

/// The last number in a name without its extension, with decimals if it has them.
fn number_in(name: &str) -> Option<f64> {
    let stem = name.rsplit_once('.').map_or(name, |(stem, _)| stem);
    let is_part = |c: char| c.is_ascii_digit() || c == '.';
    let end = stem.rfind(|c: char| c.is_ascii_digit())? + 1;
    let start = stem[..end].rfind(|c| !is_part(c)).map_or(0, |at| at + 1);
    stem[start..end].trim_start_matches('.').parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_are_read_from_names() {
        let unit = |names: &[&str]| unit_s(&names.iter().map(|name| name.to_string()).collect::<Vec<_>>());
        assert_eq!(number_in("1341848230.910894.png"), Some(1_341_848_230.910_894));
        assert_eq!(number_in("00000001_1580908153638.png"), Some(1_580_908_153_638.0));
        assert_eq!(number_in("frame.png"), None);
        assert_eq!(unit(&["1341848230.91.png", "1341848230.95.png"]), Some(1.0));
        assert_eq!(unit(&["0_1580908150203.png", "1_1580908153638.png"]), Some(1e-3));
        assert_eq!(unit(&["1580908150203000000.png", "1580908153638000000.png"]), Some(1e-9));
        assert_eq!(unit(&["frame-0001.png", "frame-0002.png"]), None, "numbers of frames are no times");
        assert_eq!(unit(&["1580908150203.png", "1580908150203.npy"]), None, "time does not stand still");
    }
}
