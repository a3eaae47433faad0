//! The variance of a pixel's q, which residuals are compared with.
//!
//! In: a sensor's noise, what the map's numbers mean, and their steps. Out: variances of q at q.

use super::expected::ExpectedNoise;
use super::lanes::{LANES, Lanes, lanes};
use super::rounding::{Rounding, steady};
use super::sensor_noise::SensorNoise;
use super::space::Space;
use crate::camera::ValueKind;

/// Variance of one pixel's q: the sensor's own error and the rounding of its values.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NoiseModel {
    noise: SensorNoise,
    space: Space,
    /// Inverse depth, 1/m, is `slope q + offset`.
    slope: f64,
    offset: f64,
    /// Steps of q.
    rounding: Rounding,
    /// Whether the noise is the scatter that a map shows, which includes the average effect of rounding.
    is_scatter: bool,
    /// Lateral error of a pixel's direction, pixels; 0 where nobody asks.
    ray: f64,
    /// The smooth part of the error, and the smooth part of the lateral error.
    smooth: SensorNoise,
    smooth_ray: f64,
    /// Whether the smooth part was estimated from the map.
    is_smooth_shown: bool,
}

/// What rounding to steps may do, in steps, to all pixels of a small patch at once: on a slow ramp they lie on one
/// level, up to half a step off, and averaging does not help. (Over many steps it would be 1 / sqrt(12).)
const ROUNDING: f64 = 0.5;

impl NoiseModel {
    /// The model of a map whose numbers are of that `value_kind` and come in steps of `step` map units (0 for values
    /// that are not rounded). `None` if the noise is stated for another kind of map: of disparity for depth, or of depth for
    /// disparity of an unknown rig.
    pub fn new(value_kind: ValueKind, noise: SensorNoise, step: f64) -> Option<Self> {
        let (slope, offset) = match (value_kind, noise) {
            (ValueKind::Depth { .. }, SensorNoise::Value { .. }) => return None,
            (ValueKind::Depth { .. }, _) => (1.0, 0.0),
            (ValueKind::InverseDepth { slope, offset }, _) => (slope, offset),
            (ValueKind::Disparity, SensorNoise::Value { .. }) => (f64::NAN, f64::NAN),
            (ValueKind::Disparity, _) => return None,
        };
        let smooth = match noise {
            SensorNoise::Value { .. } => SensorNoise::Value { sigma: 0.0 },
            _ => SensorNoise::Depth { base: 0.0, growth: 0.0 },
        };
        let space = Space::of(value_kind);
        let rounding = Rounding::of_values(step, space);
        Some(NoiseModel {
            noise,
            space,
            slope,
            offset,
            rounding,
            is_scatter: false,
            ray: 0.0,
            smooth,
            smooth_ray: 0.0,
            is_smooth_shown: false,
        })
    }

    /// This model, its noise being the scatter that a map shows, which includes the average effect of rounding.
    pub(crate) fn of_scatter(self) -> Self {
        NoiseModel { is_scatter: true, ..self }
    }

    /// This model with a lateral error of `ray` pixels in a pixel's direction, one standard deviation.
    pub(crate) fn with_ray(self, ray: f64) -> Self {
        NoiseModel { ray, ..self }
    }

    /// This model with other steps of q.
    pub(crate) fn with_rounding(self, rounding: Rounding) -> Self {
        NoiseModel { rounding, ..self }
    }

    /// This model with another smooth part, of a kind that suits the map as well.
    pub(crate) fn with_smooth(self, smooth: SensorNoise, smooth_ray: f64) -> Self {
        NoiseModel { smooth, smooth_ray, ..self }
    }

    /// This model with a smooth part `factor` times as large.
    pub(crate) fn with_smooth_times(self, factor: f64) -> Self {
        self.with_smooth(self.smooth.times(factor), self.smooth_ray * factor)
    }

    /// This model, its smooth part being one that was estimated from the map.
    pub(crate) fn of_smooth_shown(self) -> Self {
        NoiseModel { is_smooth_shown: true, ..self }
    }

    /// Whether the smooth part was estimated from the map, and so is uncertain.
    pub(crate) fn is_smooth_shown(&self) -> bool {
        self.is_smooth_shown
    }

    /// The smooth part of the lateral error, pixels.
    pub(crate) fn smooth_ray(&self) -> f64 {
        self.smooth_ray
    }

    /// Variance of the smooth part of a pixel near q on a surface whose squared slope `a^2 + b^2` is `slope`.
    pub(crate) fn smooth_variance(&self, q: f64, slope: f64) -> f64 {
        self.smooth_sigma(q).powi(2) + self.smooth_ray * self.smooth_ray * slope
    }

    /// Variance of a pixel near q without the smooth part; rounding as if noise dithered it.
    pub(crate) fn own_variance(&self, q: f64) -> f64 {
        let (sensor, rounding) = (self.sensor_sigma(q).powi(2), self.step(q).powi(2) / 12.0);
        if self.is_scatter { sensor.max(rounding) } else { sensor + rounding }
    }

    /// Standard deviation of the smooth part of q.
    pub(crate) fn smooth_sigma(&self, q: f64) -> f64 {
        self.sigma_by(&self.smooth, q)
    }

    /// What is expected, for the record; none if its numbers cannot be given.
    pub(crate) fn expected(&self) -> Option<ExpectedNoise> {
        let has_smooth = self.is_smooth_shown || !self.smooth.is_zero();
        let is_finite = self.noise.is_finite() && self.smooth.is_finite() && self.ray.is_finite();
        is_finite.then_some(ExpectedNoise {
            white: self.noise,
            white_is_estimated: self.is_scatter,
            smooth: has_smooth.then_some(self.smooth),
            smooth_is_estimated: self.is_smooth_shown,
            lateral_noise_px: self.ray,
        })
    }

    /// Lateral error of a pixel's direction, pixels, one standard deviation. It is no part of
    /// [`NoiseModel::variance`], which knows no slope.
    pub(crate) fn ray(&self) -> f64 {
        self.ray
    }

    /// Variance of one pixel's q. The part of rounding that noise does not dither is taken at its worst.
    #[inline]
    pub fn variance(&self, q: f64) -> f64 {
        self.with_sensor(q, self.sensor_sigma(q))
    }

    /// Variance of one pixel's q where the sensor's own error has the standard deviation `sensor`.
    #[inline(always)]
    fn with_sensor(&self, q: f64, sensor: f64) -> f64 {
        let square = self.step(q).powi(2);
        self.with_steps(q, sensor, square, self.steady(square, sensor * sensor))
    }

    /// As `with_sensor`, given the square of the step and the share of it that is [`steady`].
    #[inline(always)]
    fn with_steps(&self, q: f64, sensor: f64, square: f64, steady: f64) -> f64 {
        let single = 2e-7 * q; // single precision, in which q is kept
        // The scatter that a map shows includes what noise makes of the steps.
        let dithered = if self.is_scatter { 0.0 } else { (1.0 - steady) * square / 12.0 };
        sensor * sensor + steady * ROUNDING * ROUNDING * square + dithered + single * single
    }

    /// [`steady`] where the sensor's own error has the variance `sensor`.
    #[inline(always)]
    fn steady(&self, square: f64, sensor: f64) -> f64 {
        steady(square, if self.is_scatter { sensor } else { sensor + square / 12.0 })
    }

    /// For many cells of `side` pixels, given q and slopes: the variances of single pixels, and those of the smooth
    /// part with the rounding error that all pixels of a cell share.
    #[inline(always)]
    pub(crate) fn expect(&self, [q, a, b]: [&[f32]; 3], side: f64, [variances, smooth]: [&mut [f32]; 2]) {
        let slopes = a.chunks(LANES).zip(b.chunks(LANES));
        let found = variances.chunks_mut(LANES).zip(smooth.chunks_mut(LANES));
        for ((q, (a, b)), (variances, smooth)) in q.chunks(LANES).zip(slopes).zip(found) {
            let of_cells = self.expect_lanes([q, a, b].map(lanes), side);
            variances.copy_from_slice(&of_cells[0][..variances.len()]);
            smooth.copy_from_slice(&of_cells[1][..smooth.len()]);
        }
    }

    #[inline(always)]
    fn expect_lanes(&self, [q, a, b]: [Lanes; 3], side: f64) -> [[f32; LANES]; 2] {
        let (steps, sensor, shared) =
            (self.rounding.steps(&q), self.sigmas(&self.noise, &q), self.sigmas(&self.smooth, &q));
        let [mut variances, mut smooth] = [[0.0; LANES]; 2];
        for lane in 0..LANES {
            let (square, sensor, shared) = (steps[lane] * steps[lane], sensor[lane], shared[lane]);
            let steady = self.steady(square, sensor * sensor);
            variances[lane] = self.with_steps(q[lane], sensor, square, steady) as f32;
            let slope = a[lane] * a[lane] + b[lane] * b[lane];
            let rounding = steady * square / 12.0 * (square / (square + side * side * slope + f64::MIN_POSITIVE));
            smooth[lane] = (shared * shared + self.smooth_ray * self.smooth_ray * slope + rounding) as f32;
        }
        [variances, smooth]
    }

    /// The step of the map's values in q, at q.
    pub(crate) fn step(&self, q: f64) -> f64 {
        self.rounding.step(q)
    }

    /// Standard deviation of q by the stated noise, without rounding.
    ///
    /// An error of `s` metres in depth is `s p^2` in inverse depth p; divided by the slope it is in units of q.
    #[inline]
    pub fn sensor_sigma(&self, q: f64) -> f64 {
        self.sigma_by(&self.noise, q)
    }

    /// As [`NoiseModel::sensor_sigma`], for either part of the noise.
    #[inline(always)]
    fn sigma_by(&self, part: &SensorNoise, q: f64) -> f64 {
        match part {
            SensorNoise::Value { sigma } => *sigma,
            SensorNoise::Depth { base, growth } => self.sigma_of_depth(*base, *growth, q),
            SensorNoise::Table(table) => {
                let p = self.inverse_depth(q);
                table.sigma_m(p.recip()) * p * p / self.slope.abs()
            }
        }
    }

    /// As `sigma_by`, at many q.
    #[inline(always)]
    fn sigmas(&self, part: &SensorNoise, q: &Lanes) -> Lanes {
        let mut sigmas = [0.0; LANES];
        match *part {
            SensorNoise::Value { sigma } => sigmas.fill(sigma),
            SensorNoise::Depth { base, growth } => {
                (0..LANES).for_each(|lane| sigmas[lane] = self.sigma_of_depth(base, growth, q[lane]));
            }
            SensorNoise::Table(_) => (0..LANES).for_each(|lane| sigmas[lane] = self.sigma_by(part, q[lane])),
        }
        sigmas
    }

    #[inline(always)]
    fn sigma_of_depth(&self, base: f64, growth: f64, q: f64) -> f64 {
        let p = self.inverse_depth(q);
        (growth + base * p * p) / self.slope.abs()
    }

    #[inline(always)]
    fn inverse_depth(&self, q: f64) -> f64 {
        (self.slope * q + self.offset).max(0.0)
    }

    /// Standard deviation of depth at range `depth_m` by the sensor's own error, metres; `None` for disparity of an
    /// unknown rig.
    pub fn depth_sigma_m(&self, depth_m: f64) -> Option<f64> {
        let sigma = self.sensor_sigma((depth_m.recip() - self.offset) / self.slope);
        let sigma_m = sigma * self.slope.abs() * depth_m * depth_m;
        sigma_m.is_finite().then_some(sigma_m)
    }

    /// The variance that a pixel near q brings into the fit of a patch: that of the sensor plus that of rounding,
    /// which counts more where pixels share its error.
    ///
    /// Rounding to steps D has the variance D^2 / 12. Its part `exp(-(2 pi sigma / D)^2)` follows the signal; the
    /// rest is as good as white, since the sensor's noise sigma dithers it (Widrow and Kollar, *Quantization Noise*,
    /// 2008: the first harmonic of the error's mean). The patch says how many pixels share the part that follows the signal.
    #[inline]
    pub fn variance_in(&self, patch: &Patch, q: f64) -> f64 {
        let (sigma, step) = (self.sensor_sigma(q), self.step(q));
        if step == 0.0 {
            return sigma * sigma;
        }
        let white = step * step / 12.0;
        let sensor = if self.is_scatter { (sigma * sigma - white).max(0.0) } else { sigma * sigma };
        let dither = std::f64::consts::TAU * sensor.sqrt() / step;
        if dither > 4.0 {
            return sensor + white; // one part in ten million follows the signal
        }
        let alike = patch.alike(step);
        if alike == 1.0 {
            return sensor + white;
        }
        sensor + white * (1.0 + (-dither * dither).exp() * (alike - 1.0))
    }
}

/// Pixels that one plane is fitted to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Patch {
    /// Change of q per column and per row.
    pub gradient: [f64; 2],
    /// Columns and rows of the box around the pixels.
    pub extent: [f64; 2],
    /// Number of pixels.
    pub pixels: f64,
}

impl Patch {
    /// How many pixels count as one because they share the error of rounding: 1 if all err independently, all of them
    /// if they lie on one level.
    ///
    /// Along an axis the error is a sawtooth of period P = step / gradient. A line of L pixels sums to its amplitude
    /// times P / pi (the first harmonic, over the last period, which is cut off), and at most times L; if the period
    /// is below two pixels, it sums as L independent draws do. Lines within a period of each other have equal sums,
    /// others independent ones, as the border of a patch is ragged. Either axis bounds the sum of the whole (our
    /// derivation).
    #[inline]
    fn alike(&self, step: f64) -> f64 {
        let period = self.gradient.map(|gradient| step / gradient.abs());
        let [columns, rows] = self.extent;
        let line = |period: f64, length: f64| {
            if period < 2.0 { length } else { (period / std::f64::consts::PI).min(length).powi(2) }
        };
        let lines = |period: f64, length: f64| period.clamp(1.0, length);
        let along_rows = line(period[0], columns) * lines(period[1], rows) / columns;
        let along_columns = line(period[1], rows) * lines(period[0], columns) / rows;
        along_rows.min(along_columns).clamp(1.0, self.pixels)
    }
}
