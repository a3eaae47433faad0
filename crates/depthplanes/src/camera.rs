//! What a map's numbers mean, and the pinhole camera that saw them.
//!
//! Pixel coordinates are (u, v) = (column, row) with pixel centres at integers. Camera coordinates
//! are the optical frame: x right, y down, z forward, metres.
//!
//! A plane `n . P + d = 0` seen by a pinhole camera is exactly affine in inverse depth
//! (Woehler, *3D Computer Vision*, eq. 1.131-1.134): with the ray
//! `r = ((u - cx)/fx, (v - cy)/fy, 1)` and `P = z r`, `1/z = m . r` where `m = -n / d`. Disparity is
//! affine in inverse depth (paper, eq. 6), so the same holds there.

use crate::error::{Error, Result};
use crate::limits::{FOCAL_PX, MAX_OFFSET_PER_M, MAX_PRINCIPAL_POINT_PX, METRES_PER_UNIT, SLOPE_PER_M};

/// Pinhole intrinsics in pixels. `fy` (and `fx`) may be negative: ICL-NUIM's image y axis points up.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Intrinsics {
    /// Focal length along u, pixels.
    pub fx: f64,
    /// Focal length along v, pixels.
    pub fy: f64,
    /// Principal point, column.
    pub cx: f64,
    /// Principal point, row.
    pub cy: f64,
}

impl Intrinsics {
    /// Checked intrinsics.
    ///
    /// # Errors
    /// [`Error::Camera`] unless both focal lengths lie within [`FOCAL_PX`], but for their sign, and the principal point is
    /// no farther than [`MAX_PRINCIPAL_POINT_PX`] along either axis.
    pub fn new(fx: f64, fy: f64, cx: f64, cy: f64) -> Result<Self> {
        for (name, given) in [("fx", fx), ("fy", fy)] {
            let accepted = "a focal length in pixels, from 0.001 to 1e9 or from -1e9 to -0.001";
            within(name, given, FOCAL_PX.contains(&given.abs()), accepted)?;
        }
        for (name, given) in [("cx", cx), ("cy", cy)] {
            let accepted = "a pixel coordinate from -1e9 to 1e9";
            within(name, given, given.abs() <= MAX_PRINCIPAL_POINT_PX, accepted)?;
        }
        Ok(Intrinsics { fx, fy, cx, cy })
    }

    /// The camera that is assumed where none is known: on a map of `width` x `height` pixels it sees 53.13 degrees
    /// along the longer side, half of it on either side of the middle, and its pixels are square.
    ///
    /// The focal length is the longer side, in pixels: our choice, a round figure somewhat narrower than Kinects (57 to 70
    /// degrees). Planes remain planes with any camera, though angles and distances are not the true ones. Both sides have
    /// to be 1 or more, as those of a map are.
    pub fn assumed(width: usize, height: usize) -> Self {
        let [width, height] = [width, height].map(|side| side as f64);
        let focal = width.max(height);
        Intrinsics { fx: focal, fy: focal, cx: width / 2.0, cy: height / 2.0 }
    }

    /// The ray through pixel (u, v), scaled so that its z is 1.
    #[inline]
    pub fn ray(&self, u: f64, v: f64) -> [f64; 3] {
        [(u - self.cx) / self.fx, (v - self.cy) / self.fy, 1.0]
    }

    /// Pixel (u, v) of a point in front of the camera, metres in.
    #[inline]
    pub fn project(&self, point_m: [f64; 3]) -> [f64; 2] {
        let [x, y, z] = point_m;
        [self.fx * x / z + self.cx, self.fy * y / z + self.cy]
    }
}

/// What the numbers in a map mean: depth, inverse depth or disparity, and its unit. All but disparity of an unknown rig are
/// metric.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum ValueKind {
    /// Depth along the optical axis: `z = metres * value`.
    Depth {
        /// Metres per map unit.
        metres: f64,
    },
    /// Affine in inverse depth: `1/z = slope * value + offset`, in 1/m. Disparity of a known rig
    /// ([`ValueKind::stereo`]), raw Kinect.
    InverseDepth {
        /// 1/m per map unit.
        slope: f64,
        /// 1/m at value 0.
        offset: f64,
    },
    /// Affine in inverse depth by unknown factors: disparity of an unknown rig. Planes are found
    /// in it as well as in any other; metric output needs the rig.
    Disparity,
}

impl ValueKind {
    /// Depth with a unit.
    ///
    /// # Errors
    /// [`Error::Camera`] unless `metres` per unit lies within [`METRES_PER_UNIT`].
    pub fn depth(metres: f64) -> Result<Self> {
        ValueKind::Depth { metres }.checked()
    }

    /// Disparity of a rectified pair (paper, eq. 6: `z = f T / |xL - xR|`; with the Middlebury
    /// `doffs` term, `z = f T / (d + doffs)`): `pixels_per_unit` turns map values into pixels,
    /// `focal_px` is f in pixels, `baseline_m` is T in metres, `doffs_px` the difference of the two
    /// principal points in pixels (0 for most rigs).
    ///
    /// # Errors
    /// [`Error::Camera`] unless the first three are finite and positive and the last is finite, and the inverse depth that
    /// they give has a slope within [`SLOPE_PER_M`] and an offset of at most [`MAX_OFFSET_PER_M`].
    pub fn stereo(pixels_per_unit: f64, focal_px: f64, baseline_m: f64, doffs_px: f64) -> Result<Self> {
        positive("pixels of disparity per map unit", pixels_per_unit)?;
        positive("focal length in pixels", focal_px)?;
        positive("baseline in metres", baseline_m)?;
        if !doffs_px.is_finite() {
            return Err(Error::Camera { name: "doffs", given: doffs_px, accepted: "a finite number of pixels" });
        }
        let f_t = focal_px * baseline_m;
        ValueKind::InverseDepth { slope: pixels_per_unit / f_t, offset: doffs_px / f_t }.checked()
    }

    fn checked(self) -> Result<Self> {
        self.check()?;
        Ok(self)
    }

    /// That its numbers are accepted, however it was made.
    ///
    /// # Errors
    /// [`Error::Camera`] as of the constructors.
    pub(crate) fn check(&self) -> Result<()> {
        match *self {
            ValueKind::Depth { metres } => {
                let accepted = "a number of metres from 1e-12 to 1e12";
                within("metres per map unit", metres, METRES_PER_UNIT.contains(&metres), accepted)
            }
            ValueKind::InverseDepth { slope, offset } => {
                let accepted = "a number of 1/m per map unit, from 1e-15 to 1e15 or from -1e15 to -1e-15";
                within("slope", slope, SLOPE_PER_M.contains(&slope.abs()), accepted)?;
                within("offset", offset, offset.abs() <= MAX_OFFSET_PER_M, "a number of 1/m from -1e15 to 1e15")
            }
            ValueKind::Disparity => Ok(()),
        }
    }

    /// Inverse depth in 1/m of a map value; `None` of [`ValueKind::Disparity`], whose factors are unknown, and of a
    /// value that lies at or behind infinity.
    #[inline]
    pub fn inverse_depth(&self, value: f64) -> Option<f64> {
        let q = match *self {
            ValueKind::Depth { metres } => 1.0 / (metres * value),
            ValueKind::InverseDepth { slope, offset } => slope * value + offset,
            ValueKind::Disparity => return None,
        };
        (q.is_finite() && q > 0.0).then_some(q)
    }

    /// Depth in metres of a map value (eq. 6); `None` as for [`ValueKind::inverse_depth`].
    #[inline]
    pub fn depth_m(&self, value: f64) -> Option<f64> {
        self.inverse_depth(value).map(f64::recip)
    }

    /// The map value that means a depth in metres (eq. 6 the other way); `None` for
    /// [`ValueKind::Disparity`] or a depth that is not positive.
    #[inline]
    pub fn value(&self, depth_m: f64) -> Option<f64> {
        if !(depth_m > 0.0 && depth_m.is_finite()) {
            return None;
        }
        match *self {
            ValueKind::Depth { metres } => Some(depth_m / metres),
            ValueKind::InverseDepth { slope, offset } => Some((depth_m.recip() - offset) / slope),
            ValueKind::Disparity => None,
        }
    }
}

fn positive(name: &'static str, given: f64) -> Result<()> {
    within(name, given, given.is_finite() && given > 0.0, "a finite number above 0")
}

/// Refuses a quantity that is not accepted.
pub(crate) fn within(name: &'static str, given: f64, is_accepted: bool, accepted: &'static str) -> Result<()> {
    if is_accepted { Ok(()) } else { Err(Error::Camera { name, given, accepted }) }
}

/// A plane in Hessian normal form, `normal . P + distance = 0`, in camera coordinates, metres. The
/// normal has length 1 and points to the camera's side, so `distance >= 0` is the camera's distance
/// from the plane.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct HessianNormalForm {
    /// Unit normal in camera coordinates, towards the camera.
    pub normal: [f64; 3],
    /// Distance of the camera from the plane, metres.
    pub distance: f64,
}

impl HessianNormalForm {
    /// The plane whose inverse depth is `1/z = a u + b v + c` (1/m, pixels); `None` if all three
    /// are 0 (a plane at infinity).
    ///
    /// `m = (a fx, b fy, c + a cx + b cy)`, `normal = -m / |m|`, `distance = 1 / |m|`.
    pub fn from_inverse_depth(abc: [f64; 3], camera: &Intrinsics) -> Option<Self> {
        let m = ray_coefficients(abc, camera);
        let length = m.iter().map(|x| x * x).sum::<f64>().sqrt();
        if !(length > 0.0 && length.is_finite()) {
            return None;
        }
        Some(HessianNormalForm { normal: m.map(|x| -x / length), distance: length.recip() })
    }

    /// The coefficients (a, b, c) of `1/z = a u + b v + c`, the other way; `None` for a plane
    /// through the camera's centre.
    pub fn inverse_depth(&self, camera: &Intrinsics) -> Option<[f64; 3]> {
        if self.distance == 0.0 {
            return None;
        }
        let m = self.normal.map(|x| -x / self.distance);
        let (a, b) = (m[0] / camera.fx, m[1] / camera.fy);
        Some([a, b, m[2] - a * camera.cx - b * camera.cy])
    }

    /// The plane's point behind picture point (u, v), metres; `None` if the ray meets the plane at
    /// or behind infinity.
    #[inline]
    pub fn point_at(&self, [u, v]: [f64; 2], camera: &Intrinsics) -> Option<[f64; 3]> {
        self.point_along(camera.ray(u, v))
    }

    /// The plane's point on a ray, metres; `None` if the ray meets the plane at or behind infinity.
    #[inline]
    pub(crate) fn point_along(&self, ray: [f64; 3]) -> Option<[f64; 3]> {
        let [x, y, z] = self.normal;
        let depth = -self.distance / (x * ray[0] + y * ray[1] + z * ray[2]);
        (depth > 0.0 && depth.is_finite()).then(|| ray.map(|r| r * depth))
    }
}

/// `m` with `1/z = m . r` for the ray r of [`Intrinsics::ray`].
pub(crate) fn ray_coefficients([a, b, c]: [f64; 3], camera: &Intrinsics) -> [f64; 3] {
    [a * camera.fx, b * camera.fy, c + a * camera.cx + b * camera.cy]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_assumed_camera_sees_53_degrees_along_the_longer_side() {
        let cosine = |[a, b]: [[f64; 3]; 2]| {
            let dot = |a: [f64; 3], b: [f64; 3]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
            dot(a, b) / (dot(a, a) * dot(b, b)).sqrt()
        };
        let (wide, tall) = (Intrinsics::assumed(640, 480), Intrinsics::assumed(480, 640));
        let across = [wide.ray(0.0, 240.0), wide.ray(640.0, 240.0)];
        let down = [tall.ray(240.0, 0.0), tall.ray(240.0, 640.0)];
        // In the triangle of 3, 4 and 5 the angle of 53.13 degrees lies between the sides of 3 and 5.
        for ends in [across, down] {
            assert!((cosine(ends) - 3.0 / 5.0).abs() < 1e-12, "{ends:?}");
        }
        // Pixels are square.
        assert_eq!((wide.fx, tall.fx), (wide.fy, tall.fy));
    }
}
