//! The covariance of a plane's coefficients from what is known of its pixels' errors.
//!
//! In: a least-squares plane and the noise of its map. Out: the covariance by three parts of the error: white with
//! rounding, which averages out over pixels; smooth, which averages out over patches of tens of pixels at best; and
//! what the residuals show beyond both.

use super::least_squares::AffineFit;
use crate::noise::{NoiseModel, Patch};
use crate::util::vec3::inverse;

/// What the smooth part is made of: lengths over which it is correlated (the integral of the correlation), pixels,
/// and variances in units of that of the first. Patches: the lattice of 32 pixels that gives synthetic frames the
/// block means of recorded ones has this length. Bows over the whole picture: twice that variance; for the five
/// synthetic cameras, whose bows are set after recorded frames, it is 3, 4, 0.7, 0.4 and 0.3 times.
const SMOOTH: [(f64, f64); 2] = [(64.0, 1.0), (512.0, 2.0)];
/// Variance of these patches over the variance that is stated or estimated for the smooth part. The latter is
/// measured about planes, and a plane of 100 x 100 pixels takes up 57 % of the patches' variance.
const OF_PATCHES: f64 = 2.3;
/// Correlation length, pixels, of an error that is shared by a few neighbours: the windows in which stereo and
/// structured light are matched.
const FEW: f64 = 8.0;
/// Largest variance of residuals, in variances of the white part, that is still taken for white error: the white part
/// is known to a quarter of its deviation (docs/noise.md).
const WHITE: f64 = 1.56;
/// Smooth variance that scenes without smooth error seem to have because of their edges, in variances of the white
/// part: 0.3 deviations (docs/noise.md).
const BY_EDGES: f64 = 0.09;
/// Share of the smooth variance that a plane has to leave in its residuals to tell how large it is: planes of 64 x 64
/// pixels and more do.
const TELLING: f64 = 0.2;

/// Coefficients' covariance.
type Covariance = [[f64; 3]; 3];

/// A plane in the space where the noise is known.
#[derive(Clone, Copy, Debug)]
pub(super) struct Known {
    pub(super) fit: AffineFit,
    pub(super) patch: Patch,
    /// q at its pixels' mean.
    pub(super) q: f64,
    /// Inverse depth, 1/m, per unit of that space.
    pub(super) slope: f64,
}

impl Known {
    /// Covariance of the coefficients in inverse depth, and the share of it that is white: W of all C, the mean over the
    /// directions, trace(W C^-1) / 3. `None` if the noise is 0.
    pub(super) fn covariance(&self, noise: &NoiseModel) -> Option<(Covariance, f64)> {
        let fit = &self.fit;
        let (white, of_white) = fit.covariance_by(|q| noise.variance_in(&self.patch, q));
        if of_white <= 0.0 {
            return None;
        }
        let (smooth, left) = self.smooth(noise, BY_EDGES);
        // What the residuals show beside the smooth part, if it exceeds the white part by more than three standard
        // deviations of its chi-squared.
        let shown = fit.variance() - left;
        let is_larger = shown > (1.0 + 3.0 * (2.0 / fit.n).sqrt()) * of_white;
        let times = if is_larger { shown / of_white } else { 1.0 };
        // Without a smooth part all of it counts as white.
        let of_pixels = if self.smooth_variance(noise) > 0.0 { times.min(WHITE) } else { times };
        let (few, _) = fit.covariance_by_smooth((times - of_pixels) * of_white, FEW);
        let all = |i: usize, j: usize| of_pixels * white[i][j] + few[i][j] + smooth[i][j];
        let whole: Covariance = std::array::from_fn(|i| std::array::from_fn(|j| all(i, j)));
        let share = of_pixels * share_of(&white, &whole).unwrap_or(of_pixels.recip());
        Some((whole.map(|row| row.map(|entry| entry * self.slope * self.slope)), share))
    }

    /// Sums of squares of the smooth part: what the residuals show, and what the noise leads to expect. `None` for a
    /// plane that is too small to tell.
    pub(super) fn smooth_squares(&self, noise: &NoiseModel) -> Option<[f64; 2]> {
        let (_, expected) = self.smooth(noise, 0.0);
        let is_telling = expected > TELLING * OF_PATCHES * self.smooth_variance(noise);
        let shown = self.fit.variance() - WHITE * noise.own_variance(self.q);
        is_telling.then_some([self.fit.n * shown, self.fit.n * expected])
    }

    /// Covariance by the smooth part, which is reduced by `less` variances of the white part; and the variance that
    /// it leaves in the residuals.
    fn smooth(&self, noise: &NoiseModel, less: f64) -> (Covariance, f64) {
        let variance = OF_PATCHES * (self.smooth_variance(noise) - less * noise.own_variance(self.q)).max(0.0);
        let [patches, bows] = SMOOTH.map(|(length, share)| self.fit.covariance_by_smooth(share * variance, length));
        (std::array::from_fn(|i| std::array::from_fn(|j| patches.0[i][j] + bows.0[i][j])), patches.1 + bows.1)
    }

    fn smooth_variance(&self, noise: &NoiseModel) -> f64 {
        let [a, b] = self.patch.gradient;
        noise.smooth_variance(self.q, a * a + b * b)
    }
}

/// trace(A B^-1) / 3 of two covariances; `None` if B has no inverse.
fn share_of(a: &Covariance, b: &Covariance) -> Option<f64> {
    let inverse = inverse(b)?;
    let trace: f64 = (0..3).map(|i| (0..3).map(|j| a[i][j] * inverse[j][i]).sum::<f64>()).sum();
    Some((trace / 3.0).clamp(0.0, 1.0))
}

#[cfg(test)]
mod tests {
    use super::share_of;

    #[test]
    fn the_share_of_a_covariance_is_a_mean_over_directions() {
        let whole = [[4.0, 1.0, 0.0], [1.0, 9.0, 2.0], [0.0, 2.0, 16.0]];
        let half = whole.map(|row| row.map(|entry| entry / 2.0));
        assert!((share_of(&half, &whole).unwrap() - 0.5).abs() < 1e-12);
        let diagonal = |a: f64, b: f64, c: f64| [[a, 0.0, 0.0], [0.0, b, 0.0], [0.0, 0.0, c]];
        let share = share_of(&diagonal(1.0, 1.0, 2.0), &diagonal(1.0, 2.0, 8.0)).unwrap();
        assert!((share - (1.0 + 0.5 + 0.25) / 3.0).abs() < 1e-12);
        assert_eq!(share_of(&diagonal(1.0, 1.0, 1.0), &diagonal(0.0, 1.0, 1.0)), None);
    }
}
