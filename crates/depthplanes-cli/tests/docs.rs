//! Every command in the docs is executed, and prints what the docs say.
//!
//! In ```console blocks a line `$ command` is run by the shell; the lines after it are its standard
//! output, where a line `...` stands for any number of lines. With DEPTHPLANES_GOLDEN=update the
//! outputs without a `...` are written anew.
#![cfg(unix)]

mod support;

use std::path::{Path, PathBuf};
use support::{Bench, Ran};

/// One command and the lines that the docs show below it.
struct Step {
    command: String,
    expected: Vec<String>,
    /// Line numbers of the expected lines, end exclusive.
    lines: std::ops::Range<usize>,
}

fn steps(text: &str) -> Vec<Step> {
    let mut steps: Vec<Step> = Vec::new();
    let mut inside = false;
    for (i, line) in text.lines().enumerate() {
        if line.starts_with("```") {
            inside = !inside && line == "```console";
        } else if let (true, Some(command)) = (inside, line.strip_prefix("$ ")) {
            steps.push(Step { command: command.into(), expected: Vec::new(), lines: i + 1..i + 1 });
        } else if let (true, Some(step)) = (inside, steps.last_mut()) {
            step.expected.push(line.into());
            step.lines.end = i + 1;
        }
    }
    steps
}

/// Whether the lines match, `...` standing for any number of lines.
fn matches(expected: &[String], actual: &[String]) -> bool {
    match expected.split_first() {
        None => actual.is_empty(),
        Some((line, rest)) if line == "..." => (0..=actual.len()).any(|skipped| matches(rest, &actual[skipped..])),
        Some((line, rest)) => actual.first() == Some(line) && matches(rest, &actual[1..]),
    }
}

fn shell(bench: &Bench, command: &str) -> Ran {
    let program = Path::new(env!("CARGO_BIN_EXE_depthplanes")).parent().unwrap();
    let path = std::env::join_paths(
        std::iter::once(program.to_path_buf()).chain(std::env::split_paths(&std::env::var_os("PATH").unwrap())),
    );
    Ran::from(bench.command_of("sh").env("PATH", path.unwrap()).args(["-c", command]).output().unwrap())
}

fn run_document(path: &Path) {
    let text = std::fs::read_to_string(path).unwrap();
    let update = std::env::var("DEPTHPLANES_GOLDEN").is_ok_and(|value| value == "update");
    let bench = Bench::new(&format!("docs_{}", path.file_stem().unwrap().display()));
    let mut lines: Vec<String> = text.lines().map(String::from).collect();
    let mut outputs = Vec::new();
    for step in steps(&text) {
        let ran = shell(&bench, &step.command);
        let fails = step.command.contains("# fails");
        assert_eq!(ran.code == Some(0), !fails, "{}: {ran:?}", step.command);
        let shown = if fails { &ran.err } else { &ran.out };
        let actual: Vec<String> = shown.lines().map(String::from).collect();
        let fixed = !step.expected.iter().any(|line| line == "...");
        if update && fixed {
            outputs.push((step.lines, actual));
        } else {
            assert!(matches(&step.expected, &actual), "{}: {}\nprints\n{shown}", path.display(), step.command);
        }
    }
    if update {
        for (range, output) in outputs.into_iter().rev() {
            lines.splice(range, output);
        }
        std::fs::write(path, lines.join("\n") + "\n").unwrap();
    }
}

#[test]
fn the_commands_of_the_docs_print_what_the_docs_say() {
    let root = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../..");
    let documents = [root.join("docs/cli.md"), root.join("README.md")];
    for document in documents.iter().filter(|document| document.exists()) {
        run_document(document);
    }
}
