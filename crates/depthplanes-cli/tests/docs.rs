//! Every command in the docs is executed, and prints what the docs say; tables and links are checked.
//!
//! In ```console blocks a line `$ command` is run by the shell; the lines after it are its standard
//! output, where a line `...` stands for any number of lines. With DEPTHPLANES_GOLDEN=update the
//! outputs without a `...` are written anew.
#![cfg(unix)]

mod support;

use depthplanes::methods::METHODS;
use depthplanes::scene::{SCENES, SENSORS};
use depthplanes_io::encoding::ENCODINGS;
use depthplanes_io::formats::FORMATS;
use depthplanes_io::outputs::OUTPUTS;
use depthplanes_io::presets::SENSOR_PRESETS;
use std::path::{Path, PathBuf};
use std::sync::Mutex;
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

fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// Held by a test that may write documents.
static DOCUMENTS: Mutex<()> = Mutex::new(());

/// Whether the docs are to be written anew.
fn update() -> bool {
    std::env::var("DEPTHPLANES_GOLDEN").is_ok_and(|value| value == "update")
}

fn run_document(path: &Path) {
    let bench = Bench::new(&format!("docs_{}", path.file_stem().unwrap().display()));
    run_in(&bench, path);
}

fn run_in(bench: &Bench, path: &Path) {
    let text = std::fs::read_to_string(path).unwrap();
    let mut lines: Vec<String> = text.lines().map(String::from).collect();
    let mut outputs = Vec::new();
    for step in steps(&text) {
        let ran = shell(bench, &step.command);
        let fails = step.command.contains("# fails");
        assert_eq!(ran.code == Some(0), !fails, "{}: {ran:?}", step.command);
        let shown = if fails { &ran.err } else { &ran.out };
        let actual: Vec<String> = shown.lines().map(String::from).collect();
        let fixed = !step.expected.iter().any(|line| line == "...");
        if update() && fixed {
            outputs.push((step.lines, actual));
        } else {
            assert!(matches(&step.expected, &actual), "{}: {}\nprints\n{shown}", path.display(), step.command);
        }
    }
    if update() {
        for (range, output) in outputs.into_iter().rev() {
            lines.splice(range, output);
        }
        std::fs::write(path, lines.join("\n") + "\n").unwrap();
    }
}

/// Documents whose commands are run.
const WITH_COMMANDS: [&str; 21] = [
    "docs/cli.md",
    "docs/batch.md",
    "docs/live.md",
    "docs/robot.md",
    "docs/video.md",
    "docs/ngaf.md",
    "docs/planar.md",
    "docs/planar-sets.md",
    "docs/a-contrario.md",
    "docs/comparators.md",
    "docs/eval.md",
    "docs/paper.md",
    "docs/peers.md",
    "docs/results.md",
    "docs/curved.md",
    "docs/explain.md",
    "docs/noise.md",
    "docs/outlines.md",
    "docs/methods.md",
    "docs/formats.md",
    "README.md",
];

#[test]
fn the_commands_of_the_docs_print_what_the_docs_say() {
    let _alone = DOCUMENTS.lock();
    for document in WITH_COMMANDS {
        run_document(&root().join(document));
    }
}

/// The frames of the page on the first hour, and where they are among the recorded ones.
const FIRST_HOUR: [(&str, &str); 7] = [
    ("kinect.png", "gt_real/lpvo_hall_125.depth.png"),
    ("realsense.png", "realsense_polylidar/depth/00000000_1580908150203.png"),
    ("realsense.json", "realsense_polylidar/camera_intrinsic_rgb_424.json"),
    ("phone.png", "reports/other_size_256x192.png"),
    ("phone.csv", "reports/other_size_1920x1440.csv"),
    ("image.compressedDepth", "reports/depth_32FC1.compressedDepth"),
    ("network.png", "reports/relative_inverse16.png"),
];

#[test]
fn the_first_hour_goes_as_its_page_says() {
    let Some(data) = support::data() else { return };
    let _alone = DOCUMENTS.lock();
    let bench = Bench::new("docs_first_hour");
    for (name, file) in FIRST_HOUR {
        bench.write(name, &std::fs::read(data.join(file)).unwrap());
    }
    run_in(&bench, &root().join("docs/first-hour.md"));
}

#[test]
fn the_tables_of_formats_and_methods_are_the_libraries_tables() {
    let _alone = DOCUMENTS.lock();
    let formats = FORMATS.iter().filter(|format| format.name != "exr").map(|format| {
        let names: Vec<String> = format.extensions.iter().map(|extension| format!("`.{extension}`")).collect();
        format!("| {} | {} | {} |", format.name, names.join(" "), format.about)
    });
    let encodings =
        ENCODINGS.iter().map(|encoding| format!("| `{}` | {} | {} |", encoding.name, encoding.unit, encoding.about));
    let outputs =
        OUTPUTS.iter().map(|output| format!("| `--{}` | {} | {} |", output.name, output.extensions(), output.about));
    let path = root().join("docs/formats.md");
    let text = std::fs::read_to_string(&path).unwrap();
    let filled = fill(&text, "formats", "| format | names | about |", formats);
    let filled = fill(&filled, "encodings", "| encoding | unit | about |", encodings);
    let filled = fill(&filled, "outputs", "| flag | file | about |", outputs);
    written_or_equal(&path, &text, &filled);

    let path = root().join("docs/methods.md");
    let text = std::fs::read_to_string(&path).unwrap();
    let [heading, rows] = results();
    written_or_equal(&path, &text, &fill(&text, "methods", &heading[0], rows.iter().cloned()));

    let path = root().join("README.md");
    let text = std::fs::read_to_string(&path).unwrap();
    let short = rows.iter().map(|row| {
        let cells: Vec<&str> = row.split('|').map(str::trim).collect();
        format!("| {} | {} | {} |", cells[1], cells[2], cells[cells.len() - 2])
    });
    let filled = fill(&text, "real", "| method | surfaces whole | ms for a megapixel |", short);
    let latency = real_planar();
    assert!(filled.contains(&latency), "the README's latency is not that of docs/results.md: {latency}");
    written_or_equal(&path, &text, &filled);
}

/// The README's figures of `planar` on frames of real cameras, as docs/results.md has them.
fn real_planar() -> String {
    let text = std::fs::read_to_string(root().join("docs/results.md")).unwrap();
    let section = text.split("\n## ").find(|section| section.starts_with("real\n")).expect("the set `real`");
    let cells = |line: &str| line.split('|').map(|cell| cell.trim().to_string()).collect::<Vec<_>>();
    let line = |start: &str| cells(section.lines().find(|line| line.starts_with(start)).expect("a line of the table"));
    let (head, row) = (line("| method"), line("| planar"));
    let of = |name: &str| &row[head.iter().position(|cell| cell == name).expect("a column")];
    format!("it takes {} ms a frame ({} frames", of("ms"), of("maps"))
}

#[test]
fn what_the_page_of_cameras_says_to_type_exists() {
    let page = std::fs::read_to_string(root().join("docs/my-camera.md")).unwrap();
    let bench = Bench::new("docs_my_camera");
    let help = bench.run(&["detect", "--help"]).ok() + &bench.run(&["explain", "--help"]).ok();
    let words: Vec<&str> = page.split(|c: char| c.is_whitespace() || "`()|,;".contains(c)).collect();
    let mut flags = 0;
    for pair in words.windows(2).filter(|pair| pair[0].starts_with("--") && !pair[0].ends_with('-')) {
        let known = match pair[0] {
            "--encoding" => pair[1].is_empty() || ENCODINGS.iter().any(|encoding| encoding.name == pair[1]),
            "--preset" => pair[1].is_empty() || SENSOR_PRESETS.iter().any(|preset| preset.name == pair[1]),
            flag => help.contains(flag),
        };
        assert!(known, "{} {}", pair[0], pair[1]);
        flags += 1;
    }
    assert!(flags > 40, "{flags} flags");
}

#[test]
fn the_tables_of_synthetic_scenes_are_the_librarys_tables() {
    let _alone = DOCUMENTS.lock();
    let path = root().join("docs/cli.md");
    let text = std::fs::read_to_string(&path).unwrap();
    let row = |name: &str, about: &str| format!("| `{name}` | {about} |");
    let filled =
        fill(&text, "scenes", "| scene | what is there |", SCENES.iter().map(|scene| row(scene.name, scene.about)));
    let sensors = SENSORS.iter().map(|sensor| row(sensor.name, sensor.about));
    let filled = fill(&filled, "sensors", "| sensor | what it delivers |", sensors);
    written_or_equal(&path, &text, &filled);
}

fn written_or_equal(path: &Path, text: &str, filled: &str) {
    if update() {
        std::fs::write(path, filled).unwrap();
    } else {
        assert!(text == filled, "a table of {} is not that of the library; run `make golden`", path.display());
    }
}

/// Heading and rows of a table: each method with its correct planes on each set of docs/results.md, on frames of real
/// cameras the share of the labelled surfaces, and its time on the first.
fn results() -> [Vec<String>; 2] {
    let text = std::fs::read_to_string(root().join("docs/results.md")).unwrap();
    let mut heading = "| method |".to_string();
    let mut rows: Vec<String> = METHODS.iter().map(|method| format!("| `{}` |", method.name)).collect();
    let mut times = vec![String::new(); rows.len()];
    for section in text.split("\n## ").skip(1) {
        let cells = |line: &str| line.split('|').map(|cell| cell.trim().to_string()).collect::<Vec<_>>();
        let mut lines = section.lines().filter(|line| line.starts_with('|'));
        let head = cells(lines.next().expect("a table in each section"));
        let column = |name: &str| head.iter().position(|cell| cell == name);
        let (truth, what, correct, unit) = match (column("truth"), column("surfaces")) {
            (Some(truth), _) => (truth, "planes", column("correct").unwrap(), ""),
            (_, Some(surfaces)) => (surfaces, "surfaces", column("correct %").unwrap(), " %"),
            _ => continue, // a set without a truth
        };
        let (set, time) = (section.lines().next().unwrap(), column("ms/MP").unwrap());
        if set == "real-presets" {
            continue; // the frames of `real` again
        }
        let lines: Vec<Vec<String>> = lines.skip(1).map(cells).collect();
        heading += &format!(" {set}, {} {what} |", lines[0][truth]);
        for ((method, row), ms) in METHODS.iter().zip(&mut rows).zip(&mut times) {
            let line = lines.iter().find(|line| line[1] == method.name).expect("a row for each method");
            *row += &format!(" {}{unit} |", line[correct]);
            if ms.is_empty() {
                *ms = format!(" {} |", line[time]);
            }
        }
    }
    heading += " ms for a megapixel |";
    let whole = rows.into_iter().zip(times).map(|(row, ms)| row + &ms);
    [vec![heading], whole.collect()]
}

/// The text with a table between the markers of that name.
fn fill(text: &str, marker: &str, heading: &str, rows: impl Iterator<Item = String>) -> String {
    let (open, close) = (format!("<!-- {marker} -->\n"), format!("<!-- /{marker} -->"));
    let (before, rest) = text.split_once(&open).unwrap_or_else(|| panic!("no {open}"));
    let (_, after) = rest.split_once(&close).unwrap_or_else(|| panic!("no {close}"));
    let rows: Vec<String> = rows.collect();
    let rule = "|---".repeat(heading.matches('|').count() - 1) + "|";
    format!("{before}{open}{heading}\n{rule}\n{}\n{close}{after}", rows.join("\n"))
}

#[test]
fn links_of_the_docs_lead_to_files() {
    let mut links = 0;
    let others = [
        "docs/first-hour.md",
        "docs/my-camera.md",
        "docs/cameras.md",
        "docs/install.md",
        "docs/library.md",
        "docs/speed.md",
        "ARCHITECTURE.md",
        "CONTRIBUTING.md",
        "CHANGELOG.md",
        "docs/metrics.md",
        "docs/planes-schema.md",
        "docs/python.md",
        "docs/c.md",
        "docs/browser.md",
    ];
    for document in WITH_COMMANDS.into_iter().chain(others) {
        let path = root().join(document);
        let text = std::fs::read_to_string(&path).unwrap();
        let targets =
            text.split("](").chain(text.split("src=\"")).filter_map(|rest| rest.split([')', '"', '#']).next());
        for target in targets.filter(|target| target.ends_with(".md") || target.ends_with(".png")) {
            let made_later = target == "docs/paper-tables.md"; // by `make tables`
            assert!(made_later || path.with_file_name(target).exists(), "{document}: {target} is not there");
            links += 1;
        }
    }
    assert!(links > 15, "{links} links");
}
