//! Planes' equations against known ones: errors of normals, of offsets, and of the angles between
//! neighbouring planes.
//!
//! [`super::segcomp`] or [`super::evops`] say which planes belong together; the equations are asked for by label, and
//! planes without one are passed over.

use super::contingency::Match;
use super::segcomp::SegComp;
use crate::camera::HessianNormalForm;
use crate::error::{Error, Result};
use std::collections::{BTreeMap, BTreeSet};

/// How far a plane is from the true one.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct PlaneError {
    /// Angle between the normals, degrees, 0..=90.
    pub normal_deg: f64,
    /// Difference of the distances from the camera, metres.
    pub offset_m: f64,
}

/// The error of one plane. `(normal, distance)` and `(-normal, -distance)` are the same plane, so
/// that a plane through the camera may point either way.
pub fn plane_error(truth: &HessianNormalForm, prediction: &HessianNormalForm) -> PlaneError {
    let angle = angle_deg(truth.normal, prediction.normal);
    if angle <= 90.0 {
        PlaneError { normal_deg: angle, offset_m: (truth.distance - prediction.distance).abs() }
    } else {
        PlaneError { normal_deg: 180.0 - angle, offset_m: (truth.distance + prediction.distance).abs() }
    }
}

/// The errors of matched planes, in the order of the matches; `truth` and `prediction` give a
/// label's plane. A match whose planes are not both known has no entry.
pub fn plane_errors(
    matches: &[Match],
    truth: impl Fn(u16) -> Option<HessianNormalForm>,
    prediction: impl Fn(u16) -> Option<HessianNormalForm>,
) -> Vec<(Match, PlaneError)> {
    let error = |pair: &Match| Some((*pair, plane_error(&truth(pair.truth)?, &prediction(pair.prediction)?)));
    matches.iter().filter_map(error).collect()
}

/// Pairs of planes with pixels side by side or one above the other, each once, the smaller label
/// first, ascending. `labels` has `width * height` entries, row by row.
///
/// # Errors
/// [`Error::Length`] if it has not.
pub fn adjacent(labels: &[u16], width: usize, height: usize) -> Result<Vec<(u16, u16)>> {
    let area = width.saturating_mul(height);
    if labels.len() != area {
        return Err(Error::Length { given: labels.len(), least: area, most: area });
    }
    let mut pairs = BTreeSet::new();
    let mut add = |a: u16, b: u16| {
        if a != b && a != 0 && b != 0 {
            pairs.insert((a.min(b), a.max(b)));
        }
    };
    for row in labels.chunks(width.max(1)) {
        row.windows(2).for_each(|two| add(two[0], two[1]));
    }
    labels.iter().zip(labels.iter().skip(width)).for_each(|(&above, &below)| add(above, below));
    Ok(pairs.into_iter().collect())
}

/// SegComp's angle error: for each pair of neighbouring truth planes ([`adjacent`]) that are both correct, the
/// difference between the angle of the predicted planes and that of the true ones, degrees, 0..=180. In the order of
/// the pairs; pairs with a plane that is not known are passed over.
///
/// Normals point to the camera ([`HessianNormalForm`]), so that convex and concave edges differ.
pub fn angle_errors(
    found: &SegComp,
    neighbours: &[(u16, u16)],
    truth: impl Fn(u16) -> Option<HessianNormalForm>,
    prediction: impl Fn(u16) -> Option<HessianNormalForm>,
) -> Vec<f64> {
    let partner: BTreeMap<u16, u16> = found.correct.iter().map(|pair| (pair.truth, pair.prediction)).collect();
    let error = |&(a, b): &(u16, u16)| {
        let found = angle_deg(prediction(*partner.get(&a)?)?.normal, prediction(*partner.get(&b)?)?.normal);
        Some((found - angle_deg(truth(a)?.normal, truth(b)?.normal)).abs())
    };
    neighbours.iter().filter_map(error).collect()
}

/// The angle between two vectors of any length, exact also near 0 and 180 degrees.
fn angle_deg(a: [f64; 3], b: [f64; 3]) -> f64 {
    let dot = a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let cross = [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
    cross.iter().map(|x| x * x).sum::<f64>().sqrt().atan2(dot).to_degrees()
}
