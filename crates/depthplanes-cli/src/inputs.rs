//! What the words after a command stand for: files, folders, patterns, standard input, scenes.

use crate::checksum::fnv;
use crate::failure::{Failure, Outcome, note};
use crate::manifest::Named;
use depthplanes_io::formats::{FORMATS, left_out};
use depthplanes_io::outputs::OUTPUTS;
use depthplanes_video::natural;
use std::collections::BTreeMap;
use std::ffi::{OsStr, OsString};
use std::path::{Path, PathBuf};

/// One input.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Input {
    File {
        path: PathBuf,
        /// The subfolders between it and the folder that was given; files of results stand in the same ones.
        below: PathBuf,
    },
    /// Standard input, `-`.
    Standard,
    /// A synthetic scene: what follows `scene:`.
    Scene(String),
}

impl Named for Input {
    fn name(&self) -> String {
        self.name()
    }

    fn path(&self) -> Option<&Path> {
        match self {
            Input::File { path, .. } => Some(path),
            _ => None,
        }
    }
}

impl Input {
    /// Its name for people and records: as given.
    pub(crate) fn name(&self) -> String {
        match self {
            Input::File { path, .. } => path.display().to_string(),
            Input::Standard => "-".into(),
            Input::Scene(spec) => format!("scene:{spec}"),
        }
    }

    /// The subfolder of a folder of results that its files are in; mostly empty.
    pub(crate) fn below(&self) -> &Path {
        match self {
            Input::File { below, .. } => below,
            _ => Path::new(""),
        }
    }

    /// What the names of its files in a folder of results begin with.
    pub(crate) fn stem(&self) -> String {
        match self {
            Input::File { path, .. } => shortened(path.file_stem().unwrap_or_default().to_string_lossy().into_owned()),
            Input::Standard => "stdin".into(),
            Input::Scene(spec) => shortened(format!("scene_{}", file_name_of(spec))),
        }
    }
}

/// Words as a file's name: what is no letter, digit, `-`, `_` or `.` becomes `_`.
pub(crate) fn file_name_of(words: &str) -> String {
    words.chars().map(|c| if c.is_ascii_alphanumeric() || "-_.".contains(c) { c } else { '_' }).collect()
}

/// Bytes of the longest name that file systems take.
const LONGEST_NAME: usize = 255;

/// A stem that leaves room for the names of all outputs: of a longer one the beginning and a checksum of all of it, so that
/// names that begin alike stay apart.
pub(crate) fn shortened(stem: String) -> String {
    let most = LONGEST_NAME - 1 - OUTPUTS.iter().map(|output| output.file.len()).max().unwrap_or(0);
    if stem.len() <= most {
        return stem;
    }
    let tail = format!("-{:08x}", fnv(&stem) as u32);
    let kept = (0..=most - tail.len()).rev().find(|&end| stem.is_char_boundary(end)).unwrap_or(0);
    format!("{}{tail}", &stem[..kept])
}

/// All inputs that the words stand for, in the order given; folders and patterns in natural order. `recursive`: folders
/// stand for the maps in their subfolders as well.
///
/// # Errors
/// A folder without a map, a pattern without a match, standard input asked for twice. A file that
/// does not exist is found out when it is read.
pub(crate) fn expand(words: &[OsString], recursive: bool) -> Outcome<Vec<Input>> {
    let mut inputs = Vec::new();
    for word in words {
        inputs.extend(expand_word(word, recursive)?);
    }
    if inputs.iter().filter(|input| **input == Input::Standard).count() > 1 {
        return Err(Failure::request("-: standard input can be read only once; give it once"));
    }
    Ok(inputs)
}

/// A word that is no text can only be a path.
fn expand_word(word: &OsStr, recursive: bool) -> Outcome<Vec<Input>> {
    let path = Path::new(word);
    let word = word.to_str().unwrap_or_default();
    if word == "-" {
        Ok(vec![Input::Standard])
    } else if let Some(spec) = word.strip_prefix("scene:") {
        Ok(vec![Input::Scene(spec.into())])
    } else if path.is_dir() {
        maps_in(path, recursive)
    } else if word.contains(['*', '?', '[']) && !path.exists() {
        matching(word)
    } else {
        Ok(vec![file(path.into(), Path::new(""))])
    }
}

/// A file, and the folder that was given, if it was one.
fn file(path: PathBuf, given: &Path) -> Input {
    let folder = path.parent().unwrap_or(Path::new(""));
    let below = if given.as_os_str().is_empty() { Path::new("") } else { folder.strip_prefix(given).unwrap_or(folder) };
    Input::File { below: below.into(), path }
}

/// The maps of a folder: not our own outputs; with `recursive` those of its subfolders too.
fn maps_in(folder: &Path, recursive: bool) -> Outcome<Vec<Input>> {
    let mut maps = own_maps(folder)?;
    if recursive || maps.is_empty() {
        let mut below = Vec::new();
        for subfolder in subfolders(folder)? {
            below.extend(own_maps(&subfolder)?);
        }
        if !recursive && !below.is_empty() {
            return Err(only_in_subfolders(folder, &below));
        }
        maps.extend(below);
    }
    if maps.is_empty() {
        let known = FORMATS.iter().flat_map(|format| format.extensions);
        let known: Vec<String> = known.map(|extension| format!("*.{extension}")).collect();
        let mut message = format!("{}: no map in this folder; looked for {}", folder.display(), known.join(", "));
        if let Some((path, accepted)) = of_another_build(folder) {
            message += &format!("; {} is there; accepted: {accepted}", file_name(&path));
        }
        if let Some(result) = files_in(folder)?.iter().find(|path| is_ours(path)) {
            let ours: Vec<String> = OUTPUTS.iter().map(|output| format!("*.{}", output.file)).collect();
            let (result, ours) = (file_name(result), ours.join(", "));
            message += &format!("; files such as {result} are results of this program and skipped: {ours}");
        }
        return Err(Failure::request(message));
    }
    Ok(in_natural_order(maps, folder))
}

/// A file in the folder whose format this build does not read but another does, and what to do about it.
fn of_another_build(folder: &Path) -> Option<(PathBuf, &'static str)> {
    let mut paths = folder.read_dir().ok()?.flatten().map(|entry| entry.path());
    paths.find_map(|path| left_out(&extension(&path)).map(|accepted| (path, accepted)))
}

/// In small letters.
fn extension(path: &Path) -> String {
    path.extension().unwrap_or_default().to_string_lossy().to_lowercase()
}

/// The maps that stand in a folder itself.
fn own_maps(folder: &Path) -> Outcome<Vec<PathBuf>> {
    let mut maps = files_in(folder)?;
    maps.retain(|path| !is_ours(path));
    folder.read_dir().into_iter().flatten().flatten().for_each(|entry| tell_of_dangling(&entry.path()));
    Ok(maps)
}

/// The folders below a folder, at any depth, but for hidden ones and those behind links.
fn subfolders(folder: &Path) -> Outcome<Vec<PathBuf>> {
    let (mut found, mut due) = (Vec::new(), vec![folder.to_path_buf()]);
    while let Some(folder) = due.pop() {
        let failed = |error| Failure::request(format!("{}: cannot be listed: {error}", folder.display()));
        for entry in folder.read_dir().map_err(failed)? {
            let entry = entry.map_err(failed)?;
            let path = entry.path();
            if entry.file_type().map_err(failed)?.is_dir() && !file_name(&path).starts_with('.') {
                due.push(path.clone());
                found.push(path);
            }
        }
    }
    Ok(found)
}

/// So many subfolders are named in a message.
const MOST_NAMED: usize = 4;

/// Says which subfolders hold maps, those with most of them first.
fn only_in_subfolders(folder: &Path, maps: &[PathBuf]) -> Failure {
    let mut counts: BTreeMap<&Path, usize> = BTreeMap::new();
    for map in maps {
        *counts.entry(map.parent().unwrap_or(folder)).or_default() += 1;
    }
    let mut counts: Vec<(&Path, usize)> = counts.into_iter().collect();
    counts.sort_by_key(|&(_, count)| std::cmp::Reverse(count));
    let one = |(folder, count): &(&Path, usize)| {
        format!("{} ({count} file{})", folder.display(), if *count == 1 { "" } else { "s" })
    };
    let mut named: Vec<String> = counts.iter().take(MOST_NAMED).map(one).collect();
    if counts.len() > MOST_NAMED {
        named.push(format!("{} more", counts.len() - MOST_NAMED));
    }
    Failure::request(format!(
        "{}: no map in this folder itself, but below it: {}; give the one you mean, or --recursive for all",
        folder.display(),
        named.join(", ")
    ))
}

/// The files of a folder whose extension belongs to a format, hidden ones left out.
///
/// # Errors
/// A folder that cannot be listed.
pub(crate) fn files_in(folder: &Path) -> Outcome<Vec<PathBuf>> {
    let failed = |error| Failure::request(format!("{}: cannot be listed: {error}", folder.display()));
    let mut files = Vec::new();
    for entry in folder.read_dir().map_err(failed)? {
        let path = entry.map_err(failed)?.path();
        if is_readable(&path) {
            files.push(path);
        }
    }
    Ok(files)
}

fn is_readable(path: &Path) -> bool {
    has_name_of_map(path) && path.is_file()
}

fn has_name_of_map(path: &Path) -> bool {
    let extension = extension(path);
    let known = FORMATS.iter().any(|format| format.extensions.contains(&extension.as_str()));
    known && !file_name(path).starts_with('.')
}

/// Says of a link that has the name of a map and leads nowhere that it is left out.
fn tell_of_dangling(path: &Path) {
    if has_name_of_map(path) && !is_ours(path) && path.is_symlink() && !path.exists() {
        note(&format!("{}: left out: a link, and what it leads to is not there", path.display()));
    }
}

/// `detect` writes INPUT.labels.png, `demo` writes labels.png.
fn is_ours(path: &Path) -> bool {
    let name = file_name(path);
    OUTPUTS.iter().any(|output| name == output.file || name.ends_with(&format!(".{}", output.file)))
}

fn file_name(path: &Path) -> String {
    path.file_name().unwrap_or_default().to_string_lossy().into_owned()
}

fn matching(pattern: &str) -> Outcome<Vec<Input>> {
    let wrong = |error: glob::PatternError| Failure::request(format!("{pattern}: not a pattern: {error}"));
    let found: Vec<PathBuf> = glob::glob(pattern).map_err(wrong)?.flatten().collect();
    found.iter().for_each(|path| tell_of_dangling(path));
    let files: Vec<PathBuf> = found.into_iter().filter(|path| path.is_file()).collect();
    if files.is_empty() {
        return Err(Failure::request(format!("{pattern}: no file matches this pattern")));
    }
    Ok(in_natural_order(files, Path::new("")))
}

fn in_natural_order(mut paths: Vec<PathBuf>, given: &Path) -> Vec<Input> {
    paths.sort_by(|a, b| natural::compare(&a.to_string_lossy(), &b.to_string_lossy()));
    paths.into_iter().map(|path| file(path, given)).collect()
}
