//! What `make dist` packs, made from the tests' own program: the same bytes each time, each thing at its place.
#![cfg(target_os = "linux")]

mod support;

use std::collections::BTreeSet;
use std::path::Path;
use std::process::Command;
use support::Bench;

fn root() -> &'static Path {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../.."))
}

/// Standard output of a program that ends well.
fn printed(program: &str, words: &[&str]) -> String {
    let output = Command::new(program).args(words).output().unwrap_or_else(|error| panic!("{program}: {error}"));
    assert!(output.status.success(), "{program} {words:?}: {}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8_lossy(&output.stdout).into_owned()
}

/// Packs a small script that runs the tests' program into a folder of the bench; returns the names of the packages.
fn pack(bench: &Bench, folder: &str) -> Vec<String> {
    use std::os::unix::fs::PermissionsExt;
    bench.write("program", format!("#!/bin/sh\nexec '{}' \"$@\"\n", env!("CARGO_BIN_EXE_depthplanes")).as_bytes());
    let program = bench.folder.join("program");
    std::fs::set_permissions(&program, std::fs::Permissions::from_mode(0o755)).unwrap();
    let folder = bench.folder.join(folder);
    let mut command = Command::new("scripts/pack");
    let output =
        command.args([&program, &folder]).current_dir(root()).env("SOURCE_DATE_EPOCH", "1700000000").output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let mut names: Vec<_> =
        folder.read_dir().unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

/// Manual pages of the program and of all its commands.
fn pages(bench: &Bench) -> BTreeSet<String> {
    assert_eq!(bench.run(&["man", "--out-dir", "pages"]).code, Some(0));
    bench
        .folder
        .join("pages")
        .read_dir()
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect()
}

#[test]
fn the_packages_hold_what_they_should_and_are_the_same_each_time() {
    let bench = Bench::new("packages");
    let names = pack(&bench, "first");
    assert_eq!(names, pack(&bench, "second"));
    for name in &names {
        assert!(bench.read(&format!("first/{name}")) == bench.read(&format!("second/{name}")), "{name} differs");
    }
    let page = std::fs::read_to_string(root().join("docs/install.md")).unwrap();
    for name in &names {
        assert!(page.contains(&format!("`{name}`")), "docs/install.md does not name {name}");
    }
    let pages = pages(&bench);
    assert!(pages.len() > 10, "{pages:?}");

    let version = env!("CARGO_PKG_VERSION");
    let top = format!("depthplanes-{version}-x86_64-linux");
    assert_eq!(names[0], format!("{top}.tar.gz"));
    let archive = bench.folder.join("first").join(&names[0]);
    let listed = printed("tar", &["tzf", archive.to_str().unwrap()]);
    let own = ["depthplanes", "README.md", "CHANGELOG.md", "LICENSE-MIT", "LICENSE-APACHE", "THIRD-PARTY"]
        .map(str::to_string);
    let completions =
        ["depthplanes.bash", "_depthplanes", "depthplanes.fish"].map(|name| format!("completions/{name}"));
    let manuals = pages.iter().map(|page| format!("man/{page}"));
    let expected: BTreeSet<_> =
        own.into_iter().chain(completions).chain(manuals).map(|name| format!("{top}/{name}")).collect();
    let files = listed.lines().filter(|name| !name.ends_with('/')).map(str::to_string);
    assert_eq!(files.collect::<BTreeSet<_>>(), expected);

    let licences = printed("tar", &["xzOf", archive.to_str().unwrap(), &format!("{top}/THIRD-PARTY")]);
    for linked in ["musl, ", "clap 4", "exr 1", "rayon 1"] {
        assert!(licences.contains(&format!("\n{linked}")), "no licence of {linked}");
    }
    assert!(licences.contains("THE SOFTWARE IS PROVIDED") && !licences.contains("\ndepthplanes"));

    // Made where there is Debian's dpkg-deb.
    let Some(package) = names.get(1) else { return };
    assert_eq!(package, &format!("depthplanes_{version}_amd64.deb"));
    let package = bench.folder.join("first").join(package);
    let package = package.to_str().unwrap();
    let share = [
        "bash-completion/completions/depthplanes",
        "doc/depthplanes/README.md",
        "doc/depthplanes/THIRD-PARTY.gz",
        "doc/depthplanes/changelog.gz",
        "doc/depthplanes/copyright",
        "fish/vendor_completions.d/depthplanes.fish",
        "lintian/overrides/depthplanes",
        "zsh/vendor-completions/_depthplanes",
    ];
    let manuals = pages.iter().map(|page| format!("./usr/share/man/man1/{page}.gz"));
    let expected = share.iter().map(|name| format!("./usr/share/{name}")).chain(manuals);
    let expected: BTreeSet<_> = expected.chain(["./usr/bin/depthplanes".to_string()]).collect();
    let listed = printed("dpkg-deb", &["--contents", package]);
    let files = listed.lines().filter(|line| line.starts_with('-'));
    // Root's, and of the stated time.
    assert!(files.clone().all(|line| line.contains(" root/root ") && line.contains(" 2023-11-1")), "{listed}");
    assert_eq!(
        files.map(|line| line.split_whitespace().last().unwrap().to_string()).collect::<BTreeSet<_>>(),
        expected
    );
    assert_eq!(printed("dpkg-deb", &["--field", package, "Version"]).trim(), version);
}
