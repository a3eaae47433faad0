//! How noisy a sensor is, from frames of it.
//!
//! In: the scatter of small blocks of a map about their own planes. Out: a [`SensorNoise`]. Most blocks of most maps
//! lie on one smooth surface, so the lower half of the scatter in each stretch of q is noise. What rounding to steps
//! makes of it, D^2 / 12, is taken off: rounding is part of the map, not of the sensor.

use super::ray::{Slants, Tiled};
use super::steps::Steps;
use super::{NoiseModel, SensorNoise, Space};
use crate::camera::{Measure, Sensor};
use crate::error::{Error, Result};
use crate::fit::{AffineFit, Moments};
use crate::map::{AnyView, DepthView, Pixel};
use crate::with_view;
use std::cmp::Ordering;

/// Stretches of q, each with as many blocks.
const BINS: usize = 8;
/// Share of the blocks of a stretch that are taken to be flat.
const FLAT: f64 = 0.5;
/// Columns and rows of a block. It is large enough to span the steps of a sensor that rounds coarsely: within one step
/// it would show no noise at all.
const SIDE: usize = 12;
/// Columns and rows of the blocks that the ray is estimated from, and of their tiles: those of the method `planar`.
const RAY_SIDE: usize = 16;
const TILE: usize = 4;
/// Share of a block's pixels that have to be valid.
pub(crate) const VALID: f64 = 0.8;
/// Fewest blocks that [`Estimator::estimate`] answers from: one a stretch.
const LEAST: usize = BINS;

/// A block of pixels about its own plane.
#[derive(Clone, Copy, Debug)]
struct Block {
    /// Mean q.
    q: f64,
    /// Variance of q about the plane.
    scatter: f64,
    /// The part of it that rounding makes.
    rounding: f64,
}

/// The blocks of one map or of several.
#[derive(Debug, Default)]
pub(crate) struct Blocks {
    all: Vec<Block>,
}

impl Blocks {
    /// Forgets all blocks and makes room for so many.
    pub(crate) fn prepare(&mut self, count: usize) {
        self.all.clear();
        crate::group::reserve_to(&mut self.all, count);
    }

    /// Adds a block by the sums of its pixels about a q of `origin`, from a map whose values come in steps of `step`
    /// map units; one that lacks pixels or has no plane is left out.
    pub(crate) fn add(&mut self, sums: &Moments, origin: f64, space: Space, step: f64) {
        let full = (SIDE * SIDE) as f64;
        if let Some(fit) = sums.fit().filter(|fit| fit.n >= VALID * full) {
            let q = origin + sums.q / sums.n;
            let step = step * space.unit(q);
            self.push(q, fit.rms * fit.rms * fit.n / (fit.n - 3.0), step * step / 12.0);
        }
    }

    /// Adds a block by its q, the variance of q about its plane, and the part of that that rounding makes.
    pub(crate) fn push(&mut self, q: f64, scatter: f64, rounding: f64) {
        self.all.push(Block { q, scatter, rounding });
    }

    /// The noise that explains the scatter, and the q that a fortieth of the blocks lie below and above; 0 without a
    /// block.
    pub(crate) fn noise(&mut self, space: Space) -> (SensorNoise, [f64; 2]) {
        let mut blocks = &mut self.all[..];
        let few = blocks.len() / 40;
        let range =
            [Some(few), blocks.len().checked_sub(few + 1)].map(|at| nth(blocks, at, by_q).map_or(0.0, |block| block.q));
        let size = blocks.len().div_ceil(BINS).max(1);
        let mut points = [(0.0, 0.0, 0.0); BINS];
        let mut count = 0;
        for point in &mut points {
            // The lowest of those that are left.
            nth(blocks, Some(size), by_q);
            let (bin, rest) = blocks.split_at_mut(size.min(blocks.len()));
            let Some(q) = nth(bin, Some(bin.len() / 2), by_q).map(|block| block.q) else { break };
            blocks = rest;
            let flat = nth(bin, Some((bin.len() as f64 * FLAT) as usize), |a, b| a.scatter.total_cmp(&b.scatter));
            let Block { scatter, rounding, .. } = flat.expect("a share below 1 of some");
            *point = (q, (scatter - rounding).max(0.0).sqrt(), scatter.max(1e-12).recip());
            count += 1;
        }
        let [constant, square] = non_negative(&points[..count], space);
        let noise = match space {
            Space::InverseDepth { .. } => SensorNoise::Depth { base: square, growth: constant },
            Space::Value => SensorNoise::Value { sigma: constant },
        };
        (noise, range)
    }
}

/// The block that sorting would bring to a place, if there is one; those before it then go before it, those behind behind it.
fn nth(blocks: &mut [Block], at: Option<usize>, order: impl Fn(&Block, &Block) -> Ordering) -> Option<Block> {
    let at = at.filter(|&at| at < blocks.len())?;
    Some(*blocks.select_nth_unstable_by(at, order).1)
}

fn by_q(a: &Block, b: &Block) -> Ordering {
    a.q.total_cmp(&b.q).then(a.scatter.total_cmp(&b.scatter))
}

/// Least squares of `sigma = constant + square q^2` over points (q, sigma, weight), neither below 0.
///
/// An error of depth of `base + growth z^2` metres is `growth + base q^2` in inverse depth.
fn non_negative(points: &[(f64, f64, f64)], space: Space) -> [f64; 2] {
    if points.is_empty() {
        return [0.0; 2];
    }
    let (mut n, mut x, mut xx, mut y, mut xy) = (0.0, 0.0, 0.0, 0.0, 0.0);
    for &(q, sigma, weight) in points {
        let square = q * q;
        n += weight;
        x += weight * square;
        xx += weight * square * square;
        y += weight * sigma;
        xy += weight * square * sigma;
    }
    if space == Space::Value {
        return [y / n, 0.0];
    }
    let det = n * xx - x * x;
    let (constant, square) = ((xx * y - x * xy) / det, (n * xy - x * y) / det);
    if det.is_nan() || det <= 1e-9 * n * xx || square < 0.0 {
        [y / n, 0.0]
    } else if constant < 0.0 {
        [0.0, xy / xx]
    } else {
        [constant, square]
    }
}

/// A sensor's noise as frames of it show it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// [`SensorNoise::Depth`] of depth maps, [`SensorNoise::Value`] of all others.
    pub noise: SensorNoise,
    /// The steps that the values come in, map units, the finest of all frames; 0 for values that are not rounded.
    pub step: f64,
    /// Blocks of 12 x 12 pixels that the estimate rests on.
    pub blocks: usize,
    /// What the maps' numbers mean; of several depth maps with different units, the last one's.
    pub measure: Measure,
    /// Where all but a fortieth of the blocks lie on either side, low and high: 1/m for depth maps, map units for all
    /// others.
    pub range: [f64; 2],
    /// How well the rays of the pixels are known, pixels, one standard deviation; `None` where it is within 0.1, or cannot
    /// be told from the noise.
    pub ray: Option<f64>,
}

impl Estimate {
    /// The model of the sensor's own error, without rounding.
    pub fn model(&self) -> NoiseModel {
        NoiseModel::new(self.measure, self.noise, 0.0).expect("an estimate is of its own measure's kind")
    }
}

/// Estimates a sensor's noise from one frame or from several together.
///
/// It sees what varies from pixel to pixel over 12 pixels. Errors that are smooth over more, such as a bow over a whole
/// wall, are not noise to it; texture and clutter are, where they cover more than half of a stretch of ranges.
///
/// ```
/// use depthplanes::noise::{Estimator, SensorNoise};
/// use depthplanes::scene::Spec;
/// let frame = "room:sensor=tof_white".parse::<Spec>()?.frame()?;
/// let mut estimator = Estimator::default();
/// estimator.add(frame.view(), frame.sensor.measure)?;
/// // The generator's noise is 1 mm + 1.3 mm (z / 1 m)^2.
/// let sigma_m = estimator.estimate()?.model().depth_sigma_m(3.0).unwrap();
/// assert!((sigma_m / 0.0127 - 1.0).abs() < 0.2);
/// # Ok::<(), depthplanes::Error>(())
/// ```
#[derive(Debug, Default)]
pub struct Estimator {
    blocks: Blocks,
    slants: Slants,
    steps: Steps,
    /// Of the frames so far.
    seen: Option<(Measure, f64)>,
}

impl Estimator {
    /// Adds a frame whose numbers mean `measure`.
    ///
    /// # Errors
    /// [`Error::MixedMeasures`] unless all frames hold depth, or all the same disparity.
    pub fn add<'m>(&mut self, map: impl Into<AnyView<'m>>, measure: Measure) -> Result<()> {
        let step = with_view!(map.into(), map => self.frame(&map, measure, true))?;
        let finest = self.seen.map_or(step, |(_, finest)| step.min(finest));
        self.seen = Some((measure, finest));
        Ok(())
    }

    /// Adds a frame's blocks, also those that the ray is estimated from if that is wanted; gives its steps.
    fn frame<T: Pixel>(&mut self, map: &DepthView<'_, T>, measure: Measure, of_ray: bool) -> Result<f64> {
        let is_depth = |measure| matches!(measure, Measure::Depth { .. });
        if self.seen.is_some_and(|(seen, _)| seen != measure && !(is_depth(seen) && is_depth(measure))) {
            return Err(Error::MixedMeasures);
        }
        let (space, step) = (Space::of(measure), self.steps.of(map));
        for place in squares([map.width(), map.height()], SIDE) {
            let (sums, origin) = square(map, space, place, SIDE);
            self.blocks.add(&sums, origin, space, step);
        }
        for place in squares([map.width(), map.height()], RAY_SIDE).filter(|_| of_ray) {
            if let Some(tiled) = tiled(map, space, place) {
                self.slants.add(&tiled, None, space, step);
            }
        }
        Ok(step)
    }

    /// The noise of all frames so far.
    ///
    /// # Errors
    /// [`Error::TooFewBlocks`] if fewer than 8 blocks of 12 x 12 pixels have four fifths of their pixels.
    pub fn estimate(&mut self) -> Result<Estimate> {
        let found = self.blocks.all.len();
        let Some((measure, step)) = self.seen.filter(|_| found >= LEAST) else {
            return Err(Error::TooFewBlocks { found, least: LEAST });
        };
        let (noise, range) = self.blocks.noise(Space::of(measure));
        let ray = self.slants.ray();
        Ok(Estimate { noise, step, blocks: found, measure, range, ray })
    }
}

impl NoiseModel {
    /// Of one map: the sensor's noise as stated, or else as the map shows it; none where it shows no block.
    pub(crate) fn of_map<T: Pixel>(map: &DepthView<'_, T>, sensor: &Sensor) -> Self {
        let measure = sensor.measure;
        let mut estimator = Estimator::default();
        let step = estimator.frame(map, measure, false).expect("one frame has one measure");
        let stated = sensor.noise.and_then(|noise| NoiseModel::new(measure, noise, step));
        let estimated = || {
            let (noise, _) = estimator.blocks.noise(Space::of(measure));
            Some(NoiseModel::new(measure, noise, step)?.of_scatter())
        };
        stated.or_else(estimated).expect("an estimate is of the map's own kind")
    }
}

/// The first (u, v) of each square of so many pixels a side that lies within a size, row by row.
fn squares([width, height]: [usize; 2], side: usize) -> impl Iterator<Item = [usize; 2]> {
    let columns = width / side;
    (0..columns * (height / side)).map(move |at| [at % columns * side, at / columns * side])
}

/// The sums of a square's valid pixels about its first pixel and about the q that comes with them.
fn square<T: Pixel>(map: &DepthView<'_, T>, space: Space, [u, v]: [usize; 2], side: usize) -> (Moments, f64) {
    let validity = map.validity();
    let (mut sums, mut origin) = (Moments::default(), 0.0);
    for dv in 0..side {
        for (du, &value) in map.row(v + dv)[u..u + side].iter().enumerate() {
            if validity.holds(value) {
                let q = space.q(value.into());
                if sums.n == 0.0 {
                    origin = q;
                }
                sums.add(du as f64, dv as f64, q - origin);
            }
        }
    }
    (sums, origin)
}

/// What the ray is estimated from, of a block that has enough pixels.
fn tiled<T: Pixel>(map: &DepthView<'_, T>, space: Space, [u, v]: [usize; 2]) -> Option<Tiled> {
    let squared = |fit: &AffineFit| fit.rms * fit.rms * fit.n;
    let (sums, origin) = square(map, space, [u, v], RAY_SIDE);
    let fit = sums.fit().filter(|fit| fit.n >= VALID * (RAY_SIDE * RAY_SIDE) as f64)?;
    let [mut tiles_free, mut tiles_squares] = [0.0; 2];
    for [du, dv] in squares([RAY_SIDE; 2], TILE) {
        let tile = square(map, space, [u + du, v + dv], TILE).0.fit();
        if let Some(tile) = tile.filter(|tile| tile.n > 3.0) {
            tiles_free += tile.n - 3.0;
            tiles_squares += squared(&tile);
        }
    }
    let (q, [a, b, _]) = (origin + sums.q / sums.n, fit.abc);
    Some(Tiled { q, gradient: [a, b], n: fit.n, squares: squared(&fit), tiles_free, tiles_squares })
}
