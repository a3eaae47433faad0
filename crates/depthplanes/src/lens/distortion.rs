//! How a lens moves what a pinhole camera would see: normalised picture coordinates `(x, y) = (X/Z, Y/Z)` to distorted ones
//! and back. A pixel is `(fx x' + cx, fy y' + cy)` of the distorted `(x', y')`.

use crate::error::{Error, Result};

/// The formula of a lens distortion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum DistortionModel {
    /// OpenCV's pinhole model, ROS `plumb_bob` and `rational_polynomial`, in OpenCV's order: k1, k2, p1, p2, k3, k4, k5, k6, s1, s2,
    /// s3, s4; those that are not given are 0 (OpenCV, "Camera Calibration and 3D Reconstruction", calib3d; Brown 1971).
    BrownConrady,
    /// OpenCV's fisheye model, ROS and Kalibr `equidistant`: k1 to k4 (Kannala and Brandt 2006). With the angle t from the
    /// optical axis, the distorted radius is `t (1 + k1 t^2 + k2 t^4 + k3 t^6 + k4 t^8)`.
    KannalaBrandt,
    /// RealSense `inverse_brown_conrady`: k1, k2, p1, p2, k3. The Brown-Conrady formula leads from distorted to undistorted
    /// coordinates (librealsense, rsutil.h, `rs2_deproject_pixel_to_point`).
    InverseBrownConrady,
    /// RealSense `modified_brown_conrady`: k1, k2, p1, p2, k3. Tangential terms are of radially distorted coordinates
    /// (librealsense, rsutil.h, `rs2_project_point_to_pixel`).
    ModifiedBrownConrady,
}

impl DistortionModel {
    /// Its name in records, as ROS or RealSense write it.
    pub fn name(self) -> &'static str {
        match self {
            DistortionModel::BrownConrady => "brown_conrady",
            DistortionModel::KannalaBrandt => "equidistant",
            DistortionModel::InverseBrownConrady => "inverse_brown_conrady",
            DistortionModel::ModifiedBrownConrady => "modified_brown_conrady",
        }
    }

    /// The most coefficients that it has.
    fn most(self) -> usize {
        match self {
            DistortionModel::BrownConrady => COEFFICIENTS,
            DistortionModel::KannalaBrandt => 4,
            DistortionModel::InverseBrownConrady | DistortionModel::ModifiedBrownConrady => 5,
        }
    }
}

/// The most coefficients of any model.
const COEFFICIENTS: usize = 12;

/// Steps of Newton's method, after which the residual is looked at: it doubles the digits with each.
const STEPS: usize = 40;

/// How well distorting has to give back what was undistorted, normalised coordinates: a hundred thousandth of a pixel at a focal
/// length of 1000 pixels.
const CLOSE: f64 = 1e-8;

/// The widest angle from the optical axis that is undistorted: its tangent. A pinhole camera sees less than 90 degrees.
pub(super) const WIDEST: f64 = 11.43; // 85 degrees

/// The distortion of a lens: a formula and its coefficients.
///
/// ```
/// use depthplanes::{Distortion, DistortionModel};
/// let lens = Distortion::new(DistortionModel::BrownConrady, &[-0.05, 0.01])?;
/// let [x, y] = lens.distort([0.4, 0.3]);
/// let r2 = 0.4 * 0.4 + 0.3 * 0.3;
/// assert!((x - 0.4 * (1.0 - 0.05 * r2 + 0.01 * r2 * r2)).abs() < 1e-12);
/// let back = lens.undistort([x, y]).unwrap();
/// assert!((back[0] - 0.4).abs() < 1e-8 && (back[1] - 0.3).abs() < 1e-8);
/// # Ok::<(), depthplanes::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Distortion {
    model: DistortionModel,
    coefficients: [f64; COEFFICIENTS],
}

impl Distortion {
    /// A distortion by its coefficients, in the model's order; those that are left out are 0.
    ///
    /// # Errors
    /// [`Error::Camera`] for a coefficient that is not finite, and for more coefficients than the model has unless they are 0.
    pub fn new(model: DistortionModel, given: &[f64]) -> Result<Self> {
        let mut coefficients = [0.0; COEFFICIENTS];
        for (at, &value) in given.iter().enumerate() {
            if !value.is_finite() {
                let accepted = "finite numbers";
                return Err(Error::Camera { name: "distortion coefficient", given: value, accepted });
            }
            if at < model.most() {
                coefficients[at] = value;
            } else if value != 0.0 {
                let accepted = "0, since the model of the distortion has fewer coefficients";
                return Err(Error::Camera { name: "further distortion coefficient", given: value, accepted });
            }
        }
        Ok(Distortion { model, coefficients })
    }

    /// The formula.
    pub fn model(&self) -> DistortionModel {
        self.model
    }

    /// The coefficients, in the model's order.
    pub fn coefficients(&self) -> &[f64] {
        &self.coefficients[..self.model.most()]
    }

    /// Whether it moves nothing: all coefficients are 0, and the model is one of lenses that are pinholes then.
    pub fn is_none(&self) -> bool {
        self.model != DistortionModel::KannalaBrandt && self.coefficients == [0.0; COEFFICIENTS]
    }

    pub(crate) fn check(&self) -> Result<()> {
        Distortion::new(self.model, &self.coefficients).map(drop)
    }

    /// Where the lens puts what a pinhole camera sees at (x, y), normalised coordinates. Far out the formulas mean nothing: see
    /// [`Distortion::undistort`].
    #[inline]
    pub fn distort(&self, at: [f64; 2]) -> [f64; 2] {
        match self.model {
            DistortionModel::BrownConrady => self.polynomial(at),
            DistortionModel::KannalaBrandt => self.fisheye(at),
            DistortionModel::InverseBrownConrady => self.newton(at, at).unwrap_or([f64::NAN; 2]),
            DistortionModel::ModifiedBrownConrady => self.modified(at),
        }
    }

    /// What a pinhole camera would see at (x, y) of the distorted picture; `None` where the lens puts nothing: beyond 85
    /// degrees from the axis, and where the formula folds back.
    pub fn undistort(&self, at: [f64; 2]) -> Option<[f64; 2]> {
        let found = match self.model {
            DistortionModel::InverseBrownConrady => self.polynomial(at),
            DistortionModel::KannalaBrandt => self.straight(at)?,
            DistortionModel::BrownConrady | DistortionModel::ModifiedBrownConrady => self.newton(at, at)?,
        };
        self.shows(found, at).then_some(found)
    }

    /// Whether the lens puts the ray (x, y) at that place of the distorted picture, and not another one nearer the axis.
    pub(super) fn shows(&self, ray: [f64; 2], distorted: [f64; 2]) -> bool {
        self.is_in_sight(ray) && !self.folds(self.place_in_formula(ray, distorted))
    }

    /// Whether a ray is near enough to the axis, and to where the formula means something.
    pub(super) fn is_in_sight(&self, [x, y]: [f64; 2]) -> bool {
        let r = x.hypot(y);
        r <= WIDEST && (self.model != DistortionModel::KannalaBrandt || self.radius(r.atan())[1] > 0.0)
    }

    /// Which of the two is what [`Distortion::forward`] is given.
    pub(super) fn place_in_formula(&self, ray: [f64; 2], distorted: [f64; 2]) -> [f64; 2] {
        if self.model == DistortionModel::InverseBrownConrady { distorted } else { ray }
    }

    /// OpenCV's formula (calib3d): radial, tangential and thin prism terms.
    #[inline]
    fn polynomial(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let [k1, k2, p1, p2, k3, k4, k5, k6, s1, s2, s3, s4] = self.coefficients;
        let (r2, xy) = (x * x + y * y, x * y);
        let radial = (1.0 + r2 * (k1 + r2 * (k2 + r2 * k3))) / (1.0 + r2 * (k4 + r2 * (k5 + r2 * k6)));
        [
            x * radial + 2.0 * p1 * xy + p2 * (r2 + 2.0 * x * x) + r2 * (s1 + r2 * s2),
            y * radial + p1 * (r2 + 2.0 * y * y) + 2.0 * p2 * xy + r2 * (s3 + r2 * s4),
        ]
    }

    /// librealsense's formula: the tangential terms are of x and y after the radial ones, r is that before.
    fn modified(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let [k1, k2, p1, p2, k3, ..] = self.coefficients;
        let r2 = x * x + y * y;
        let [x, y] = [x, y].map(|side| side * (1.0 + r2 * (k1 + r2 * (k2 + r2 * k3))));
        [x + 2.0 * p1 * x * y + p2 * (r2 + 2.0 * x * x), y + 2.0 * p2 * x * y + p1 * (r2 + 2.0 * y * y)]
    }

    /// The distorted radius of an angle from the axis, and how fast it grows.
    pub(super) fn radius(&self, angle: f64) -> [f64; 2] {
        let [k1, k2, k3, k4, ..] = self.coefficients;
        let t2 = angle * angle;
        [
            angle * (1.0 + t2 * (k1 + t2 * (k2 + t2 * (k3 + t2 * k4)))),
            1.0 + t2 * (3.0 * k1 + t2 * (5.0 * k2 + t2 * (7.0 * k3 + t2 * 9.0 * k4))),
        ]
    }

    fn fisheye(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let r = x.hypot(y);
        if r < 1e-12 {
            return [x, y];
        }
        let [distorted, _] = self.radius(r.atan());
        [x, y].map(|side| side * distorted / r)
    }

    /// The inverse of [`Distortion::fisheye`]: the angle is found by Newton's method from 0, on which side no step overshoots
    /// where the radius grows.
    fn straight(&self, [x, y]: [f64; 2]) -> Option<[f64; 2]> {
        let distorted = x.hypot(y);
        if distorted < 1e-12 {
            return Some([x, y]);
        }
        let mut angle = distorted.min(WIDEST.atan());
        for _ in 0..STEPS {
            let [radius, growth] = self.radius(angle);
            let step = (radius - distorted) / growth;
            angle = (angle - step).clamp(0.0, std::f64::consts::FRAC_PI_2);
            if step.abs() < 1e-13 {
                break;
            }
        }
        let [radius, growth] = self.radius(angle);
        let is_found = (radius - distorted).abs() < CLOSE && growth > 0.0 && angle < WIDEST.atan();
        is_found.then(|| [x, y].map(|side| side * angle.tan() / distorted))
    }

    /// The formula that Newton's method turns round.
    #[inline]
    pub(super) fn forward(&self, at: [f64; 2]) -> [f64; 2] {
        match self.model {
            DistortionModel::ModifiedBrownConrady => self.modified(at),
            _ => self.polynomial(at),
        }
    }

    /// The derivative of [`Distortion::forward`] by differences, row by row.
    pub(super) fn slope(&self, [x, y]: [f64; 2]) -> [[f64; 2]; 2] {
        const H: f64 = 1e-6;
        let by = |dx: f64, dy: f64| {
            let [ahead, behind] = [self.forward([x + dx, y + dy]), self.forward([x - dx, y - dy])];
            [(ahead[0] - behind[0]) / (2.0 * H), (ahead[1] - behind[1]) / (2.0 * H)]
        };
        let [[a, c], [b, d]] = [by(H, 0.0), by(0.0, H)];
        [[a, b], [c, d]]
    }

    /// Where the formula gives `goal`, by Newton's method from `start`; none if it does not get there.
    pub(super) fn newton(&self, goal: [f64; 2], start: [f64; 2]) -> Option<[f64; 2]> {
        let mut at = start;
        for _ in 0..STEPS {
            let given = self.forward(at);
            let off = [given[0] - goal[0], given[1] - goal[1]];
            if off[0].hypot(off[1]) < 1e-12 {
                break;
            }
            let [[a, b], [c, d]] = self.slope(at);
            let det = a * d - b * c;
            // A long step leaves the part of the picture for which the coefficients were found.
            let step = [(d * off[0] - b * off[1]) / det, (a * off[1] - c * off[0]) / det];
            let length = step[0].hypot(step[1]);
            if !length.is_finite() {
                return None;
            }
            let shorter = (0.25 / length).min(1.0);
            at = [at[0] - step[0] * shorter, at[1] - step[1] * shorter];
        }
        let given = self.forward(at);
        ((given[0] - goal[0]).hypot(given[1] - goal[1]) < CLOSE).then_some(at)
    }

    /// Whether the formula has folded back on the way out from the axis to there: a second ray has the same pixel.
    pub(super) fn folds(&self, [x, y]: [f64; 2]) -> bool {
        if self.model == DistortionModel::KannalaBrandt {
            return false; // looked at with the angle
        }
        (1..=8).map(|part| f64::from(part) / 8.0).any(|part| self.folds_at([x * part, y * part]))
    }

    /// Whether the formula goes back there, or comes out on the other side of the axis.
    pub(super) fn folds_at(&self, at: [f64; 2]) -> bool {
        let ([[a, b], [c, d]], [x, y]) = (self.slope(at), self.forward(at));
        a * d - b * c <= 0.0 || a + d <= 0.0 || x * at[0] + y * at[1] < 0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use DistortionModel::{BrownConrady, InverseBrownConrady, KannalaBrandt, ModifiedBrownConrady};

    fn lens(model: DistortionModel, coefficients: &[f64]) -> Distortion {
        Distortion::new(model, coefficients).unwrap()
    }

    /// Lenses as they occur: TUM fr1, Azure Kinect's depth, a fisheye of 160 degrees, RealSense's colour.
    fn lenses() -> Vec<(Distortion, f64)> {
        vec![
            (lens(BrownConrady, &[0.2624, -0.9531, -0.0054, 0.0026, 1.1633]), 0.55),
            (lens(BrownConrady, &[-0.05]), 0.8),
            (lens(BrownConrady, &[-0.28, 0.07, 1e-4, -2e-4, 0.0]), 0.8),
            (lens(BrownConrady, &[6.084, 4.375, -5.5e-5, 6.5e-5, 0.236, 6.409, 6.418, 1.220]), 1.2),
            (lens(BrownConrady, &[0.1, 0.01, 1e-3, -1e-3, 0.0, 0.05, 0.0, 0.0, 1e-3, 2e-3, -1e-3, 1e-4]), 0.8),
            (lens(KannalaBrandt, &[-0.0132, 0.0205, -0.0213, 0.0070]), 2.0),
            (lens(KannalaBrandt, &[0.0; 4]), 5.0),
            (lens(InverseBrownConrady, &[-0.0565, 0.0688, -7e-4, -2.5e-5, -0.0224]), 0.7),
            (lens(ModifiedBrownConrady, &[0.14, -0.5, 1e-3, -2e-3, 0.45]), 0.6),
        ]
    }

    #[test]
    fn undistorting_undoes_distorting_of_every_model() {
        for (lens, reach) in lenses() {
            for step in 0..400 {
                let (angle, r) = (f64::from(step) * 0.7, reach * f64::from(step) / 400.0);
                let ray = [r * angle.cos(), r * angle.sin()];
                let back = lens.undistort(lens.distort(ray)).unwrap_or_else(|| panic!("{lens:?} at {ray:?}"));
                assert!((back[0] - ray[0]).hypot(back[1] - ray[1]) < 1e-7, "{lens:?}: {ray:?} {back:?}");
            }
        }
    }

    #[test]
    fn distorted_coordinates_are_those_of_the_formulas() {
        // Worked out by hand for (0.5, -0.25): r2 = 0.3125.
        let near = |given: [f64; 2], right: [f64; 2]| {
            assert!((given[0] - right[0]).abs() < 1e-12 && (given[1] - right[1]).abs() < 1e-12, "{given:?} {right:?}");
        };
        let (x, y, r2) = (0.5, -0.25, 0.3125f64);
        let radial = 1.0 + 0.1 * r2 - 0.2 * r2 * r2 + 0.05 * r2.powi(3);
        let tangential =
            [2.0 * 0.01 * x * y + 0.02 * (r2 + 2.0 * x * x), 0.01 * (r2 + 2.0 * y * y) + 2.0 * 0.02 * x * y];
        let brown = [0.1, -0.2, 0.01, 0.02, 0.05];
        let expected = [x * radial + tangential[0], y * radial + tangential[1]];
        near(lens(BrownConrady, &brown).distort([x, y]), expected);
        near(lens(InverseBrownConrady, &brown).undistort([x, y]).unwrap(), expected);
        let (mx, my) = (x * radial, y * radial);
        near(
            lens(ModifiedBrownConrady, &brown).distort([x, y]),
            [
                mx + 2.0 * 0.01 * mx * my + 0.02 * (r2 + 2.0 * mx * mx),
                my + 2.0 * 0.02 * mx * my + 0.01 * (r2 + 2.0 * my * my),
            ],
        );
        let t = r2.sqrt().atan();
        let radius = t * (1.0 + 0.1 * t * t - 0.05 * t.powi(4));
        let scale = radius / r2.sqrt();
        near(lens(KannalaBrandt, &[0.1, -0.05]).distort([x, y]), [x * scale, y * scale]);
        let rational = lens(BrownConrady, &[0.1, 0.0, 0.0, 0.0, 0.0, 0.3, 0.0, 0.0]);
        let ratio = (1.0 + 0.1 * r2) / (1.0 + 0.3 * r2);
        near(rational.distort([x, y]), [x * ratio, y * ratio]);
    }

    #[test]
    fn where_the_formula_folds_back_there_is_no_ray() {
        // r (1 - 0.3 r2) is largest at r = 1.054, where it is 0.7027.
        let lens = lens(BrownConrady, &[-0.3]);
        assert!(lens.undistort([0.70, 0.0]).is_some());
        assert_eq!(lens.undistort([0.71, 0.0]), None);
        assert_eq!(super::tests::lens(KannalaBrandt, &[-0.1]).undistort([1.4, 0.0]), None);
        assert_eq!(lens.undistort([f64::NAN, 0.0]), None);
    }

    #[test]
    fn coefficients_are_checked_and_zeros_are_no_distortion() {
        assert!(Distortion::new(BrownConrady, &[f64::NAN]).is_err());
        assert!(Distortion::new(KannalaBrandt, &[0.0, 0.0, 0.0, 0.0, 1.0]).is_err());
        assert!(lens(BrownConrady, &[0.0; 14]).is_none());
        assert!(!lens(KannalaBrandt, &[0.0; 4]).is_none());
    }
}
