//! Another reading under which far more of the map is planes: depth, inverse depth, distance along the rays.
//!
//! Planes are affine in inverse depth. Read in another way they bend, and fall into pieces or are lost. So where little
//! of a map is planes, the other readings are tried.

use depthplanes::{Detection, Detector, Planar, Sensor, ValueKind};

use crate::frame::{Frame, Pixels};
use crate::outputs::Report;
use crate::ray_distance;
use crate::traps::{Probe, is_small};

/// Above this share of pixels on planes nobody doubts a reading. Of recorded frames of rooms, three quarters have more.
const SHARE: f64 = 0.8;
/// Fewer valid pixels say nothing.
const FEW: usize = 1024;

/// How whole the planes of a reading are.
#[derive(Clone, Copy)]
struct Score {
    /// Share of the valid pixels that lie on planes.
    share: f64,
    /// Chance that two valid pixels lie on one plane.
    together: f64,
}

impl Score {
    fn of(found: &Detection) -> Self {
        let squares = found.planes.iter().map(|plane| plane.share_of_valid.powi(2));
        Score { share: found.labelled_share(), together: squares.sum() }
    }

    /// Whether this reading is far better. On 26 recorded frames and 15 synthetic ones, read right, no other reading is.
    fn beats(&self, other: &Score) -> bool {
        let (gain, times) = (self.share - other.share, self.together / other.together.max(1e-6));
        self.share > 0.5 && ((gain > 0.15 && times > 1.5) || (gain > 0.05 && times > 2.5 && self.share > 0.6))
    }

    /// Whether this reading makes planes of all, and the other one does not.
    fn is_whole_beside(&self, other: &Score) -> bool {
        self.share > 0.95 && self.share - other.share > 0.15 && self.together > 1.2 * other.together
    }
}

/// A reading under which far more pixels lie on planes.
pub(super) fn better(report: &Report<'_>) -> Option<String> {
    let (frame, as_read) = (report.frame, Score::of(report.detection));
    let explained = ["label image", "try --swap-bytes", "try --preset kinect1-raw", "resized with interpolation"];
    let is_explained = |warning: &String| explained.iter().any(|words| warning.contains(words));
    if frame.warnings.iter().any(is_explained)
        || report.method.name != "planar"
        || as_read.share > SHARE
        || report.detection.valid_pixels < FEW
    {
        return None;
    }
    let told = |reading: Score, advice: &str| {
        let [now, then] = [as_read.share, reading.share].map(|share| 100.0 * share);
        format!("{now:.0} % of the valid pixels lie on planes, but {then:.0} % if {advice}")
    };
    match frame.sensor.value_kind {
        ValueKind::Depth { .. } if frame.provenance.ray_distance => {
            let mut distances = frame.clone();
            ray_distance::to_distance(&mut distances);
            let score = score(&distances, distances.sensor)?;
            score.beats(&as_read).then(|| told(score, "they are depths already: leave --ray-distance out"))
        }
        ValueKind::Depth { .. } => {
            let along_rays = as_ray_distance(frame).filter(|score| score.beats(&as_read));
            // The points of a cloud are depths by their format.
            let inverse = (frame.format != "pcd").then(|| with(frame, ValueKind::Disparity)).flatten();
            let inverse = inverse.filter(|score| score.beats(&as_read) || score.is_whole_beside(&as_read));
            match (along_rays, inverse) {
                (along, Some(score)) if along.is_none_or(|along| score.together > along.together) => Some(told(
                    score,
                    "they are inverse depth, large values near: try --encoding inverse-depth or --disparity",
                )),
                (Some(score), _) => Some(told(score, "they are distances along the rays: try --ray-distance")),
                _ => None,
            }
        }
        ValueKind::Disparity | ValueKind::InverseDepth { .. } if is_assumed_disparity(frame) => {
            let score = with(frame, ValueKind::Depth { metres: 1e-3 })?;
            score.is_whole_beside(&as_read).then(|| told(score, "they are depth: try --encoding millimetre"))
        }
        ValueKind::Disparity if frame.format == "pfm" && frame.provenance.is_guess() => {
            let score = with(frame, ValueKind::Depth { metres: 1.0 })?;
            score.beats(&as_read).then(|| told(score, "they are depth: try --encoding metre or millimetre"))
        }
        _ => None,
    }
}

/// Whether 16 bits are read as disparity because of a preset, a rig or a camera file.
fn is_assumed_disparity(frame: &Frame) -> bool {
    let is_16_bits = matches!(frame.pixels, Pixels::U16(_));
    is_16_bits && frame.provenance.encoding != "stated" && ["kitti", "disparity"].contains(&frame.encoding)
}

/// How much larger values have to be in the lower half of a picture to look like disparity or inverse depth: what is near is
/// mostly below. On 58 recorded maps of depth they are 1.14 times as large at the most, on 16 of 21 maps of disparity more than 1.3 times.
const GROWS: f64 = 1.3;

/// Values that grow towards the bottom of the picture, taken for depth by a guess, where planes do not say that they are
/// depth, as they do of a ceiling.
pub(super) fn grows_below(report: &Report<'_>) -> Option<String> {
    let frame = report.frame;
    let is_depth = matches!(frame.sensor.value_kind, ValueKind::Depth { .. }) && frame.format != "pcd";
    let is_told = frame.warnings.iter().any(|warning| warning.contains("label image") || warning.contains("try --enc"));
    if !is_depth || !frame.provenance.is_guess() || is_told || is_small(frame) {
        return None;
    }
    let times = Probe::some(frame)?.grows_below().filter(|&times| times > GROWS)?;
    let (depth, inverse) = (score(frame, frame.sensor)?, with(frame, ValueKind::Disparity)?);
    let is_surely_depth = depth.share > SHARE && depth.together > inverse.together;
    (!is_surely_depth).then(|| {
        format!(
            "values are {times:.1} times as large in the lower half of the picture as in the upper one, as disparity and inverse \
             depth are: try --encoding inverse-depth, or --disparity; state the encoding if it is depth"
        )
    })
}

/// The frame read in another way.
fn with(frame: &Frame, value_kind: ValueKind) -> Option<Score> {
    score(frame, frame.sensor.value_kind(value_kind).noise(None).smooth_noise(None))
}

fn as_ray_distance(frame: &Frame) -> Option<Score> {
    let mut depth = frame.clone();
    ray_distance::to_depth(&mut depth).ok()?;
    score(&depth, depth.sensor)
}

fn score(frame: &Frame, sensor: Sensor) -> Option<Score> {
    let mut detector = Detector::new(Planar::default()).ok()?.sensor(sensor);
    Some(Score::of(detector.detect(frame.view().ok()?).ok()?))
}
