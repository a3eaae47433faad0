//! `depthplanes track`: its flags and what they mean.

use super::flags::{self, Reading, path_given};
use super::outputs;
use crate::shard::Shard;
use clap::builder::PossibleValuesParser;
use clap::{Arg, ArgMatches, Command};
use depthplanes::methods::MethodInfo;
use depthplanes_video::StatedUp;
use std::path::PathBuf;

/// What a video can have in a folder of results.
pub(crate) const TRACK_OUTPUTS: [&str; 4] = ["lines", "mcap", "labels", "overlays"];

/// What is wanted of one video, or of many.
pub(crate) struct Track {
    pub(crate) sources: Vec<String>,
    pub(crate) reading: Reading,
    pub(crate) method: &'static MethodInfo,
    pub(crate) parameters: Vec<(&'static str, f64)>,
    pub(crate) noise_table: Option<PathBuf>,
    /// The file of a JSON line for each frame, or of a recording; `-` for standard output.
    pub(crate) out: Option<PathBuf>,
    /// The folder of label images.
    pub(crate) labels: Option<PathBuf>,
    /// The folder of pictures.
    pub(crate) overlays: Option<PathBuf>,
    /// The folder in which each video has a folder of results.
    pub(crate) out_dir: Option<PathBuf>,
    /// What is in these; all of [`TRACK_OUTPUTS`] if none is named.
    pub(crate) only: Vec<&'static str>,
    /// The part of the videos that is worked on.
    pub(crate) shard: Option<Shard>,
    /// Whether what an earlier run did is not done again.
    pub(crate) resume: bool,
    /// Whether the ground is wanted as well.
    pub(crate) floor: bool,
    pub(crate) up: StatedUp,
    pub(crate) camera_height: Option<f64>,
    /// Whether the newest frames are wanted, and others dropped.
    pub(crate) live: bool,
    /// Threads that find planes, if stated.
    pub(crate) jobs: Option<usize>,
    /// The most frames that are read.
    pub(crate) frames: Option<u64>,
    pub(crate) kept_frames: Option<u32>,
    pub(crate) ignore_poses: bool,
}

impl Track {
    /// Whether the pictures of the frames are wanted.
    pub(crate) fn draws(&self) -> bool {
        self.overlays.is_some() || self.out_dir.is_some() && (self.only.is_empty() || self.only.contains(&"overlays"))
    }
}

/// The command; `method` has the flags of the method.
pub(super) fn command(method: Vec<Arg>) -> Command {
    let output = [
        flags::path("out", "FILE").help(
            "Write a JSON line for each frame (.jsonl, or - for standard output), or a recording for Foxglove (.mcap)",
        ),
        flags::path("labels", "DIR")
            .help("Write a label image for each frame into this folder: pixels have their plane's id"),
        flags::path("overlays", "DIR")
            .help("Write a picture for each frame into this folder; with --floor of the ground"),
        flags::path("out-dir", "DIR")
            .help("Write all of this for each of several videos, into a folder of this one")
            .long_help(
                "Write all of this for each of several videos, into a folder of this one that has the video's name: planes.jsonl, \
                 planes.mcap, labels, overlays. A video has its folder once all of it is done",
            )
            .conflicts_with_all(["out", "labels", "overlays", "live"]),
        Arg::new("only").long("only").value_name("A,B,..").value_delimiter(',').requires("out-dir")
            .value_parser(PossibleValuesParser::new(TRACK_OUTPUTS))
            .hide_possible_values(true)
            .help(format!("With --out-dir: write only these, of {}", TRACK_OUTPUTS.join(", "))),
        flags::switch("floor", "Find the floor, obstacles and steps of each frame too; they go into its line"),
    ];
    let running = [
        flags::switch("live", "Drop frames rather than fall behind: the newest ones are wanted"),
        flags::count("jobs", "N")
            .help("Frames searched at the same time; changes no result [default: cores, at most 4 for a video]"),
        flags::shard().requires("out-dir"),
        flags::resume()
            .long_help(
                "Go on where an earlier run of these words ended: videos that are done are left out, those that failed are \
                 tried again. --out-dir has the manifest, a line for each video, manifest.jsonl or manifest.I-of-N.jsonl",
            ),
        flags::count("frames", "N").help("Stop after so many frames"),
        flags::count("kept-frames", "N").help("Frames for which a plane that is not seen keeps its id [default: 30]"),
        flags::switch("ignore-poses", "Estimate how the camera moves even where the source says it"),
    ];
    let under = |heading: &'static str| move |arg: Arg| arg.help_heading(heading);
    Command::new("track")
        .about("Follows planes through depth video: lasting ids, floor and obstacles frame by frame")
        .arg(flags::sources())
        .args(output.map(under("Output")))
        .args(outputs::ground_flags().map(|arg| arg.requires("floor")).map(under("Ground")))
        .arg(outputs::world_up().requires("floor").help_heading("Ground"))
        .args(flags::reading())
        .args(method)
        .args(running.map(under("Running")))
}

pub(super) fn from_matches(matches: &ArgMatches, method: &'static MethodInfo) -> Track {
    let count = |id| matches.get_one::<usize>(id).copied();
    let only: Vec<&String> = matches.get_many("only").into_iter().flatten().collect();
    Track {
        sources: matches.get_many::<String>("source").expect("it is required").cloned().collect(),
        reading: Reading::from_matches(matches),
        method,
        parameters: flags::parameters_given(matches),
        noise_table: path_given(matches, "noise-table"),
        out: path_given(matches, "out"),
        labels: path_given(matches, "labels"),
        overlays: path_given(matches, "overlays"),
        out_dir: path_given(matches, "out-dir"),
        only: TRACK_OUTPUTS.into_iter().filter(|name| only.iter().any(|given| given == name)).collect(),
        shard: matches.get_one("shard").copied(),
        resume: matches.get_flag("resume"),
        floor: matches.get_flag("floor"),
        up: outputs::stated_up(matches),
        camera_height: matches.get_one("camera-height").copied(),
        live: matches.get_flag("live"),
        jobs: count("jobs"),
        frames: count("frames").map(|frames| frames as u64),
        kept_frames: count("kept-frames").map(|frames| frames as u32),
        ignore_poses: matches.get_flag("ignore-poses"),
    }
}
