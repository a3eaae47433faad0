//! Evenly spaced pixels of a map, with what the traps ask of them.

use depthplanes::{AnyView, DepthView, Pixel, with_view};

use crate::error::Result;
use crate::frame::{Frame, Pixels};

/// Fewer valid pixels say nothing.
pub(super) const FEW: usize = 64;
/// Maps of fewer pixels are examples written by hand, of few values and large steps; no camera makes them.
const SMALL: usize = 4096;

/// Pixels that are looked at: enough for shares of half a percent, cheap enough for every frame.
const PIXELS: usize = 1 << 12;

/// Evenly spaced pixels of a map.
pub(crate) struct Probe {
    /// Pixels looked at.
    pub(crate) pixels: usize,
    /// The valid values among them, increasing.
    pub(crate) valid: Vec<f64>,
    /// Valid pixels and their right neighbours.
    pub(crate) pairs: Vec<[f64; 2]>,
    /// Whether the file's samples are whole numbers.
    pub(crate) is_integer: bool,
    /// Pixels among them that are below 0; only floats are.
    pub(crate) negative: usize,
    /// How many times the median of the valid values in the lower half of the picture is that in the upper half.
    below_to_above: Option<f64>,
}

impl Probe {
    /// About `most` pixels of a map, or all of them if it has no more.
    pub(crate) fn of(frame: &Frame, most: usize) -> Result<Probe> {
        let least = (frame.width * frame.height).div_ceil(most);
        // So as not to stay in a few columns, nor to meet a ramp at multiples of a number alone.
        let stride =
            if least == 1 { 1 } else { (least..).find(|&step| is_coprime(step, 210 * frame.width)).unwrap_or(1) };
        let is_integer = !matches!(frame.pixels, Pixels::F32(_));
        let view: AnyView<'_> = frame.view()?;
        Ok(with_view!(view, view => Probe { is_integer, ..Probe::values(view, stride) }))
    }

    /// As many pixels as say enough of a map; none of one that the library does not accept.
    pub(crate) fn some(frame: &Frame) -> Option<Probe> {
        Probe::of(frame, PIXELS).ok()
    }

    fn values<T: Pixel>(view: DepthView<'_, T>, stride: usize) -> Probe {
        let (width, valid) = (view.width(), view.validity());
        let mut probe = Probe {
            pixels: 0,
            valid: Vec::new(),
            pairs: Vec::new(),
            is_integer: true,
            negative: 0,
            below_to_above: None,
        };
        let mut above = 0;
        for at in (0..width * view.height()).step_by(stride) {
            probe.pixels += 1;
            let (row, u) = (view.row(at / width), at % width);
            probe.negative += usize::from(row[u].into() < 0.0);
            if 2 * (at / width) < view.height() {
                above = probe.valid.len();
            }
            if valid.holds(row[u]) {
                probe.valid.push(row[u].into());
                if u + 1 < width && valid.holds(row[u + 1]) {
                    probe.pairs.push([row[u].into(), row[u + 1].into()]);
                }
            }
        }
        probe.below_to_above = {
            let (above, below) = probe.valid.split_at_mut(above);
            middle(above).zip(middle(below)).map(|(above, below)| below / above)
        };
        probe.valid.sort_unstable_by(f64::total_cmp);
        probe
    }

    /// Share of the pixels without a measurement, 0 to 1.
    pub(crate) fn missing_share(&self) -> f64 {
        1.0 - self.valid.len() as f64 / self.pixels.max(1) as f64
    }

    /// The value in the middle.
    pub(super) fn median(&self) -> Option<f64> {
        self.valid.get(self.valid.len() / 2).copied()
    }

    /// How many times as large values are in the lower half of the picture as in the upper one, by their medians; `None`
    /// where there are too few.
    pub(crate) fn grows_below(&self) -> Option<f64> {
        self.below_to_above.filter(|_| self.levels().len() > 32)
    }

    /// The largest value, and how many of the valid pixels have exactly that.
    pub(super) fn largest(&self) -> Option<(f64, usize)> {
        let &largest = self.valid.last()?;
        Some((largest, self.valid.len() - self.valid.partition_point(|&value| value < largest)))
    }

    /// The different values, increasing.
    pub(crate) fn levels(&self) -> Vec<f64> {
        let mut levels = self.valid.clone();
        levels.dedup();
        levels
    }
}

fn middle(values: &mut [f64]) -> Option<f64> {
    let at = values.len() / 2;
    (!values.is_empty()).then(|| *values.select_nth_unstable_by(at, f64::total_cmp).1)
}

fn is_coprime(mut a: usize, mut b: usize) -> bool {
    while b > 0 {
        (a, b) = (b, a % b);
    }
    a == 1
}

/// Whether a map was written by hand.
pub(crate) fn is_small(frame: &Frame) -> bool {
    frame.pixels.len() < SMALL
}

/// A share for people, at least 1 %.
pub(super) fn percent(share: f64) -> String {
    format!("{:.0} %", (100.0 * share).max(1.0))
}
