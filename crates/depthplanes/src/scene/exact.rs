//! Arithmetic that gives the same bits on every platform: sines and small vectors.
//!
//! Only `+ - * /`, `sqrt`, `floor` and integers are used, which IEEE 754 rounds in one way
//! (and Rust never fuses them). The sines of the platform's own library differ in their last bit,
//! enough to move a rounded millimetre, so they are not used here.

use std::f64::consts::PI;

/// A point or direction.
pub(super) type Vec3 = [f64; 3];

pub(super) fn add(a: Vec3, b: Vec3) -> Vec3 {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

pub(super) fn sub(a: Vec3, b: Vec3) -> Vec3 {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

pub(super) fn scale(a: Vec3, s: f64) -> Vec3 {
    [a[0] * s, a[1] * s, a[2] * s]
}

#[inline(always)]
pub(super) fn dot(a: Vec3, b: Vec3) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(super) fn cross(a: Vec3, b: Vec3) -> Vec3 {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// The vector at length 1; `None` if it has no direction.
pub(super) fn unit(a: Vec3) -> Option<Vec3> {
    let length = dot(a, a).sqrt();
    (length > 1e-12 && length.is_finite()).then(|| scale(a, 1.0 / length))
}

/// Sine and cosine of an angle in degrees, to 2e-16, exact at multiples of 90.
pub(super) fn sin_cos_deg(degrees: f64) -> (f64, f64) {
    let turn = degrees.rem_euclid(360.0);
    let quadrant = (turn / 90.0 + 0.5).floor();
    let x = (turn - 90.0 * quadrant) * (PI / 180.0);
    // Taylor series; |x| <= pi/4 leaves less than 1e-18 after nine terms.
    let (mut sine, mut cosine, mut term) = (0.0, 0.0, 1.0);
    for k in 0..9 {
        let n = f64::from(2 * k);
        let sign = if k % 2 == 0 { 1.0 } else { -1.0 };
        cosine += sign * term;
        term *= x / (n + 1.0);
        sine += sign * term;
        term *= x / (n + 2.0);
    }
    match quadrant as i64 % 4 {
        0 => (sine, cosine),
        1 => (cosine, -sine),
        2 => (-sine, -cosine),
        _ => (-cosine, sine),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sines_match_the_library_of_the_platform() {
        for step in -800..800 {
            let degrees = f64::from(step) * 0.7;
            let (sine, cosine) = sin_cos_deg(degrees);
            let (s, c) = degrees.to_radians().sin_cos();
            assert!((sine - s).abs() < 3e-15 && (cosine - c).abs() < 3e-15, "at {degrees}");
        }
        assert_eq!(sin_cos_deg(90.0), (1.0, 0.0));
        assert_eq!(sin_cos_deg(-180.0).1, -1.0);
    }
}
