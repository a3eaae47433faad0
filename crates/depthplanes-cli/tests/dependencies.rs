//! What the project is built from: crates of crates.io, which are kept up and whose licences are among those of `deny.toml`.
//! `make deny` asks the database of advisories as well.

use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::Command;

const LOCKS: [&str; 2] = ["Cargo.lock", "fuzz/Cargo.lock"];

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

/// One of them that a crate may ask for all the same: `paste`, which is run by the compiler and is in no program, for the
/// recordings of Rerun. `deny.toml` says the same.
const EXCEPTION: (&str, &str) = ("paste", "re_string_interner");

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

/// The crates of a lock file that ask for one.
fn askers<'a>(lock: &'a str, wanted: &str) -> Vec<&'a str> {
    let asks = |entry: &&str| {
        entry.lines().any(|line| {
            line.trim_start()
                .strip_prefix('"')
                .is_some_and(|line| line.trim_end_matches([',', '"']).split(' ').next() == Some(wanted))
        })
    };
    lock.split("[[package]]").filter(asks).map(|entry| values(entry, "name")[0]).collect()
}

#[test]
fn an_asker_is_found() {
    let lock = read("Cargo.lock");
    assert_eq!(askers(&lock, EXCEPTION.0), [EXCEPTION.1]);
    assert!(askers(&lock, "serde_json").len() > 5);
}

#[test]
fn no_crate_is_known_to_be_unmaintained() {
    for name in LOCKS {
        let lock = read(name);
        let crates = values(&lock, "name");
        assert!(crates.contains(&"depthplanes"), "{name}");
        for (unmaintained, advisory) in UNMAINTAINED {
            let askers = askers(&lock, unmaintained);
            let is_excepted = unmaintained == EXCEPTION.0 && askers.iter().all(|asker| *asker == EXCEPTION.1);
            assert!(
                !crates.contains(&unmaintained) || is_excepted,
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
