//! What a map's values are rounded to.
//!
//! In: one map of any pixel type, and its space. Out: a [`Rounding`], the step of q as a function of q. Disparity
//! stored as depth has steps that grow with the square of the range, time of flight has steps of depth, half
//! precision doubles its step at powers of two; so the step is looked for in each stretch of q by itself. A value
//! counts by how often it occurs, not by its type: rounded values repeat, and the same numbers give the same steps as
//! `u16` millimetres and as `f32` metres.
//!
//! A thin sample leaves gaps between values, scaled maps leave out values everywhere, and flying pixels lie between
//! the steps. So the step is a low quantile of the gaps between values that repeat, sharpened by the mean of the gaps
//! near it. On planes along whose rows or columns the value is constant, repeats say nothing; there the step is what
//! all values are multiples of, which is 0 for true floats.

use super::lanes::{LANES, Lanes};
use super::space::Space;
use crate::map::{DepthView, Pixel};
use crate::util::memory::reserve_to;

mod level;
mod sample;
#[cfg(test)]
mod tests;
mod units;

use level::{LEAST, Level};
use sample::{SHIFT, Sample};

/// Entries of a table over q: eight octaves of eight entries.
const BINS: usize = 64;
/// Units in the last place by which a value may lie below an eighth of an octave and belong to it: single precision
/// puts 1/0.8 below 1.25.
const NEAR: u32 = 16;
/// Fewest gaps of a stretch.
const ENOUGH: usize = 12;
/// Share of the pixels whose values may be left out, the rarest first: flying pixels and interpolated ones. In a
/// sample in which values occur by chance, these are no more than a quarter of the values.
const RARE: f64 = 0.1;
/// A value repeats if it starts at least so often in rows and in columns: on a map that is its own mirror image true
/// floats occur twice.
const REPEATS: usize = 3;
/// Share of the pixels of a stretch whose values have to repeat, equal to the quantile. Where a level floor and a
/// level wall cross in one stretch, a step between every fifth of their lines makes so many.
const REPEATED: f64 = QUANTILE;
/// Mean number of repeats of a value at which hardly a value is missing or taken for a stray one.
const DENSE: u32 = 8;
/// Higher numbers of repeats are not told apart.
const OFTEN: usize = 32;
/// The quantile of the gaps: fewer than a fifth of them are shorter than a step, next to values between the steps;
/// and a fifth of the gaps is one step long as long as a fifth of the values is seen.
const QUANTILE: f64 = 0.2;

/// The share of rounding that follows the signal instead of being dithered, for steps of that square and pixels that
/// scatter with the variance `scatter`: none from a scatter of half a step on. (The exact share is an exponential of
/// the ratio; this uses no function that differs between machines.)
#[inline(always)]
pub(crate) fn steady(square: f64, scatter: f64) -> f64 {
    if square > 0.0 { (4.0 / 3.0 * (1.0 - 4.0 * scatter / square)).clamp(0.0, 1.0) } else { 0.0 }
}

/// The steps of q, the space where planes are affine ([`Space`]), over q.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rounding(Steps);

#[derive(Clone, Copy, Debug, PartialEq)]
#[expect(clippy::large_enum_variant, reason = "a handful exist at a time, and being `Copy` keeps a noise model plain")]
enum Steps {
    /// Steps of the map's values, map units, the same everywhere.
    Values { step: f64, space: Space },
    /// Steps of q, one for each eighth of an octave, beginning with the one of number `first`.
    Table { first: u32, steps: [f32; BINS] },
}

impl Rounding {
    /// Values that are not rounded.
    pub const NONE: Rounding = Rounding(Steps::Values { step: 0.0, space: Space::Value });

    /// The rounding of a map whose values come in steps of `step` map units, 0 or more, everywhere.
    pub fn of_values(step: f64, space: Space) -> Self {
        Rounding(Steps::Values { step, space })
    }

    /// The step of q at q, 0 for values that are not rounded.
    #[inline]
    pub fn step(&self, q: f64) -> f64 {
        match &self.0 {
            Steps::Values { step, space } => step * space.unit(q),
            Steps::Table { first, steps } => steps[place(q, *first)].into(),
        }
    }

    /// The steps at many q.
    #[inline(always)]
    pub(super) fn steps(&self, q: &Lanes) -> Lanes {
        let mut out = [0.0; LANES];
        match &self.0 {
            Steps::Values { step, space } => (0..LANES).for_each(|lane| out[lane] = step * space.unit(q[lane])),
            Steps::Table { first, steps } => {
                (0..LANES).for_each(|lane| out[lane] = steps[place(q[lane], *first)].into());
            }
        }
        out
    }

    /// The variance of q by rounding: that of a uniform error within half a step.
    #[inline]
    pub fn variance(&self, q: f64) -> f64 {
        let step = self.step(q);
        step * step / 12.0
    }
}

/// The eighth of an octave in which q lies, from 2^-127 on.
#[inline(always)]
fn bin(q: f32) -> u32 {
    ((q.to_bits() & 0x7fff_ffff) + NEAR) >> SHIFT
}

/// The entry for q of a table that begins with the eighth of an octave of number `first`.
#[inline(always)]
fn place(q: f64, first: u32) -> usize {
    bin(q as f32).saturating_sub(first).min(BINS as u32 - 1) as usize
}

/// The middle of an eighth of an octave.
fn middle(bin: u32) -> f64 {
    let [low, high] = [bin, bin + 1].map(|bin| f64::from(f32::from_bits(bin << SHIFT)));
    (low * high).sqrt()
}

/// Finds what values are rounded to; reuses its memory.
#[derive(Debug, Default)]
pub struct RoundingFinder {
    sample: Sample,
    /// q of each value that occurs, ascending.
    levels: Vec<Level>,
    gaps: Vec<f64>,
}

/// A step and where it was found.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Knot {
    /// The middle of its levels.
    q: f64,
    step: f64,
}

impl RoundingFinder {
    /// The rounding of a map whose planes are affine in that space.
    ///
    /// ```
    /// use depthplanes::DepthView;
    /// use depthplanes::noise::{RoundingFinder, Space};
    /// // A wall, slanted across, by a sensor that knows even millimetres only.
    /// let depth_mm: Vec<u16> = (0..160 * 120).map(|at| 1000 + (at % 160 + at / 160) as u16 / 4 * 2).collect();
    /// let map = DepthView::new(&depth_mm, 160, 120)?;
    /// let rounding = RoundingFinder::default().find(&map, Space::InverseDepth { metres: 0.001 });
    /// let step_m = rounding.step(1.0 / 1.05) * 1.05 * 1.05;
    /// assert!((step_m - 0.002).abs() < 0.0002);
    /// # Ok::<(), depthplanes::Error>(())
    /// ```
    pub fn find<T: Pixel>(&mut self, map: &DepthView<'_, T>, space: Space) -> Rounding {
        let RoundingFinder { sample, levels, gaps } = self;
        let whole: f64 = if T::IS_INTEGER { 1.0 } else { 0.0 };
        sample.take(map);
        reserve_to(levels, sample::MOST);
        reserve_to(gaps, sample::MOST);
        levels.extend(sample.sorted().map(|counted| Level::of(counted, space)));
        if let Space::InverseDepth { .. } = space {
            levels.reverse();
        }
        let unit = units::common(levels, space, whole);
        let table = if sample.is_thin() { None } else { table(levels, gaps, unit, space) };
        table.unwrap_or(Rounding::of_values(unit, space))
    }
}

/// The steps over q, from levels that are multiples of `unit`; `None` if they tell no more than that unit.
fn table(levels: &[Level], gaps: &mut Vec<f64>, unit: f64, space: Space) -> Option<Rounding> {
    let first = bin(levels.last()?.q as f32).saturating_sub(BINS as u32 - 1);
    let all: u32 = levels.iter().map(|level| level.weight).sum();
    let mut knots = [Knot::default(); BINS];
    let mut bounds = [f64::INFINITY; BINS];
    let (mut count, mut is_told) = (0, false);
    let mut rest = levels;
    while !rest.is_empty() && count < BINS {
        let stretch;
        (stretch, rest) = rest.split_at(length(rest));
        let [low, high] = [stretch[0].q, stretch[stretch.len() - 1].q].map(|q| bin(q as f32).max(first));
        let weight: u32 = stretch.iter().map(|level| level.weight).sum();
        let step = match look(stretch, gaps, unit, space) {
            Found::Step(step) => step,
            Found::AtMost(most) => {
                bounds[(low - first) as usize..=(high - first) as usize].fill(most);
                continue;
            }
            // A few stray values say nothing of the steps.
            Found::Nothing if f64::from(weight) < RARE * f64::from(all) => continue,
            Found::Nothing => unit * space.unit(middle(low.midpoint(high))),
        };
        is_told |= step > unit * space.unit(middle(high));
        knots[count] = Knot { q: middle(low.midpoint(high)), step };
        count += 1;
    }
    if !is_told {
        return None;
    }
    let mut steps = [0.0; BINS];
    for ((bin, step), most) in (first..).zip(&mut steps).zip(bounds) {
        let q = middle(bin);
        *step = between(&knots[..count], q).min(most).max(unit * space.unit(q)) as f32;
    }
    Some(Rounding(Steps::Table { first, steps }))
}

/// How many of the levels make the next stretch: whole bins, with enough gaps in it and in the rest.
fn length(levels: &[Level]) -> usize {
    let of = |at: usize| bin(levels[at].q as f32);
    let ends = |at: &usize| of(*at) != of(*at - 1);
    let end = (ENOUGH + 1..levels.len()).find(ends);
    end.filter(|end| levels.len() - end > ENOUGH).unwrap_or(levels.len())
}

/// What the levels of a stretch say of its step.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Found {
    /// The step of q.
    Step(f64),
    /// An upper bound, from the lines of level surfaces.
    AtMost(f64),
    /// Values do not repeat.
    Nothing,
}

/// What the levels of a stretch, all multiples of `unit`, say of the step of q.
fn look(levels: &[Level], gaps: &mut Vec<f64>, unit: f64, space: Space) -> Found {
    // Weight by how often a value repeats.
    let mut weights = [0; OFTEN + 1];
    levels.iter().for_each(|level| weights[OFTEN.min(level.repeats as usize)] += level.weight);
    let all: u32 = weights.iter().sum();
    let is_share = |weight: u32, share: f64| f64::from(weight) >= share * f64::from(all);
    let repeats = is_share(all - weights[..REPEATS].iter().sum::<u32>(), REPEATED);
    let on_line = |level: &&Level| (level.weight - level.repeats) as usize >= REPEATS;
    let on_lines = levels.iter().filter(on_line).map(|level| level.weight).sum();
    if !repeats && !is_share(on_lines, 1.0 - RARE) {
        return Found::Nothing;
    }
    // How often a value has to occur not to be a stray one.
    let mut rarer = 0;
    let is_stray = |weight: &&u32| {
        rarer += **weight;
        is_share(all - rarer, 1.0 - RARE)
    };
    let least = weights[..OFTEN].iter().take_while(is_stray).count() as u32;
    gaps.clear();
    let mut last = None;
    for level in levels.iter().filter(|level| level.repeats >= least) {
        gaps.extend(last.replace(level.q).map(|last| level.q - last));
    }
    if gaps.len() < LEAST {
        return Found::Nothing;
    }
    let quantile = (QUANTILE * gaps.len() as f64) as usize;
    let low = *gaps.select_nth_unstable_by(quantile, f64::total_cmp).1;
    let unit = unit * space.unit(levels[levels.len() / 2].q);
    let is_dense = all >= 2 * DENSE * levels.len() as u32;
    if repeats { Found::Step(sharpened(gaps, low, unit, is_dense)) } else { Found::AtMost(low) }
}

/// The mean of the gaps near `low`: steps of one and a half millimetres stored as whole ones are gaps of one and of
/// two. Gaps of two steps do not count, for a value may be missing between; and where many are missing, a gap of one
/// unit is taken as one unit.
fn sharpened(gaps: &[f64], low: f64, unit: f64, is_dense: bool) -> f64 {
    if low <= 1.5 * unit && !is_dense {
        return unit;
    }
    let [from, to] = [(0.7 * low).min(low - 1.2 * unit), (1.4 * low).max(low + 1.2 * unit)];
    let near = gaps.iter().filter(|gap| (from..=to).contains(*gap));
    let (count, sum) = near.fold((0.0, 0.0), |(count, sum), gap| (count + 1.0, sum + gap));
    sum / count
}

/// The step at q, interpolated linearly between the middles of stretches; beyond the outermost it follows a power of q.
fn between(knots: &[Knot], q: f64) -> f64 {
    let after = knots.partition_point(|knot| knot.q < q);
    let before = after.checked_sub(1).map(|before| knots[before]);
    match (before, knots.get(after)) {
        (Some(low), Some(high)) => low.step + (high.step - low.step) * (q - low.q) / (high.q - low.q),
        (None, Some(first)) => beyond(first, knots.get(1), q),
        (Some(last), None) => beyond(&last, after.checked_sub(2).map(|at| &knots[at]), q),
        (None, None) => 0.0,
    }
}

/// The step at q beyond the middle of the outermost stretch, by the power of q that leads to the step of the next
/// stretch: 0 as for disparity, 1, or 2 as for depth. It uses no logarithm, which differs between machines.
fn beyond(outermost: &Knot, next: Option<&Knot>, q: f64) -> f64 {
    let Some(next) = next.filter(|next| next.step > 0.0 && outermost.step > 0.0) else { return outermost.step };
    let [low, high] = if next.q < outermost.q { [next, outermost] } else { [outermost, next] };
    let (grown, by) = (high.step / low.step, high.q / low.q);
    let power = i32::from(grown * grown > by) + i32::from(grown * grown > by.powi(3));
    outermost.step * (q / outermost.q).powi(power)
}
