//! The flags of `detect` and `floor` that say what comes out, and how it runs.

use super::flags;
use clap::{Arg, ArgMatches, builder::PossibleValuesParser};
use depthplanes::Coplanar;
use depthplanes::outline::DEFAULT_TOLERANCE_PX;
use depthplanes_io::outputs::{OUTPUTS, Output, TableForm};
use depthplanes_video::StatedUp;

pub(super) fn output_flags() -> Vec<Arg> {
    let flag = |output: &'static Output| {
        let written = |about| format!("Write the {about} ({})", output.extensions());
        let short = output.about.split([':', ';', ',']).next().unwrap_or_default();
        flags::path(output.name, "FILE").help(written(short)).long_help(written(output.about))
    };
    let mut all: Vec<Arg> = OUTPUTS.iter().map(flag).collect();
    let names: Vec<String> = OUTPUTS.iter().map(|output| output.file.to_string()).collect();
    let only = Arg::new("only").long("only").value_name("A,B,..").value_delimiter(',').requires("out-dir");
    let only = only.value_parser(PossibleValuesParser::new(OUTPUTS.iter().map(|output| output.name)));
    all.extend([
        flags::path("out-dir", "DIR")
            .help("Write all outputs of each input into this folder")
            .long_help(format!("Write all outputs of each input into this folder, as INPUT.{}", names.join(", INPUT."))),
        only.hide_possible_values(true).help("With --out-dir: write only these, such as `overlay,planes`").long_help(
            format!("With --out-dir: write only these; names are {}", output_names()),
        ),
        flags::path("table", "FILE")
            .help(format!("Write the planes of all inputs into one file ({})", TableForm::extensions()))
            .long_help(format!(
                "Write the planes of all inputs into one file ({}): a row for each plane, in .jsonl a line for each input. Inputs \
                 that fail are left out and named",
                TableForm::extensions()
            )),
        flags::switch("legend", "Put a legend beside the overlay and numbers on its planes"),
        flags::switch(
            "curved",
            "Report curved surfaces as well: in the summary, in the JSON record and hatched on the overlay",
        ),
        outlines_flag(),
        flags::pixels("min-hole").requires("outlines").help(
            "With --outlines: fill holes of fewer pixels than this, in the mesh too; by default none are filled",
        ),
        flags::switch("json", "Print the record as JSON; one line for each of several inputs"),
        flags::count("rows", "N").default_value("20").help("Planes in the printed table"),
    ]);
    all.into_iter().map(|arg| arg.help_heading("Output")).collect()
}

fn output_names() -> String {
    OUTPUTS.iter().map(|output| output.name).collect::<Vec<_>>().join(", ")
}

pub(super) fn merge_coplanar_flag() -> Arg {
    let Coplanar { angle_deg, distance_m, .. } = Coplanar::default();
    let both = format!("{angle_deg},{distance_m}");
    let long = format!(
        "Join separate pieces of one plane whose normals differ by at most DEG degrees and whose middles lie \
         within M metres of each other's plane [default {both}]; needs unit and camera"
    );
    let flag = flags::numbers::<2>("merge-coplanar", "DEG,M").long("merge-coplanar");
    flag.num_args(0..=1)
        .require_equals(true)
        .default_missing_value(both)
        .help("Join separate pieces of one plane; needs unit and camera")
        .long_help(long)
        .help_heading(flags::METHOD)
}

fn outlines_flag() -> Arg {
    let long = format!(
        "Put the planes' outlines into the JSON record and onto the overlay, and simplify those of the mesh, \
         to within PX pixels [default {DEFAULT_TOLERANCE_PX}; 0 keeps every corner]"
    );
    // With `=`, so that the word after the flag is never taken for its value.
    let flag = flags::number("outlines", "PX").long("outlines").num_args(0..=1).require_equals(true);
    flag.default_missing_value(DEFAULT_TOLERANCE_PX.to_string())
        .help("Put outlines (polygons) into the JSON record and onto the overlay")
        .long_help(long)
}

pub(super) fn running_flags() -> Vec<Arg> {
    let all = [
        flags::count("jobs", "N").default_value("1").help("Inputs worked on at the same time"),
        flags::shard(),
        flags::resume()
            .conflicts_with_all(OUTPUTS.iter().map(|output| output.name).chain(["json", "repeat"]))
            .long_help(
                "Go on where an earlier run of these words ended: inputs that are done are left out, those that failed are \
                 tried again. --out-dir has the manifest, a line for each input, manifest.jsonl or manifest.I-of-N.jsonl",
            ),
        flags::count("threads", "N").default_value("1").help("Threads for each map; the answer does not depend on it"),
        flags::count("repeat", "N").help("Measure the detection alone, N times after a warm-up; truest with one job"),
    ];
    all.into_iter().map(|arg| arg.help_heading("Running")).collect()
}

/// What is known of the ground beforehand.
pub(super) fn ground_flags() -> [Arg; 2] {
    [
        flags::numbers::<3>("up", "X,Y,Z")
            .long("up")
            .help("Up in camera coordinates: x right, y down, z ahead; 0,-1,0 of a level camera; estimated without it")
            .long_help(
                "Up in camera coordinates (x right, y down, z ahead), of any length: 0,-1,0 of a level camera. It is what an \
                 accelerometer at rest measures, turned into the camera's axes; of a pose whose world has z up it is the third \
                 row of the rotation from camera to world. Without it up is estimated from the planes, for a camera that is \
                 upright to within 60 degrees",
            ),
        flags::number("camera-height", "METRES")
            .long("camera-height")
            .help("The camera's height, if it is known: of several levels the one nearest to it is the floor, not the lowest"),
    ]
}

/// Up in the world of a video's poses.
pub(super) fn world_up() -> Arg {
    flags::numbers::<3>("world-up", "X,Y,Z")
        .long("world-up")
        .conflicts_with("up")
        .help("Up in the world of the source's poses, such as 0,0,1: then up is known in every frame")
}

/// What [`ground_flags`] and [`world_up`] state of up.
pub(super) fn stated_up(matches: &ArgMatches) -> StatedUp {
    match (matches.get_one("world-up"), matches.get_one("up")) {
        (Some(&up), _) => StatedUp::World(up),
        (None, Some(&up)) => StatedUp::Camera(up),
        (None, None) => StatedUp::Nothing,
    }
}

pub(super) fn floor_flags() -> Vec<Arg> {
    let output = [
        flags::path("overlay", "FILE")
            .help("Write a picture (.png): the floor green, obstacles red, drops blue, and where the free floor ends"),
        flags::path("grid", "FILE")
            .help("Write the floor from above as a ROS map: a picture (.png, .pgm) and the YAML file beside it")
            .long_help(
                "Write the floor from above as a map that ROS' map_server reads: a picture (.png or .pgm), black where \
                 something stands or the floor falls, white where floor is seen and grey elsewhere, and beside it the YAML \
                 file of the same name. x is ahead of the camera, y to its left, and the origin below it",
            ),
        flags::number("resolution", "METRES")
            .long("resolution")
            .help("Side of a cell of --grid, 0.01 to 1; 0.05 without it")
            .requires("grid"),
        flags::switch("json", "Print one JSON document; one line for each of several inputs"),
        flags::count("rows", "N").default_value("20").help("Planes in the printed table"),
    ];
    let under = |heading: &'static str| move |arg: Arg| arg.help_heading(heading);
    ground_flags().into_iter().map(under("Ground")).chain(output.into_iter().map(under("Output"))).collect()
}
