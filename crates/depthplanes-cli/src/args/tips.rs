//! What to type instead of words that other programs take: the file alone, `-o`, a flag for each part of the camera.

use clap::builder::StyledStr;
use clap::error::{ContextKind, ContextValue, ErrorKind};

/// Flags of other programs, and what to type here.
const FLAGS: &[(&[&str], &str)] = &[
    (
        &["-o", "--output", "--out", "--save", "--outdir", "--output-dir"],
        "each kind of result has a flag of its own: --overlay FILE.png, --labels FILE.png, --planes FILE.csv, --json; --out-dir DIR \
         writes all of them",
    ),
    (
        &["--fx", "--fy", "--cx", "--cy", "-K", "-k", "--K", "--intrinsic"],
        "the camera is one flag: --intrinsics FX,FY,CX,CY",
    ),
    (&["--depth_scale", "--unit", "--units"], "the unit is stated as --scale (map units per metre) or --encoding"),
    (&["-i", "--input", "--depth", "-f", "--file"], "inputs need no flag: depthplanes detect FILE"),
    (&["--width", "--height", "-w", "--size"], "the size of headerless samples is one flag: --raw-size WxH"),
];

/// The error with what to type instead, where that is known.
pub(super) fn with_tip(mut error: clap::Error, words: &[String]) -> clap::Error {
    let given = |kind| match error.get(kind) {
        Some(ContextValue::String(word)) => Some(word.clone()),
        _ => None,
    };
    let tip = match error.kind() {
        ErrorKind::InvalidSubcommand => given(ContextKind::InvalidSubcommand).and_then(|word| of_file(&word, words)),
        ErrorKind::UnknownArgument => given(ContextKind::InvalidArg).and_then(|word| of_flag(&word)),
        _ => None,
    };
    if let Some(tip) = tip {
        error.insert(ContextKind::Suggested, ContextValue::StyledStrs(vec![StyledStr::from(tip)]));
    }
    error
}

/// A file, a folder or a scene in the place of a command.
fn of_file(word: &str, words: &[String]) -> Option<String> {
    let is_input = word.contains(['.', '/', '*', ':']) || std::path::Path::new(word).exists();
    let rest = words.get(1..).unwrap_or_default().join(" ");
    is_input.then(|| format!("to find its planes: depthplanes detect {rest}"))
}

fn of_flag(word: &str) -> Option<String> {
    let name = word.split('=').next().unwrap_or(word);
    FLAGS.iter().find(|(names, _)| names.contains(&name)).map(|(_, tip)| tip.to_string())
}
