//! The second pass over a plane's pixels: their distances from it, and how much of its area is seen.

use super::least_squares::{AffineFit, LANES, Lanes, hessian_normal_form, in_lanes, metric_covariance};
use super::plane_sums::PlaneSums;
use crate::camera::Intrinsics;
use crate::components::selection::LabelledRun;
use crate::detection::{CovarianceSource, MetricPlane};
use crate::map::Pixel;
use crate::noise::NoiseModel;
use crate::sensor::Sensor;

/// What the second pass has to know beside the pixels.
#[derive(Clone, Copy, Debug)]
pub struct Seen<'a> {
    /// What the numbers mean, and the camera.
    pub sensor: &'a Sensor,
    /// The noise of the map, if it is known.
    pub noise: Option<&'a NoiseModel>,
    /// Valid pixels of the map.
    pub valid_pixels: usize,
}

/// What the second pass sums for a plane.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Distances {
    /// Sum of (z (q - q of the plane))^2.
    squares: Lanes,
    /// Sum of the points, metres.
    pub(super) point: [f64; 3],
    /// Area of the plane's part behind its pixels' squares, in units of `1 / (distance |fx fy|)`, m^3.
    area: f64,
    /// Whether some pixel's square reaches infinity on the plane.
    reaches_infinity: bool,
    /// Whether some pixel lies at or behind infinity, which leaves the plane without metric values.
    behind_infinity: bool,
}

impl Distances {
    /// Adds a run of pixels by their depths, in units of `metres`; their points are not summed.
    #[inline(always)]
    pub(super) fn add_depths<T: Pixel>(&mut self, run: &LabelledRun, values: &[T], plane: &AffineFit, metres: f64) {
        let (first, slope) = (metres * plane.at(run.u_first.into(), run.v.into()), metres * plane.abc[0]);
        let mut squares = [0.0; LANES];
        in_lanes(
            values,
            |k, value| 1.0 - value.into() * (first + slope * k), // z (q - q of the plane)
            #[inline(always)]
            |_, relative| (0..LANES).for_each(|lane| squares[lane] += relative[lane] * relative[lane]),
        );
        (0..LANES).for_each(|lane| self.squares[lane] += squares[lane]);
        // Whole numbers that are valid are more than 0.
        if !T::IS_INTEGER {
            let is_behind = |depth: f64| !(depth > 0.0 && depth < f64::INFINITY);
            self.behind_infinity |= values.iter().fold(false, |any, &value| any | is_behind(metres * value.into()));
        }
        self.add_area(run, plane);
    }

    /// Adds a run of pixels and their points by their inverse depths, 1/m.
    #[inline(always)]
    pub(super) fn add_inverse_depths<T: Pixel>(
        &mut self,
        run: &LabelledRun,
        values: &[T],
        plane: &AffineFit,
        camera: &Intrinsics,
        inverse_depth: impl Fn(T) -> f64,
    ) {
        let (u, v) = (f64::from(run.u_first), f64::from(run.v));
        let (first, slope) = (plane.at(u, v), plane.abc[0]);
        let [mut squares, mut depths, mut by_k] = [[0.0; LANES]; 3];
        in_lanes(
            values,
            |_, value| inverse_depth(value),
            #[inline(always)]
            |k, q| {
                for lane in 0..LANES {
                    let depth = if q[lane] == 0.0 { 0.0 } else { 1.0 / q[lane] }; // 0 for a lane without a pixel
                    let relative = depth * (q[lane] - (first + slope * k[lane]));
                    squares[lane] += relative * relative;
                    depths[lane] += depth;
                    by_k[lane] += k[lane] * depth;
                }
            },
        );
        (0..LANES).for_each(|lane| self.squares[lane] += squares[lane]);
        let is_behind = |q: f64| !(f64::MIN_POSITIVE..f64::INFINITY).contains(&q);
        self.behind_infinity |= values.iter().fold(false, |any, &value| any | is_behind(inverse_depth(value)));
        let ([depth, by_k], ray) = ([depths, by_k].map(|lanes| lanes.iter().sum::<f64>()), camera.ray(u, v));
        self.point[0] += ray[0] * depth + by_k / camera.fx;
        self.point[1] += ray[1] * depth;
        self.point[2] += depth;
        self.add_area(run, plane);
    }

    /// Adds what was summed of other pixels of the plane.
    pub(super) fn merge(&mut self, other: &Distances) {
        (0..LANES).for_each(|lane| self.squares[lane] += other.squares[lane]);
        (0..3).for_each(|axis| self.point[axis] += other.point[axis]);
        self.area += other.area;
        self.reaches_infinity |= other.reaches_infinity;
        self.behind_infinity |= other.behind_infinity;
    }

    /// Adds the area of the plane's part behind the squares of a run of pixels.
    ///
    /// With the rays r of a triangle's corners, `|det(r1, r2, r3)| / (6 q1 q2 q3)` is the volume of
    /// the pyramid from the camera over the triangle on the plane, a third of its area times the
    /// camera's distance; the determinant is twice the triangle's area on the picture over
    /// `|fx fy|`. A run's rectangle is two triangles that share two corners, and q is affine, so
    /// that they add up to `pixels q(middle) / (distance |fx fy| q1 q2 q3 q4)`.
    #[inline(always)]
    fn add_area(&mut self, run: &LabelledRun, plane: &AffineFit) {
        let (left, right) = (f64::from(run.u_first) - 0.5, f64::from(run.u_last) + 0.5);
        let (top, bottom) = (f64::from(run.v) - 0.5, f64::from(run.v) + 0.5);
        let corners = [plane.at(left, top), plane.at(right, top), plane.at(left, bottom), plane.at(right, bottom)];
        let middle = 0.25 * corners.iter().sum::<f64>();
        self.area += (right - left) * middle / corners.iter().product::<f64>();
        self.reaches_infinity |= corners.iter().any(|&q| q <= 0.0);
    }

    /// The metric plane: a point's distance from it is z |q - q of the plane| times the plane's
    /// distance from the camera, since n . P + d = d (1 - z m . r).
    pub(super) fn metric(&self, tally: &PlaneSums, seen: &Seen<'_>) -> Option<MetricPlane> {
        let camera = &seen.sensor.intrinsics?;
        let fit = tally.inverse_depth.filter(|_| !self.behind_infinity)?;
        let plane = hessian_normal_form(&fit, camera)?;
        let n = tally.pixel_count as f64;
        let by_noise = |noise| tally.known(seen.sensor)?.covariance(noise);
        let (covariance, white_share, covariance_from) = match seen.noise.and_then(by_noise) {
            Some((covariance, white_share)) => (covariance, white_share, CovarianceSource::Noise),
            None => (fit.covariance(), 1.0, CovarianceSource::Residuals),
        };
        let area = self.area / (plane.distance * (camera.fx * camera.fy).abs());
        let metric = MetricPlane {
            plane,
            rms_m: (self.squares.iter().sum::<f64>() / n).sqrt() * plane.distance,
            centroid_m: self.point.map(|sum| sum / n),
            area_m2: Some(area).filter(|area| !self.reaches_infinity && area.is_finite()),
            covariance: metric_covariance(fit.abc, &covariance, camera),
            white_share,
            covariance_from,
        };
        is_finite(&metric).then_some(metric)
    }
}

/// Whether all numbers of a plane can be given: values near the ends of single precision and noise beyond measure lead
/// out of what numbers can hold.
fn is_finite(metric: &MetricPlane) -> bool {
    let MetricPlane { plane, rms_m, centroid_m, covariance, .. } = metric;
    // 0 times a number is 0, but of an infinity or of none it is none; a sum needs no branch for each number.
    let zeros = |numbers: &[f64]| numbers.iter().map(|number| 0.0 * number).sum::<f64>();
    let of_plane = zeros(&plane.normal) + 0.0 * plane.distance + 0.0 * rms_m;
    of_plane + zeros(centroid_m) + zeros(covariance.as_flattened()) == 0.0
}
