//! Label images and masks, of whatever sample type.

use std::ops::RangeInclusive;

use depthplanes::{DepthView, Pixel, ValueKind, with_view};

use super::probe::{Probe, is_small};
use crate::frame::Frame;

/// Different values of a label image.
const LEVELS: RangeInclusive<usize> = 1..=64;
/// What programs write for "yes" in a mask.
const YES: [f64; 2] = [1.0, 255.0];
/// Share of neighbours that differ, above which a map is no regions of one value each. On recorded label images it is 0.059 at
/// the most, where their borders are one pixel wide.
const BORDERS: f64 = 0.065;

/// Few whole numbers, each alike over whole regions, that jump at borders: a label image.
pub(super) fn labels(frame: &Frame, probe: &Probe) -> Option<String> {
    // Stated disparity of whole pixels has few values, too.
    let is_depth = matches!(frame.sensor.value_kind, ValueKind::Depth { .. });
    let is_open = frame.provenance.is_guess() && !frame.provenance.disparity;
    let may_be = is_depth || is_open || frame.encoding == "grey";
    if is_small(frame) || !may_be || !LEVELS.contains(&probe.levels().len()) {
        return None;
    }
    let regions = with_view!(frame.view().ok()?, view => Regions::of(view))?;
    regions.are_labels().then(|| {
        let or = match regions.levels[..] {
            [only] => return format!("all valid pixels are {only}: is this a label image or a mask, not depth?"),
            _ if is_open => "or disparity in few steps? state --disparity if it is",
            _ => "not depth?",
        };
        let count = regions.levels.len();
        format!("only {count} different values, in regions of one value each: is this a label image or a mask, {or}")
    })
}

/// The regions of one value of a map.
struct Regions {
    /// The different values, increasing.
    levels: Vec<f64>,
    valid: usize,
    pixels: usize,
    /// Valid pixels beside or above each other, those that differ, and those between which there are other values.
    pairs: usize,
    changes: usize,
    jumps: usize,
}

impl Regions {
    /// Those of a map of few whole numbers; none of another.
    fn of<T: Pixel>(view: DepthView<'_, T>) -> Option<Regions> {
        let (height, validity) = (view.height(), view.validity());
        let (mut levels, mut valid, mut last): (Vec<f64>, _, _) = (Vec::new(), 0, f64::NAN);
        for &pixel in (0..height).flat_map(|v| view.row(v)).filter(|&&pixel| validity.holds(pixel)) {
            let value: f64 = pixel.into();
            valid += 1;
            if value != last
                && let Err(at) = levels.binary_search_by(|level| level.total_cmp(&value))
            {
                if value.fract() != 0.0 || levels.len() == *LEVELS.end() {
                    return None;
                }
                levels.insert(at, value);
            }
            last = value;
        }
        let pixels = view.width() * height;
        let mut regions = Regions { levels, valid, pixels, pairs: 0, changes: 0, jumps: 0 };
        let mut pair = |a: T, b: T| {
            if validity.holds(a) && validity.holds(b) {
                regions.pairs += 1;
                if a != b {
                    let rank = |value: T| regions.levels.partition_point(|&level| level < value.into());
                    regions.changes += 1;
                    regions.jumps += usize::from(rank(a).abs_diff(rank(b)) > 1);
                }
            }
        };
        for v in 0..height {
            let row = view.row(v);
            row.windows(2).for_each(|pixels| pair(pixels[0], pixels[1]));
            if v > 0 {
                view.row(v - 1).iter().zip(row).for_each(|(&above, &below)| pair(above, below));
            }
        }
        Some(regions)
    }

    /// Whether they are those of a label image. Surfaces of few levels change by one level at a time; labels of neighbours have
    /// nothing to do with each other, so that of n levels all but two of n are further apart. On recorded label images at
    /// least 0.75 of that share of the changes are jumps, on maps of depth and disparity at most 0.17, but for 0.65 where
    /// all surfaces face the camera.
    fn are_labels(&self) -> bool {
        let count = self.levels.len();
        if count == 1 {
            return YES.contains(&self.levels[0]) && self.valid < self.pixels;
        }
        let unrelated = 1.0 - 2.0 / count as f64;
        self.pairs > self.valid
            && self.changes as f64 <= BORDERS * self.pairs as f64
            && self.jumps as f64 >= 0.5 * unrelated * self.changes as f64
    }
}
