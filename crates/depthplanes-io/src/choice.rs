//! Which encoding a map has: the one stated, or else the preset's, or else the one that its numbers look like.
//!
//! A preset speaks of what a camera delivers. Where the file itself says something else, the file is right: floats are
//! not a Kinect's millimetres, 8 bits are no 1/256 pixels, and PCD files hold metres.
//!
//! Without a stated encoding [`likely`] decides by the sample type:
//! arrays of floats in memory -> `metre`, PFM -> `middlebury` (or `millimetre` if the median is above the number of columns), float -> `metre` (or `millimetre`
//! if the median is above 100), 16-bit -> `millimetre`, 8-bit -> `grey`. It never guesses a bit packing; the traps of
//! `crate::traps` say when the numbers look like one.

use crate::encoding::{self, Encoding};
use crate::error::Result;
use crate::formats::Image;
use crate::frame::Pixels;
use crate::presets::SensorPreset;

/// The format of maps that are in memory.
pub(crate) const IN_MEMORY: &str = "array";

/// An encoding, and why it is this one.
pub(crate) struct Choice {
    pub(crate) encoding: &'static Encoding,
    pub(crate) why: String,
    /// What a person should know of it.
    pub(crate) note: Option<String>,
}

/// Chooses the encoding of a map: the one `stated`, if one is; `disparity` says that the numbers are disparities, and
/// `has_scale` that their scale is stated.
///
/// # Errors
/// [`crate::Error::Parameter`] for an encoding that does not exist.
pub(crate) fn choose(
    image: &Image,
    format: &str,
    stated: Option<&'static Encoding>,
    disparity: bool,
    has_scale: bool,
    preset: Option<&SensorPreset>,
) -> Result<Choice> {
    if let Some(encoding) = stated {
        return Ok(Choice { encoding, why: "stated".into(), note: None });
    }
    if let Some(encoding) = encoding::stated_by_file(image) {
        let [a, b] = image.quantisation.unwrap_or_default();
        let note = format!(
            "read as a 32FC1 topic: quantised inverse depth by the header's A = {a} and B = {b}; if the topic is 16UC1, \
             state --encoding millimetre"
        );
        return Ok(Choice { encoding, why: "the file's header states it".into(), note: Some(note) });
    }
    let Some(preset) = preset else {
        let (encoding, why) = match image.sample {
            "int16" if disparity => (encoding::by_name("opencv")?, "OpenCV's matchers write signed 16 bits".into()),
            _ => likely(&image.pixels, image.width, format, disparity),
        };
        let note = match (encoding.name, has_scale) {
            ("kitti" | "opencv", false) if disparity => Some(format!(
                "disparity of 16 bits is taken to be in {} (`{}`), since {why}; state --encoding or --scale if it is not, \
                 --encoding millimetre if it is depth",
                encoding.unit, encoding.name
            )),
            // The scale is known; that some pixels are left out is said all the same.
            ("opencv", true) if disparity && image.sample != "int16" => {
                Some(format!("read as `opencv`, since {why}: those pixels are missing"))
            }
            _ => None,
        };
        return Ok(Choice { encoding, why, note });
    };
    let of_preset = encoding::by_name(preset.encoding)?;
    if suits(of_preset, image, format) {
        return Ok(Choice { encoding: of_preset, why: "preset".into(), note: None });
    }
    let (encoding, why) = likely(&image.pixels, image.width, format, of_preset.disparity || disparity);
    let note = format!(
        "the preset `{}` expects the encoding `{}`, but this is {format} of {}: read as `{}`, since {why}; state --encoding \
         if it is another",
        preset.name, of_preset.name, image.sample, encoding.name
    );
    Ok(Choice { encoding, why, note: Some(note) })
}

/// Whether the choice for a map in memory rests on its values, and not on its type and what is stated alone.
pub(crate) fn rests_on_values(pixels: &Pixels, is_stated: bool, disparity: bool, has_preset: bool) -> bool {
    !is_stated
        && match pixels {
            Pixels::U8(_) => false,
            Pixels::U16(_) => disparity && !has_preset,
            Pixels::F32(_) => has_preset,
        }
}

/// Whether a map can be of a preset's encoding at all.
fn suits(encoding: &Encoding, image: &Image, format: &str) -> bool {
    match &image.pixels {
        _ if format == "pcd" => false, // its points are in metres
        _ if encoding.name == "middlebury" => true,
        Pixels::U16(_) => true,
        Pixels::U8(_) => false,
        // Counts that somebody saved as floats; of metres nobody has so many.
        Pixels::F32(values) => typical(values).is_some_and(|median| median > 100.0) && are_whole(values),
    }
}

fn are_whole(values: &[f32]) -> bool {
    values.iter().filter(|value| value.is_finite()).all(|value| value.fract() == 0.0)
}

/// The encoding to assume when none is stated, and why; the rule stands in the module header.
/// `width` is the number of columns; `disparity` says that the numbers are known to be disparities.
pub(crate) fn likely(pixels: &Pixels, width: usize, format: &str, disparity: bool) -> (&'static Encoding, String) {
    let (name, why) = match pixels {
        Pixels::F32(_) if format == "pcd" => ("metre", "PCD files hold metres".to_string()),
        Pixels::F32(_) if format == IN_MEMORY && !disparity => ("metre", "arrays of floats hold metres".to_string()),
        Pixels::F32(values) if format == "pfm" && !disparity => match typical(values) {
            // A disparity is at most the width of the picture.
            Some(median) if f64::from(median) > width as f64 => {
                ("millimetre", format!("the median {median} is no disparity in {width} columns"))
            }
            _ => ("middlebury", "PFM files hold disparity in pixels".to_string()),
        },
        Pixels::F32(_) if format == "pfm" => ("middlebury", "PFM files hold disparity in pixels".to_string()),
        Pixels::F32(_) if disparity => ("disparity", "float disparity is in pixels".to_string()),
        Pixels::U8(_) if disparity => ("middlebury", "8-bit disparity has a scale of its data set".to_string()),
        Pixels::U16(values)
            if disparity && values.iter().filter(|&&value| value == 65_520).count() * 200 > values.len() =>
        {
            ("opencv", "65520 is the -16 of OpenCV's matchers".to_string())
        }
        Pixels::U16(values) if disparity => match values.iter().max() {
            Some(largest) if *largest > 2048 => ("kitti", format!("{largest} pixels of disparity would be too many")),
            _ => ("disparity", "the values are small enough to be pixels".to_string()),
        },
        Pixels::F32(values) => match typical(values) {
            Some(median) if median > 100.0 => ("millimetre", format!("the median {median} is too far for metres")),
            _ => ("metre", "float maps hold metres".to_string()),
        },
        Pixels::U16(_) => ("millimetre", "16-bit maps mostly hold millimetres".to_string()),
        Pixels::U8(_) => ("grey", "8-bit maps have no common unit".to_string()),
    };
    (encoding::by_name(name).expect("a name of the table"), why)
}

/// The median of at most 4096 positive values.
fn typical(values: &[f32]) -> Option<f32> {
    let step = values.len() / 4096 + 1;
    let mut sample: Vec<f32> = values.iter().step_by(step).copied().filter(|z| *z > 0.0 && z.is_finite()).collect();
    sample.sort_by(f32::total_cmp);
    sample.get(sample.len() / 2).copied()
}
