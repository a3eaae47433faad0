//! One exact value on many pixels, which stands for "nothing measured": a far clip, a background, what a matcher writes where
//! it matches nothing.
//!
//! A measured surface goes on to neighbouring values, at its edges and by its noise. A sentinel value is by itself. It may
//! lie anywhere among the values, and is mostly the largest or the smallest.

use depthplanes::{DepthView, Pixel, ValueKind, with_view};

use super::missing::shown;
use super::probe::{FEW, Probe, is_small, percent};
use crate::frame::Frame;

/// Share of the pixels from which on one exact value is no accident.
const SHARE: f64 = 0.01;
/// How many times as common as any other value a sentinel is.
const TIMES: f64 = 8.0;
/// How many times as large, or as small, as all others a value is that lies apart.
const APART: f64 = 1.5;
/// Difference up to which neighbours go on to each other, as a share of the value.
const NEAR: f64 = 0.05;
/// Share of the neighbours at the edges of a sentinel's regions that are near it by chance.
const BY_CHANCE: f64 = 0.1;
/// How many times as long as that of a square the border of a sentinel's regions is: a surface is in few pieces.
const RAGGED: f64 = 3.0;
/// Share of equal neighbours up to which a map is noisy, so that no surface has one exact value.
const NOISY: f64 = 0.3;
/// Fewest pairs of the probe with a value that tell of it.
const EXACT: usize = 16;

/// What every note on a sentinel value has.
pub(crate) const EXACTLY: &str = "are exactly";

/// One value that stands for "nothing".
pub(super) fn sentinel(frame: &Frame, probe: &Probe) -> Option<String> {
    let is_grey = frame.encoding == "grey" && frame.provenance.is_guess();
    if is_small(frame) || is_grey {
        return None;
    }
    let metres = match frame.sensor.value_kind {
        ValueKind::Depth { metres } => Some(metres),
        _ => None,
    };
    let is_bound = |value: f64| frame.valid_range.is_some_and(|(low, high)| [low, high].contains(&value));
    let common = Common::values(probe).into_iter().filter(|common| common.share >= SHARE && !is_bound(common.value));
    common.into_iter().find(|common| common.is_sentinel(frame, probe, metres)).map(|common| common.told(metres))
}

/// A value of a map that many pixels may have.
struct Common {
    value: f64,
    /// Share of all pixels.
    share: f64,
    /// How many times as common as any other value.
    times: f64,
    /// The values before and after it that occur.
    below: Option<f64>,
    above: Option<f64>,
}

impl Common {
    /// The most common, the largest and the smallest value of a map.
    fn values(probe: &Probe) -> Vec<Common> {
        let counts: Vec<(f64, usize)> = probe.valid.chunk_by(|a, b| a == b).map(|run| (run[0], run.len())).collect();
        let Some(commonest) = (0..counts.len()).max_by_key(|&at| counts[at].1) else { return Vec::new() };
        let near = |at: Option<usize>| Some(counts.get(at?)?.0);
        let of = |at: usize| {
            let (value, count) = counts[at];
            let next = (0..counts.len()).filter(|&other| other != at).map(|other| counts[other].1).max().unwrap_or(0);
            let (share, times) = (count as f64 / probe.pixels as f64, count as f64 / next as f64);
            let is_all = probe.valid.len() - count < FEW;
            (!is_all).then(|| Common { value, share, times, below: near(at.checked_sub(1)), above: near(Some(at + 1)) })
        };
        [commonest, counts.len() - 1, 0].into_iter().filter_map(of).collect()
    }

    fn is_sentinel(&self, frame: &Frame, probe: &Probe, metres: Option<f64>) -> bool {
        let is_chosen = is_chosen(self.value) || metres.is_some_and(|metres| is_chosen(self.value * metres));
        if self.times <= TIMES {
            return is_chosen && self.is_apart() && self.times > 1.0 / TIMES;
        }
        let is_by_itself = || {
            let Ok(view) = frame.view() else { return false };
            with_view!(view, view => Edges::of(&view, self.value, self.step())).are_of_nothing()
        };
        self.is_apart() || is_chosen && self.above.is_none() || is_exact_in_noise(probe, self.value) || is_by_itself()
    }

    /// Difference to the nearest of the other values.
    fn step(&self) -> f64 {
        let others = [self.below, self.above].into_iter().flatten();
        others.map(|other| (self.value - other).abs()).fold(f64::INFINITY, f64::min)
    }

    /// Whether it is far above or far below all others.
    fn is_apart(&self) -> bool {
        match (self.below, self.above) {
            (Some(below), None) => self.value > APART * below,
            (None, Some(above)) => above > APART * self.value,
            _ => false,
        }
    }

    fn told(&self, metres: Option<f64>) -> String {
        let (share, value) = (percent(self.share), shown(self.value));
        let length = metres.map_or(String::new(), |metres| format!(" ({:.4} m)", self.value * metres));
        let what = match (self.below, self.above) {
            (Some(below), None) => format!("all others are {} or less: a background or a far clip?", shown(below)),
            (None, Some(above)) => format!("all others are {} or more: a value for nothing measured?", shown(above)),
            _ => "hardly any pixel beside them is near that: a value for nothing measured?".into(),
        };
        format!("{share} of the pixels {EXACTLY} {value}{length}, and {what} try --missing {value}")
    }
}

/// The pixels with one value, and their valid neighbours that have another.
struct Edges {
    pixels: usize,
    near: usize,
    far: usize,
}

impl Edges {
    /// Those along rows and columns; values up to a step from it are near whatever it is.
    fn of<T: Pixel>(view: &DepthView<'_, T>, value: f64, step: f64) -> Edges {
        let (validity, mut edges, near) =
            (view.validity(), Edges { pixels: 0, near: 0, far: 0 }, step.max(NEAR * value));
        let mut pair = |a: T, b: T| {
            let [a_value, b_value]: [f64; 2] = [a.into(), b.into()];
            if (a_value == value) != (b_value == value) && validity.holds(a) && validity.holds(b) {
                let is_near = (a_value - b_value).abs() <= near;
                edges.near += usize::from(is_near);
                edges.far += usize::from(!is_near);
            }
        };
        for v in 0..view.height() {
            let row = view.row(v);
            row.windows(2).for_each(|two| pair(two[0], two[1]));
            if v > 0 {
                view.row(v - 1).iter().zip(row).for_each(|(&above, &below)| pair(above, below));
            }
        }
        let is = |pixel: &T| Into::<f64>::into(*pixel) == value;
        edges.pixels = (0..view.height()).map(|v| view.row(v).iter().filter(|pixel| is(pixel)).count()).sum();
        edges
    }

    /// Whether the regions go on to nothing beside them and are in many pieces, as no surface that faces the camera is.
    fn are_of_nothing(&self) -> bool {
        let all = (self.near + self.far) as f64;
        let of_a_square = 4.0 * (self.pixels as f64).sqrt();
        all >= RAGGED * of_a_square && self.near as f64 <= BY_CHANCE * all
    }
}

/// Whether pixels with one value lie beside each other in a map whose other neighbours hardly ever are equal.
fn is_exact_in_noise(probe: &Probe, value: f64) -> bool {
    let (with, others): (Vec<[f64; 2]>, Vec<[f64; 2]>) = probe.pairs.iter().partition(|pair| pair.contains(&value));
    let equal = |pairs: &[[f64; 2]]| pairs.iter().filter(|[a, b]| a == b).count() as f64 / pairs.len() as f64;
    // A surface in steps along rows has equal neighbours, too; that of one value in all of noise has none.
    with.len() >= EXACT && others.len() >= FEW && equal(&with) >= 0.5 && equal(&others) <= NOISY
}

/// Whether a number is one that programs choose: one or two digits that are not 0, all bits or all digits at their largest.
fn is_chosen(number: f64) -> bool {
    let digits = number / 10f64.powf(number.abs().log10().floor() - 1.0);
    let is_round = (digits - digits.round()).abs() < 1e-5;
    let is_full = number >= 127.0 && number.fract() == 0.0 && number < 1e9 && {
        let next = number as u64 + 1;
        next.is_power_of_two() || [1_000, 10_000, 100_000, 1_000_000].contains(&next)
    };
    is_round || is_full
}
