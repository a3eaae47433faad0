//! Where the outputs of inputs go.

use crate::args::Detect;
use crate::failure::{Failure, Outcome};
use crate::folders::refuse_file;
use crate::inputs::Input;
use depthplanes_io::outputs::{self, OUTPUTS, Output, TableForm};
use std::io::IsTerminal;
use std::path::{Path, PathBuf};

/// The file of an output in a folder of results.
pub(super) fn file_in(folder: &Path, input: &Input, output: &Output) -> PathBuf {
    folder.join(input.below()).join(format!("{}.{}", input.stem(), output.file))
}

/// Refuses outputs that have a wrong name or would overwrite something, before any work is done.
pub(super) fn check_outputs(wanted: &Detect, inputs: &[Input]) -> Outcome {
    if let (Some((output, _)), true) = (wanted.outputs.first(), inputs.len() > 1) {
        let (name, count) = (output.name, inputs.len());
        let table = if name == "planes" { ", or --table for one file" } else { "" };
        let message = format!("--{name} names one file, but there are {count} inputs; use --out-dir{table}");
        return Err(Failure::request(message));
    }
    for (output, path) in &wanted.outputs {
        let writer = output.writer(path)?;
        if is_standard_output(path) {
            check_standard_output(wanted, output.name, !["json", "csv"].contains(&writer.extension))?;
        } else {
            outputs::check_folder(path)?;
        }
    }
    let to_files = wanted.outputs.iter().filter(|(_, path)| !is_standard_output(path));
    let named = to_files.map(|(output, path)| (path.clone(), format!("--{}", output.name)));
    let mut written: Vec<(PathBuf, String)> = named.collect();
    if let Some(path) = &wanted.table {
        TableForm::of(path)?;
        outputs::check_folder(path)?;
        written.push((path.clone(), "--table".into()));
    }
    if let Some(folder) = &wanted.out_dir {
        refuse_file(folder)?;
        for input in inputs {
            let name = |output: &Output| format!("the {} of {}", output.name, input.name());
            let is_wanted =
                |output: &&Output| wanted.only.is_empty() || wanted.only.iter().any(|only| only.name == output.name);
            let all = OUTPUTS.iter().filter(is_wanted);
            written.extend(all.map(|output| (file_in(folder, input, output), name(output))));
        }
    }
    Ok(outputs::check_paths(&read_paths(wanted, inputs), &written)?)
}

/// Whether an output goes to standard output: `-`, or the system's name for it.
pub(super) fn is_standard_output(path: &Path) -> bool {
    path == Path::new("-") || path == Path::new("/dev/stdout")
}

/// Refuses a second thing on standard output, and bytes that are no text on a terminal.
fn check_standard_output(wanted: &Detect, name: &str, is_binary: bool) -> Outcome {
    let outputs = wanted.outputs.iter().filter(|(_, path)| is_standard_output(path)).count();
    if outputs > 1 || wanted.json {
        let message = "standard output takes one output, and --json is one; give the others file names";
        return Err(Failure::request(format!("--{name} -: {message}")));
    }
    if is_binary && std::io::stdout().is_terminal() {
        let message = "standard output is a terminal; send it to a file or a program, with > or |";
        return Err(Failure::request(format!("--{name} -: {message}")));
    }
    Ok(())
}

/// The files that are read: inputs, camera and noise.
fn read_paths(wanted: &Detect, inputs: &[Input]) -> Vec<(PathBuf, String)> {
    let path = |input: &Input| match input {
        Input::File { path, .. } => Some((path.clone(), format!("the input {}", path.display()))),
        _ => None,
    };
    let camera = wanted.reading.camera.iter().map(|path| (path.clone(), "the camera file".to_string()));
    let noise = wanted.noise_table.iter().map(|path| (path.clone(), "the table of the noise".to_string()));
    inputs.iter().filter_map(path).chain(camera).chain(noise).collect()
}
