//! The invariants of ARCHITECTURE.md that can be read off the sources.

use std::path::{Path, PathBuf};

fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// Every Rust file below a folder of the project: its path from there, and its text.
fn sources(folder: &str) -> Vec<(String, String)> {
    fn collect(folder: &Path, files: &mut Vec<PathBuf>) {
        for entry in folder.read_dir().unwrap_or_else(|error| panic!("{}: {error}", folder.display())) {
            let path = entry.unwrap().path();
            if path.is_dir() {
                collect(&path, files);
            } else if path.extension().is_some_and(|extension| extension == "rs") {
                files.push(path);
            }
        }
    }
    let (top, mut files) = (root().join(folder), Vec::new());
    collect(&top, &mut files);
    files.sort();
    let named = |path: PathBuf| {
        let text = std::fs::read_to_string(&path).unwrap();
        let name: Vec<_> = path.strip_prefix(&top).unwrap().iter().map(|part| part.to_str().unwrap()).collect();
        (name.join("/"), text)
    };
    files.into_iter().map(named).collect()
}

/// The lines that are code, up to a file's own tests.
fn code(text: &str) -> impl Iterator<Item = &str> {
    let code = text.split("#[cfg(test)]").next().unwrap_or(text);
    code.lines().filter(|line| !line.trim_start().starts_with("//"))
}

/// Files with a line of code that holds one of the words.
fn files_with(folder: &str, words: &[&str]) -> Vec<String> {
    let holds = |text: &str| code(text).any(|line| words.iter().any(|word| line.contains(word)));
    sources(folder).into_iter().filter(|(_, text)| holds(text)).map(|(name, _)| name).collect()
}

#[test]
fn the_library_asks_nothing_of_the_outside() {
    let outside = ["std::fs", "std::env", "std::time", "std::io", "std::net", "std::process", "RandomState", "HashMap"];
    // But for the build that `make ablate` makes.
    assert_eq!(files_with("crates/depthplanes/src", &outside), ["util/switches.rs"]);
}

#[test]
fn arrows_do_not_turn_back() {
    let ranks: [(&str, &[&str]); 8] = [
        ("the detector", &["crate::detector", "crate::Detector"]),
        ("scenes", &["crate::scene"]),
        ("metrics", &["crate::metrics"]),
        ("outlines", &["crate::outline"]),
        ("methods", &["crate::methods"]),
        ("baselines", &["crate::baselines"]),
        ("planes' records", &["crate::statistics::{", "crate::statistics::PlaneStatistics"]),
        ("selection", &["crate::components::selection"]),
    ];
    let may = |name: &str, what: &str| match what {
        _ if name == "lib.rs" || name.ends_with("tests.rs") => true, // they look at all of it
        "the detector" | "scenes" => name.starts_with("scene/"),
        "methods" => name == "detector.rs" || name.starts_with("methods/") || name.starts_with("baselines/"),
        "baselines" => name == "methods/mod.rs" || name.starts_with("baselines/"),
        "metrics" | "outlines" => false, // nothing in the library asks how well it did, or for outlines
        "planes' records" => name == "labelled.rs" || name == "lens/carry.rs" || name.starts_with("methods/"),
        _ => ["methods/", "statistics/", "coplanar.rs", "labelled.rs", "lens/carry.rs"]
            .iter()
            .any(|start| name.starts_with(start)),
    };
    for (what, words) in ranks {
        for name in files_with("crates/depthplanes/src", words) {
            assert!(may(&name, what), "{name} knows {what}");
        }
    }
}

#[test]
fn unsafe_code_stands_in_the_kernels_alone() {
    for name in files_with("crates/depthplanes/src", &["unsafe "]) {
        assert!(name.starts_with("components/kernels/") || name == "util/simd.rs", "{name}");
    }
    assert_eq!(files_with("crates/depthplanes-io/src", &["unsafe "]), [""; 0]);
    assert_eq!(files_with("crates/depthplanes-video/src", &["unsafe "]), [""; 0]);
    assert_eq!(files_with("crates/depthplanes-serve/src", &["unsafe "]), [""; 0]);
    assert_eq!(files_with("crates/depthplanes-cli/src", &["unsafe "]), [""; 0]);
    assert_eq!(files_with("crates/depthplanes-ros2/src", &["unsafe "]), [""; 0]);
    assert_eq!(files_with("crates/depthplanes-rerun/src", &["unsafe "]), [""; 0]);
    assert_eq!(files_with("bindings/python/src", &["unsafe "]), ["array.rs"]); // memory that NumPy and Rust share
    let border = ["border.rs", "detector.rs", "map.rs", "stated.rs", "tables.rs"]; // texts, pixels and arrays of C
    assert_eq!(files_with("bindings/c/src", &["unsafe "]), border);
    assert_eq!(files_with("bindings/web/src", &["unsafe "]), ["clock.rs"]); // the clock of JavaScript, which is declared
}

#[test]
fn the_argument_parser_is_known_to_one_module() {
    for krate in ["depthplanes-cli", "depthplanes-ros2", "depthplanes-rerun"] {
        for name in files_with(&format!("crates/{krate}/src"), &["clap"]) {
            assert!(name == "args.rs" || name.starts_with("args/"), "{name}");
        }
    }
}

#[test]
fn the_tests_that_the_architecture_names_exist() {
    let tests: String = ["crates", "bindings"].into_iter().flat_map(sources).map(|(_, text)| text).collect();
    let text = std::fs::read_to_string(root().join("ARCHITECTURE.md")).unwrap();
    let mut named = 0;
    for line in text.lines().filter(|line| line.starts_with('|')) {
        for name in line.split('`').filter(|name| name.matches('_').count() >= 3) {
            assert!(tests.contains(&format!("fn {name}(")), "there is no test `{name}`");
            named += 1;
        }
    }
    assert!(named > 20, "{named} tests named");
}

#[test]
fn nobody_but_tests_and_benchmarks_asks_for_stages_by_themselves() {
    for krate in [
        "crates/depthplanes",
        "crates/depthplanes-io",
        "crates/depthplanes-video",
        "crates/depthplanes-serve",
        "crates/depthplanes-cli",
        "crates/depthplanes-ros2",
        "crates/depthplanes-rerun",
        "bindings/python",
        "bindings/c",
        "bindings/web",
    ] {
        let folder = &format!("{krate}/src");
        assert_eq!(files_with(folder, &["::internals"]), [""; 0], "{folder}");
    }
}

#[test]
fn planar_has_fewer_than_25_files() {
    let count = sources("crates/depthplanes/src/methods/planar").len();
    assert!((10..25).contains(&count), "{count} files");
}
