//! Which values occur in a map, and how often.
//!
//! In: a map. Out: the values of pixels on a lattice over it, ascending, each with how often it starts anew along
//! rows and along columns of the lattice. On a level wall every row has one value: it starts once in its row, and
//! once in every column.

use crate::map::{DepthView, Pixel};
use crate::util::memory::reserve_to;

/// Bits of single precision that do not tell the eighth of an octave.
pub(super) const SHIFT: u32 = 20;
/// Pixels that are looked at, about.
const PIXELS: usize = 16_000;
/// Places of the table of values.
const PLACES: usize = 1 << 15;
/// Most values that are told apart; three quarters of the places.
pub(super) const MOST: usize = PLACES / 4 * 3;
/// Least mean number of starts of a value; with fewer the sample is thin.
const OFTEN: usize = 3;
/// Steps of the lattice between those pixels that are looked at first.
const FIRST: usize = 4;
/// Fewest different values among the first pixels that can tell a thin sample.
const LEAST: usize = 100;
/// Share of different values among the first pixels above which the sample is thin: where a value occurs [`OFTEN`]
/// times in the whole sample, one in ten pixels of a sixteenth of it meets an equal one.
const DIFFERENT: f64 = 0.9;
/// Most values of a thin sample that are looked at.
const FEW: usize = 1 << 11;

/// A value, its sign left out, and how often it starts anew.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Counted {
    pub(super) value: f32,
    pub(super) rows: u32,
    pub(super) columns: u32,
}

/// Takes samples; reuses its memory.
#[derive(Debug, Default)]
pub(super) struct Sample {
    /// Open addressing: the bits of a value, 0 where none is.
    values: Vec<u32>,
    /// How often it starts in columns, plus 65,536 times how often it starts in rows.
    counts: Vec<u32>,
    /// Places that are taken.
    taken: Vec<u32>,
    /// The row of the lattice above.
    above: Vec<u32>,
    sorted: Vec<u64>,
    /// Starts of values.
    starts: usize,
    is_thin: bool,
}

impl Sample {
    /// Looks at a few pixels of a map, and at more unless most of the few differ.
    pub(super) fn take<T: Pixel>(&mut self, map: &DepthView<'_, T>) {
        let step = map.area().div_ceil(PIXELS).isqrt();
        let step = if step * step * PIXELS < map.area() { step + 1 } else { step };
        let pixels = self.look(map, FIRST * step);
        self.is_thin = self.taken.len() >= LEAST && self.taken.len() as f64 > DIFFERENT * pixels as f64;
        if !self.is_thin {
            self.look(map, step);
            self.is_thin = self.starts < OFTEN * self.taken.len();
        }
    }

    /// Looks at a lattice of pixels with the given step; returns how many are valid.
    fn look<T: Pixel>(&mut self, map: &DepthView<'_, T>, step: usize) -> usize {
        self.clear();
        reserve_to(&mut self.above, map.width());
        self.above.resize(map.width().div_ceil(step), 0);
        let validity = map.validity();
        let mut pixels = 0;
        let mut above = std::mem::take(&mut self.above);
        for v in (0..map.height()).step_by(step) {
            let mut left = 0;
            for (&value, above) in map.row(v).iter().step_by(step).zip(&mut above) {
                let bits = if validity.holds(value) { value.to_f32().to_bits() & 0x7fff_ffff } else { 0 };
                let above = std::mem::replace(above, bits);
                let starts = u32::from(bits != left) << 16 | u32::from(bits != above);
                left = bits;
                if bits > 0 {
                    pixels += 1;
                    self.count(bits, starts);
                }
            }
        }
        self.above = above;
        pixels
    }

    fn clear(&mut self) {
        let Sample { values, counts, taken, sorted, .. } = self;
        if values.is_empty() {
            values.resize(PLACES, 0);
            counts.resize(PLACES, 0);
            taken.reserve(PLACES);
            sorted.reserve(PLACES);
        }
        taken.drain(..).for_each(|place| values[place as usize] = 0);
        self.starts = 0;
    }

    #[inline(always)]
    fn count(&mut self, bits: u32, starts: u32) {
        // A value that goes on adds 0 to its count, without a branch, which would rarely be predicted. The place is a
        // multiplicative hash by the golden ratio (Knuth, The Art of Computer Programming 3, section 6.4).
        let mut place = (bits.wrapping_mul(0x9e37_79b1) >> (32 - PLACES.ilog2())) as usize;
        self.starts += usize::from(starts > 0);
        loop {
            if self.values[place] == bits {
                self.counts[place] += starts;
                return;
            }
            if self.values[place] == 0 {
                if self.taken.len() == MOST {
                    return;
                }
                self.values[place] = bits;
                self.counts[place] = starts;
                self.taken.push(place as u32);
                return;
            }
            place = (place + 1) % PLACES;
        }
    }

    /// Whether most values occur once or twice: floats that are not rounded, or rounded so finely that the sample leaves
    /// out most steps.
    pub(super) fn is_thin(&self) -> bool {
        self.is_thin
    }

    /// The values that occur, ascending. Of a thin sample only those of the eighth of an octave that has most: what
    /// values are multiples of shows best among close ones.
    pub(super) fn sorted(&mut self) -> impl Iterator<Item = Counted> {
        let fullest = if self.is_thin() { self.fullest() } else { None };
        let Sample { values, counts, taken, sorted, .. } = self;
        let each = taken.iter().map(|&place| (values[place as usize], counts[place as usize]));
        let both = |(bits, counts): (u32, u32)| u64::from(bits) << 32 | u64::from(counts);
        sorted.clear();
        match fullest {
            Some(bin) => sorted.extend(each.filter(|(bits, _)| bits >> SHIFT == bin).take(FEW).map(both)),
            None => sorted.extend(each.map(both)),
        }
        sorted.sort_unstable();
        sorted.iter().map(|&both| Counted {
            value: f32::from_bits((both >> 32) as u32),
            rows: both as u32 >> 16,
            columns: both as u32 & 0xffff,
        })
    }

    /// The eighth of an octave with the most values.
    fn fullest(&self) -> Option<u32> {
        let mut counts = [0u32; 1 << (31 - SHIFT)];
        self.taken.iter().for_each(|&place| counts[(self.values[place as usize] >> SHIFT) as usize] += 1);
        (0..).zip(counts).max_by_key(|&(_, count)| count).map(|(bin, _)| bin)
    }
}
