//! The command line: the only file that knows the argument parser (with args/ for its longer parts).
//!
//! In: the words after `depthplanes`. Out: a [`Command`] of plain values. The flags of methods,
//! outputs, encodings and presets come from the libraries' tables, so that a new row there is a new
//! flag here.

mod exit_codes;
mod flags;
mod help;
mod outputs;
mod serve;
mod several;
mod tips;
mod track;

use crate::failure::{Failure, exit_code};
use crate::shard::Shard;
use crate::terminal::plain;
use clap::{Arg, ArgMatches, builder::PossibleValuesParser, value_parser};
use depthplanes::methods::{self, METHODS, MethodInfo};
use depthplanes_io::outputs::{OUTPUTS, Output};
use exit_codes::EXIT_CODES;
use flags::path_given;
use std::ffi::OsString;
use std::io::Write;
use std::path::PathBuf;

pub(crate) use clap_complete::Shell;
pub(crate) use flags::{Inputs, Reading};
pub(crate) use serve::Serve;
pub(crate) use several::{Compare, Eval, Paper};
#[cfg(test)]
pub(crate) use track::TRACK_OUTPUTS;
pub(crate) use track::Track;

/// What the user wants.
pub(crate) enum Command {
    Detect(Box<Detect>),
    Explain(Box<Explain>),
    Floor(Box<Floor>),
    Inspect { inputs: Inputs, reading: Box<Reading>, json: bool },
    Noise { inputs: Inputs, reading: Box<Reading>, json: bool },
    Score(Score),
    Serve(Box<Serve>),
    Track(Box<Track>),
    Eval(Eval),
    Paper(Paper),
    Compare(Box<Compare>),
    Datasets,
    Demo { out_dir: PathBuf },
    Methods,
    Params { method: Option<&'static MethodInfo> },
    Formats,
    Encodings,
    Presets,
    Completions { shell: Shell },
    Man { out_dir: Option<PathBuf> },
}

/// `depthplanes detect`.
pub(crate) struct Detect {
    pub(crate) inputs: Inputs,
    pub(crate) reading: Reading,
    pub(crate) method: &'static MethodInfo,
    /// Parameters given, by flag; also those that the method does not have.
    pub(crate) parameters: Vec<(&'static str, f64)>,
    pub(crate) noise_table: Option<PathBuf>,
    pub(crate) outputs: Vec<(&'static Output, PathBuf)>,
    pub(crate) out_dir: Option<PathBuf>,
    /// The outputs that go into the folder; all that are possible if none is named.
    pub(crate) only: Vec<&'static Output>,
    /// One file for the planes of all inputs.
    pub(crate) table: Option<PathBuf>,
    /// The part of the inputs that is worked on.
    pub(crate) shard: Option<Shard>,
    /// Whether what an earlier run did is not done again.
    pub(crate) resume: bool,
    pub(crate) legend: bool,
    /// Angle in degrees and distance in metres within which coplanar planes are joined, if that is wanted.
    pub(crate) merge_coplanar: Option<[f64; 2]>,
    /// Tolerance of the planes' outlines, pixels, if they are wanted.
    pub(crate) outlines: Option<f64>,
    /// Pixels of the smallest hole that outlines keep.
    pub(crate) min_hole: usize,
    /// Whether surfaces that bend are wanted as well.
    pub(crate) curved: bool,
    pub(crate) json: bool,
    pub(crate) rows: usize,
    pub(crate) repeat: usize,
    pub(crate) jobs: usize,
    pub(crate) threads: usize,
}

impl Detect {
    /// Whether anything but standard output is written.
    pub(crate) fn writes_files(&self) -> bool {
        !self.outputs.is_empty() || self.out_dir.is_some() || self.table.is_some()
    }
}

/// `depthplanes explain`.
pub(crate) struct Explain {
    pub(crate) input: OsString,
    pub(crate) at: [usize; 2],
    pub(crate) reading: Reading,
    pub(crate) method: &'static MethodInfo,
    pub(crate) parameters: Vec<(&'static str, f64)>,
    pub(crate) noise_table: Option<PathBuf>,
    pub(crate) json: bool,
}

/// `depthplanes floor`.
pub(crate) struct Floor {
    pub(crate) inputs: Inputs,
    pub(crate) reading: Reading,
    pub(crate) method: &'static MethodInfo,
    pub(crate) parameters: Vec<(&'static str, f64)>,
    pub(crate) noise_table: Option<PathBuf>,
    /// Up in camera coordinates, if it is known.
    pub(crate) up: Option<[f64; 3]>,
    /// Height of the camera above the floor that it stands on, metres, if it is known.
    pub(crate) camera_height: Option<f64>,
    pub(crate) overlay: Option<PathBuf>,
    /// The occupancy grid's picture.
    pub(crate) grid: Option<PathBuf>,
    /// Metres of a cell's side, if stated.
    pub(crate) resolution: Option<f64>,
    pub(crate) json: bool,
    pub(crate) rows: usize,
}

/// `depthplanes score`.
pub(crate) struct Score {
    pub(crate) truth: OsString,
    pub(crate) prediction: OsString,
    pub(crate) tolerance: f64,
    pub(crate) truth_from: u16,
    pub(crate) json: bool,
}

/// Parses the command line; on wrong use, or where help is asked for, it prints that, and what is left is the exit code.
pub(crate) fn parse(words: Vec<OsString>) -> Result<Command, u8> {
    match program().try_get_matches_from(&words) {
        Ok(matches) => Ok(command(&matches)),
        Err(error) => Err(told(error, &words)),
    }
}

/// Prints help, or what is wrong with the words; the exit code for it.
fn told(error: clap::Error, words: &[OsString]) -> u8 {
    // The message shows words, and these may be names of files: said of words that steer no terminal.
    let words: Vec<String> = words.iter().map(|word| plain(&word.to_string_lossy()).into_owned()).collect();
    let error = program().try_get_matches_from(&words).err().unwrap_or(error);
    let error = tips::with_tip(error, &words);
    let printed = error.print().and_then(|()| std::io::stdout().flush());
    match printed {
        // Wrong use is wrong use even where nobody can be told.
        _ if error.use_stderr() => 2,
        printed => exit_code(printed.map_err(Failure::from)),
    }
}

/// What the user wants, by the words' meaning.
fn command(matches: &ArgMatches) -> Command {
    let (name, matches) = matches.subcommand().expect("a command is required");
    match name {
        "detect" => Command::Detect(Box::new(detect(matches))),
        "explain" => Command::Explain(Box::new(explain(matches))),
        "floor" => Command::Floor(Box::new(floor(matches))),
        "inspect" => Command::Inspect {
            inputs: Inputs::from_matches(matches),
            reading: Box::new(Reading::from_matches(matches)),
            json: matches.get_flag("json"),
        },
        "noise" => Command::Noise {
            inputs: Inputs::from_matches(matches),
            reading: Box::new(Reading::from_matches(matches)),
            json: matches.get_flag("json"),
        },
        "score" => Command::Score(score(matches)),
        "serve" => Command::Serve(Box::new(serve::from_matches(matches, method(matches).expect("it has a default")))),
        "track" => Command::Track(Box::new(track::from_matches(matches, method(matches).expect("it has a default")))),
        "eval" => Command::Eval(several::eval(matches)),
        "paper" => Command::Paper(several::paper(matches)),
        "compare" => Command::Compare(Box::new(several::compare(matches))),
        "datasets" => Command::Datasets,
        "demo" => Command::Demo { out_dir: path_given(matches, "out-dir").expect("it has a default") },
        "methods" => Command::Methods,
        "params" => Command::Params { method: method(matches) },
        "formats" => Command::Formats,
        "encodings" => Command::Encodings,
        "presets" => Command::Presets,
        "completions" => Command::Completions { shell: *matches.get_one("shell").expect("it is required") },
        "man" => Command::Man { out_dir: path_given(matches, "out-dir") },
        other => unreachable!("no command `{other}`"),
    }
}

/// Writes the completion script for a shell.
pub(crate) fn completions(shell: Shell, out: &mut dyn Write) {
    clap_complete::generate(shell, &mut program(), "depthplanes", &mut &mut *out);
}

/// The manual pages, one for the program and one for each command: (file name, contents).
pub(crate) fn man_pages() -> std::io::Result<Vec<(String, Vec<u8>)>> {
    let mut program = program().disable_help_subcommand(true);
    program.build();
    let mut pages = vec![program.clone()];
    pages.extend(program.get_subcommands().map(|command| {
        let name = command.get_display_name().unwrap_or(command.get_name()).to_string();
        command.clone().name(name)
    }));
    let page = |command: clap::Command| {
        let mut bytes = Vec::new();
        let man = clap_mangen::Man::new(command);
        man.render(&mut bytes).map(|()| (man.get_filename(), bytes))
    };
    pages.into_iter().map(page).collect()
}

fn program() -> clap::Command {
    let commands = [
        detect_command(),
        explain_command(),
        floor_command(),
        track::command(one_method()),
        serve::command(one_method()),
        inspect_command(),
        noise_command(),
        score_command(),
        several::compare_command(),
        several::eval_command(),
        several::paper_command(),
        clap::Command::new("datasets").about("Lists the sets of maps that `eval` knows, and how their folders look"),
        demo_command(),
        clap::Command::new("methods").about("Lists the methods"),
        clap::Command::new("params")
            .about("Lists the parameters of the methods: default, unit, range, meaning")
            .arg(method_arg("method").help("Only this method's")),
        clap::Command::new("formats").about("Lists the file formats that can be read"),
        clap::Command::new("encodings").about("Lists what a file's numbers can mean"),
        clap::Command::new("presets").about("Lists the sensors whose encoding and camera are known"),
        completions_command(),
        clap::Command::new("man")
            .about("Prints the manual page, or writes all of them to a folder")
            .arg(flags::path("out-dir", "DIR").help("Write one page for each command into this folder")),
    ]
    .map(help::with_short_page);
    clap::Command::new("depthplanes")
        .version(env!("CARGO_PKG_VERSION"))
        .about("Finds planes in depth and disparity maps.")
        .help_template(help::template(&commands))
        .after_help(FIRST_STEPS)
        .after_long_help(format!("{FIRST_STEPS}\n\n{EXIT_CODES}"))
        .subcommand_required(true)
        .arg_required_else_help(true)
        .subcommands(commands)
}

const FIRST_STEPS: &str = "First steps:
  depthplanes demo             a synthetic scene through the whole pipeline
  depthplanes inspect map.png  what is in a file, and the command to type next
  depthplanes detect map.png   the planes of a map
  depthplanes detect -h        the flags that most people need; `--help` shows all";

fn detect_command() -> clap::Command {
    clap::Command::new("detect")
        .about("Finds the planes of depth and disparity maps: as a table, or as files")
        .args(flags::inputs())
        .args(outputs::output_flags())
        .args(flags::reading())
        .args(one_method())
        .arg(outputs::merge_coplanar_flag())
        .args(outputs::running_flags())
}

fn explain_command() -> clap::Command {
    let input = Arg::new("input").value_name("INPUT").required(true).value_parser(value_parser!(OsString));
    clap::Command::new("explain")
        .about("Says why a pixel belongs to a plane or to none, and what to change")
        .arg(input.help("A file, - for standard input, or scene:SPEC for a synthetic scene"))
        .arg(flags::pixel("at").required(true).help("The pixel: column and row, from 0"))
        .args(flags::reading())
        .args(one_method())
        .arg(flags::switch("json", "Print one JSON document"))
}

fn floor_command() -> clap::Command {
    clap::Command::new("floor")
        .about("Finds the floor, how the camera stands above it, obstacles, steps, kinds of planes")
        .args(flags::inputs())
        .args(outputs::floor_flags())
        .args(flags::reading())
        .args(one_method())
}

/// The method, its parameters and the file that states its noise.
fn one_method() -> Vec<Arg> {
    let method = method_arg("method").long("method").default_value(methods::default().name).hide_possible_values(true);
    let mut all = vec![method.help("How to look for planes (`depthplanes methods`)")];
    all.extend(flags::method_parameters(&[methods::default()]));
    all.push(flags::noise_table());
    all.into_iter().map(|arg| arg.help_heading(flags::METHOD)).collect()
}

fn inspect_command() -> clap::Command {
    clap::Command::new("inspect")
        .about("Says what is in a file: values, likely encoding, what to type next")
        .args(flags::inputs())
        .args(flags::reading())
        .arg(flags::switch("json", "Print a JSON line for each input"))
}

fn noise_command() -> clap::Command {
    clap::Command::new("noise")
        .about("Estimates how noisy a sensor is from maps of it, and gives the flags for `detect`")
        .args(flags::inputs())
        .args(flags::reading())
        .arg(flags::switch("json", "Print one JSON document"))
}

fn score_command() -> clap::Command {
    let word = |id: &'static str| Arg::new(id).required(true).value_parser(value_parser!(OsString));
    clap::Command::new("score")
        .about("Scores label images against the truth: SegComp, EVOPS, Rand index and others")
        .after_long_help(EXIT_CODES)
        .args([
            word("truth").value_name("TRUTH").help(
                "Label image of the truth, 0 = no plane; a folder of them; or scene:SPEC for a synthetic scene's truth",
            ),
            word("prediction")
                .value_name("PRED")
                .help("Label image to score, as `detect --labels` writes it, or a folder with the same names"),
            flags::number("tolerance", "SHARE")
                .long("tolerance")
                .default_value("0.8")
                .help("SegComp: the share of a plane that an overlap must exceed, 0.51 to 0.95"),
            flags::label("truth-from", "LABEL")
                .default_value("1")
                .help("The lowest truth label that is a plane; SegComp's and SynPEB's truth has noise below 10"),
            flags::switch("json", "Print one JSON document"),
        ])
}

fn demo_command() -> clap::Command {
    let folder = flags::path("out-dir", "DIR").default_value("depthplanes-demo").help("Where the files go");
    clap::Command::new("demo").about("Runs a synthetic scene through the whole pipeline").arg(folder)
}

fn completions_command() -> clap::Command {
    let shell = Arg::new("shell").value_name("SHELL").required(true).value_parser(value_parser!(Shell));
    clap::Command::new("completions").about("Prints the completion script for a shell").arg(shell)
}

fn method_arg(id: &'static str) -> Arg {
    Arg::new(id).value_name("METHOD").value_parser(PossibleValuesParser::new(METHODS.iter().map(|method| method.name)))
}

fn detect(matches: &ArgMatches) -> Detect {
    let count = |name| *matches.get_one::<usize>(name).expect("it has a default");
    let outputs = OUTPUTS.iter().filter_map(|output| Some((output, path_given(matches, output.name)?)));
    Detect {
        inputs: Inputs::from_matches(matches),
        reading: Reading::from_matches(matches),
        method: method(matches).expect("it has a default"),
        parameters: flags::parameters_given(matches),
        noise_table: path_given(matches, "noise-table"),
        outputs: outputs.collect(),
        out_dir: path_given(matches, "out-dir"),
        only: only(matches),
        table: path_given(matches, "table"),
        shard: matches.get_one("shard").copied(),
        resume: matches.get_flag("resume"),
        legend: matches.get_flag("legend"),
        merge_coplanar: matches.get_one("merge-coplanar").copied(),
        outlines: matches.get_one("outlines").copied(),
        min_hole: matches.get_one("min-hole").copied().unwrap_or(0),
        curved: matches.get_flag("curved"),
        json: matches.get_flag("json"),
        rows: count("rows"),
        repeat: matches.get_one("repeat").copied().unwrap_or(0),
        jobs: count("jobs"),
        threads: count("threads"),
    }
}

fn explain(matches: &ArgMatches) -> Explain {
    Explain {
        input: matches.get_one::<OsString>("input").cloned().expect("it is required"),
        at: *matches.get_one("at").expect("it is required"),
        reading: Reading::from_matches(matches),
        method: method(matches).expect("it has a default"),
        parameters: flags::parameters_given(matches),
        noise_table: path_given(matches, "noise-table"),
        json: matches.get_flag("json"),
    }
}

fn floor(matches: &ArgMatches) -> Floor {
    Floor {
        inputs: Inputs::from_matches(matches),
        reading: Reading::from_matches(matches),
        method: method(matches).expect("it has a default"),
        parameters: flags::parameters_given(matches),
        noise_table: path_given(matches, "noise-table"),
        up: matches.get_one("up").copied(),
        camera_height: matches.get_one("camera-height").copied(),
        overlay: path_given(matches, "overlay"),
        grid: path_given(matches, "grid"),
        resolution: matches.get_one("resolution").copied(),
        json: matches.get_flag("json"),
        rows: *matches.get_one("rows").expect("it has a default"),
    }
}

fn score(matches: &ArgMatches) -> Score {
    let word = |id| matches.get_one::<OsString>(id).cloned().expect("it is required");
    Score {
        truth: word("truth"),
        prediction: word("prediction"),
        tolerance: *matches.get_one("tolerance").expect("it has a default"),
        truth_from: *matches.get_one("truth-from").expect("it has a default"),
        json: matches.get_flag("json"),
    }
}

fn method(matches: &ArgMatches) -> Option<&'static MethodInfo> {
    let name = matches.get_one::<String>("method")?;
    Some(methods::find(name).expect("the parser accepts only names of the table"))
}

/// The outputs named, in the order of the table.
fn only(matches: &ArgMatches) -> Vec<&'static Output> {
    let names: Vec<&String> = matches.get_many("only").into_iter().flatten().collect();
    OUTPUTS.iter().filter(|output| names.iter().any(|name| *name == output.name)).collect()
}

#[cfg(test)]
mod tests {
    #[test]
    fn the_command_line_is_consistent() {
        super::program().debug_assert();
    }
}
