//! Which encoding a map has: the one stated, or else the preset's, or else the one that its numbers look like.
//!
//! A preset speaks of what a camera delivers. Where the file itself says something else, the file is right: floats are
//! not a Kinect's millimetres, 8 bits are no 1/256 pixels, and PCD files hold metres.

use crate::encoding::{self, Encoding};
use crate::error::Result;
use crate::formats::Image;
use crate::frame::Pixels;
use crate::presets::SensorPreset;

/// An encoding, and why it is this one.
pub(crate) struct Choice {
    pub(crate) encoding: &'static Encoding,
    pub(crate) why: String,
    /// What a person should know of it.
    pub(crate) note: Option<String>,
}

/// Chooses the encoding of a map: the one `stated`, if one is; `disparity` says that the numbers are disparities.
///
/// # Errors
/// [`crate::Error::Parameter`] for an encoding that does not exist.
pub(crate) fn choose(
    image: &Image,
    format: &str,
    stated: Option<&'static Encoding>,
    disparity: bool,
    preset: Option<&SensorPreset>,
) -> Result<Choice> {
    if let Some(encoding) = stated {
        return Ok(Choice { encoding, why: "stated".into(), note: None });
    }
    if let Some(encoding) = encoding::stated_by_file(image) {
        return Ok(Choice { encoding, why: "the file's header states it".into(), note: None });
    }
    let Some(preset) = preset else {
        let (encoding, why) = match image.sample {
            "int16" if disparity => (encoding::by_name("opencv")?, "OpenCV's matchers write signed 16 bits".into()),
            _ => encoding::likely(&image.pixels, image.width, format, disparity),
        };
        let is_doubtful = disparity && ["kitti", "opencv"].contains(&encoding.name);
        let note = format!(
            "disparity of 16 bits is taken to be in {} (`{}`), since {why}; state --encoding or --scale if it is not",
            encoding.unit, encoding.name
        );
        return Ok(Choice { encoding, why, note: is_doubtful.then_some(note) });
    };
    let of_preset = encoding::by_name(preset.encoding)?;
    if suits(of_preset, image, format) {
        return Ok(Choice { encoding: of_preset, why: "preset".into(), note: None });
    }
    let (encoding, why) = encoding::likely(&image.pixels, image.width, format, of_preset.disparity || disparity);
    let note = format!(
        "the preset `{}` expects the encoding `{}`, but this is {format} of {}: read as `{}`, since {why}; state --encoding \
         if it is another",
        preset.name, of_preset.name, image.sample, encoding.name
    );
    Ok(Choice { encoding, why, note: Some(note) })
}

/// Whether a map can be of a preset's encoding at all.
fn suits(encoding: &Encoding, image: &Image, format: &str) -> bool {
    match &image.pixels {
        _ if format == "pcd" => false, // its points are in metres
        _ if encoding.name == "middlebury" => true,
        Pixels::U16(_) => true,
        Pixels::U8(_) => false,
        // Counts that somebody saved as floats; of metres nobody has so many.
        Pixels::F32(values) => encoding::typical(values).is_some_and(|median| median > 100.0) && are_whole(values),
    }
}

fn are_whole(values: &[f32]) -> bool {
    values.iter().filter(|value| value.is_finite()).all(|value| value.fract() == 0.0)
}
