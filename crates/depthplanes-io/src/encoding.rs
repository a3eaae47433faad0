//! What a map's numbers mean: unit, bit packing, the value for "missing".
//!
//! In: an [`Image`] and what the user knows. Out: the same image, unpacked only where the encoding
//! packs bits (`kinect-sdk`, `sun-rgbd`) or spreads bytes over channels (`packed.rs`), and its [`Meaning`]. Integer maps
//! otherwise keep the numbers that are in the file, because the paper's threshold counts grey levels.

use depthplanes::ValueKind;

use crate::error::{Error, Result};
use crate::formats::{self, Image};
use crate::frame::Pixels;
use crate::packed::{self, Packing};
pub use crate::stereo::Stereo;

/// What the user says beside the encoding's name.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Given {
    /// The encoding's scale; what it counts is [`Encoding::scale`].
    pub scale: Option<f64>,
    /// The stereo rig, for encodings of disparity.
    pub stereo: Option<Stereo>,
}

/// The numbers of one map, explained.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Meaning {
    /// Depth, inverse depth or disparity.
    pub value_kind: ValueKind,
    /// Smallest and largest valid value, map units, where the encoding limits them.
    pub valid_range: Option<(f64, f64)>,
}

/// One encoding.
#[derive(Clone, Copy, Debug)]
pub struct Encoding {
    /// Its name, as in [`crate::Frame::encoding`].
    pub name: &'static str,
    /// Other names of it.
    pub aliases: &'static [&'static str],
    /// One line for the table of encodings.
    pub about: &'static str,
    /// What a map value counts.
    pub unit: &'static str,
    /// What the option `scale` counts, with its default; empty if there is none to state.
    pub scale: &'static str,
    /// The value for "missing" beside 0, NaN and the infinities.
    pub missing: Option<f64>,
    /// Whether the values are disparities, which need a [`Stereo`] rig to become metres.
    pub disparity: bool,
    /// Whether a value is spread over the channels of a picture.
    pub channels: bool,
    /// Whether the numbers of the map are others than those of the file, or may be: bits are packed, bytes swapped.
    pub unpacks: bool,
    /// Unpacks the image and explains it.
    pub apply: fn(&mut Image, &Given) -> Result<Meaning>,
}

const DEPTH: Encoding = Encoding {
    name: "millimetre",
    aliases: &["mm", "millimetres", "millimeter", "millimeters", "openni"],
    about: "depth in millimetres: OpenNI, ROS 16UC1, Kinect v2, Azure Kinect, 7-Scenes",
    unit: "mm",
    scale: "map units per metre, 1000",
    missing: None,
    disparity: false,
    channels: false,
    unpacks: false,
    apply: |image, given| depth(image, given.scale.unwrap_or(1000.0)),
};

const DISPARITY: Encoding = Encoding {
    name: "disparity",
    aliases: &[],
    about: "disparity in pixels",
    unit: "px",
    scale: "map units per pixel of disparity, 1",
    missing: None,
    disparity: true,
    channels: false,
    unpacks: false,
    apply: |image, given| disparity(image, given, given.scale.unwrap_or(1.0)),
};

/// Bytes of millimetres in several channels.
const SPREAD: Encoding = Encoding { channels: true, unpacks: true, ..DEPTH };

/// All encodings.
pub const ENCODINGS: &[Encoding] = &[
    DEPTH,
    Encoding {
        name: "metre",
        aliases: &["m", "metres", "meter", "meters"],
        about: "depth in metres: ROS 32FC1, most files of floats",
        unit: "m",
        scale: "map units per metre, 1",
        apply: |image, given| depth(image, given.scale.unwrap_or(1.0)),
        ..DEPTH
    },
    Encoding {
        name: "tum",
        aliases: &["icl", "icl-nuim"],
        about: "depth in 1/5000 m: TUM RGB-D, ICL-NUIM",
        unit: "1/5000 m",
        scale: "map units per metre, 5000",
        apply: |image, given| depth(image, given.scale.unwrap_or(5000.0)),
        ..DEPTH
    },
    Encoding {
        name: "realsense",
        aliases: &["z16"],
        about: "RealSense Z16: depth in the camera's depth units; state what its get_depth_scale says as --depth-scale",
        unit: "depth unit",
        scale: "map units per metre, 1000",
        apply: |image, given| depth(image, given.scale.unwrap_or(1000.0)),
        ..DEPTH
    },
    Encoding {
        name: "kinect-sdk",
        aliases: &[],
        about: "Kinect SDK 1: millimetres above three bits of player index",
        unit: "mm",
        scale: "",
        unpacks: true,
        apply: |image, given| unpacked("kinect-sdk", image, given, |value| value >> 3),
        ..DEPTH
    },
    Encoding {
        name: "sun-rgbd",
        aliases: &["sun"],
        about: "SUN RGB-D: millimetres, bits rotated left by three",
        unit: "mm",
        scale: "",
        unpacks: true,
        apply: |image, given| unpacked("sun-rgbd", image, given, |value| value.rotate_right(3)),
        ..DEPTH
    },
    Encoding {
        name: "kinect-raw",
        aliases: &["freenect"],
        about: "Kinect v1 raw 11-bit disparity, 2047 = missing",
        unit: "raw disparity",
        scale: "",
        missing: Some(2047.0),
        unpacks: true,
        apply: kinect_raw,
        ..DEPTH
    },
    DISPARITY,
    Encoding {
        name: "kitti",
        aliases: &[],
        about: "16-bit disparity in 1/256 pixel: KITTI, many stereo programs",
        unit: "1/256 px",
        scale: "map units per pixel of disparity, 256",
        apply: |image, given| disparity(image, given, given.scale.unwrap_or(256.0)),
        ..DISPARITY
    },
    Encoding {
        name: "opencv",
        aliases: &["sgbm"],
        about: "disparity in 1/16 pixel: OpenCV's matchers; -16 or 65520 = missing",
        unit: "1/16 px",
        scale: "map units per pixel of disparity, 16",
        missing: Some(65_520.0),
        apply: |image, given| disparity(image, given, given.scale.unwrap_or(16.0)),
        ..DISPARITY
    },
    Encoding {
        name: "middlebury",
        aliases: &["eth3d"],
        about: "Middlebury disparity: float pixels (PFM), or integers with the data set's scale",
        unit: "px times scale",
        scale: "map units per pixel of disparity, 1 for float maps, to be stated for integers",
        apply: middlebury,
        ..DISPARITY
    },
    Encoding {
        name: "inverse-depth",
        aliases: &["inverse", "relative"],
        about: "inverse depth, large values near: MiDaS, Depth Anything and other networks; metric with a scale",
        unit: "1/m times scale",
        scale: "map units in 1/m; without it the scale is unknown, and there are no metres",
        apply: inverse_depth,
        ..DEPTH
    },
    Encoding {
        name: "compressed-depth",
        aliases: &["ros-32fc1"],
        about: "quantised inverse depth of a ROS 32FC1 compressedDepth topic, by A and B of its header",
        unit: "quantised 1/m",
        scale: "",
        apply: quantised,
        ..DEPTH
    },
    Encoding {
        name: "bytes-high-low",
        aliases: &["rgb16-high-low"],
        about: "16-bit millimetres in two channels (R and G, grey and opacity ...), high byte first",
        apply: |image, given| spread("bytes-high-low", image, given, Packing::TwoBytes { high_first: true }),
        ..SPREAD
    },
    Encoding {
        name: "bytes-low-high",
        aliases: &["rgb16-low-high"],
        about: "16-bit millimetres in two channels, low byte first",
        apply: |image, given| spread("bytes-low-high", image, given, Packing::TwoBytes { high_first: false }),
        ..SPREAD
    },
    Encoding {
        name: "rgb24-high-low",
        aliases: &["rgb24-big-endian"],
        about: "24-bit millimetres, R * 65536 + G * 256 + B; Google Brain robot data with a scale of 256000",
        apply: |image, given| spread("rgb24-high-low", image, given, Packing::ThreeBytes { high_first: true }),
        ..SPREAD
    },
    Encoding {
        name: "rgb24-low-high",
        aliases: &["rgb24-little-endian"],
        about: "24-bit millimetres, R + G * 256 + B * 65536",
        apply: |image, given| spread("rgb24-low-high", image, given, Packing::ThreeBytes { high_first: false }),
        ..SPREAD
    },
    Encoding {
        name: "rgb24-carla",
        aliases: &["carla"],
        about: "CARLA: R + G * 256 + B * 65536 as a part of 1000 m; the farthest 0.1 % is the sky",
        unit: "far plane / (2^24 - 1)",
        scale: "distance of the far plane in metres, 1000",
        apply: carla,
        ..SPREAD
    },
    Encoding {
        name: "rgba-float-little-endian",
        aliases: &["rgba-float"],
        about: "32-bit float in the bytes of R, G, B and opacity, the lowest byte in R: depth in metres",
        unit: "m",
        scale: "map units per metre, 1",
        apply: |image, given| float_bytes("rgba-float-little-endian", image, given, false),
        ..SPREAD
    },
    Encoding {
        name: "rgba-float-big-endian",
        aliases: &[],
        about: "32-bit float in the bytes of R, G, B and opacity, the lowest byte in opacity: depth in metres",
        unit: "m",
        scale: "map units per metre, 1",
        apply: |image, given| float_bytes("rgba-float-big-endian", image, given, true),
        ..SPREAD
    },
    Encoding {
        name: "grey",
        aliases: &["gray"],
        about: "grey levels of unknown unit: planes in pixels, no metres",
        unit: "grey level",
        scale: "",
        apply: |_, given| {
            no_scale("grey", given).map(|()| Meaning { value_kind: ValueKind::Disparity, valid_range: None })
        },
        ..DEPTH
    },
];

/// The encoding of that name or alias.
///
/// # Errors
/// [`Error::Parameter`] with the names there are.
pub fn by_name(name: &str) -> Result<&'static Encoding> {
    ENCODINGS.iter().find(|encoding| encoding.name == name || encoding.aliases.contains(&name)).ok_or_else(|| {
        let names: Vec<_> = ENCODINGS.iter().map(|encoding| encoding.name).collect();
        Error::parameter("--encoding", name, names.join(", "))
    })
}

/// The encoding that a file itself states.
pub fn stated_by_file(image: &Image) -> Option<&'static Encoding> {
    image.quantisation.map(|_| by_name("compressed-depth").expect("a name of the table"))
}

/// Depth, negative floats missing.
fn depth(image: &Image, units_per_metre: f64) -> Result<Meaning> {
    let value_kind = ValueKind::depth(1.0 / positive_scale(units_per_metre)?)?;
    Ok(Meaning { value_kind, valid_range: float_range(image, 0.0) })
}

/// Disparity, metric if the rig is known.
fn disparity(image: &Image, given: &Given, units_per_pixel: f64) -> Result<Meaning> {
    let pixels_per_unit = 1.0 / positive_scale(units_per_pixel)?;
    let (value_kind, lowest) = match given.stereo {
        Some(rig) => {
            let value_kind = ValueKind::stereo(pixels_per_unit, rig.focal_px, rig.baseline_m, rig.doffs_px)?;
            (value_kind, -rig.doffs_px * units_per_pixel)
        }
        None => (ValueKind::Disparity, 0.0),
    };
    Ok(Meaning { value_kind, valid_range: float_range(image, lowest) })
}

/// Relative, as networks give it, unless the scale is stated.
fn inverse_depth(image: &mut Image, given: &Given) -> Result<Meaning> {
    let value_kind = match given.scale {
        Some(scale) => ValueKind::InverseDepth { slope: 1.0 / positive_scale(scale)?, offset: 0.0 },
        None => ValueKind::Disparity,
    };
    Ok(Meaning { value_kind, valid_range: float_range(image, 0.0) })
}

fn middlebury(image: &mut Image, given: &Given) -> Result<Meaning> {
    let float = matches!(image.pixels, Pixels::F32(_));
    if !float && given.scale.is_none() && given.stereo.is_some() {
        let accepted = "map units per pixel of disparity, stated by the data set (8 for 2001, 4 for 2003, 3 for the \
             third-size maps of 2005 and 2006); without it leave out the baseline";
        return Err(Error::parameter("--scale", "not given", accepted));
    }
    disparity(image, given, given.scale.unwrap_or(1.0))
}

/// `1/z = -0.0030711016 r + 3.3309495161` (OpenKinect, S. Burrus' calibration), which reaches
/// infinity behind 1084.
fn kinect_raw(image: &mut Image, given: &Given) -> Result<Meaning> {
    no_scale("kinect-raw", given)?;
    let values = sixteen_bits("kinect-raw", image)?;
    if let Some(&largest) = values.iter().max()
        && largest > 2047
    {
        if values.iter().any(|value| value.swap_bytes() > 2047) {
            return Err(Error::parameter(
                "--encoding",
                "kinect-raw",
                format!("values up to 2047, the map has {largest}"),
            ));
        }
        values.iter_mut().for_each(|value| *value = value.swap_bytes());
        image.warnings.push("the bytes were swapped: only so are all values at most 2047".to_string());
    }
    let value_kind = ValueKind::InverseDepth { slope: -0.0030711016, offset: 3.3309495161 };
    Ok(Meaning { value_kind, valid_range: Some((1.0, 1084.0)) })
}

/// 16-bit millimetres behind a packing of bits.
fn unpacked(name: &'static str, image: &mut Image, given: &Given, unpack: fn(u16) -> u16) -> Result<Meaning> {
    no_scale(name, given)?;
    sixteen_bits(name, image)?.iter_mut().for_each(|value| *value = unpack(*value));
    depth(image, 1000.0)
}

/// Millimetres from several channels.
fn spread(name: &'static str, image: &mut Image, given: &Given, packing: Packing) -> Result<Meaning> {
    packed::unpack(name, image, packing)?;
    depth(image, given.scale.unwrap_or(1000.0))
}

fn float_bytes(name: &'static str, image: &mut Image, given: &Given, big_endian: bool) -> Result<Meaning> {
    packed::unpack(name, image, Packing::Float { big_endian })?;
    depth(image, given.scale.unwrap_or(1.0))
}

/// CARLA's depth camera (carla.readthedocs.io, "Sensors reference"): a part of the far plane's distance.
fn carla(image: &mut Image, given: &Given) -> Result<Meaning> {
    const LARGEST: f64 = 16_777_215.0;
    packed::unpack("rgb24-carla", image, Packing::ThreeBytes { high_first: false })?;
    let far_m = positive_scale(given.scale.unwrap_or(1000.0))?;
    Ok(Meaning { value_kind: ValueKind::depth(far_m / LARGEST)?, valid_range: Some((0.0, 0.999 * LARGEST)) })
}

/// `z = A / (value - B)` (compressed_depth_image_transport), 0 = missing.
fn quantised(image: &mut Image, given: &Given) -> Result<Meaning> {
    no_scale("compressed-depth", given)?;
    let Some([a, b]) = image.quantisation else {
        let accepted = "a compressedDepth payload whose header states A and B";
        return Err(Error::parameter("--encoding", "compressed-depth", accepted));
    };
    Ok(Meaning { value_kind: formats::quantised_inverse_depth(a, b)?, valid_range: None })
}

fn sixteen_bits<'a>(name: &'static str, image: &'a mut Image) -> Result<&'a mut Vec<u16>> {
    match &mut image.pixels {
        Pixels::U16(values) => Ok(values),
        _ => {
            Err(Error::parameter("--encoding", name, format!("a map of 16-bit integers, this one is {}", image.sample)))
        }
    }
}

fn no_scale(name: &str, given: &Given) -> Result<()> {
    match given.scale {
        None => Ok(()),
        Some(scale) => Err(Error::parameter("--scale", scale, format!("none: the encoding `{name}` fixes the unit"))),
    }
}

fn positive_scale(scale: f64) -> Result<f64> {
    if scale > 0.0 && scale.is_finite() && scale.recip().is_finite() {
        Ok(scale)
    } else {
        Err(Error::parameter("--scale", scale, "a finite number above 0"))
    }
}

fn float_range(image: &Image, lowest: f64) -> Option<(f64, f64)> {
    matches!(image.pixels, Pixels::F32(_)).then_some((lowest, f64::from(f32::MAX)))
}
