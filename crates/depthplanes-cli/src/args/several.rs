//! Commands that run several methods: `compare`, `eval`, `paper`.

use super::exit_codes::EXIT_CODES;
use super::flags::{self, Reading, path_given};
use clap::{Arg, ArgMatches, builder::PossibleValuesParser, value_parser};
use depthplanes::methods::{self, METHODS};
use std::ffi::OsString;
use std::path::PathBuf;

/// `depthplanes compare`.
pub(crate) struct Compare {
    pub(crate) input: OsString,
    pub(crate) reading: Reading,
    pub(crate) methods: Vec<String>,
    /// Parameters given, by flag; each goes to the methods that have it.
    pub(crate) parameters: Vec<(&'static str, f64)>,
    pub(crate) truth: Option<PathBuf>,
    pub(crate) truth_from: u16,
    pub(crate) picture: Option<PathBuf>,
    pub(crate) repeat: usize,
    pub(crate) threads: usize,
}

/// `depthplanes eval`.
pub(crate) struct Eval {
    pub(crate) datasets: Vec<String>,
    pub(crate) methods: Vec<String>,
    /// Parameters given, by flag; each goes to the methods that have it.
    pub(crate) parameters: Vec<(&'static str, f64)>,
    /// Commands of programs that run other people's methods.
    pub(crate) peers: Vec<String>,
    /// Folder of sets.
    pub(crate) data: Option<PathBuf>,
    pub(crate) report: PathBuf,
    pub(crate) repeat: usize,
    pub(crate) jobs: usize,
    pub(crate) threads: usize,
}

/// `depthplanes paper`.
pub(crate) struct Paper {
    /// What `ngaf` is compared with.
    pub(crate) methods: Vec<String>,
    /// Folder of the maps.
    pub(crate) data: Option<PathBuf>,
    pub(crate) report: PathBuf,
    pub(crate) repeat: usize,
    pub(crate) jobs: usize,
    pub(crate) threads: usize,
}

/// Some methods, all of them or one by default.
fn methods_flag(default: impl IntoIterator<Item = &'static str>) -> Arg {
    let names = METHODS.iter().map(|method| method.name);
    let flag = Arg::new("methods").long("methods").value_name("A,B,..").value_delimiter(',');
    flag.value_parser(PossibleValuesParser::new(names)).default_values(default).help("Methods to run")
}

pub(super) fn compare_command() -> clap::Command {
    let input = Arg::new("input").value_name("INPUT").required(true).value_parser(value_parser!(OsString));
    clap::Command::new("compare")
        .about("Runs several methods on one map: a table, and a picture of all side by side")
        .arg(input.help("A file, - for standard input, or scene:SPEC for a synthetic scene, which knows its truth"))
        .args(flags::reading())
        .arg(methods_flag(METHODS.iter().map(|method| method.name)))
        .args(flags::method_parameters(METHODS))
        .args([
            flags::path("picture", "FILE").help("Write the picture of all side by side (.png)"),
            flags::path("truth", "FILE")
                .help("Label image of the truth: adds scores to the table, and the truth to the picture"),
            flags::label("truth-from", "LABEL").default_value("1").help("The lowest truth label that is a plane"),
            flags::count("repeat", "N").default_value("5").help("Timed runs of each method, after a warm-up"),
            flags::count("threads", "N").default_value("1").help("Threads for each map"),
        ])
}

pub(super) fn eval_command() -> clap::Command {
    clap::Command::new("eval")
        .about("Runs methods over sets of maps and writes a report")
        .long_about(
            "Runs methods over sets of maps and writes a report; started again, it goes on where it was interrupted",
        )
        .args([
            Arg::new("datasets").value_name("SET").required(true).num_args(1..).help(
                "A set in the folder of sets, NAME=DIR, or scene:SPEC (seed=1-20 for twenty seeds); \
                 `depthplanes datasets` lists them",
            ),
            methods_flag([methods::default().name]),
            Arg::new("peers").long("peers").value_name("COMMAND").action(clap::ArgAction::Append).help(
                "A program that runs other people's methods on the same maps, such as `make peers` has; \
                 docs/eval.md says how one is written",
            ),
            flags::path("data", "DIR").help("Folder of sets"),
        ])
        .args(report_flags())
        .args(flags::method_parameters(METHODS))
}

pub(super) fn paper_command() -> clap::Command {
    clap::Command::new("paper")
        .about("Repeats the paper's experiments, and shows what its measures hide")
        .after_help(format!(
            "Maps that are not in DIR are replaced by synthetic ones, and the report says which. Without --data a checkout of \
             this project looks into shared/data beside it.\n\n{EXIT_CODES}"
        ))
        .args([
            methods_flag(METHODS.iter().map(|method| method.name)).help("Methods to compare `ngaf` with"),
            flags::path("data", "DIR").help("Folder of the paper's maps, as docs/paper.md lists them"),
        ])
        .args(report_flags())
}

/// Where a report goes, and how it is made.
fn report_flags() -> [Arg; 4] {
    [
        flags::path("report", "DIR")
            .required(true)
            .help("Folder for the report and for the results that an interrupted run continues from"),
        flags::count("repeat", "N").default_value("3").help("Timed runs of each method on each map, after a warm-up"),
        flags::count("jobs", "N").default_value("1").help("Maps worked on at the same time; times are truest with one"),
        flags::count("threads", "N").default_value("1").help("Threads for each map"),
    ]
}

pub(super) fn compare(matches: &ArgMatches) -> Compare {
    let count = |name| *matches.get_one::<usize>(name).expect("it has a default");
    Compare {
        input: matches.get_one::<OsString>("input").cloned().expect("it is required"),
        reading: Reading::from_matches(matches),
        methods: matches.get_many::<String>("methods").expect("it has a default").cloned().collect(),
        parameters: flags::parameters_given(matches),
        truth: path_given(matches, "truth"),
        truth_from: *matches.get_one("truth-from").expect("it has a default"),
        picture: path_given(matches, "picture"),
        repeat: count("repeat"),
        threads: count("threads"),
    }
}

pub(super) fn eval(matches: &ArgMatches) -> Eval {
    let texts = |name| matches.get_many::<String>(name).expect("it has a value").cloned().collect();
    let count = |name| *matches.get_one::<usize>(name).expect("it has a default");
    Eval {
        datasets: texts("datasets"),
        methods: texts("methods"),
        parameters: flags::parameters_given(matches),
        peers: matches.get_many::<String>("peers").into_iter().flatten().cloned().collect(),
        data: path_given(matches, "data"),
        report: path_given(matches, "report").expect("it is required"),
        repeat: count("repeat"),
        jobs: count("jobs"),
        threads: count("threads"),
    }
}

pub(super) fn paper(matches: &ArgMatches) -> Paper {
    let count = |name| *matches.get_one::<usize>(name).expect("it has a default");
    Paper {
        methods: matches.get_many::<String>("methods").expect("it has a default").cloned().collect(),
        data: path_given(matches, "data"),
        report: path_given(matches, "report").expect("it is required"),
        repeat: count("repeat"),
        jobs: count("jobs"),
        threads: count("threads"),
    }
}
