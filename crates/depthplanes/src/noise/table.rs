//! A sensor's noise as a table.
//!
//! In: up to [`MAX_ROWS`] pairs of range and standard deviation. Out: the standard deviation at any range. Its size
//! is fixed, so that a sensor stays a plain value that can be copied and compared.

use crate::error::{Error, Result};
use crate::limits::MAX_NOISE;

/// Most rows of a [`NoiseTable`].
pub const MAX_ROWS: usize = 16;

/// Standard deviation of depth over the range, linear between rows; the first and the last row hold beyond them.
///
/// ```
/// use depthplanes::noise::NoiseTable;
/// let table = NoiseTable::new(&[[1.0, 0.002], [3.0, 0.010]])?;
/// assert_eq!([0.5, 2.0, 9.0].map(|z| table.sigma_m(z)), [0.002, 0.006, 0.010]);
/// # Ok::<(), depthplanes::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "Vec<[f64; 2]>", into = "Vec<[f64; 2]>"))]
pub struct NoiseTable {
    /// Range and standard deviation, metres; the last row is repeated up to the end.
    rows: [[f64; 2]; MAX_ROWS],
    count: usize,
}

impl TryFrom<Vec<[f64; 2]>> for NoiseTable {
    type Error = Error;

    fn try_from(rows: Vec<[f64; 2]>) -> Result<Self> {
        NoiseTable::new(&rows)
    }
}

impl From<NoiseTable> for Vec<[f64; 2]> {
    fn from(table: NoiseTable) -> Self {
        table.rows().to_vec()
    }
}

impl NoiseTable {
    /// A table of rows [range, standard deviation], metres, by increasing range.
    ///
    /// # Errors
    /// [`Error::NoiseTable`] for no row or more than [`MAX_ROWS`], a range that is not above 0 and above the one before,
    /// a standard deviation below 0, or either above [`MAX_NOISE`].
    pub fn new(rows: &[[f64; 2]]) -> Result<Self> {
        let wrong = |row, given, accepted| Err(Error::NoiseTable { row, given, accepted });
        let Some(last) = rows.last().filter(|_| rows.len() <= MAX_ROWS) else {
            return wrong(0, rows.len() as f64, "1 to 16 rows");
        };
        let mut before = 0.0;
        for (row, &[range, sigma]) in (1..).zip(rows) {
            if !(range > before && range <= MAX_NOISE) {
                return wrong(row, range, "ranges in metres, above 0, each above the one before, at most 1e12");
            }
            if !(0.0..=MAX_NOISE).contains(&sigma) {
                return wrong(row, sigma, "standard deviations in metres, from 0 to 1e12");
            }
            before = range;
        }
        let mut table = NoiseTable { rows: [*last; MAX_ROWS], count: rows.len() };
        table.rows[..rows.len()].copy_from_slice(rows);
        Ok(table)
    }

    /// The rows.
    pub fn rows(&self) -> &[[f64; 2]] {
        &self.rows[..self.count]
    }

    /// The table with standard deviations `factor` times as large.
    pub(super) fn times(mut self, factor: f64) -> Self {
        self.rows.iter_mut().for_each(|[_, sigma]| *sigma *= factor);
        self
    }

    /// Standard deviation at range `depth_m` (infinity is accepted), metres.
    pub fn sigma_m(&self, depth_m: f64) -> f64 {
        let rows = self.rows();
        let above = rows.partition_point(|[range, _]| *range < depth_m);
        if above == 0 || above == rows.len() {
            return rows[above.min(rows.len() - 1)][1];
        }
        let ([near, low], [far, high]) = (rows[above - 1], rows[above]);
        low + (high - low) * (depth_m - near) / (far - near)
    }
}
