//! From several channels to one, or a refusal that says what the picture is.
//!
//! In: interleaved samples. Out: the first channel, if the colours are equal. Colours that differ are a colour or colourised
//! picture, or the bytes of one value ([`super::spread`]); an encoding that reads these asks for all channels
//! ([`DecodeOptions::channels`]).

use super::format::{DecodeOptions, Image};
use super::spread;
use crate::error::{Error, Result};
use crate::frame::Pixels;

/// The advice for pictures that are not depth maps.
const NOT_DEPTH: &str = "one channel, or several equal ones: a colourised picture cannot be turned back \
     into depth, export the raw depth (16-bit or float) instead";

/// The advice for bytes that are spread.
const SPREAD: &str = "one channel, or the bytes of one value over the channels with the encoding stated \
     (`depthplanes encodings` lists them)";

/// Makes one channel of the image's `channels`, the last of which is opacity if `alpha`, unless all are asked for.
///
/// # Errors
/// [`Error::Unreadable`] if the channels (but opacity) differ, or if opacity holds a part of the value.
pub(super) fn reduce(format: &'static str, image: &mut Image, alpha: bool, options: &DecodeOptions) -> Result<()> {
    if image.channels <= 1 || options.channels {
        return Ok(());
    }
    let channels = image.channels;
    if let Some(wrong) = spread::explain(&image.pixels, image.width, channels, alpha) {
        return Err(Error::Unreadable { format, wrong, accepted: SPREAD });
    }
    match &mut image.pixels {
        Pixels::U8(samples) => first(format, samples, channels, alpha, &mut image.warnings)?,
        Pixels::U16(samples) => first(format, samples, channels, alpha, &mut image.warnings)?,
        Pixels::F32(samples) => first(format, samples, channels, alpha, &mut image.warnings)?,
    }
    image.channels = 1;
    Ok(())
}

fn first<T: Copy + PartialEq>(
    format: &'static str,
    samples: &mut Vec<T>,
    channels: usize,
    alpha: bool,
    warnings: &mut Vec<String>,
) -> Result<()> {
    let colours = channels - usize::from(alpha);
    let differing = samples.chunks_exact(channels).filter(|p| p[1..colours].iter().any(|c| *c != p[0])).count();
    if differing > 0 {
        let wrong = format!("the {colours} channels differ in {differing} pixels: a colourised picture, not depth");
        return Err(Error::Unreadable { format, wrong, accepted: NOT_DEPTH });
    }
    if colours > 1 {
        warnings.push(format!("{colours} equal channels: one is kept"));
    }
    if alpha {
        warnings.push(ignored_opacity(samples.iter().skip(channels - 1).step_by(channels)));
    }
    let area = samples.len() / channels;
    for pixel in 0..area {
        samples[pixel] = samples[pixel * channels];
    }
    samples.truncate(area);
    samples.shrink_to_fit();
    Ok(())
}

/// A mask has two levels.
fn ignored_opacity<'a, T: PartialEq + 'a>(mut opacity: impl Iterator<Item = &'a T>) -> String {
    let one = opacity.next();
    let other = opacity.find(|value| Some(*value) != one);
    let more = opacity.any(|value| Some(value) != one && Some(value) != other);
    let hint =
        if more { "; if it holds the low or high byte, try --encoding bytes-high-low or bytes-low-high" } else { "" };
    format!("the opacity channel is ignored{hint}")
}
