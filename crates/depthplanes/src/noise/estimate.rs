//! How noisy a sensor is, from frames of it.
//!
//! In: maps. Out: the white part of the sensor's error and its smooth part, each a [`SensorNoise`], from what
//! [`Scales`] measures on the maps' cells. The variance of rounding to steps D, D^2 / 12, is subtracted from the
//! white part: rounding is part of the map, not of the sensor.

use super::errors::Errors;
use super::model::NoiseModel;
use super::rounding::{Rounding, RoundingFinder};
use super::scales::{Cell, Cells, FEW, SIDES, SUMMED, Scales};
use super::sensor_noise::SensorNoise;
use super::space::{LARGEST_Q, Space};
use super::steps::Steps;
use crate::camera::ValueKind;
use crate::error::{Error, Result};
use crate::map::with_view;
use crate::map::{AnyView, DepthView, Pixel};
use crate::sensor::Sensor;
use crate::statistics::least_squares::Moments;

/// Maps are padded to a multiple of so many columns and rows, as in `planar`.
pub(crate) const PADDED: [usize; 2] = [128, 16];

/// A sensor's noise as frames of it show it.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct Estimate {
    /// The white part, which differs from pixel to pixel: [`SensorNoise::Depth`] of depth maps, [`SensorNoise::Value`] of
    /// all others.
    pub noise: SensorNoise,
    /// The white part without the variance of rounding. It differs from `noise` where the sensor's own steps are
    /// longer than those of the map's numbers. This is the one to give to `planar`, which finds the rounding by
    /// itself. 0 where rounding makes more than a fiftieth of the variance.
    pub beside_rounding: SensorNoise,
    /// The smooth part, which neighbouring pixels share, as means over 16 x 16 pixels show it; of the same kind. This
    /// is the one to give to `planar`, which finds the longer waves by itself.
    pub smooth: SensorNoise,
    /// The smooth part as means over up to 32 x 32 pixels show it where no edge runs through them: it includes the
    /// longer waves, and excludes the scene's edges, which `smooth` includes.
    pub wide: SensorNoise,
    /// The steps that the values come in, map units, the finest of all frames; 0 for values that are not rounded.
    pub step: f64,
    /// Blocks of 4 x 4 pixels that were compared with their neighbours on either side, along rows and along columns.
    pub blocks: usize,
    /// What the maps' numbers mean; of several depth maps with different units, the last one's.
    pub value_kind: ValueKind,
    /// The range of the blocks, without a fortieth of them at either end: 1/m for depth maps, map units for all
    /// others.
    pub range: [f64; 2],
    /// Lateral error of a pixel's direction, pixels, one standard deviation; `None` where slanted surfaces scatter no
    /// more than those that face the camera.
    pub lateral_noise_px: Option<f64>,
}

impl Estimate {
    /// The model of the white part of the sensor's own error, without rounding.
    pub fn model(&self) -> NoiseModel {
        NoiseModel::new(self.value_kind, self.noise, 0.0).expect("an estimate is of the maps' own kind")
    }

    /// The model of the smooth part, over 16 pixels.
    pub fn smooth_model(&self) -> NoiseModel {
        NoiseModel::new(self.value_kind, self.smooth, 0.0).expect("an estimate is of the maps' own kind")
    }

    /// The model of the smooth part with its longer waves.
    pub fn wide_model(&self) -> NoiseModel {
        NoiseModel::new(self.value_kind, self.wide, 0.0).expect("an estimate is of the maps' own kind")
    }
}

/// Estimates a sensor's noise from one frame or from several together.
///
/// It compares means over neighbouring blocks of 4 x 4 to 32 x 32 pixels. Errors that are smooth over far more
/// than 32 pixels, such as a bow over a whole wall, are not noise to it; texture and clutter are, where they cover more
/// than half of the map.
///
/// ```
/// use depthplanes::noise::{Estimator, SensorNoise};
/// use depthplanes::scene::Spec;
/// let frame = "room:sensor=tof_white".parse::<Spec>()?.frame()?;
/// let mut estimator = Estimator::default();
/// estimator.add(frame.view(), frame.sensor.value_kind)?;
/// // The generator's noise is 1 mm + 1.3 mm (z / 1 m)^2.
/// let sigma_m = estimator.estimate()?.model().depth_sigma_m(3.0).unwrap();
/// assert!((sigma_m / 0.0127 - 1.0).abs() < 0.2);
/// # Ok::<(), depthplanes::Error>(())
/// ```
#[derive(Debug, Default)]
pub struct Estimator {
    scales: Scales,
    steps: Steps,
    finder: RoundingFinder,
    /// The rounding of the newest frame.
    rounding: Option<Rounding>,
    /// The value kind of the frames so far, and their finest step.
    seen: Option<(ValueKind, f64)>,
}

impl Estimator {
    /// Adds a frame whose numbers are of that `value_kind`.
    ///
    /// # Errors
    /// [`Error::MixedValueKinds`] unless all frames hold depth, or all the same disparity.
    pub fn add<'m>(&mut self, map: impl Into<AnyView<'m>>, value_kind: ValueKind) -> Result<()> {
        self.add_view(map.into(), value_kind)
    }

    fn add_view(&mut self, map: AnyView<'_>, value_kind: ValueKind) -> Result<()> {
        let is_depth = |value_kind| matches!(value_kind, ValueKind::Depth { .. });
        if self.seen.is_some_and(|(seen, _)| seen != value_kind && !(is_depth(seen) && is_depth(value_kind))) {
            return Err(Error::MixedValueKinds);
        }
        let step = with_view!(map, map => self.look(&map, Space::of(value_kind)));
        let finest = self.seen.map_or(step, |(_, finest)| step.min(finest));
        self.seen = Some((value_kind, finest));
        Ok(())
    }

    /// Looks at a frame's cells; returns its step.
    fn look<T: Pixel>(&mut self, map: &DepthView<'_, T>, space: Space) -> f64 {
        let mut usual = 0.0;
        for (level, &side) in SIDES[..SUMMED].iter().enumerate() {
            // As many cells as in `planar`, so that the same ones are looked at.
            let [columns, rows] = [(map.width(), PADDED[0]), (map.height(), PADDED[1])]
                .map(|(length, of)| length.next_multiple_of(of) / side);
            let cells: Vec<Cell> = (0..columns * rows)
                .map(|at| cell(map, space, [at % columns * side, at / columns * side], side))
                .collect();
            if level == 0 {
                let pixels: f32 = cells.iter().map(|cell| cell.n).sum();
                usual = pixels / cells.iter().filter(|cell| cell.n > 0.0).count().max(1) as f32;
            }
            self.scales.look_at(Cells { level, columns, rows, usual }, |at| cells[at]);
        }
        self.rounding = Some(self.finder.find(map, space));
        self.steps.of(map)
    }

    /// The noise of all frames so far.
    ///
    /// # Errors
    /// [`Error::TooFewBlocks`] if fewer than 16 blocks of 4 x 4 pixels have about as many valid pixels as most have, and
    /// others like them on either side.
    pub fn estimate(&mut self) -> Result<Estimate> {
        let blocks = self.scales.bends[0].len();
        let too_few = Error::TooFewBlocks { found: blocks, least: FEW };
        let Some((value_kind, step)) = self.seen else { return Err(too_few) };
        let space = Space::of(value_kind);
        let rounding = self.rounding.unwrap_or(Rounding::NONE);
        // Tiles that lie apart show no smooth part, which is asked for here.
        let errors = if blocks < FEW { None } else { self.scales.errors(space, &rounding) };
        let Some(errors) = errors else { return Err(too_few) };
        let range = self.range();
        let ray = Some(errors.white * errors.ray).filter(|ray| *ray > 0.0);
        let noise = white(&errors, range, space, step);
        let [smooth, wide] = [errors.smooth, errors.whole].map(|factor| errors.times(factor, space));
        let beside_rounding = beside_rounding(&errors, range, space, &rounding);
        Ok(Estimate { noise, beside_rounding, smooth, wide, step, blocks, value_kind, range, lateral_noise_px: ray })
    }

    /// The range of q without a fortieth of the blocks at either end.
    fn range(&mut self) -> [f64; 2] {
        let bends = &mut self.scales.bends[0];
        let few = bends.len() / 40;
        [few, bends.len() - 1 - few].map(|at| bends.select_nth_unstable_by(at, |a, b| a.q.total_cmp(&b.q)).1.q.into())
    }
}

/// The white part without the variance of rounding, taken in the middle of a range of q.
fn white(errors: &Errors, [low, high]: [f64; 2], space: Space, step: f64) -> SensorNoise {
    let q = (low + high) / 2.0;
    let (variance, rounding) = (errors.white.powi(2) * errors.variance(q, 0.0), step * space.unit(q));
    let own = (1.0 - rounding * rounding / (12.0 * variance).max(f64::MIN_POSITIVE)).max(0.0);
    errors.times(errors.white * own.sqrt(), space)
}

/// Share of the white part's variance that has to be left without rounding. Where rounding makes more of it, the rest
/// is not well known, and does not grow over the range by one law.
const LEFT: f64 = 0.98;

/// The white part without the variance of rounding, from what is left at both ends of a range of q: what is left
/// grows over the range differently from what is seen. 0 where less than [`LEFT`] is left.
fn beside_rounding(errors: &Errors, [low, high]: [f64; 2], space: Space, rounding: &Rounding) -> SensorNoise {
    let [at_low, at_high] = [low, high].map(|q| {
        let white = errors.white.powi(2) * errors.variance(q, 0.0);
        Some(white - rounding.variance(q)).filter(|left| *left > LEFT * white).map(f64::sqrt)
    });
    let (Some(at_low), Some(at_high)) = (at_low, at_high) else { return errors.times(0.0, space) };
    let square = match space {
        Space::InverseDepth { .. } if high > low => ((at_high - at_low) / (high * high - low * low)).max(0.0),
        _ => 0.0,
    };
    let constant = (0.5 * (at_low + at_high - square * (low * low + high * high))).max(0.0);
    Errors { constant, square, ..*errors }.times(1.0, space)
}

/// The noise that is stated of a sensor, for a map of that pixel type; none if nothing is stated, or that of another kind of
/// map.
pub(crate) fn stated_noise<T: Pixel>(sensor: &Sensor) -> Option<NoiseModel> {
    NoiseModel::new(sensor.value_kind, sensor.noise?, if T::IS_INTEGER { 1.0 } else { 0.0 })
}

/// The noise of one map, for methods that compare single pixels with planes: the sensor's noise as stated, or else
/// both parts as the map shows them, since a pixel's error has both; 0 where the map shows nothing.
pub(crate) fn noise_of_map<T: Pixel>(map: &DepthView<'_, T>, sensor: &Sensor) -> NoiseModel {
    let (value_kind, space) = (sensor.value_kind, Space::of(sensor.value_kind));
    let mut estimator = Estimator::default();
    let step = estimator.look(map, space);
    let stated = sensor.noise.and_then(|noise| NoiseModel::new(value_kind, noise, step));
    let estimated = || {
        let rounding = estimator.rounding.unwrap_or(Rounding::NONE);
        let errors = estimator.scales.errors(space, &rounding).unwrap_or(Errors::NONE);
        Some(NoiseModel::new(value_kind, errors.times(errors.white.hypot(errors.whole), space), step)?.of_scatter())
    };
    stated.or_else(estimated).expect("an estimate is of the map's own kind")
}

/// A square cell of `side` pixels whose first pixel is (u, v), as far as it lies on the map. As in `planar`, tiles
/// whose pixels lie on one line are left out.
fn cell<T: Pixel>(map: &DepthView<'_, T>, space: Space, [u, v]: [usize; 2], side: usize) -> Cell {
    let middle = (side as f64 - 1.0) / 2.0;
    let mut sums = Moments::default();
    let mut origin = None;
    let tiles = side / SIDES[0];
    for at in 0..tiles * tiles {
        let [du, dv] = [at % tiles * SIDES[0], at / tiles * SIDES[0]];
        let mut tile = Moments::default();
        for [u, v, q] in pixels(map, space, [u + du, v + dv]) {
            let off = q - *origin.get_or_insert(q);
            tile.add(du as f64 + u - middle, dv as f64 + v - middle, off);
        }
        if tile.fit().is_some() {
            sums.merge(&tile);
        }
    }
    let origin = origin.unwrap_or(0.0);
    match sums.fit() {
        Some(fit) => {
            let [a, b, c] = fit.abc;
            Cell {
                n: fit.n as f32,
                abc: [a, b, origin + c].map(|number| number as f32),
                squares: (fit.rms * fit.rms * fit.n) as f32,
            }
        }
        None => Cell { n: 0.0, abc: [0.0; 3], squares: 0.0 },
    }
}

/// The valid pixels of the tile whose first pixel is (u, v): column and row counted from that pixel, and q.
fn pixels<T: Pixel>(map: &DepthView<'_, T>, space: Space, [u, v]: [usize; 2]) -> impl Iterator<Item = [f64; 3]> {
    let [columns, rows] = [(u, map.width()), (v, map.height())].map(|(first, end)| first..end.min(first + SIDES[0]));
    let validity = map.validity();
    rows.flat_map(move |row| columns.clone().map(move |column| (column, row, map.row(row)[column])))
        .filter(move |(.., value)| validity.holds(*value))
        .map(move |(column, row, value)| [(column - u) as f64, (row - v) as f64, space.q(value.into())])
        .filter(|[.., q]| q.abs() <= LARGEST_Q.into())
}
