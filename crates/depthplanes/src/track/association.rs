//! Which plane of this frame is which track.
//!
//! In: how much the tracks overlap this frame's planes. Out: a label for each track that is seen, the plane that holds it
//! for each that is part of another now, and the origin of planes that split off.

use super::egomotion::{self, Pair};
use super::field::{Field, Overlap};
use super::filter::State;
use super::pose::Motion;
use super::tracked::TrackedPlane;
use crate::camera::HessianNormalForm;
use crate::detection::{Detection, MetricPlane};
use crate::util::vec3::{dot, quadratic_form};

/// Least intersection over union of a track and its plane: below it they share no more than a border or a corner.
const LEAST_IOU: f64 = 0.1;
/// Share of a track or a plane that lies in another of which it is part.
const PART: f64 = 0.5;
/// Share of a plane that an older track makes up at least to go on as that plane.
const OLD_PART: f64 = 0.25;
/// Radians by which a plane of few pixels turns from frame to frame beside what its covariance says: 2 degrees.
const ANGLE_SD: f64 = 0.035;
/// The same for its distance, in metres for each metre of depth.
const OFFSET_SD: f64 = 0.01;
/// Squared deviations, of 1 degree of freedom, up to which what is seen in a track's pixels is where the track should be: one
/// of 100 is not by chance. How it is turned does not count: small planes turn by far more than their covariance says.
const THERE: f64 = 6.6;
/// Squared deviations, of 3 degrees of freedom, up to which two planes may be one: one of 100 is not by chance.
const ALIKE: f64 = 11.3;
/// Radians up to which two planes may be one before the motion of the camera is known: 15 degrees.
const MOST_TURN: f64 = 0.26;
/// Median of the squared deviations of 3 degrees of freedom up to which the camera is at rest; by chance it is 2.4.
const AT_REST: f64 = 3.0;

/// Reuses its memory from frame to frame.
#[derive(Clone, Debug, Default)]
pub(super) struct Association {
    pub(super) overlaps: Vec<Overlap>,
    /// The label of each track.
    pub(super) labels: Vec<Option<u16>>,
    /// The id of the plane that each track without a label is part of.
    pub(super) subsumed_by: Vec<Option<u32>>,
    /// The id of the plane that each label was part of before, label 1 first.
    pub(super) split_from: Vec<Option<u32>>,
    /// The track of each label, label 1 first.
    owners: Vec<Option<usize>>,
    /// Intersections over union of the overlaps, the largest first.
    ranked: Vec<(f64, Overlap)>,
    pairs: Vec<Pair>,
    squares: Vec<f64>,
}

impl Association {
    /// Ranks the overlaps by intersection over union, then by track and label.
    fn rank(&mut self, found: &Detection, field: &Field) {
        let iou = |overlap: &Overlap| {
            let both = f64::from(overlap.pixels);
            let now = found.planes[usize::from(overlap.label) - 1].pixel_count as f64;
            both / (f64::from(field.pixels_of(overlap.track)) + now - both).max(both)
        };
        self.ranked.clear();
        self.ranked.extend(self.overlaps.iter().map(|overlap| (iou(overlap), *overlap)));
        self.ranked.sort_unstable_by(|a, b| {
            b.0.total_cmp(&a.0).then_with(|| (a.1.track, a.1.label).cmp(&(b.1.track, b.1.label)))
        });
    }

    /// Pairs tracks and labels one to one, the best overlap first.
    fn take(&mut self, tracks: usize, labels: usize, mut accepts: impl FnMut(&Overlap) -> bool) {
        self.labels.clear();
        self.labels.resize(tracks, None);
        self.owners.clear();
        self.owners.resize(labels, None);
        for (_, overlap) in self.ranked.iter().take_while(|(iou, _)| *iou >= LEAST_IOU) {
            let owner = &mut self.owners[usize::from(overlap.label) - 1];
            let label = &mut self.labels[overlap.track];
            if owner.is_none() && label.is_none() && accepts(overlap) {
                (*label, *owner) = (Some(overlap.label), Some(overlap.track));
            }
        }
    }

    /// How the camera moved since the last frame, by the planes that are in both.
    pub(super) fn egomotion(&mut self, found: &Detection, field: &Field, states: &[Option<State>]) -> Motion {
        let metric = |label: u16| found.planes[usize::from(label) - 1].metric;
        self.rank(found, field);
        self.take(states.len(), found.planes.len(), |overlap| {
            let planes = states[overlap.track].zip(metric(overlap.label));
            planes.is_some_and(|(before, now)| angle(&before.plane, &now.plane) < MOST_TURN)
        });
        self.pairs.clear();
        for (state, label) in states.iter().zip(&self.labels) {
            let planes = state.zip(label.and_then(metric));
            self.pairs.extend(planes.map(|(before, now)| pair(&before, &now)));
        }
        self.squares.clear();
        self.squares.extend(self.pairs.iter().map(|pair| egomotion::squares(pair, &Motion::NONE)));
        let middle = self.squares.len() / 2;
        if self.squares.is_empty() || *self.squares.select_nth_unstable_by(middle, f64::total_cmp).1 <= AT_REST {
            return Motion::NONE;
        }
        egomotion::motion(&self.pairs)
    }

    /// Gives the labels to the tracks; the states are predicted and the field is moved.
    pub(super) fn assign(
        &mut self,
        found: &Detection,
        field: &Field,
        states: &[Option<State>],
        planes: &[TrackedPlane],
    ) {
        let metric = |label: u16| found.planes[usize::from(label) - 1].metric;
        let agree = |overlap: &Overlap| match states[overlap.track].zip(metric(overlap.label)) {
            Some((state, metric)) => is_alike(&state, &metric),
            None => true, // not metric: the pixels alone decide
        };
        self.rank(found, field);
        self.take(planes.len(), found.planes.len(), |overlap| {
            let both = states[overlap.track].zip(metric(overlap.label));
            both.is_none_or(|(state, metric)| moved(&state, &metric) <= THERE)
        });
        self.prefer_older(found, field, agree);
        self.subsumed_by.clear();
        self.subsumed_by.resize(planes.len(), None);
        self.split_from.clear();
        self.split_from.resize(found.planes.len(), None);
        for overlap in &self.overlaps {
            let label = usize::from(overlap.label) - 1;
            let pixels = f64::from(overlap.pixels);
            let of_label = PART * found.planes[label].pixel_count as f64;
            let of_track = PART * f64::from(field.pixels_of(overlap.track));
            match (self.labels[overlap.track], self.owners[label]) {
                (None, Some(owner)) if pixels >= of_track && agree(overlap) => {
                    self.subsumed_by[overlap.track] = Some(planes[owner].id);
                }
                (Some(_), None) if pixels >= of_label && agree(overlap) => {
                    self.split_from[label] = Some(planes[overlap.track].id);
                }
                _ => (),
            }
        }
    }

    /// Where several tracks have become one plane, the oldest goes on: it takes the label of a younger one if it lies
    /// mostly in that plane and makes up a good part of it.
    fn prefer_older(&mut self, found: &Detection, field: &Field, agree: impl Fn(&Overlap) -> bool) {
        for overlap in &self.overlaps {
            let label = usize::from(overlap.label) - 1;
            let Some(owner) = self.owners[label].filter(|&owner| overlap.track < owner) else { continue };
            let pixels = f64::from(overlap.pixels);
            let of_label = OLD_PART * found.planes[label].pixel_count as f64;
            let of_track = PART * f64::from(field.pixels_of(overlap.track));
            if self.labels[overlap.track].is_none() && pixels >= of_label.max(of_track) && agree(overlap) {
                (self.labels[owner], self.labels[overlap.track]) = (None, Some(overlap.label));
                self.owners[label] = Some(overlap.track);
            }
        }
    }
}

fn angle(a: &HessianNormalForm, b: &HessianNormalForm) -> f64 {
    dot(a.normal, b.normal).clamp(-1.0, 1.0).acos()
}

/// Variance of a plane's normal, and of its height at a point.
fn variances(covariance: &[[f64; 4]; 4], [x, y, z]: [f64; 3]) -> [f64; 2] {
    let height = quadratic_form(covariance, [x, y, z, 1.0]).max(0.0);
    [(0..3).map(|i| covariance[i][i]).sum::<f64>() / 2.0, height]
}

/// The least that two planes are off each other: rounding, and what is smaller than any sensor's error.
const LEAST_VARIANCE: f64 = 1e-8;

fn pair(before: &State, now: &MetricPlane) -> Pair {
    let at = now.centroid_m;
    let white = now.covariance.map(|row| row.map(|entry| entry * now.white_share));
    let [[normal_before, height_before], [normal, height]] = [variances(before.white(), at), variances(&white, at)];
    Pair {
        before: before.plane,
        after: now.plane,
        normal_variance: normal_before + normal + LEAST_VARIANCE,
        at,
        variance: height_before + height + LEAST_VARIANCE,
    }
}

/// How far the middle of what is seen now is off the track's plane, squared, in deviations.
fn moved(state: &State, now: &MetricPlane) -> f64 {
    let at = now.centroid_m;
    let [height_before, height] = [&state.covariance(), &now.covariance].map(|covariance| variances(covariance, at)[1]);
    let offset = dot(state.plane.normal, at) + state.plane.distance;
    offset * offset / (height_before + height + (OFFSET_SD * at[2]).powi(2))
}

/// Whether what is seen now may be the track's plane, also where their pixels do not say so.
fn is_alike(state: &State, now: &MetricPlane) -> bool {
    let [before, seen] =
        [&state.covariance(), &now.covariance].map(|covariance| variances(covariance, now.centroid_m)[0]);
    let turned = angle(&state.plane, &now.plane).powi(2) / (before + seen + ANGLE_SD * ANGLE_SD);
    turned + moved(state, now) <= ALIKE
}
