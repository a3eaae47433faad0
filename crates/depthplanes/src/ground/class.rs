//! What a plane is to somebody who stands on the floor: a row of [`CLASSES`] for each kind.

use super::floor::Floor;
use super::space::{angle_deg, height_m, height_sd_m};
use crate::detection::{MetricPlane, Plane};

/// What a plane is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "lowercase"))]
#[non_exhaustive]
pub enum PlaneClass {
    /// The floor, or a piece of it.
    Floor,
    /// Level, faces down, at 1.8 m or higher.
    Ceiling,
    /// Upright and at least a quarter of a square metre.
    Wall,
    /// Level, faces up, too high for a step: the top of a table, a seat, a shelf.
    Table,
    /// Faces up and slopes by at most 30 degrees.
    Ramp,
    /// Level, faces up, and no more than 25 cm above or below the floor or another step.
    Step,
    /// None of these: sides of boxes, undersides, slanting planes, and planes whose place is not known.
    Other,
}

impl PlaneClass {
    /// The word for it in records: `floor`, `ceiling`, ...
    pub fn name(self) -> &'static str {
        CLASSES.iter().find(|row| row.class == self).map_or("other", |row| row.name)
    }
}

/// One plane, by where it is above the floor.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct ClassifiedPlane {
    /// Its label.
    pub label: u16,
    /// What it is.
    pub class: PlaneClass,
    /// Height of its middle above the floor, metres; below 0 under it. `None` if its place is not known.
    pub height_m: Option<f64>,
    /// Angle between its normal and the floor's, degrees: 0 of level planes that face up, 90 of upright ones, 180 of
    /// ceilings.
    pub slope_deg: Option<f64>,
}

/// What the classes are told by.
struct Seen {
    is_floor: bool,
    slope_deg: f64,
    /// Degrees that its slope may be off.
    tolerance_deg: f64,
    height_m: f64,
    area_m2: f64,
}

struct Row {
    class: PlaneClass,
    name: &'static str,
    holds: fn(&Seen) -> bool,
}

/// Degrees that a level or an upright plane is off at least, three standard deviations of its normal if these are more, and
/// no more than the second number.
const LEVEL_DEG: [f64; 2] = [5.0, 10.0];
/// Degrees of the steepest ramp: twice the steepest of garages, and less than stairs.
const RAMP_DEG: f64 = 30.0;
/// Metres above the floor of the lowest ceiling.
const CEILING_M: f64 = 1.8;
/// Square metres of the smallest wall; smaller upright planes are sides of things.
const WALL_M2: f64 = 0.25;
/// Metres from one step to the next: the lowest is more than the error of a piece of floor, the highest is that of building
/// codes (21 cm) and of steep stairs.
pub(super) const RISE_M: [f64; 2] = [0.04, 0.25];

/// Square metres of the smallest tread: what is seen of one behind the edge of the next, 25 cm wide.
const TREAD_M2: f64 = 0.03;

/// All classes; a plane is of the first that holds.
const CLASSES: &[Row] = &[
    Row { class: PlaneClass::Floor, name: "floor", holds: |seen| seen.is_floor },
    // By `climb`, since it takes the other steps.
    Row { class: PlaneClass::Step, name: "step", holds: |_| false },
    Row { class: PlaneClass::Table, name: "table", holds: |seen| seen.is_level() && seen.height_m > RISE_M[1] },
    Row {
        class: PlaneClass::Ceiling,
        name: "ceiling",
        holds: |seen| 180.0 - seen.slope_deg <= seen.tolerance_deg && seen.height_m >= CEILING_M,
    },
    Row {
        class: PlaneClass::Wall,
        name: "wall",
        holds: |seen| (90.0 - seen.slope_deg).abs() <= seen.tolerance_deg && seen.area_m2 >= WALL_M2,
    },
    Row {
        class: PlaneClass::Ramp,
        name: "ramp",
        holds: |seen| seen.slope_deg <= RAMP_DEG && !seen.is_level() && seen.height_m > 0.0,
    },
    Row { class: PlaneClass::Other, name: "other", holds: |_| true },
];

impl Seen {
    fn is_level(&self) -> bool {
        self.slope_deg <= self.tolerance_deg
    }
}

/// Classifies all planes, in the order of their labels.
pub(super) fn classify(planes: &[Plane], floor: &Floor, classified: &mut Vec<ClassifiedPlane>) {
    classified.clear();
    classified.extend(planes.iter().map(|plane| {
        let seen = plane.metric.map(|metric| see(plane, &metric, floor));
        let class = seen.as_ref().map_or(PlaneClass::Other, class_of);
        let (height_m, slope_deg) = (seen.as_ref().map(|seen| seen.height_m), seen.map(|seen| seen.slope_deg));
        ClassifiedPlane { label: plane.label, class, height_m, slope_deg }
    }));
    climb(planes, floor, classified);
}

fn class_of(seen: &Seen) -> PlaneClass {
    CLASSES.iter().find(|row| (row.holds)(seen)).map_or(PlaneClass::Other, |row| row.class)
}

fn see(plane: &Plane, metric: &MetricPlane, floor: &Floor) -> Seen {
    // Half of the trace: a unit normal turns about two axes.
    let turn = |covariance: &[[f64; 4]; 4]| (0..3).map(|i| covariance[i][i]).sum::<f64>() / 2.0;
    let sd_deg = (turn(&metric.covariance) + turn(&floor.covariance)).max(0.0).sqrt().to_degrees();
    Seen {
        is_floor: floor.labels.contains(&plane.label),
        slope_deg: angle_deg(metric.plane.normal, floor.plane.normal),
        tolerance_deg: (3.0 * sd_deg).clamp(LEVEL_DEG[0], LEVEL_DEG[1]),
        height_m: height_m(&floor.plane, metric.centroid_m),
        area_m2: metric.area_m2.unwrap_or(f64::INFINITY),
    }
}

/// Level planes within a rise of the floor are steps, and so are those within a rise of these.
fn climb(planes: &[Plane], floor: &Floor, classified: &mut [ClassifiedPlane]) {
    loop {
        let is_next = |at: usize| {
            let ClassifiedPlane { class, height_m: Some(height), .. } = classified[at] else { return false };
            let Some(metric) = planes[at].metric else { return false };
            let seen = see(&planes[at], &metric, floor);
            if matches!(class, PlaneClass::Floor | PlaneClass::Step) || !seen.is_level() || seen.area_m2 < TREAD_M2 {
                return false;
            }
            // What may be floor that errs is no step.
            let least = RISE_M[0].max(3.0 * height_sd_m(&floor.covariance, &metric));
            let is_rise = |from: f64| (RISE_M[0]..=RISE_M[1]).contains(&(height - from).abs());
            let steps = classified.iter().filter(|other| other.class == PlaneClass::Step);
            height.abs() >= least && (is_rise(0.0) || steps.filter_map(|step| step.height_m).any(is_rise))
        };
        let Some(next) = (0..classified.len()).find(|&at| is_next(at)) else { return };
        classified[next].class = PlaneClass::Step;
    }
}
