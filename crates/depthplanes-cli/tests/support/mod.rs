//! The real program in an empty folder, with maps made on the spot.
#![allow(dead_code, reason = "each test file uses its own part")]

use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::time::{Duration, Instant};

/// An empty folder that belongs to one test.
pub struct Bench {
    pub folder: PathBuf,
}

impl Bench {
    pub fn new(name: &str) -> Self {
        let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
        let _ = std::fs::remove_dir_all(&folder);
        std::fs::create_dir_all(&folder).unwrap();
        Bench { folder }
    }

    /// A bench with `map.pgm`: two flat surfaces, 16 bits, millimetres.
    pub fn with_map(name: &str) -> Self {
        let bench = Bench::new(name);
        bench.write("map.pgm", &two_planes(1003));
        bench
    }

    pub fn write(&self, name: &str, bytes: &[u8]) {
        std::fs::write(self.folder.join(name), bytes).unwrap();
    }

    pub fn read(&self, name: &str) -> Vec<u8> {
        std::fs::read(self.folder.join(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
    }

    /// Everything in the folder, by name.
    pub fn names(&self) -> Vec<String> {
        names_in(&self.folder)
    }

    /// Runs the program with these words.
    pub fn run(&self, words: &[&str]) -> Ran {
        let output = self.command().args(words).stdin(Stdio::null()).output().unwrap();
        Ran::from(output)
    }

    /// Runs a line of the shell, in which `$DP` is the program.
    pub fn shell(&self, line: &str) -> Ran {
        let mut command = self.command_of("sh");
        command.args(["-c", line]).env("DP", env!("CARGO_BIN_EXE_depthplanes")).env_remove("RUST_BACKTRACE");
        Ran::from(command.stdin(Stdio::null()).output().unwrap())
    }

    /// Runs the program with these words, kills it once `report/rows.jsonl` has three rows, and lets it go on to the end:
    /// no row is made again, and of the same rows, `count`, a further run makes the same report.
    pub fn kill_and_go_on(&self, words: &[&str], count: usize) {
        let mut child = self.command().args(words).stdout(Stdio::null()).spawn().unwrap();
        let start = Instant::now();
        let kept = || std::fs::read_to_string(self.folder.join("report/rows.jsonl")).unwrap_or_default();
        while kept().matches('\n').count() < 3 && start.elapsed() < Duration::from_secs(60) {
            std::thread::sleep(Duration::from_millis(1));
        }
        child.kill().unwrap(); // SIGKILL: nothing is tidied up
        child.wait().unwrap();
        let before = kept();
        let whole = &before[..before.rfind('\n').map_or(0, |end| end + 1)];
        assert!(whole.lines().count() >= 3, "{before}");
        self.run(words).ok();
        assert!(kept().starts_with(whole), "a row was made again");
        let pages =
            || ["report.html", "report.md", "rows.csv", "rows.json"].map(|name| self.read(&format!("report/{name}")));
        let made = pages();
        let again = self.run(words);
        assert!(again.err.contains(&format!("{count} of {count} results are there already")), "{again:?}");
        assert!(pages() == made, "the report of the same rows is another");
    }

    pub fn command(&self) -> Command {
        self.command_of(env!("CARGO_BIN_EXE_depthplanes"))
    }

    /// Another program in the same folder.
    pub fn command_of(&self, program: &str) -> Command {
        let mut command = Command::new(program);
        command.current_dir(&self.folder).env("COLUMNS", "100").env_remove("CLICOLOR_FORCE");
        command
    }
}

pub fn names_in(folder: &Path) -> Vec<String> {
    let entries = folder.read_dir().unwrap();
    let mut names: Vec<String> = entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

/// How a run ended.
#[derive(Debug, PartialEq)]
pub struct Ran {
    pub code: Option<i32>,
    pub out: String,
    pub err: String,
}

impl From<Output> for Ran {
    fn from(output: Output) -> Self {
        let text = |bytes| String::from_utf8(bytes).unwrap();
        Ran { code: output.status.code(), out: text(output.stdout), err: text(output.stderr) }
    }
}

impl Ran {
    /// Standard output of a run that has to succeed.
    #[track_caller]
    pub fn ok(self) -> String {
        assert_eq!(self.code, Some(0), "{self:?}");
        self.out
    }

    /// Standard error of a run that has to fail with this exit code.
    #[track_caller]
    pub fn fails(self, code: i32) -> String {
        assert_eq!(self.code, Some(code), "{self:?}");
        assert!(self.err.starts_with("error:"), "{self:?}");
        assert!(!self.err.contains("panicked"), "{self:?}");
        self.err
    }
}

/// A 16-bit PGM, 32 x 24: the left half at `near`, the right half 500 further, one missing corner.
pub fn two_planes(near: u16) -> Vec<u8> {
    let value = |at: usize| match (at % 32, at / 32) {
        (u, v) if u < 4 && v < 4 => 0,
        (u, _) if u < 16 => near,
        _ => near + 500,
    };
    let mut bytes = b"P5 32 24 65535\n".to_vec();
    bytes.extend((0..32 * 24).flat_map(|at| value(at).to_be_bytes()));
    bytes
}

/// The folder of recorded maps: `DEPTHPLANES_DATA`, or `shared/data` beside a folder above this crate.
/// Without it the calling test is skipped, but for CI, where it fails.
pub fn data() -> Option<PathBuf> {
    let beside = || {
        let above = Path::new(env!("CARGO_MANIFEST_DIR")).ancestors().skip(1);
        above.map(|folder| folder.join("shared/data")).find(|data| data.join("MANIFEST.tsv").is_file())
    };
    let found = std::env::var_os("DEPTHPLANES_DATA").map(PathBuf::from).or_else(beside);
    if found.is_none() {
        assert!(std::env::var("CI").as_deref() != Ok("true"), "there is no data: set DEPTHPLANES_DATA");
        println!("skipped: there is no data, set DEPTHPLANES_DATA");
    }
    found
}
