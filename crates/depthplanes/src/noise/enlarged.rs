//! Whether a map was enlarged by repeating pixels.
//!
//! In: a map. Out: an [`Enlargement`], the first column and the first row of each source pixel; `None` for other
//! maps. Enlarging to the nearest pixel turns every slanted plane into steps that face the camera, and gives whole
//! blocks of pixels the same error.
//!
//! In an enlarged map, columns (and rows) differ from those before them only at the borders of source pixels, which
//! are evenly spaced from the map's edge on, two or more pixels apart. Planes that face the camera, constant maps and
//! coarse disparities differ in few columns; so many have to differ that they would not all be borders by chance. A
//! find by chance does no harm, for the pixels of one block are equal.

use crate::map::{DepthView, Pixel};
use crate::util::simd::vectorised;

#[cfg(test)]
mod tests;

/// Smallest and largest factor.
const FACTORS: [f64; 2] = [2.0, 16.0];
/// Rows that are compared first, and rows between two checks of all others.
const FIRST: usize = 16;
/// Least evidence, bits, that the columns which differ are not borders by chance; for columns and for rows. Some
/// hundred factors are tried, each with two or three phases: of a thousand ordinary maps one may pass for columns,
/// and of these one in a million for both.
const CERTAIN: f64 = 10.0;
/// Least evidence, bits, for columns and rows together.
const CERTAIN_BOTH: f64 = 40.0;

/// Where the pixels of the source begin in a map that was enlarged.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Enlargement<'a> {
    /// The first column of each column of the source, ascending from 0.
    pub columns: &'a [u32],
    /// The first row of each row of the source.
    pub rows: &'a [u32],
    /// Columns and rows of the map for each source pixel, 2 to 16: source pixel i has its centre at `(i + 0.5) factor
    /// - 0.5`.
    pub factor: [f64; 2],
}

/// Finds out whether maps were enlarged; reuses its memory.
#[derive(Debug, Default)]
pub struct EnlargementFinder {
    columns: Axis,
    rows: Axis,
}

/// The columns of a map, or its rows.
#[derive(Debug, Default)]
struct Axis {
    /// Whether a column differs from the one before.
    differs: Vec<bool>,
    /// First columns of source pixels.
    starts: Vec<u32>,
}

impl EnlargementFinder {
    /// How a map was enlarged, along columns and along rows; `None` unless that is certain.
    ///
    /// ```
    /// use depthplanes::DepthView;
    /// use depthplanes::noise::EnlargementFinder;
    /// // 60 x 60 pixels of 30 x 30, on a slant.
    /// let depth_mm: Vec<u16> = (0..60 * 60).map(|at| 1000 + (at % 60 / 2 * 5 + at / 60 / 2 * 3) as u16).collect();
    /// let mut finder = EnlargementFinder::default();
    /// let found = finder.find(&DepthView::new(&depth_mm, 60, 60)?).unwrap();
    /// assert_eq!((found.factor, &found.columns[..4]), ([2.0, 2.0], &[0, 2, 4, 6][..]));
    /// # Ok::<(), depthplanes::Error>(())
    /// ```
    pub fn find<T: Pixel>(&mut self, map: &DepthView<'_, T>) -> Option<Enlargement<'_>> {
        let EnlargementFinder { columns, rows } = self;
        columns.start(map.width());
        rows.start(map.height());
        // A few rows first: in ordinary maps the first of them tells.
        for v in (0..map.height()).step_by(map.height().div_ceil(FIRST)) {
            compare_columns(map, v, &mut columns.differs);
            if !columns.is_possible() {
                return None;
            }
        }
        vectorised(
            #[inline(always)]
            || {
                for v in 0..map.height() {
                    compare_columns(map, v, &mut columns.differs);
                    rows.differs[v] = v > 0 && differ(map, [v - 1, v]);
                    if v % FIRST == 0 && !(columns.is_possible() && rows.is_possible()) {
                        return;
                    }
                }
            },
        );
        if !(columns.is_possible() && rows.is_possible()) {
            return None;
        }
        // Where few columns differ, several factors fit: prefer a round one, or one that fits the rows too.
        let common = columns.largest(columns.whole().filter(|&factor| rows.fits(factor)));
        let factor_of = |axis: &Axis| axis.largest(round()).or(common).or_else(|| axis.largest(axis.whole()));
        let factor = [factor_of(columns)?, factor_of(rows)?];
        if columns.evidence(factor[0]) + rows.evidence(factor[1]) < CERTAIN_BOTH {
            return None;
        }
        columns.list(factor[0]);
        rows.list(factor[1]);
        Some(Enlargement { columns: &columns.starts, rows: &rows.starts, factor })
    }
}

/// Marks the columns whose pixel in a row differs from the one to its left. Two missing pixels are equal.
#[inline(always)]
fn compare_columns<T: Pixel>(map: &DepthView<'_, T>, v: usize, differs: &mut [bool]) {
    let validity = map.validity();
    let row = map.row(v);
    for ((differs, &a), &b) in differs[1..].iter_mut().zip(row).zip(&row[1..]) {
        *differs |= (a != b) & (validity.holds(a) | validity.holds(b));
    }
}

/// Whether two rows differ.
#[inline(always)]
fn differ<T: Pixel>(map: &DepthView<'_, T>, [a, b]: [usize; 2]) -> bool {
    let validity = map.validity();
    let mut differ = false;
    for (&a, &b) in map.row(a).iter().zip(map.row(b)) {
        differ |= (a != b) & (validity.holds(a) | validity.holds(b));
    }
    differ
}

/// Whole and half factors, whether or not whole source pixels fill the map: it may have been cropped.
fn round() -> impl Iterator<Item = f64> {
    let [least, most] = FACTORS.map(|factor| 2 * factor as usize);
    (least..=most).map(|halves| 0.5 * halves as f64)
}

impl Axis {
    fn start(&mut self, length: usize) {
        self.differs.clear();
        self.differs.resize(length, false);
        self.starts.clear();
        self.starts.reserve(length);
    }

    /// Whether no two columns side by side both differ from the ones before them.
    fn is_possible(&self) -> bool {
        self.differs.windows(2).all(|pair| pair != [true, true])
    }

    /// The factors by which whole source pixels fill the map.
    fn whole(&self) -> impl Iterator<Item = f64> + use<> {
        let ([least, most], length) = (FACTORS.map(|factor| factor as usize), self.differs.len());
        (length.div_ceil(most)..=length / least).map(move |pixels| length as f64 / pixels as f64)
    }

    /// The largest of the given factors that fits.
    fn largest(&self, factors: impl Iterator<Item = f64>) -> Option<f64> {
        factors.filter(|&factor| self.fits(factor)).max_by(f64::total_cmp)
    }

    /// Whether all columns that differ are borders of source pixels enlarged by that factor, and enough of them.
    fn fits(&self, factor: f64) -> bool {
        self.evidence(factor) >= CERTAIN
    }

    /// Lists the first columns of source pixels.
    fn list(&mut self, factor: f64) {
        let Axis { differs, starts } = self;
        let Some(Borders { phase, tie }) = Borders::of(differs, factor) else { return };
        let length = differs.len() as u32;
        let differs = |border: u32| differs.get(border as usize) == Some(&true);
        let borders = (1..).map(|k| {
            let place = f64::from(k) * factor + phase;
            let rounded = [place, place - tie, place + tie].map(|place| place.ceil().max(0.0) as u32);
            rounded.into_iter().find(|&border| differs(border)).unwrap_or(rounded[0])
        });
        starts.push(0);
        starts.extend(borders.skip_while(|&border| border == 0).take_while(|&border| border < length));
    }

    /// Evidence, bits, that the columns which differ are not all borders of source pixels by chance; none if they are not.
    fn evidence(&self, factor: f64) -> f64 {
        let Some(borders) = Borders::of(&self.differs, factor) else { return 0.0 };
        self.differs.iter().filter(|differs| **differs).count() as f64 * (factor / borders.at_most()).log2()
    }
}

/// Where source pixels begin: at `ceil(k factor + phase)`.
#[derive(Clone, Copy, Debug)]
struct Borders {
    /// Above -1 and up to 0: -0.5 where a column shows the source pixel under its centre, 0 where it shows the one under its
    /// left edge, others where the map was cropped.
    phase: f64,
    /// How far from a whole pixel a border may be that is rounded either way.
    tie: f64,
}

impl Borders {
    /// The borders at which all columns that differ lie.
    fn of(differs: &[bool], factor: f64) -> Option<Borders> {
        let borders = || (0..differs.len()).filter(|&at| differs[at]).map(|at| at as f64);
        let are_of_centres = |tie: f64| {
            borders().all(|at| {
                let before = ((at - OF_CENTRES + tie) / factor + TINY).floor() * factor;
                before > at - 1.0 - OF_CENTRES - tie + TINY
            })
        };
        // Away from the numbers at which rounding would decide.
        let of_centres = |tie| Some(Borders { phase: OF_CENTRES - TINY, tie }).filter(|_| are_of_centres(tie));
        let cropped = || {
            let [mut low, mut high] = [-1.0f64, 0.0f64];
            for at in borders() {
                let off = at - ((at + 1.0) / factor + TINY).floor() * factor;
                (low, high) = (low.max(off - 1.0), high.min(off));
                if low > high - TINY {
                    return None;
                }
            }
            let of_edges = low + TINY < 0.0 && 0.0 <= high + TINY;
            Some(Borders { phase: if of_edges { 0.0 } else { high } - TINY, tie: 0.0 })
        };
        let rounded = || if factor.fract() == 0.0 { None } else { of_centres(TIE) };
        of_centres(0.0).or_else(cropped).or_else(rounded)
    }

    /// Columns for each source pixel that may be its border: every second is rounded either way at most.
    fn at_most(&self) -> f64 {
        if self.tie > 0.0 { 1.5 } else { 1.0 }
    }
}

/// The phase of columns that show the source pixel under their centres.
const OF_CENTRES: f64 = -0.5;

/// How far from a whole pixel a border may be that is rounded either way: programs that enlarge maps add up the places of
/// centres in single precision or in fixed point. By a whole factor none is there.
const TIE: f64 = 0.01;

/// Far below the distance of a source pixel's border from whole pixels, far above the rounding error of pixel counts.
const TINY: f64 = 1e-6;
