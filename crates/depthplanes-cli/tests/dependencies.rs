//! What the project is built from: crates of crates.io, which are kept up and whose licences are among those of `deny.toml`.
//! `make deny` asks the database of advisories as well.

use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::Command;

const LOCKS: [&str; 3] = ["Cargo.lock", "fuzz/Cargo.lock", "tests/wasm/Cargo.lock"];

/// Crates that nobody keeps up, which others still ask for: the advisory that says so. See https://rustsec.org.
const UNMAINTAINED: [(&str, &str); 19] = [
    ("adler", "RUSTSEC-2025-0056"),
    ("ansi_term", "RUSTSEC-2021-0139"),
    ("atty", "RUSTSEC-2024-0375"),
    ("bincode", "RUSTSEC-2025-0141"),
    ("derivative", "RUSTSEC-2024-0388"),
    ("encoding", "RUSTSEC-2021-0153"),
    ("failure", "RUSTSEC-2020-0036"),
    ("fxhash", "RUSTSEC-2025-0057"),
    ("instant", "RUSTSEC-2024-0384"),
    ("mach", "RUSTSEC-2020-0168"),
    ("number_prefix", "RUSTSEC-2025-0119"),
    ("paste", "RUSTSEC-2024-0436"),
    ("proc-macro-error", "RUSTSEC-2024-0370"),
    ("serde_cbor", "RUSTSEC-2021-0127"),
    ("stdweb", "RUSTSEC-2020-0056"),
    ("term_size", "RUSTSEC-2020-0163"),
    ("tempdir", "RUSTSEC-2018-0017"),
    ("wee_alloc", "RUSTSEC-2022-0054"),
    ("yaml-rust", "RUSTSEC-2024-0320"),
];

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

fn read(name: &str) -> String {
    std::fs::read_to_string(root().join(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
}

/// What the lines `KEY = "VALUE"` of a lock file say.
fn values<'a>(lock: &'a str, key: &str) -> Vec<&'a str> {
    let start = format!("{key} = \"");
    lock.lines().filter_map(|line| line.strip_prefix(&start)?.strip_suffix('"')).collect()
}

#[test]
fn no_crate_is_known_to_be_unmaintained() {
    for name in LOCKS {
        let lock = read(name);
        let crates = values(&lock, "name");
        assert!(crates.contains(&"depthplanes"), "{name}");
        for (unmaintained, advisory) in UNMAINTAINED {
            assert!(
                !crates.contains(&unmaintained),
                "{name}: nobody keeps up `{unmaintained}` ({advisory}). `cargo tree --workspace --features exr --target all \
                 --invert {unmaintained}` says who asks for it; take another version of that: `cargo update NAME --precise VERSION`"
            );
        }
    }
}

#[test]
fn all_crates_are_of_crates_io() {
    for name in LOCKS {
        for source in values(&read(name), "source") {
            assert_eq!(source, "registry+https://github.com/rust-lang/crates.io-index", "{name}");
        }
    }
}

/// The licences that `deny.toml` allows.
fn allowed() -> Vec<String> {
    let text = read("deny.toml");
    let (_, list) = text.split_once("\nallow = [").unwrap();
    let (list, _) = list.split_once(']').unwrap();
    list.split('"').skip(1).step_by(2).map(str::to_string).collect()
}

/// Whether an SPDX expression can be met: each part that is joined by AND names one that is allowed.
fn is_met(expression: &str, allowed: &[String]) -> bool {
    let alternatives = |part: &str| part.trim_matches(['(', ')']).replace('/', " OR ");
    expression.split(" AND ").all(|part| {
        let part = alternatives(part);
        part.split(" OR ").any(|name| allowed.iter().any(|allowed| allowed == name.trim()))
    })
}

#[test]
fn every_licence_is_allowed() {
    let allowed = allowed();
    assert!(allowed.len() >= 5, "{allowed:?}");
    assert!(is_met("MIT/Apache-2.0", &allowed) && is_met("(MIT OR GPL-3.0) AND Unicode-3.0", &allowed));
    assert!(!is_met("GPL-3.0", &allowed) && !is_met("MIT AND GPL-3.0", &allowed) && !is_met("", &allowed));

    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    // Those of Linux; others' are downloaded by nobody who builds there.
    let words =
        ["metadata", "--format-version=1", "--locked", "--filter-platform=x86_64-unknown-linux-gnu", "--all-features"];
    let output = Command::new(cargo).args(words).current_dir(root()).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let metadata: Value = serde_json::from_slice(&output.stdout).unwrap();
    let packages = metadata["packages"].as_array().unwrap();
    assert!(packages.len() > 50, "{} packages", packages.len());
    for package in packages {
        let licence = package["license"].as_str().unwrap_or("");
        assert!(is_met(licence, &allowed), "{} is under `{licence}`; deny.toml allows {allowed:?}", package["name"]);
    }
}
