//! What to type instead of words that other programs take: the file alone, `-o`, a flag for each part of the camera, other
//! names of units and sensors.

use clap::builder::StyledStr;
use clap::error::{ContextKind, ContextValue, ErrorKind};

/// Flags of other programs, and what to type here.
const FLAGS: &[(&[&str], &str)] = &[
    (
        &["-o", "--output", "--out", "--save", "--outdir", "--output-dir"],
        "each kind of result has a flag of its own: --overlay FILE.png, --labels FILE.png, --planes FILE.csv, --json; --out-dir DIR \
         writes all of them",
    ),
    (
        &["--fx", "--fy", "--cx", "--cy", "-K", "-k", "--K", "--intrinsic"],
        "the camera is one flag: --intrinsics FX,FY,CX,CY",
    ),
    (&["--depth_scale", "--unit", "--units"], "the unit is stated as --scale (map units per metre) or --encoding"),
    (
        &["--max-depth", "--min-depth", "--max-range", "--min-range", "--zmin", "--zmax", "--clip", "--far", "--near"],
        "depths are limited in map units: --valid-range LO,HI",
    ),
    (
        &["--threshold", "--distance-threshold", "--inlier-distance", "--dist", "--eps", "--tolerance", "--sigma"],
        "`planar` tells planes apart by the noise of the map: --noise METRES or --noise-scale FACTOR; `depthplanes params METHOD` \
         lists the thresholds of a method",
    ),
    (
        &["--max-planes", "--num-planes", "--n-planes", "--nplanes", "--top", "--limit"],
        "all planes are found, the largest first: --min-pixels N leaves out small ones, --rows N shortens the printed table",
    ),
    (
        &["--iterations", "--max-iterations", "--num-iterations", "--iters", "--seed"],
        "`planar` has no iterations; `--method ransac` has: `depthplanes params ransac`",
    ),
    (
        &["--ply", "--pcd", "--points", "--pointcloud"],
        "point cloud and mesh are PLY files: --cloud FILE.ply, --mesh FILE.ply",
    ),
    (&["--csv", "--tsv"], "the planes as a table: --planes FILE.csv, or --table FILE.csv for those of all inputs"),
    (
        &["--png", "--mask", "--masks", "--segmentation"],
        "the planes as a picture: --overlay FILE.png, or --labels FILE.png",
    ),
    (
        &["--show", "--view", "--viz", "--visualize", "--visualise", "--plot", "--display"],
        "there is no window; a picture of the planes is written by --overlay FILE.png",
    ),
    (
        &["--format", "--type", "--dtype"],
        "formats are known by the content of files; what the numbers mean is --encoding, headerless samples have --raw-type",
    ),
    (
        &["--fov", "--hfov", "--vfov"],
        "the camera is stated as --intrinsics FX,FY,CX,CY; FX is columns / (2 tan(horizontal field / 2))",
    ),
    (&["--quiet", "-q", "--silent"], "notes go to standard error: add 2>/dev/null"),
    (&["--verbose", "-v", "--debug"], "`depthplanes inspect FILE` and `depthplanes explain FILE --at U,V` tell more"),
    (&["-i", "--input", "--depth", "-f", "--file"], "inputs need no flag: depthplanes detect FILE"),
    (&["--width", "--height", "-w", "--size"], "the size of headerless samples is one flag: --raw-size WxH"),
];

/// Values of other programs, the flag that they are given to, and what to type here.
const VALUES: &[(&str, &[&str], &str)] = &[
    (
        "--encoding",
        &["cm", "centimetre", "centimetres", "centimeter", "centimeters"],
        "for centimetres: --scale 100 (map units per metre)",
    ),
    ("--encoding", &["dm", "decimetre", "decimeter"], "for decimetres: --scale 10 (map units per metre)"),
    ("--encoding", &["inch", "inches", "in"], "for inches: --scale 39.3701 (map units per metre)"),
    ("--encoding", &["feet", "foot", "ft"], "for feet: --scale 3.28084 (map units per metre)"),
    (
        "--encoding",
        &["depth", "uint16", "16bit", "z"],
        "for 16-bit depth mostly --encoding millimetre; `depthplanes encodings` lists all",
    ),
    ("--encoding", &[], "`depthplanes encodings` says what each is"),
    (
        "--preset",
        &["kinect", "kinectv1", "kinect-v1", "xtion", "primesense", "asus"],
        "--preset kinect1 (Kinect v1, Xtion) or kinect2 (Kinect v2)",
    ),
    ("--preset", &["kinectv2", "kinect-v2", "kinect-one"], "--preset kinect2"),
    (
        "--preset",
        &["k4a", "azure", "kinect-azure", "femto", "orbbec"],
        "--preset azure-kinect, with --camera for its calibration",
    ),
    (
        "--preset",
        &["tum", "tum-freiburg1", "tum-freiburg2", "tum-freiburg3", "freiburg1", "freiburg2", "freiburg3"],
        "--preset tum-fr1, tum-fr2 or tum-fr3, by the number of the sequence",
    ),
    (
        "--preset",
        &["realsense", "d405", "d415", "d435", "d435i", "d455", "d457"],
        "--preset realsense-d4xx, with --intrinsics or --camera",
    ),
    ("--preset", &["l515"], "an L515 counts 1/4000 m: --scale 4000, with --intrinsics or --camera"),
    (
        "--preset",
        &["oak", "oak-d", "depthai", "zed", "zed2", "iphone", "ipad", "arkit", "lidar"],
        "it needs none: millimetres and metres are recognised; give --intrinsics or --camera",
    ),
    ("--preset", &["scannet", "structure-sensor"], "--preset structure"),
    ("--preset", &["icl", "icl-nuim", "iclnuim"], "--preset synthetic"),
    ("--preset", &["7scenes", "sevenscenes"], "--preset 7-scenes"),
    (
        "--preset",
        &["kitti", "sgbm", "opencv"],
        "disparity: --preset stereo, or --disparity with --encoding kitti or opencv",
    ),
    ("--preset", &[], "`depthplanes presets` says which sensor each is for"),
    ("--only", &["ply", "pcd", "points", "pointcloud"], "point cloud and mesh are PLY files: --only cloud,mesh"),
    ("--only", &["csv", "table"], "the planes as CSV: --only planes"),
    ("--only", &["png", "image", "picture"], "pictures: --only overlay,labels"),
];

/// The error with what to type instead, where that is known.
pub(super) fn with_tip(mut error: clap::Error, words: &[String]) -> clap::Error {
    let given = |kind| match error.get(kind) {
        Some(ContextValue::String(word)) => Some(word.clone()),
        _ => None,
    };
    let tip = match error.kind() {
        ErrorKind::InvalidSubcommand => given(ContextKind::InvalidSubcommand).and_then(|word| of_file(&word, words)),
        ErrorKind::UnknownArgument => given(ContextKind::InvalidArg).and_then(|word| of_flag(&word)),
        ErrorKind::InvalidValue => {
            let words = given(ContextKind::InvalidArg).zip(given(ContextKind::InvalidValue));
            words.and_then(|(flag, value)| of_value(&flag, &value))
        }
        _ => None,
    };
    if error.kind() == ErrorKind::UnknownArgument {
        // How to give the flag's name as a file's: nobody means that.
        error.remove(ContextKind::Suggested);
    }
    if let Some(tip) = tip {
        // What merely looks alike.
        error.remove(ContextKind::SuggestedArg);
        error.remove(ContextKind::SuggestedValue);
        error.insert(ContextKind::Suggested, ContextValue::StyledStrs(vec![StyledStr::from(tip)]));
    }
    error
}

/// A file, a folder or a scene in the place of a command.
fn of_file(word: &str, words: &[String]) -> Option<String> {
    let is_input = word.contains(['.', '/', '*', ':']) || std::path::Path::new(word).exists();
    let rest = words.get(1..).unwrap_or_default().join(" ");
    is_input.then(|| format!("to find its planes: depthplanes detect {rest}"))
}

fn of_flag(word: &str) -> Option<String> {
    let name = word.split('=').next().unwrap_or(word);
    FLAGS.iter().find(|(names, _)| names.contains(&name)).map(|(_, tip)| tip.to_string())
}

/// A word that is no value of a flag that takes names; a row without words is for all others.
fn of_value(flag: &str, value: &str) -> Option<String> {
    let (name, value) = (flag.split_whitespace().next().unwrap_or(flag), value.to_lowercase());
    let mut rows = VALUES.iter().filter(|(of, ..)| *of == name);
    rows.find(|(_, values, _)| values.is_empty() || values.contains(&value.as_str())).map(|(.., tip)| tip.to_string())
}
