//! Results never go over the frames that they are made from.

use crate::args::Track;
use crate::failure::{Failure, Outcome};
use depthplanes_io::outputs;
use depthplanes_video::path_and_topic;
use std::path::{Path, PathBuf};

/// Refuses folders of results that are the source, lie in it, or are the same, and a file of lines that is one of the source's.
///
/// # Errors
/// What is wrong, and what to do.
pub(super) fn check(wanted: &Track) -> Outcome {
    if let Some(path) = wanted.out.as_deref().filter(|path| path.as_os_str() != "-") {
        outputs::check_folder(path)?;
    }
    let folders = [("--labels", &wanted.labels), ("--overlays", &wanted.overlays), ("--out", &wanted.out)];
    let given: Vec<(&str, PathBuf)> =
        folders.into_iter().filter_map(|(flag, path)| Some((flag, existing(path.as_deref()?)?))).collect();
    let source = existing(path_and_topic(&wanted.source).0);
    for (flag, path) in &given {
        if source.as_ref().is_some_and(|source| path.starts_with(source)) {
            let (path, source) = (path.display(), &wanted.source);
            return Err(Failure::request(format!(
                "{flag}: {path} is there already and belongs to the source {source}, whose frames would be lost; \
                 accepted: a place outside of the source, or one that is new"
            )));
        }
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

/// The one path of something that is there.
fn existing(path: &Path) -> Option<PathBuf> {
    path.canonicalize().ok()
}
