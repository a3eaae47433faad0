//! Where the files of `floor` go, checked before any work is done.

use crate::args::Floor;
use crate::failure::{Failure, Outcome};
use crate::inputs::Input;
use depthplanes_io::outputs;
use std::path::PathBuf;

/// Refuses files of a wrong name, of several inputs, and such as would overwrite an input.
pub(super) fn check(wanted: &Floor, inputs: &[Input]) -> Outcome {
    let Some(path) = &wanted.overlay else { return Ok(()) };
    let extension = path.extension().map(|extension| extension.to_string_lossy().to_lowercase());
    if extension.as_deref() != Some("png") {
        return Err(Failure::request(format!("--overlay {}: accepted: a name that ends in .png", path.display())));
    }
    if inputs.len() > 1 {
        let count = inputs.len();
        return Err(Failure::request(format!(
            "--overlay names one file, but there are {count} inputs; give them one by one"
        )));
    }
    outputs::check_folder(path)?;
    let read = |input: &Input| match input {
        Input::File { path, .. } => Some((path.clone(), format!("the input {}", path.display()))),
        _ => None,
    };
    let read: Vec<(PathBuf, String)> = inputs.iter().filter_map(read).collect();
    Ok(outputs::check_paths(&read, &[(path.clone(), "--overlay".into())])?)
}
