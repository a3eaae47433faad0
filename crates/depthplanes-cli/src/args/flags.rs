//! Flags that several commands share, and those that come from the libraries' tables.

use super::help;
use crate::shard::Shard;
use clap::builder::{PossibleValue, PossibleValuesParser};
use clap::parser::ValueSource;
use clap::{Arg, ArgAction, ArgMatches, value_parser};
use depthplanes::methods::{METHODS, MethodInfo, Param};
use depthplanes_io::encoding::ENCODINGS;
use depthplanes_io::presets::SENSOR_PRESETS;
use std::ffi::OsString;
use std::path::PathBuf;

/// The words that stand for inputs.
pub(crate) struct Inputs {
    pub(crate) words: Vec<OsString>,
    /// Whether folders stand for the maps of their subfolders as well.
    pub(crate) recursive: bool,
}

impl Inputs {
    pub(super) fn from_matches(matches: &ArgMatches) -> Self {
        let words = matches.get_many::<OsString>("input").into_iter().flatten().cloned().collect();
        Inputs { words, recursive: matches.get_flag("recursive") }
    }
}

/// How the inputs are to be read, as given.
#[derive(Clone, Debug, Default)]
pub(crate) struct Reading {
    pub(crate) encoding: Option<String>,
    pub(crate) preset: Option<String>,
    pub(crate) scale: Option<f64>,
    pub(crate) depth_scale: Option<f64>,
    pub(crate) ray_distance: bool,
    pub(crate) intrinsics: Option<[f64; 4]>,
    pub(crate) camera: Option<PathBuf>,
    pub(crate) camera_size: Option<(usize, usize)>,
    pub(crate) rectified: Option<bool>,
    pub(crate) disparity: bool,
    pub(crate) swap_bytes: bool,
    pub(crate) baseline: Option<f64>,
    pub(crate) focal: Option<f64>,
    pub(crate) doffs: Option<f64>,
    pub(crate) missing: Option<f64>,
    pub(crate) valid_range: Option<[f64; 2]>,
    pub(crate) raw_size: Option<(usize, usize)>,
    pub(crate) raw_type: Option<String>,
    pub(crate) member: Option<String>,
    pub(crate) max_pixels: usize,
    pub(crate) max_bytes: usize,
    /// All of it in the words that were given.
    pub(crate) words: Vec<String>,
}

impl Reading {
    /// The flags on reading that these words are.
    ///
    /// # Errors
    /// Says which word is no such flag, or no value of its flag.
    pub(crate) fn from_words(words: &[String]) -> Result<Self, String> {
        let flags = clap::Command::new("flags").no_binary_name(true).disable_help_flag(true).args(reading());
        let matches = flags.try_get_matches_from(words).map_err(|error| {
            let message = error.to_string();
            let first = message.lines().next().unwrap_or_default();
            first.strip_prefix("error: ").unwrap_or(first).to_string()
        })?;
        Ok(Self::from_matches(&matches))
    }

    pub(super) fn from_matches(matches: &ArgMatches) -> Self {
        let number = |id| matches.get_one::<f64>(id).copied();
        let text = |id| matches.get_one::<String>(id).cloned();
        Reading {
            encoding: text("encoding"),
            preset: text("preset"),
            scale: number("scale"),
            depth_scale: number("depth-scale"),
            ray_distance: matches.get_flag("ray-distance"),
            intrinsics: matches.get_one("intrinsics").copied(),
            camera: matches.get_one("camera").cloned(),
            camera_size: matches.get_one("camera-size").copied(),
            rectified: matches.get_one("rectified").copied(),
            disparity: matches.get_flag("disparity"),
            swap_bytes: matches.get_flag("swap-bytes"),
            baseline: number("baseline"),
            focal: number("focal"),
            doffs: number("doffs"),
            missing: number("missing"),
            max_pixels: *matches.get_one("max-pixels").expect("it has a default"),
            max_bytes: *matches.get_one("max-bytes").expect("it has a default"),
            valid_range: matches.get_one("valid-range").copied(),
            raw_size: matches.get_one("raw-size").copied(),
            raw_type: text("raw-type"),
            member: text("member"),
            words: words_given(matches),
        }
    }
}

/// The flags on reading as they were given, with their values.
fn words_given(matches: &ArgMatches) -> Vec<String> {
    let mut words = Vec::new();
    for arg in reading() {
        let id = arg.get_id().as_str();
        if matches.value_source(id) != Some(ValueSource::CommandLine) {
            continue;
        }
        words.push(format!("--{id}"));
        if arg.get_action().takes_values() {
            words.extend(matches.get_raw(id).into_iter().flatten().map(|value| value.to_string_lossy().into_owned()));
        }
    }
    words
}

pub(super) fn inputs() -> [Arg; 2] {
    let input = Arg::new("input").value_name("INPUT").required(true).num_args(1..);
    let input = input.value_parser(value_parser!(OsString)).help(
        "Files, folders (all their maps, in natural order), patterns such as 'maps/*.png', \
         - for standard input, or scene:SPEC for a synthetic scene",
    );
    [input, switch("recursive", "Folders stand for the maps in their subfolders as well").help_heading("Input")]
}

pub(super) fn reading() -> Vec<Arg> {
    let encodings = ENCODINGS.iter().map(|encoding| PossibleValue::new(encoding.name).aliases(encoding.aliases));
    let presets = PossibleValuesParser::new(SENSOR_PRESETS.iter().map(|preset| preset.name));
    let listed = |arg: Arg| arg.hide_possible_values(true);
    let all = [
        listed(Arg::new("preset").value_parser(presets).value_name("SENSOR"))
            .help("A known sensor: its encoding, nominal camera and noise"),
        numbers::<4>("intrinsics", "FX,FY,CX,CY")
            .help("The camera: focal lengths and principal point, pixels")
            .long_help("The camera: focal lengths and principal point, pixels; FY below 0 means that y points up"),
        path("camera", "FILE").help("Camera file: ROS, OpenCV, RealSense, COLMAP, KITTI and many more"),
        listed(Arg::new("encoding").value_parser(PossibleValuesParser::new(encodings)).value_name("NAME"))
            .help("What the numbers mean; `depthplanes encodings` lists the names"),
        number("scale", "UNITS_PER_METRE")
            .help("Map units in a metre: 1000 for millimetres")
            .long_help("Map units in a metre, or what `depthplanes encodings` states as the encoding's scale"),
        number("depth-scale", "METRES").help("Metres in a map unit, instead of --scale: RealSense's depth scale"),
        switch("ray-distance", "The values are distances along the rays; they are turned into depth"),
        Arg::new("camera-size")
            .value_name("WxH")
            .value_parser(size)
            .help("Size of the picture that --intrinsics or --camera are for; they are scaled to the map"),
        Arg::new("rectified")
            .value_name("yes|no")
            .num_args(0..=1)
            .require_equals(true)
            .default_missing_value("yes")
            .value_parser(yes_or_no)
            .help("The map is of the rectified picture: lens distortion is ignored; --rectified=no: it is undone"),
        number("missing", "VALUE").help("A value that means `missing`, beside 0, NaN and the infinities"),
        numbers::<2>("valid-range", "LO,HI").help("Only values within this range, in map units, are valid"),
        switch("disparity", "The numbers are disparities; with --focal and --baseline they become metric"),
        number("focal", "PIXELS").help("Focal length of the stereo rig"),
        number("baseline", "METRES").help("Baseline of the stereo rig"),
        number("doffs", "PIXELS").help("Difference of the two principal points (Middlebury's doffs)"),
        Arg::new("raw-size").value_name("WxH").value_parser(size).help("Size of a headerless file"),
        Arg::new("raw-type").value_name("TYPE").requires("raw-size").help(
            "Sample type of a headerless file in numpy's words, such as uint16, uint16-be or float32; without it the \
             length of the file decides",
        ),
        Arg::new("member")
            .value_name("NAME")
            .help("Which of several maps: the array's name (NPZ), its index (NPY), the page (TIFF)"),
        switch("swap-bytes", "Swap the two bytes of 16-bit samples"),
        limit("max-pixels", MAX_PIXELS)
            .help("Refuse larger maps; `planar` needs 24 bytes of memory a pixel, with all outputs 64"),
        limit("max-bytes", MAX_BYTES).help("Refuse longer files, and maps that unpack to more"),
    ];
    all.into_iter().map(with_name_and_heading).collect()
}

/// The most pixels of a map unless the user says otherwise, 33.5 million: a gigabyte of memory.
pub(crate) const MAX_PIXELS: usize = 1 << 25;
/// The most bytes of a file, 537 million: 16 for each pixel of the largest map.
pub(crate) const MAX_BYTES: usize = 1 << 29;

/// A flag that takes a limit of what is read.
fn limit(id: &'static str, default: usize) -> Arg {
    Arg::new(id).value_name("N").default_value(default.to_string()).value_parser(|text: &str| {
        match text.parse::<usize>() {
            Ok(number) if number > 0 && number < 1 << 40 => Ok(number),
            _ => Err("accepted: a whole number from 1".to_string()),
        }
    })
}

/// Heading of the method and its parameters.
pub(super) const METHOD: &str = "Method";

/// A flag for each parameter of any method; methods share the flags of the names they share. Help shows those of some
/// methods alone. Whose a parameter is stands before its meaning, unless all of these have it and mean the same.
pub(super) fn method_parameters(shown: &[&'static MethodInfo]) -> Vec<Arg> {
    parameter_names().into_iter().map(|name| method_parameter(name, shown)).collect()
}

fn method_parameter(name: &'static str, shown: &[&'static MethodInfo]) -> Arg {
    let flag = number(name, "NUMBER").long(flag_name(name)).aliases(aliases(name)).help_heading(METHOD);
    let owners: Vec<(&str, &Param)> = shown.iter().flat_map(|method| owned(method, name)).collect();
    let Some(&(_, first)) = owners.first() else {
        let all = METHODS.iter().flat_map(|method| owned(method, name)).collect::<Vec<_>>();
        return flag.help(sentences(&all, false)).hide_short_help(true).hide_long_help(true);
    };
    let alike = owners.len() == shown.len() && owners.iter().all(|(_, param)| says(param) == says(first));
    flag.help(sentences(&owners, alike))
}

/// The other names of a parameter, which are flags as well; its help says so.
fn aliases(name: &str) -> Vec<&'static str> {
    let all = METHODS.iter().flat_map(|method| owned(method, name));
    let mut aliases: Vec<&str> = all.filter_map(|(_, param)| param.alias).collect();
    aliases.dedup();
    aliases
}

/// Meaning, unit and default.
fn says(param: &Param) -> (&str, &str, f64) {
    (param.meaning, param.unit, param.default)
}

fn owned(method: &'static MethodInfo, name: &str) -> Option<(&'static str, &'static Param)> {
    method.params.iter().find(|param| param.name == name).map(|param| (method.name, param))
}

/// A sentence for each meaning; whose it is stands before it, unless all have the same.
fn sentences(owners: &[(&str, &Param)], alike: bool) -> String {
    let mut meanings: Vec<(Vec<&str>, &Param)> = Vec::new();
    for &(method, param) in owners {
        match meanings.iter_mut().find(|(_, known)| says(known) == says(param)) {
            Some((methods, _)) => methods.push(method),
            None => meanings.push((vec![method], param)),
        }
    }
    let sentence = |(methods, param): &(Vec<&str>, &Param)| {
        let whose = if alike { String::new() } else { format!("{}: ", methods.join(", ")) };
        let alias = param.alias.map_or(String::new(), |alias| format!("; or --{}", flag_name(alias)));
        format!("{whose}{} [{}, default {}{alias}]", param.meaning, param.unit, param.default)
    };
    meanings.iter().map(sentence).collect::<Vec<_>>().join(" ")
}

/// The noise as a file, for methods that have the parameters for it.
pub(super) fn noise_table() -> Arg {
    path("noise-table", "FILE")
        .help("The noise of depth as CSV, by increasing range: lines of range,standard deviation in metres")
        .conflicts_with_all(["noise", "noise-growth"])
}

/// The parameters given on the command line, whichever method has them.
pub(super) fn parameters_given(matches: &ArgMatches) -> Vec<(&'static str, f64)> {
    let given = |name: &'static str| Some((name, *matches.get_one::<f64>(name)?));
    parameter_names().into_iter().filter_map(given).collect()
}

/// The path given for a flag, if one was.
pub(super) fn path_given(matches: &ArgMatches, id: &str) -> Option<PathBuf> {
    matches.get_one::<PathBuf>(id).cloned()
}

/// Each name once, in the order of the tables.
fn parameter_names() -> Vec<&'static str> {
    let mut names = Vec::new();
    for param in METHODS.iter().flat_map(|method| method.params) {
        if !names.contains(&param.name) {
            names.push(param.name);
        }
    }
    names
}

fn flag_name(parameter: &str) -> String {
    parameter.replace('_', "-")
}

/// A flag that takes a path.
pub(super) fn path(id: &'static str, value: &'static str) -> Arg {
    Arg::new(id).long(id).value_name(value).value_parser(value_parser!(PathBuf))
}

/// A flag without a value.
pub(super) fn switch(id: &'static str, help: &'static str) -> Arg {
    Arg::new(id).long(id).action(ArgAction::SetTrue).help(help)
}

/// More inputs at once, threads, runs or rows than anybody means.
const MOST: usize = 1_000_000;

/// What a source of a video is.
const SOURCE: &str = "A folder of maps, of TUM RGB-D, 7-Scenes or rosbag2; FILE.mcap or FILE.mcap:/topic; - for raw frames on standard \
                      input; scene:SPEC for a synthetic camera";

/// The source of a video.
pub(super) fn source() -> Arg {
    Arg::new("source").value_name("SOURCE").required(true).help(SOURCE)
}

/// Those of several videos.
pub(super) fn sources() -> Arg {
    let several = "With --out-dir several of them, and patterns such as 'walks/*.mcap'";
    source().num_args(1..).long_help(format!("{SOURCE}. {several}"))
}

/// A flag that takes a whole number from 1 to [`MOST`].
pub(super) fn count(id: &'static str, value: &'static str) -> Arg {
    Arg::new(id).long(id).value_name(value).value_parser(|text: &str| match text.parse::<usize>() {
        Ok(number) if (1..=MOST).contains(&number) => Ok(number),
        _ => Err(format!("accepted: a whole number from 1 to {MOST}")),
    })
}

/// A part of the inputs.
pub(super) fn shard() -> Arg {
    Arg::new("shard")
        .long("shard")
        .value_name("I/N")
        .value_parser(|text: &str| text.parse::<Shard>())
        .help("Work on the Ith of N parts of the inputs, for N runs on as many machines")
}

/// Going on where an earlier run ended.
pub(super) fn resume() -> Arg {
    switch("resume", "Go on where an earlier run of these words ended, by the manifest in --out-dir")
        .requires("out-dir")
}

/// A flag that takes a number of pixels, from 0.
pub(super) fn pixels(id: &'static str) -> Arg {
    Arg::new(id).long(id).value_name("PIXELS").value_parser(|text: &str| {
        text.parse::<usize>().map_err(|_| "accepted: a whole number of pixels from 0".to_string())
    })
}

/// A flag that takes a pixel.
pub(super) fn pixel(id: &'static str) -> Arg {
    Arg::new(id).long(id).value_name("U,V").value_parser(|text: &str| {
        let parts: Result<Vec<usize>, _> = text.split(',').map(|part| part.trim().parse()).collect();
        let pixel = parts.ok().and_then(|parts| <[usize; 2]>::try_from(parts).ok());
        pixel.ok_or_else(|| "accepted: column and row, two whole numbers from 0 with a comma between".to_string())
    })
}

/// A flag that takes a plane's label.
pub(super) fn label(id: &'static str, value: &'static str) -> Arg {
    Arg::new(id).long(id).value_name(value).value_parser(|text: &str| match text.parse::<u16>() {
        Ok(label) if label > 0 => Ok(label),
        _ => Err(format!("accepted: a whole number from 1 to {}", u16::MAX)),
    })
}

/// An argument that takes a number of any kind.
pub(super) fn number(id: &'static str, value: &'static str) -> Arg {
    Arg::new(id).value_name(value).allow_hyphen_values(true).value_parser(parse_number)
}

/// A flag that takes several numbers with commas between.
pub(super) fn numbers<const N: usize>(id: &'static str, value: &'static str) -> Arg {
    Arg::new(id).value_name(value).allow_hyphen_values(true).value_parser(|text: &str| {
        let parts = text.split(',').map(parse_number).collect::<Result<Vec<f64>, _>>()?;
        let given = parts.len();
        <[f64; N]>::try_from(parts).map_err(|_| {
            let were = if given == 1 { "was" } else { "were" };
            format!("accepted: {N} numbers with commas between and no blanks; {given} {were} given")
        })
    })
}

fn parse_number(text: &str) -> Result<f64, String> {
    text.trim().parse().map_err(|_| format!("`{text}` is not a number; accepted: numbers such as 2, 0.5 or 1e-3"))
}

fn yes_or_no(text: &str) -> Result<bool, String> {
    match text {
        "yes" => Ok(true),
        "no" => Ok(false),
        _ => Err("accepted: --rectified, --rectified=yes or --rectified=no".to_string()),
    }
}

fn size(text: &str) -> Result<(usize, usize), String> {
    let parts = text.split_once(['x', 'X']);
    let parsed = parts.and_then(|(width, height)| Some((width.parse().ok()?, height.parse().ok()?)));
    parsed.ok_or_else(|| "accepted: columns and rows, such as 640x480".to_string())
}

fn with_name_and_heading(arg: Arg) -> Arg {
    let id = arg.get_id().to_string();
    arg.help_heading(help::heading(&id)).long(id)
}
