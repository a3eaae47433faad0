//! Where the files of `floor` go, checked before any work is done.

use crate::args::Floor;
use crate::failure::{Failure, Outcome};
use crate::inputs::Input;
use depthplanes_io::outputs;
use std::path::{Path, PathBuf};

/// Refuses files of a wrong name, of several inputs, and such as would overwrite an input or each other.
pub(super) fn check(wanted: &Floor, inputs: &[Input]) -> Outcome {
    let flags = [("--overlay", &wanted.overlay, &["png"][..]), ("--grid", &wanted.grid, &["png", "pgm"])];
    let mut written: Vec<(PathBuf, String)> = Vec::new();
    for (flag, path, extensions) in flags {
        let Some(path) = path else { continue };
        check_name(flag, path, extensions)?;
        if inputs.len() > 1 {
            let count = inputs.len();
            return Err(Failure::request(format!(
                "{flag} names one file, but there are {count} inputs; give them one by one"
            )));
        }
        written.push((path.clone(), flag.into()));
        if flag == "--grid" {
            written.push((outputs::grid_yaml_path(path), "the YAML file of --grid".into()));
        }
    }
    for (path, _) in &written {
        outputs::check_folder(path)?;
    }
    let read = |input: &Input| match input {
        Input::File { path, .. } => Some((path.clone(), format!("the input {}", path.display()))),
        _ => None,
    };
    let read: Vec<(PathBuf, String)> = inputs.iter().filter_map(read).collect();
    Ok(outputs::check_paths(&read, &written)?)
}

fn check_name(flag: &str, path: &Path, extensions: &[&str]) -> Outcome {
    let extension = path.extension().map(|extension| extension.to_string_lossy().to_lowercase());
    if extension.is_some_and(|extension| extensions.contains(&extension.as_str())) {
        return Ok(());
    }
    let accepted = extensions.join(" or .");
    Err(Failure::request(format!("{flag} {}: accepted: a name that ends in .{accepted}", path.display())))
}
