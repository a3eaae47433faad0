//! How far off a sensor is: what averages out over pixels and what does not.
//!
//! In: a depth and the draws of a frame. Out: the depth as it is measured, before it is written.
//!
//! Real error is smooth for the most part. Residuals of 119 labelled planes about their own
//! least-squares plane (recorded frames of Kinect v1 and v2, Azure Kinect, RealSense D4xx and a
//! stereo rig, measured 2026-11-28) keep most of their standard deviation in means over blocks:
//!
//! | sensor (planes) | unit | 1 px | 4 x 4 | 8 x 8 | 16 x 16 | 32 x 32 |
//! |---|---|---|---|---|---|---|
//! | Kinect v1 (85) | px of disparity | 0.092 | 0.075 | 0.066 | 0.059 | 0.053 |
//! | Kinect v2 (12) | 1/m | 0.0030 | 0.0025 | 0.0022 | 0.0023 | 0.0022 |
//! | RealSense D4xx (7) | 1/m | 0.0030 | 0.0024 | 0.0023 | 0.0020 | 0.0015 |
//! | Azure Kinect (6) | 1/m | 0.0013 | 0.0013 | 0.0012 | 0.0011 | 0.0013 |
//! | stereo (8) | 1/m | 0.0039 | 0.0037 | 0.0033 | 0.0027 | 0.0019 |
//! | white noise | share | 1 | 0.25 | 0.125 | 0.063 | 0.031 |
//!
//! [`Correlated`] adds up, in inverse depth or disparity: white noise, patches of a few and of tens of pixels
//! ([`Field`]), and the error that a camera has in every frame alike, a bow (quadratic over the picture) and seams
//! (steps along a column). The sum is rounded there, before it becomes a depth. `tests/sensors.rs` holds synthetic
//! frames to the table, within a quarter.

use super::field::Field;
use crate::scene::pose::{Camera, KINECT_FOCAL_PX};
use crate::util::random::Random;

/// Distance of the nodes of the small and the large patches, pixels of a picture of 640 x 480. Our
/// choice: of 4, 8, 16, 32 and 64 px these two suit the rows of the table best.
const PATCHES_PX: [f64; 2] = [4.0, 32.0];
/// Share of the deviation of either kind that is left in means over 16 x 16 px about the plane of a surface of 3,000
/// px and more, median over the planes of synthetic rooms: averaging reduces the small patches, the plane takes up
/// part of the large ones.
const LEFT_OF_PATCHES: [f64; 2] = [0.22, 0.71];
/// Half the width of a picture of 640 columns: the unit of the bow's coordinates.
const HALF_WIDTH_PX: f64 = 320.0;

/// How far off a sensor is at one depth, all in inverse depth, 1/m: times `f b` it is pixels of
/// disparity, times `z^2` it is metres of depth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SensorError {
    /// Standard deviation of what is drawn anew for each pixel, before rounding. It falls with the
    /// square root of the number of pixels.
    pub white: f64,
    /// Standard deviation of patches of a few pixels: in means over 4 x 4 px most of it is still
    /// there, in means over 16 x 16 px hardly any.
    pub short: f64,
    /// Standard deviation of the part that does not average out over 16 x 16 px, about the least-squares plane of a
    /// surface of 3,000 px and more (a median: how much a surface shows depends on its size).
    pub smooth: f64,
    /// What values are rounded to: the sensor's own step and that of the map, added in squares.
    pub step: f64,
}

impl SensorError {
    /// The error of an exact sensor.
    pub const NONE: SensorError = SensorError { white: 0.0, short: 0.0, smooth: 0.0, step: 0.0 };

    /// Standard deviation of what a pixel does not share with others: the white part and the rounding's step / sqrt(12).
    pub fn pixel(&self) -> f64 {
        (self.white * self.white + self.step * self.step / 12.0).sqrt()
    }
}

/// One part of an error and its growth over the range: in inverse depth its standard deviation is
/// `sqrt(far^2 + (relative / z)^2)`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Part {
    /// At long range, in units of the row.
    pub(super) far: f64,
    /// As a share of the depth, which is the larger part at short range.
    pub(super) relative: f64,
}

/// Error with the structure of a real camera's. Lengths are pixels of its own picture, taken to be
/// 640 x 480: a smaller picture of the same view has the same error in depth.
#[derive(Clone, Copy, Debug)]
pub(super) struct Correlated {
    /// Units of this row per 1/m: `f b` for pixels of disparity, 1 for 1/m.
    pub(super) units_m: f64,
    /// Drawn for each pixel.
    pub(super) white: Part,
    /// Small patches.
    pub(super) short: Part,
    /// Large patches.
    pub(super) long: Part,
    /// Factors of x^2, y^2 and x y, where x and y are 1 at half the width of the picture.
    pub(super) bow: [f64; 3],
    /// Column and step there: further right all values are larger by it.
    pub(super) seams: &'static [(f64, f64)],
    /// Standard deviation of bow and seams about the planes of synthetic rooms, a median.
    pub(super) fixed: f64,
    /// What values are rounded to; 0 = nothing.
    pub(super) step: f64,
}

/// How a sensor errs.
#[derive(Clone, Copy, Debug)]
pub(super) enum ErrorModel {
    /// White noise: the measured depth, given the exact one and a draw of deviation 1; and the error that this amounts to.
    White { depth_m: fn(f64, f64) -> f64, stated: fn(f64) -> SensorError },
    /// Any other error.
    Correlated(Correlated),
}

impl ErrorModel {
    /// The error at a depth in metres.
    pub(super) fn at(&self, depth_m: f64) -> SensorError {
        match self {
            ErrorModel::White { stated, .. } => stated(depth_m),
            ErrorModel::Correlated(model) => model.at(depth_m),
        }
    }

    /// The draws that a frame needs before its first pixel.
    pub(super) fn drawn(&self, camera: &Camera, random: &mut Random) -> FrameError {
        match *self {
            ErrorModel::White { depth_m, .. } => FrameError::White(depth_m),
            ErrorModel::Correlated(model) => FrameError::Correlated(Box::new(Drawn::new(model, *camera, random))),
        }
    }
}

impl Part {
    /// Standard deviation at inverse depth `q`, 1/m.
    fn sigma(self, q: f64, units_m: f64) -> f64 {
        let (far, near) = (self.far / units_m, self.relative * q);
        (far * far + near * near).sqrt()
    }
}

impl Correlated {
    fn at(&self, depth_m: f64) -> SensorError {
        let q = 1.0 / depth_m;
        let [small, large] = [self.short, self.long].map(|part| part.sigma(q, self.units_m));
        let left = [small * LEFT_OF_PATCHES[0], large * LEFT_OF_PATCHES[1], self.fixed / self.units_m];
        SensorError {
            white: self.white.sigma(q, self.units_m),
            short: small,
            smooth: left.iter().map(|x| x * x).sum::<f64>().sqrt(),
            step: self.step / self.units_m,
        }
    }

    /// The error that is the same in every frame, 1/m, at a place in pixels of a picture of
    /// 640 x 480 from its middle. The bow is 0 in the mean over a whole picture of 4:3.
    fn fixed_at(&self, [u, v]: [f64; 2]) -> f64 {
        let (x, y) = (u / HALF_WIDTH_PX, v / HALF_WIDTH_PX);
        let [xx, yy, xy] = self.bow;
        let bow = xx * (x * x - 1.0 / 3.0) + yy * (y * y - 3.0 / 16.0) + xy * x * y;
        let passed = self.seams.iter().filter(|(column, _)| u + HALF_WIDTH_PX - 0.5 >= *column);
        (bow + passed.map(|(_, step)| step).sum::<f64>()) / self.units_m
    }
}

/// The error of one frame.
pub(super) enum FrameError {
    White(fn(f64, f64) -> f64),
    Correlated(Box<Drawn>),
}

/// Patches of one frame, and their values in the row at hand.
pub(super) struct Drawn {
    model: Correlated,
    camera: Camera,
    patches: [Field; 2],
    row: [Vec<f64>; 2],
    v: usize,
}

impl Drawn {
    fn new(model: Correlated, camera: Camera, random: &mut Random) -> Self {
        let own_pixel = camera.intrinsics.fx.abs() / KINECT_FOCAL_PX;
        let patches = PATCHES_PX.map(|px| Field::drawn([camera.width, camera.height], px * own_pixel, random));
        Drawn { model, camera, patches, row: Default::default(), v: 0 }
    }

    fn depth_m(&self, u: usize, z: f64, noise: f64) -> f64 {
        let (model, q) = (&self.model, 1.0 / z);
        let sigma = |part: Part| part.sigma(q, model.units_m);
        let [rx, ry, _] = self.camera.intrinsics.ray(u as f64, self.v as f64);
        let fixed = model.fixed_at([rx * KINECT_FOCAL_PX, ry * KINECT_FOCAL_PX]);
        let patches = sigma(model.short) * self.row[0][u] + sigma(model.long) * self.row[1][u];
        let measured = q + sigma(model.white) * noise + patches + fixed;
        let step = model.step / model.units_m;
        1.0 / if step > 0.0 { (measured / step + 0.5).floor() * step } else { measured }
    }
}

impl FrameError {
    /// Prepares for the pixels of row `v`.
    pub(super) fn start_row(&mut self, v: usize) {
        if let FrameError::Correlated(drawn) = self {
            drawn.v = v;
            for (field, row) in drawn.patches.iter().zip(&mut drawn.row) {
                field.row(v, row);
            }
        }
    }

    /// What a pixel in column `u` measures of a depth, metres; not positive if the error is larger
    /// than the inverse depth. `noise` is a draw of mean 0 and deviation 1.
    pub(super) fn depth_m(&self, u: usize, exact_m: f64, noise: f64) -> f64 {
        match self {
            FrameError::White(depth_m) => depth_m(exact_m, noise),
            FrameError::Correlated(drawn) => drawn.depth_m(u, exact_m, noise),
        }
    }
}
