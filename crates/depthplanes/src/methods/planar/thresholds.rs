//! What the stages hold their statistics against, in one place.
//!
//! Noise is in two parts everywhere: a pixel's own (`variance`: white error and rounding), which averages out, and
//! the smooth part (`smooth`), which all pixels of a patch share. A sum of squared residuals over n pixels may
//! therefore be `chi * variance + deviations^2 * n * smooth`; all constants below are these two factors, for one
//! question each, and angles. Those without another reason were chosen by hand with the recorded frames of `eval
//! real` and the synthetic rooms in view: the results on these flatter, and no other frames have confirmed them yet.

/// What squares may be: so many variances in all, and for each pixel so many of the smooth part.
#[derive(Clone, Copy, Debug)]
pub(super) struct Allowance {
    pub(super) variances: f64,
    pub(super) smooth: f64,
}

impl Allowance {
    /// Of n pixels of these variances.
    #[inline(always)]
    pub(super) fn of(self, n: f64, variance: f64, smooth: f64) -> f64 {
        self.variances * variance + self.smooth * n * smooth
    }
}

/// What the plane of a region may add to the squares that a flat cell larger than a tile has about its own plane, if it joins.
/// A plane's three parameters add 3 in the mean; from 10 to 30 the recorded frames are the same within two surfaces. Smooth:
/// 3.5 deviations. A tile's whole squares about the region's plane are held against [`limit`] and the same smooth part.
pub(super) const JOIN: Allowance = Allowance { variances: 20.0, smooth: 12.0 };
/// What the plane of a flat cell may add to the squares of each of its parts. Tighter than [`JOIN`], since what grows from
/// it is known by it alone: of 100 surfaces of recorded frames five more are lost at 4 than at 1.5 times the smooth variance,
/// and it is as good at 1.25.
pub(super) const FLAT: Allowance = Allowance { variances: 10.0, smooth: 1.25 };
/// What the joint plane of two regions that are one may add to either, for each pixel: half a variance, and 2.5 deviations
/// of the smooth part.
pub(super) const MERGE: Allowance = Allowance { variances: 0.5, smooth: 6.0 };

/// Two regions that meet without a step and at a small angle are one as well if their joint plane adds up to
/// `BOWED_MERGE * excess` times what [`MERGE`] allows, where `excess` is the larger of what either's own squares are in units
/// of its noise, from 1 to [`BOWED_EXCESS`]. So it is 16 to 64 times as much: the bow of a wall over metres is a camera's,
/// and no statistic of a small patch sees it. Recorded frames are the same from 16 to 24; beyond, synthetic walls run into
/// columns of a large radius.
pub(super) const BOWED_MERGE: f64 = 16.0;
/// Largest excess that counts: a region that lies off its own plane by more was merged of two.
pub(super) const BOWED_EXCESS: f64 = 4.0;
/// Largest angle at which they meet, degrees; what turns by more is an edge or a bend. Of 580 surfaces (recorded frames,
/// mirrored, turned and cropped) 90.7 % are whole at 6, and between 8 and 12 the figures are the same within a point, while a
/// synthetic wall takes a cushion in at 10, and bends by it. Synthetic ramps begin at a few degrees.
pub(super) const BOWED_ANGLE: f64 = 8.0;
/// Largest step between their planes in the middle of their border, in deviations of what [`STEP_NOISE`] says.
pub(super) const BOWED_STEP: f64 = 4.0;
/// Variances of a pixel and of the smooth part that a step is held against.
pub(super) const STEP_NOISE: Allowance = Allowance { variances: 3.25, smooth: 2.25 };

/// Pixels from which on a region shows the smooth part of the error; from 1,000 to 5,000 the recorded frames are the same.
pub(super) const SHOWN_PIXELS: f64 = 2000.0;
/// The smooth part as a share of a large region's deviation from its plane, which holds its bow from end to end as well. Of
/// 580 surfaces 92.4 % are whole without a look at the regions, 93.3 % at 0.5, 94.0 % at 0.7, where four times as
/// many pixels of curved things are planes, and 92.2 % at 1, where half as many again are merged that are two.
pub(super) const SHOWN: f64 = 0.5;
/// Most times the smooth part may be that was estimated: where even more is shown, the regions are wrong.
pub(super) const SHOWN_MOST: f64 = 10.0;

/// Smallest angle, degrees, between a region's plane and the ray through the middle of the region. Below it depth changes by
/// 8 % and more from one pixel of a camera of 585 pixels of focal length to the next: pixels of two surfaces that are one
/// behind the other, and flying pixels between them, lie on such planes, which pass close by the camera. Recorded frames are the
/// same from 1.2 to 5, but for NYU's, of whose false planes more go the larger it is. A camera 5 cm above the floor, whose range
/// begins at 1 m, sees it at 1.4.
pub(super) const GRAZING: f64 = 1.2;

/// Smallest bow of a curved region, root mean square, in deviations of the smooth part.
pub(super) const BOW: f64 = 1.7;
/// Variances that a quadratic has to explain beyond a region's plane: its three terms explain 3 of white noise, and
/// more than 20 once in six thousand regions.
pub(super) const BOW_VARIANCES: f64 = 20.0;
/// Smallest turn of a curved region, degrees: a wall that bows 5 mm over 2 m turns by 1, a ball's facet by more than 10.
pub(super) const TURN: f64 = 8.0;
/// Deviations of the smooth part by which a bow, and the turn with it, is shortened first: those of small regions turn by
/// 20 to 120 degrees by their error alone.
pub(super) const TURN_ERROR: f64 = 1.3;

/// By what a quadratic may miss two facets of one smooth surface, and by what it has to explain them better than their two
/// planes do.
pub(super) const JOINT_MISS: Allowance = Allowance { variances: 0.12, smooth: 2.0 };
pub(super) const JOINT_GAIN: Allowance = Allowance { variances: 9.0, smooth: 0.3 };

/// Around a small region, whose error bows it as much as a ball would: what it may miss as long as it leaves little
/// ([`super::curved`]), and what it has to explain, of the smooth part as much as a bow ([`BOW`]).
pub(super) const LOOSE_MISS: Allowance = Allowance { variances: 0.4, smooth: 2.0 };
pub(super) const LOOSE_GAIN: Allowance = Allowance { variances: 9.0, smooth: BOW * BOW };

/// Largest angle, degrees, at which a curved surface turns between two facets: spheres are modelled with 16 segments and
/// more, which turn by 22.5 degrees. The smallest is [`BOWED_ANGLE`]: what turns by less is one plane.
pub(super) const GENTLE: f64 = 23.5;
/// Share of a facet's border beyond which it turns so: one on the rim has a step on its other side.
pub(super) const GENTLE_SHARE: f64 = 0.4;
/// A neighbour counts for that from so much of the facet's pixels on.
pub(super) const GENTLE_SIZE: f64 = 0.25;
/// One neighbour that has so many times the pixels is enough: the facet is a bump of it.
pub(super) const GENTLE_LARGER: f64 = 2.0;

/// Largest sum of squared residuals of n pixels of one plane, in variances: the mean of chi-squared is n, its
/// standard deviation sqrt(2 n). The noise level itself is known to about a fifth.
#[inline(always)]
pub(super) fn limit(n: f32, inlier_threshold: f32) -> f32 {
    1.4 * (n + inlier_threshold * (2.0 * n).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::methods::planar::testing::{Made, SIGMA, Stages, THRESHOLD, noise};
    use crate::util::random::Random;

    #[test]
    fn squares_of_white_noise_are_above_the_limit_as_rarely_as_chi_squared_says_and_of_twice_the_noise_often() {
        let mut random = Random::new(3);
        for (n, twice) in [(16, 0.5), (64, 0.99), (256, 1.0)] {
            let mut above = [0; 3];
            let rounds = 4000;
            for _ in 0..rounds {
                let squares: f64 = (0..n).map(|_| random.gaussian().powi(2)).sum();
                let limit = |threshold: f32| f64::from(limit(n as f32, threshold));
                // Without the allowance for a noise that is known to a fifth it is the mean and one deviation more.
                let more = [squares > limit(1.0) / 1.4, squares > limit(4.0), 4.0 * squares > limit(4.0)];
                (0..3).for_each(|i| above[i] += u32::from(more[i]));
            }
            let above = above.map(|count| f64::from(count) / f64::from(rounds));
            assert!((0.13..0.18).contains(&above[0]), "{} above one deviation, {n} pixels", above[0]);
            assert!(above[1] == 0.0 && above[2] >= twice, "{above:?}, {n} pixels");
        }
    }

    #[test]
    fn flat_cells_of_white_noise_are_rarely_rough_and_those_of_half_as_much_again_mostly_are_if_large() {
        let rough = |times: f64, level: usize| {
            let mut random = Random::new(4);
            let made = Made::exact([512, 256], |u, _| 40.0 + 0.05 * u as f64 + times * SIGMA * random.gaussian());
            let grid = &Stages::tiles(&made, noise(0.0)).run.pyramid.grids[level];
            grid.roughness.iter().filter(|&&roughness| roughness > 1.0).count() as f64 / grid.len() as f64
        };
        // Tiles: once in a thousand. Larger cells have several parts, each of which the plane may suit less by chance.
        let shares = [0, 1, 2].map(|level| rough(1.0, level));
        assert!(shares[0] < 1e-3 && shares[1] < 0.1 && shares[2] < 0.3, "{shares:?}");
        assert!(rough(1.5, 2) > 0.5 && rough(3.0, 0) > 0.95, "{} {}", rough(1.5, 2), rough(3.0, 0));
        const { assert!(THRESHOLD == 4.0) };
    }

    #[test]
    fn an_allowance_is_of_a_pixels_variance_once_and_of_the_smooth_part_for_each_pixel() {
        let allowance = Allowance { variances: 3.0, smooth: 2.0 };
        assert_eq!(allowance.of(16.0, 0.5, 0.25), 3.0 * 0.5 + 2.0 * 16.0 * 0.25);
        // A cell joins what is known better than a cell's parts join each other.
        const { assert!(FLAT.variances < JOIN.variances && FLAT.smooth < JOIN.smooth) };
    }
}
