//! Results never go over what they are made from.

use super::videos::Source;
use crate::args::Track;
use crate::failure::{Failure, Outcome};
use depthplanes_io::outputs;
use depthplanes_video::path_and_topic;
use std::fs::Metadata;
use std::path::{Path, PathBuf};

/// Refuses folders of results that are the source, lie in it, or are the same, and a file of results that is one of the
/// source's or that a flag names, under whatever name.
///
/// # Errors
/// What is wrong, and what to do.
pub(super) fn check(wanted: &Track, source: &str) -> Outcome {
    if let Some(path) = wanted.out.as_deref().filter(|path| path.as_os_str() != "-") {
        outputs::check_folder(path)?;
    }
    let folders = [("--labels", &wanted.labels), ("--overlays", &wanted.overlays), ("--out", &wanted.out)];
    let given: Vec<(&str, PathBuf)> =
        folders.into_iter().filter_map(|(flag, path)| Some((flag, existing(path.as_deref()?)?))).collect();
    let place = existing(path_and_topic(source).0);
    for (flag, path) in &given {
        if place.as_ref().is_some_and(|place| path.starts_with(place)) {
            let path = path.display();
            return Err(Failure::request(format!(
                "{flag}: {path} is there already and belongs to the source {source}, whose frames would be lost; \
                 accepted: a place outside of the source, or one that is new"
            )));
        }
    }
    if let Some(path) = &wanted.out {
        check_inputs(wanted, source, path)?;
    }
    match (&wanted.labels, &wanted.overlays) {
        (Some(labels), Some(overlays))
            if labels == overlays || existing(labels).is_some_and(|same| Some(same) == existing(overlays)) =>
        {
            Err(Failure::request("--labels and --overlays are the same folder; their files have the same names"))
        }
        _ => Ok(()),
    }
}

/// Refuses a folder for the results of several videos that is one of them or lies in one, where it would be among the frames.
pub(super) fn check_out_dir(folder: &Path, sources: &[Source]) -> Outcome {
    // The folder itself may not be there yet.
    let Some(place) =
        folder.ancestors().map(|above| if above == Path::new("") { Path::new(".") } else { above }).find_map(existing)
    else {
        return Ok(());
    };
    let is_in = |source: &&Source| existing(path_and_topic(&source.word).0).is_some_and(|path| place.starts_with(path));
    match sources.iter().find(is_in) {
        Some(source) => Err(Failure::request(format!(
            "--out-dir: {} lies in the source {}, where results would be among its frames; accepted: a place outside of the sources",
            folder.display(),
            source.word
        ))),
        None => Ok(()),
    }
}

/// Refuses a file of results that is an input by another name: a link, or the file behind standard input.
fn check_inputs(wanted: &Track, source: &str, out: &Path) -> Outcome {
    let Ok(of_out) = out.metadata() else { return Ok(()) };
    let named = [Some(path_and_topic(source).0), wanted.reading.camera.as_deref(), wanted.noise_table.as_deref()];
    let named = named.into_iter().flatten().map(|path| (path.display().to_string(), path.metadata().ok()));
    let piped = (source == "-").then(|| ("standard input".to_string(), standard_input()));
    let mut inputs = named.chain(piped);
    let is_it = |(_, input): &(String, Option<Metadata>)| input.as_ref().is_some_and(|input| is_same(input, &of_out));
    match inputs.find(is_it) {
        Some((name, _)) => Err(Failure::request(format!(
            "--out: {} is the file of {name}, which would be lost; accepted: another place",
            out.display()
        ))),
        None => Ok(()),
    }
}

/// What is behind standard input.
#[cfg(unix)]
fn standard_input() -> Option<Metadata> {
    use std::os::fd::AsFd;
    std::fs::File::from(std::io::stdin().as_fd().try_clone_to_owned().ok()?).metadata().ok()
}

#[cfg(not(unix))]
fn standard_input() -> Option<Metadata> {
    None
}

/// Whether two are one regular file.
#[cfg(unix)]
fn is_same(a: &Metadata, b: &Metadata) -> bool {
    use std::os::unix::fs::MetadataExt;
    a.is_file() && (a.dev(), a.ino()) == (b.dev(), b.ino())
}

#[cfg(not(unix))]
fn is_same(_: &Metadata, _: &Metadata) -> bool {
    false
}

/// The one path of something that is there.
fn existing(path: &Path) -> Option<PathBuf> {
    path.canonicalize().ok()
}
