//! Steps of a stair: the treads in order, with rise and run.
//!
//! In: the planes that are steps by their height. Out: one step for each height, counted from the floor upwards and
//! downwards. The run is the distance between the front edges of two treads, along the direction that the risers face, or
//! along the view where no riser is seen.

use super::class::{ClassifiedPlane, PlaneClass, RISE_M};
use super::standing::Standing;
use crate::detection::{Detection, Plane};
use crate::sensor::Sensor;
use crate::util::memory::reserve_to;

/// A step up from the floor, or down from it.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct Step {
    /// Label of its tread.
    pub label: u16,
    /// 1 for the first step up from the floor, then 2, ...; -1 for the first one down.
    pub order: i32,
    /// Height of the tread above the floor, metres; below 0 of steps down.
    pub height_m: f64,
    /// Height from the level before, metres; below 0 of steps down.
    pub rise_m: f64,
    /// Distance from the near edge of the step before to its own, metres; `None` of the first, before which is floor.
    pub run_m: Option<f64>,
    /// Distance of the near edge from the point below the camera, metres, along the direction of the stair.
    pub distance_m: f64,
}

/// Columns from one that is asked for a tread's edge to the next; rows are all asked, since one is centimetres of floor.
const STRIDE: usize = 4;
/// Square metres of the largest riser; walls beside the stair are larger.
const RISER_M2: f64 = 1.0;
/// Metres that the middle of a riser may lie off the middle between two treads.
const RISER_M: f64 = 0.06;
/// Metres that a riser may stand off the nearest pixel of its tread.
const EDGE_M: f64 = 0.12;
/// Most steps.
const MOST: usize = 64;

/// The steps: those up from the lowest, then those down from the highest.
pub(super) fn find(
    found: &Detection,
    classified: &[ClassifiedPlane],
    standing: &Standing,
    sensor: &Sensor,
    steps: &mut Vec<Step>,
) {
    steps.clear();
    reserve_to(steps, MOST);
    for of in classified.iter().filter(|of| of.class == PlaneClass::Step) {
        let Some(height_m) = of.height_m else { continue };
        // The larger of two pieces at one height comes first, and is the step.
        let is_known = steps.iter().any(|step| (step.height_m - height_m).abs() < RISE_M[0]);
        if !is_known && steps.len() < MOST {
            let step = Step { label: of.label, order: 0, height_m, rise_m: 0.0, run_m: None, distance_m: 0.0 };
            steps.push(step);
        }
    }
    steps.sort_unstable_by(|a, b| {
        let key = |step: &Step| (step.height_m < 0.0, step.height_m.abs());
        key(a).partial_cmp(&key(b)).unwrap_or(std::cmp::Ordering::Equal)
    });
    let climb = direction(found, classified, standing, steps);
    let mut before: Option<Step> = None;
    for step in steps.iter_mut() {
        before = before.filter(|before| (before.height_m < 0.0) == (step.height_m < 0.0));
        let down = step.height_m < 0.0;
        step.order = before.map_or(if down { -1 } else { 1 }, |before| before.order + if down { -1 } else { 1 });
        step.rise_m = step.height_m - before.map_or(0.0, |before| before.height_m);
        let middle_m = step.height_m - step.rise_m / 2.0;
        let edge = found.plane(step.label).and_then(|plane| near_edge_m(found, plane, standing, sensor, climb));
        let edge = edge.map(|edge| riser_m(found, classified, standing, climb, [edge, middle_m]).unwrap_or(edge));
        step.distance_m = edge.unwrap_or(0.0);
        step.run_m = before.filter(|_| edge.is_some()).map(|before| step.distance_m - before.distance_m);
        before = Some(*step);
    }
}

/// The direction in which the stair goes, right and ahead: away from what its risers face.
fn direction(found: &Detection, classified: &[ClassifiedPlane], standing: &Standing, steps: &[Step]) -> [f64; 2] {
    let mut sum = [0.0; 2];
    for (plane, of) in found.planes.iter().zip(classified) {
        let (Some(metric), Some(height)) = (plane.metric, of.height_m) else { continue };
        let mut below = 0.0;
        let is_between = steps.iter().any(|step| {
            let middle = (below + step.height_m) / 2.0;
            below = step.height_m;
            (height - middle).abs() < RISER_M
        });
        let [right, ahead] = standing.direction(metric.plane.normal);
        // Risers face the one who climbs; sides of the stair do not.
        let is_riser = ahead < -0.5 && metric.area_m2.is_some_and(|area| area <= RISER_M2);
        if is_between && is_riser && is_upright(of) {
            let pixels = plane.pixel_count as f64;
            sum = [sum[0] - pixels * right, sum[1] - pixels * ahead];
        }
    }
    let length = sum[0].hypot(sum[1]);
    if length > 0.0 { sum.map(|x| x / length) } else { [0.0, 1.0] }
}

/// Whether a plane is upright.
fn is_upright(of: &ClassifiedPlane) -> bool {
    of.slope_deg.is_some_and(|slope| (80.0..=100.0).contains(&slope))
}

/// Where the riser below a tread stands along the stair: that at the height of its middle, near the tread's edge. Its plane
/// tells that better than the border of two planes does.
fn riser_m(
    found: &Detection,
    classified: &[ClassifiedPlane],
    standing: &Standing,
    climb: [f64; 2],
    [edge_m, middle_m]: [f64; 2],
) -> Option<f64> {
    let upright = found.planes.iter().zip(classified).filter(|(_, of)| is_upright(of));
    let mut near = upright.filter_map(|(plane, of)| {
        let along = along_m(standing.direction(plane.metric?.centroid_m), climb);
        let is_it = (of.height_m? - middle_m).abs() < RISER_M && (along - edge_m).abs() < EDGE_M;
        is_it.then_some(along)
    });
    near.next() // the largest
}

fn along_m([right, ahead]: [f64; 2], climb: [f64; 2]) -> f64 {
    right * climb[0] + ahead * climb[1]
}

/// The nearest of a tread along the stair, metres from the point below the camera.
fn near_edge_m(found: &Detection, plane: &Plane, standing: &Standing, sensor: &Sensor, climb: [f64; 2]) -> Option<f64> {
    let form = plane.metric?.plane;
    let bounds = plane.bounding_box;
    let mut nearest = f64::INFINITY;
    for v in bounds.v_min as usize..=bounds.v_max as usize {
        for u in (bounds.u_min as usize..=bounds.u_max as usize).step_by(STRIDE) {
            if found.labels[v * found.width + u] != plane.label {
                continue;
            }
            let Some(point) = sensor.ray(u as f64, v as f64).and_then(|ray| form.point_along(ray)) else { continue };
            nearest = nearest.min(along_m(standing.direction(point), climb));
        }
    }
    nearest.is_finite().then_some(nearest)
}
