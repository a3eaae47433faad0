//! The command line.

use crate::failure::{Failure, Outcome};
use clap::builder::PossibleValuesParser;
use clap::{Arg, ArgAction, ArgMatches, Command, value_parser};
use depthplanes::Intrinsics;
use depthplanes_io::ReadOptions;
use depthplanes_io::camera_file::read_camera;
use depthplanes_io::encoding::ENCODINGS;
use depthplanes_io::presets::SENSOR_PRESETS;
use depthplanes_video::StatedUp;
use std::path::PathBuf;

/// What is wanted.
pub(crate) struct Wanted {
    pub(crate) source: String,
    pub(crate) out: PathBuf,
    pub(crate) read: ReadOptions,
    pub(crate) floor: bool,
    pub(crate) up: StatedUp,
    pub(crate) camera_height_m: Option<f64>,
    /// The most frames that are read.
    pub(crate) frames: Option<u64>,
    pub(crate) kept_frames: Option<u32>,
    pub(crate) ignores_poses: bool,
}

/// What is wanted, of the words; ends the program for `--help` and for what is wrong with one of them.
///
/// # Errors
/// What is wrong with the words together, or with a file that they name.
pub(crate) fn parse() -> Outcome<Wanted> {
    from_matches(&command().get_matches())
}

fn command() -> Command {
    let presets = PossibleValuesParser::new(SENSOR_PRESETS.iter().map(|preset| preset.name));
    let encodings = PossibleValuesParser::new(ENCODINGS.iter().map(|encoding| encoding.name));
    let word = |id: &'static str, value: &'static str, accepted: PossibleValuesParser| {
        flag(id, value).value_parser(accepted).hide_possible_values(true)
    };
    let reading = [
        word("encoding", "NAME", encodings).help("What the numbers mean; `depthplanes encodings` lists them"),
        word("preset", "SENSOR", presets).help("A known sensor: its noise, its nominal camera"),
        flag("camera", "FILE").value_parser(value_parser!(PathBuf)).help("The camera's file"),
        numbers::<4>("intrinsics", "FX,FY,CX,CY").help("The camera, pixels"),
        flag("depth-scale", "METRES").value_parser(value_parser!(f64)).help("Metres in a unit of the maps"),
    ];
    let switch = |id: &'static str| Arg::new(id).long(id).action(ArgAction::SetTrue);
    let ground = [
        switch("floor").help("Find the floor and what is in the way as well"),
        numbers::<3>("up", "X,Y,Z").requires("floor").help("Up in camera coordinates; else as the source says it"),
        numbers::<3>("world-up", "X,Y,Z").requires("floor").conflicts_with("up").help("Up in the world of the poses"),
        flag("camera-height", "METRES")
            .requires("floor")
            .value_parser(value_parser!(f64))
            .help("The camera's height, if it is known"),
    ];
    let running = [
        count("frames").help("Stop after so many frames"),
        count("kept-frames").help("Frames for which a plane that is not seen keeps its id [default: 30]"),
        switch("ignore-poses").help("Estimate how the camera moves even where the source says it"),
    ];
    let under = |heading: &'static str| move |arg: Arg| arg.help_heading(heading);
    Command::new("depthplanes-rerun")
        .about("Records the planes of depth video for Rerun's viewer: map, ids, outlines, poses, floor")
        .version(env!("CARGO_PKG_VERSION"))
        .arg(Arg::new("source").value_name("SOURCE").required(true).help("Frames, as `depthplanes track` takes them"))
        .arg(flag("out", "FILE.rrd").required(true).value_parser(value_parser!(PathBuf)).help("The recording"))
        .args(reading.map(under("Input")))
        .args(ground.map(under("Ground")))
        .args(running.map(under("Running")))
}

fn flag(id: &'static str, value: &'static str) -> Arg {
    Arg::new(id).long(id).value_name(value).allow_hyphen_values(true)
}

fn count(id: &'static str) -> Arg {
    flag(id, "N").value_parser(value_parser!(u32).range(1..=1_000_000))
}

/// A flag that takes several numbers with commas between.
fn numbers<const N: usize>(id: &'static str, value: &'static str) -> Arg {
    flag(id, value).value_parser(|text: &str| {
        let parts: Option<Vec<f64>> = text.split(',').map(|part| part.trim().parse().ok()).collect();
        let parts = parts.and_then(|parts| <[f64; N]>::try_from(parts).ok());
        parts.ok_or_else(|| format!("accepted: {N} numbers with commas between and no blanks"))
    })
}

fn from_matches(matches: &ArgMatches) -> Outcome<Wanted> {
    let out = matches.get_one::<PathBuf>("out").cloned().expect("it is required");
    if !out.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("rrd")) {
        return Err(Failure::request(format!("--out {}; accepted: a file that ends in .rrd", out.display())));
    }
    let direction = |id: &str| matches.get_one::<[f64; 3]>(id).copied();
    let up = direction("up").map(StatedUp::Camera).or(direction("world-up").map(StatedUp::World));
    Ok(Wanted {
        source: matches.get_one::<String>("source").cloned().expect("it is required"),
        out,
        read: read(matches)?,
        floor: matches.get_flag("floor"),
        up: up.unwrap_or_default(),
        camera_height_m: matches.get_one("camera-height").copied(),
        frames: matches.get_one::<u32>("frames").map(|&frames| frames.into()),
        kept_frames: matches.get_one("kept-frames").copied(),
        ignores_poses: matches.get_flag("ignore-poses"),
    })
}

fn read(matches: &ArgMatches) -> Outcome<ReadOptions> {
    let mut read = ReadOptions {
        preset: matches.get_one("preset").cloned(),
        encoding: matches.get_one("encoding").cloned(),
        depth_scale: matches.get_one("depth-scale").copied(),
        ..ReadOptions::default()
    };
    if let Some(path) = matches.get_one::<PathBuf>("camera") {
        read = read.camera(&read_camera(path)?);
    }
    if let Some(&[fx, fy, cx, cy]) = matches.get_one::<[f64; 4]>("intrinsics") {
        read.intrinsics = Some(Intrinsics::new(fx, fy, cx, cy)?);
    }
    Ok(read)
}
