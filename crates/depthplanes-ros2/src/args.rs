//! The command line of the node.

use clap::builder::PossibleValuesParser;
use clap::{Arg, ArgMatches, Command, value_parser};
use depthplanes::Intrinsics;
use depthplanes::methods::{METHODS, MethodInfo};
use depthplanes::noise::SensorNoise;
use depthplanes_io::presets::SENSOR_PRESETS;
use depthplanes_io::{ReadOptions, read_noise_table};
use depthplanes_ros2::Options;
use std::path::PathBuf;

/// What is wanted, of the words and of the environment; ends the program for `--help` and what is wrong.
pub(crate) fn parse() -> Result<Options, String> {
    let words = std::env::args_os().map(|word| word.to_string_lossy().into_owned());
    from_matches(&command().get_matches_from(flags(words)?))
}

/// The words with those behind `--ros-args` as flags: `-r __node:=NAME`, `-r depth:=/TOPIC`, `-p min_pixels:=500`.
fn flags(mut words: impl Iterator<Item = String>) -> Result<Vec<String>, String> {
    let (mut flags, mut is_ros) = (Vec::new(), false);
    while let Some(word) = words.next() {
        match word.as_str() {
            "--ros-args" => is_ros = true,
            "--" if is_ros => is_ros = false,
            "-r" | "--remap" | "-p" | "--param" if is_ros => flags.push(flag(&words.next().unwrap_or_default())?),
            _ if is_ros => return Err(format!("--ros-args {word}; accepted: -r NAME:=VALUE and -p NAME:=VALUE")),
            _ => flags.push(word),
        }
    }
    Ok(flags)
}

fn flag(assignment: &str) -> Result<String, String> {
    let (name, value) = assignment.split_once(":=").ok_or_else(|| {
        format!("--ros-args: `{assignment}`; accepted: NAME:=VALUE, such as __node:=NAME, __ns:=/NAME, depth:=/TOPIC")
    })?;
    let name = match name {
        "__node" => "name",
        "__ns" => "namespace",
        name => name,
    };
    Ok(format!("--{}={value}", name.replace('_', "-")))
}

fn command() -> Command {
    let defaults = Options::default();
    let topic = |id: &'static str| Arg::new(id).long(id).value_name("TOPIC");
    let listening = [
        topic("depth").default_value(defaults.depth).help("Depth images"),
        topic("camera-info").help("Their camera [default: camera_info beside the images]"),
        Arg::new("name").long("name").value_name("NAME").default_value(defaults.name).help("The node's name"),
        Arg::new("namespace").long("namespace").default_value(defaults.namespace).help("The node's namespace"),
        Arg::new("floor-frame")
            .long("floor-frame")
            .value_name("NAME")
            .default_value(defaults.floor_frame)
            .help("The floor's frame of coordinates in /tf"),
        Arg::new("domain-id")
            .long("domain-id")
            .value_name("N")
            .value_parser(value_parser!(u16))
            .help("The domain [default: ROS_DOMAIN_ID, or 0]"),
        Arg::new("localhost")
            .long("localhost")
            .action(clap::ArgAction::SetTrue)
            .help("Talk to programs on this machine only, as ROS_LOCALHOST_ONLY=1 does"),
    ];
    let presets = PossibleValuesParser::new(SENSOR_PRESETS.iter().map(|preset| preset.name));
    let reading = [
        Arg::new("preset")
            .long("preset")
            .value_name("SENSOR")
            .value_parser(presets)
            .hide_possible_values(true)
            .help("A known sensor: its noise, its nominal camera"),
        numbers::<4>("intrinsics", "FX,FY,CX,CY").help("The camera instead of --camera-info, pixels"),
        number("depth-scale", "METRES").help("Metres in a unit of 16-bit images [default: 0.001]"),
        Arg::new("rectified")
            .long("rectified")
            .value_name("yes|no")
            .num_args(0..=1)
            .require_equals(true)
            .default_missing_value("yes")
            .value_parser(["yes", "no"])
            .hide_possible_values(true)
            .help("Whether lens distortion is ignored, or undone"),
        number("missing", "VALUE").help("A value that means `missing`, beside 0 and NaN"),
        Arg::new("noise-table")
            .long("noise-table")
            .value_name("FILE")
            .value_parser(value_parser!(PathBuf))
            .help("The noise of depth as CSV: range,deviation in metres"),
    ];
    let ground = [
        numbers::<3>("up", "X,Y,Z").help("Up in the optical frame, 0,-1,0 if level; else estimated"),
        number("camera-height", "METRES").help("The camera's height, if it is known"),
    ];
    let running = [
        count("kept-frames").help("Frames for which a plane that is not seen keeps its id [default: 30]"),
        count("threads").help("Threads of a frame [default: 1]"),
    ];
    let names = PossibleValuesParser::new(METHODS.iter().map(|method| method.name));
    let method = Arg::new("method")
        .long("method")
        .value_name("NAME")
        .value_parser(names)
        .hide_possible_values(true)
        .default_value(defaults.method.name)
        .help("`depthplanes methods` lists them");
    let under = |heading: &'static str| move |arg: Arg| arg.help_heading(heading);
    Command::new("depthplanes-ros2")
        .about("A ROS 2 node: planes with lasting ids, floor and obstacles of a topic of depth images")
        .version(env!("CARGO_PKG_VERSION"))
        .args(listening.map(under("ROS")))
        .args(reading.map(under("Input")))
        .args(ground.map(under("Ground")))
        .args([method].map(under("Method")))
        .args(parameters())
        .args(running.map(under("Running")))
}

/// A flag for each parameter of any method. `-h` shows those that people set.
fn parameters() -> Vec<Arg> {
    let shown = ["noise", "min-pixels"];
    let flag = |name: &'static str| {
        let param =
            METHODS.iter().flat_map(|method| method.params).find(|param| param.name == name).expect("it is of them");
        let help = format!("{} [{}, default {}]", param.meaning, param.unit, param.default);
        number(name, "NUMBER").help(help).help_heading("Method").hide_short_help(!shown.contains(&name))
    };
    parameter_names().into_iter().map(flag).collect()
}

fn parameter_names() -> Vec<&'static str> {
    let mut names: Vec<&str> = METHODS.iter().flat_map(|method| method.params).map(|param| param.name).collect();
    names.sort_unstable();
    names.dedup();
    names
}

fn number(id: &'static str, value: &'static str) -> Arg {
    let long = id.replace('_', "-");
    Arg::new(id).long(long).value_name(value).allow_hyphen_values(true).value_parser(value_parser!(f64))
}

fn count(id: &'static str) -> Arg {
    Arg::new(id).long(id).value_name("N").value_parser(value_parser!(u32).range(1..=1_000_000))
}

/// A flag that takes several numbers with commas between.
fn numbers<const N: usize>(id: &'static str, value: &'static str) -> Arg {
    Arg::new(id).long(id).value_name(value).allow_hyphen_values(true).value_parser(|text: &str| {
        let parts: Option<Vec<f64>> = text.split(',').map(|part| part.trim().parse().ok()).collect();
        let parts = parts.and_then(|parts| <[f64; N]>::try_from(parts).ok());
        parts.ok_or_else(|| format!("accepted: {N} numbers with commas between and no blanks"))
    })
}

fn from_matches(matches: &ArgMatches) -> Result<Options, String> {
    let text = |id: &str| matches.get_one::<String>(id).cloned();
    let given = |name: &'static str| Some((name, *matches.get_one::<f64>(name)?));
    let defaults = Options::default();
    Ok(Options {
        depth: text("depth").unwrap_or(defaults.depth),
        camera_info: text("camera-info"),
        name: text("name").unwrap_or(defaults.name),
        namespace: text("namespace").unwrap_or(defaults.namespace),
        domain_id: matches.get_one("domain-id").copied().map_or_else(domain_of_environment, Ok)?,
        is_local: matches.get_flag("localhost") || std::env::var("ROS_LOCALHOST_ONLY").is_ok_and(|value| value == "1"),
        floor_frame: text("floor-frame").unwrap_or(defaults.floor_frame),
        read: read(matches)?,
        method: method(&text("method").unwrap_or_default())?,
        parameters: parameter_names().into_iter().filter_map(given).collect(),
        threads: matches.get_one::<u32>("threads").map_or(defaults.threads, |&threads| threads as usize),
        up: matches.get_one("up").copied(),
        camera_height_m: matches.get_one("camera-height").copied(),
        kept_frames: matches.get_one("kept-frames").copied().unwrap_or(defaults.kept_frames),
    })
}

fn method(name: &str) -> Result<&'static MethodInfo, String> {
    depthplanes::methods::find(name).map_err(|error| error.to_string())
}

fn domain_of_environment() -> Result<u16, String> {
    match std::env::var("ROS_DOMAIN_ID") {
        Ok(text) if !text.is_empty() => text
            .trim()
            .parse()
            .map_err(|_| format!("ROS_DOMAIN_ID is `{text}`; accepted: a whole number from 0 to 232")),
        _ => Ok(0),
    }
}

fn read(matches: &ArgMatches) -> Result<ReadOptions, String> {
    let camera = matches.get_one::<[f64; 4]>("intrinsics").map(|&[fx, fy, cx, cy]| Intrinsics::new(fx, fy, cx, cy));
    let table = matches.get_one::<PathBuf>("noise-table").map(read_noise_table).transpose();
    Ok(ReadOptions {
        preset: matches.get_one("preset").cloned(),
        intrinsics: camera.transpose().map_err(|error| error.to_string())?,
        depth_scale: matches.get_one("depth-scale").copied(),
        rectified: matches.get_one::<String>("rectified").map(|word| word == "yes"),
        missing: matches.get_one("missing").copied(),
        noise: table.map_err(|error| error.to_string())?.map(SensorNoise::Table),
        ..ReadOptions::default()
    })
}

#[cfg(test)]
mod tests {
    use super::flags;

    #[test]
    fn words_behind_ros_args_are_flags() {
        let of = |words: &str| flags(words.split(' ').map(String::from)).map(|flags| flags.join(" "));
        assert_eq!(
            of("node --threads 2 --ros-args -r __ns:=/a --remap __node:=b -p min_pixels:=9 -- --localhost").unwrap(),
            "node --threads 2 --namespace=/a --name=b --min-pixels=9 --localhost"
        );
        assert!(of("node --ros-args --log-level debug").unwrap_err().contains("accepted: -r NAME:=VALUE"));
        assert!(of("node --ros-args -r depth=/x").unwrap_err().contains("accepted: NAME:=VALUE"));
    }
}
