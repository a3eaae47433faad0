//! How well the rays of a map's pixels are known, from the map itself.
//!
//! In: flat blocks, each with its slope and with the scatter of its tiles about their own planes. Out: pixels, one
//! standard deviation. A surface whose q has the gradient g scatters by `ray |g|` where rays are off by `ray`, on top of
//! the noise: how the scatter grows with the slope gives both apart.
//!
//! Three things grow with the slope as well. Edges and curved surfaces are told by the block, whose scatter is more than
//! that of its tiles, and are left out. Noise grows with the range, and near and far surfaces are slanted differently:
//! it is fitted together with the ray, as growth and base of [`super::SensorNoise::Depth`]. And rounding makes nothing
//! on one level and its full variance on a slope: it is taken to be there in full.

use super::{NoiseModel, Space};

/// An estimate counts from so many times the least on: until then the noise's own differences pass for it.
const CLEAR: f64 = 2.0;
/// The most that is believed, pixels: a ray that is off by more is that of the next pixel, and what scatters so is
/// something else. Rounding to whole pixels makes 0.29.
const MOST: f64 = 0.5;
/// Fewest blocks of which the ray makes at least half of the scatter. Where it makes less, it matters little, and noise
/// that differs from surface to surface passes for it. As many have to have less than half of their slope: one slant
/// alone does not tell ray and noise apart.
const SHOWN: usize = 16;
/// Largest ratio of the estimate, an upper quartile, to the ray that fits all best. Edges and clutter agree on none; on
/// walls of a scan that was turned into a picture by the nearest pixel the ratio is 1.2 (SynPEB).
const AGREED: f64 = 1.5;
/// What the scatter of tiles about the plane of their block may be of that about their own, each over its degrees of
/// freedom, and the reverse. A flat block of 16 x 16 pixels that err independently has 1 in the mean, with a standard
/// deviation of 0.23 (F of 45 and 208 degrees of freedom).
const ALIKE: f64 = 2.0;
/// Blocks that are looked at, at most about; each tells its scatter to a tenth.
const SAMPLE: usize = 2048;
/// Times that the fit is weighted anew. The first follows what scatters most; later ones change little.
const ROUNDS: usize = 4;
/// Relative residual up to which a block has its full weight: the standard deviation of a block's variance.
const FULL_WEIGHT: f64 = 0.1;

/// A flat block.
#[derive(Clone, Copy, Debug)]
struct Flat {
    /// Variance of its pixels.
    scatter: f64,
    /// What of it is known to be no matter of the ray: noise as stated, and rounding.
    known: f64,
    /// What the variance grows by with each unknown: (noise at range 0)^2, (its growth)^2, ray^2.
    by: [f64; 3],
}

impl Flat {
    /// Variance without the ray's part.
    fn noise(&self, unknown: [f64; 3]) -> f64 {
        self.known + unknown[0] * self.by[0] + unknown[1] * self.by[1]
    }
}

/// The flat blocks of a map or of several.
#[derive(Debug, Default)]
pub(crate) struct Slants {
    flat: Vec<Flat>,
}

/// A block, and the tiles that it consists of.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Tiled {
    /// q in its middle, and what it changes by per column and per row.
    pub(crate) q: f64,
    pub(crate) gradient: [f64; 2],
    /// Pixels, and their squared residuals about its plane.
    pub(crate) n: f64,
    pub(crate) squares: f64,
    /// Degrees of freedom and squared residuals of its tiles, each about its own plane.
    pub(crate) tiles_free: f64,
    pub(crate) tiles_squares: f64,
}

impl Slants {
    /// The least that is expected, pixels: no camera is calibrated to much better. Of rendered maps (ICL-NUIM) 0.06
    /// remain.
    pub(crate) const LEAST: f64 = 0.05;

    /// Forgets all blocks and makes room for so many.
    pub(crate) fn prepare(&mut self, count: usize) {
        self.flat.clear();
        crate::group::reserve_to(&mut self.flat, count);
    }

    /// Every which block of so many is worth looking at.
    pub(crate) fn stride(count: usize) -> usize {
        count.div_ceil(SAMPLE).max(1)
    }

    /// Adds a block if it is flat and its pixels err independently; with the noise, if that is stated.
    pub(crate) fn add(&mut self, block: &Tiled, noise: Option<&NoiseModel>, space: Space, step: f64) {
        let &Tiled { q, gradient: [a, b], n, squares, tiles_free, tiles_squares } = block;
        let within = tiles_squares / tiles_free;
        let between = (squares - tiles_squares) / (n - 3.0 - tiles_free);
        // Not a number and nothing are not flat.
        if between <= ALIKE * within && within <= ALIKE * between && within > 0.0 {
            let rounding = step * space.unit(q);
            let single = 2e-7 * q;
            let stated = noise.map_or(0.0, |noise| noise.sensor_sigma(q));
            let known = stated * stated + rounding * rounding / 12.0 + single * single;
            let by_noise = if space == Space::Value { 0.0 } else { (q * q) * (q * q) };
            let scatter = (squares / (n - 3.0)).max(known);
            self.flat.push(Flat { scatter, known, by: [by_noise, 1.0, a * a + b * b] });
        }
    }

    /// The ray that explains how the scatter grows with the slope, pixels; `None` where it is near [`Slants::LEAST`], or
    /// too few blocks show one that they agree on.
    ///
    /// Rays are not equally well known everywhere, and a plane has to hold together everywhere: it is the upper quartile
    /// over the blocks that show it.
    pub(crate) fn ray(&mut self) -> Option<f64> {
        let unknown = self.fit();
        let shows = |flat: &Flat| unknown[2] * flat.by[2] >= flat.noise(unknown);
        let (mut shown, mut slopes) = (0, 0.0);
        for flat in self.flat.iter().filter(|flat| shows(flat)) {
            shown += 1;
            slopes += flat.by[2];
        }
        // Of half the slope and less.
        let gentle = slopes / shown as f64 / 4.0;
        let opposed = self.flat.iter().filter(|flat| flat.by[2] <= gentle).count();
        if unknown[2] == 0.0 || shown < SHOWN || opposed < SHOWN {
            return None;
        }
        let own = |flat: &Flat| {
            if shows(flat) { (flat.scatter - flat.noise(unknown)) / flat.by[2] } else { f64::INFINITY }
        };
        let by_own = |a: &Flat, b: &Flat| own(a).total_cmp(&own(b));
        let upper = own(self.flat.select_nth_unstable_by(3 * shown / 4, by_own).1).sqrt();
        let is_agreed = upper <= AGREED * unknown[2].sqrt();
        Some(upper).filter(|ray| is_agreed && (CLEAR * Self::LEAST..=MOST).contains(ray))
    }

    /// The unknowns of least relative residuals: least squares in which a block that is off by much has less weight in
    /// the next round.
    fn fit(&self) -> [f64; 3] {
        let mut unknown = [0.0; 3];
        for round in 0..ROUNDS {
            let mut sums = Normal::default();
            for flat in &self.flat {
                let expected = if round == 0 { flat.scatter } else { flat.noise(unknown) + unknown[2] * flat.by[2] };
                let off = (flat.scatter - expected).abs().max(FULL_WEIGHT * expected);
                sums.add(flat.by, flat.scatter - flat.known, 1.0 / (expected * off));
            }
            unknown = sums.non_negative();
            // Most maps show no ray, and those that do show it in each round.
            if unknown[2] == 0.0 {
                break;
            }
        }
        unknown
    }
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Normal equations of three unknowns.
#[derive(Debug, Default)]
struct Normal {
    matrix: [[f64; 3]; 3],
    right: [f64; 3],
}

impl Normal {
    fn add(&mut self, by: [f64; 3], value: f64, weight: f64) {
        for i in 0..3 {
            let weighted = weight * by[i];
            self.right[i] += weighted * value;
            for j in i..3 {
                self.matrix[i][j] += weighted * by[j];
            }
        }
    }

    /// The least squares of which no unknown is below 0.
    ///
    /// Some of the unknowns are 0 and the others solve their own equations: of the eight cases the best that is allowed.
    fn non_negative(&self) -> [f64; 3] {
        let cases = (0..8u32).filter_map(|case| self.solved(std::array::from_fn(|i| case >> i & 1 == 1)));
        let gain = |x: &[f64; 3]| dot(*x, self.right);
        cases.max_by(|a, b| gain(a).total_cmp(&gain(b))).unwrap_or_default()
    }

    /// The equations of some unknowns alone, the others being 0, by Gauss's elimination; `None` if they have no solution
    /// or one below 0.
    fn solved(&self, free: [bool; 3]) -> Option<[f64; 3]> {
        let mut rows: [[f64; 4]; 3] = std::array::from_fn(|i| {
            let of = |j: usize| match (free[i] && free[j], i == j) {
                (true, _) => self.matrix[i.min(j)][i.max(j)],
                (false, same) => f64::from(u8::from(same)),
            };
            [of(0), of(1), of(2), if free[i] { self.right[i] } else { 0.0 }]
        });
        for i in 0..3 {
            let pivot = rows[i];
            let is_sound = pivot[i] > 1e-9 * self.matrix[i][i];
            if free[i] && !is_sound {
                return None;
            }
            for row in rows.iter_mut().skip(i + 1) {
                let times = row[i] / pivot[i];
                row.iter_mut().zip(pivot).for_each(|(number, pivot)| *number -= times * pivot);
            }
        }
        let z = rows[2][3] / rows[2][2];
        let y = (rows[1][3] - rows[1][2] * z) / rows[1][1];
        let x = (rows[0][3] - rows[0][1] * y - rows[0][2] * z) / rows[0][0];
        [x, y, z].iter().all(|number| *number >= 0.0).then_some([x, y, z])
    }
}
