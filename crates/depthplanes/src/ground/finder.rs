//! All of the ground of a frame, one line for each stage.

use super::cells::Cells;
use super::class::{self, ClassifiedPlane};
use super::floor::{self, Floor};
use super::marks;
use super::obstacles::{Obstacle, Obstacles};
use super::sectors::{self, Sector};
use super::standing::Standing;
use super::steps::{self, Step};
use super::up::{self, Up};
use crate::detection::Detection;
use crate::error::{Error, Result};
use crate::limits::MAX_PLANES;
use crate::map::AnyView;
use crate::sensor::Sensor;
use crate::util::memory::reserve_to;

/// What stands where, seen from the floor.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct Ground {
    /// The direction that is up, of length 1, camera coordinates: as stated, or as the planes say; `None` if they do not.
    pub up: Option<[f64; 3]>,
    /// The floor; `None` if there is none in view, or none that can be told from a wall.
    pub floor: Option<Floor>,
    /// Every plane of the detection, in its order; empty without a floor.
    pub planes: Vec<ClassifiedPlane>,
    /// What each pixel is, row by row ([`super::marks`]); empty without a floor.
    pub marks: Vec<u8>,
    /// What stands on the floor and where it falls, the nearest first.
    pub obstacles: Vec<Obstacle>,
    /// How far the floor is free, from left to right across the picture.
    pub sectors: Vec<Sector>,
    /// Steps up from the floor, then steps down.
    pub steps: Vec<Step>,
}

/// Finds the ground in frame after frame, and reuses its memory.
#[derive(Clone, Debug, Default)]
pub struct GroundFinder {
    up: Up,
    height_m: Option<f64>,
    /// Memory for the floor's labels, while there is no floor.
    labels: Vec<u16>,
    cells: Cells,
    obstacles: Obstacles,
    ground: Ground,
}

impl GroundFinder {
    /// With what is known of up.
    #[must_use]
    pub fn up(self, up: Up) -> Self {
        GroundFinder { up, ..self }
    }

    /// As [`GroundFinder::up`], between two frames.
    pub fn set_up(&mut self, up: Up) {
        self.up = up;
    }

    /// With the camera's height above the floor that it stands on, if that is known: of several levels the one nearest to
    /// it is the floor, such as the landing before stairs that lead down. Without it the lowest is.
    ///
    /// # Errors
    /// [`Error::Parameter`] unless it is a finite number of metres above 0.
    pub fn camera_height_m(self, height_m: impl Into<Option<f64>>) -> Result<Self> {
        let height_m = height_m.into();
        match height_m.filter(|&height| !(height > 0.0 && f64::is_finite(height))) {
            Some(given) => {
                let accepted = "a finite number of metres above 0".to_string();
                Err(Error::Parameter { name: "camera-height", given, accepted })
            }
            None => Ok(GroundFinder { height_m, ..self }),
        }
    }

    /// Finds the ground of a map by what was detected in it.
    ///
    /// # Errors
    /// [`Error::NotMetric`] unless the sensor's value kind is metric and its camera known; [`Error::Labels`] if the detection
    /// is not one of a map of that size.
    pub fn find<'m>(&mut self, map: impl Into<AnyView<'m>>, found: &Detection, sensor: &Sensor) -> Result<&Ground> {
        self.find_in_view(map.into(), found, sensor)
    }

    fn find_in_view(&mut self, map: AnyView<'_>, found: &Detection, sensor: &Sensor) -> Result<&Ground> {
        let pixels = map.width() * map.height();
        if [map.width(), map.height()] != [found.width, found.height] || found.labels.len() != pixels {
            return Err(Error::Labels { given: found.labels.len(), pixels });
        }
        sensor.check_metric("floor")?;
        let camera = sensor.intrinsics.expect("metric sensors have a camera");
        let ground = &mut self.ground;
        if let Some(floor) = ground.floor.take() {
            self.labels = floor.labels;
        }
        ground.clear();
        // As many as there can be, so that no later frame needs more.
        reserve_to(&mut ground.planes, MAX_PLANES);
        let vote = up::find(self.up, &found.planes, found.valid_pixels, &camera);
        ground.up = vote.map(|vote| vote.up);
        let labels = &mut self.labels;
        ground.floor = vote.and_then(|vote| floor::find(&found.planes, &vote, self.height_m, &camera, labels));
        if let Some(floor) = &ground.floor {
            let standing = Standing::new(floor);
            class::classify(&found.planes, floor, &mut ground.planes);
            marks::mark(map, found, sensor, floor, &ground.planes, &mut ground.marks);
            self.cells.fill(map, sensor, &ground.marks);
            self.obstacles.find(&self.cells, &standing, &mut ground.obstacles);
            sectors::find(&self.cells, &self.obstacles.distances_m, &standing, &mut ground.sectors);
            steps::find(found, &ground.planes, &standing, sensor, &mut ground.steps);
        } else {
            ground.marks.clear();
        }
        Ok(ground)
    }
}

impl Ground {
    /// Empties all but the marks, which are written anew where there is a floor.
    fn clear(&mut self) {
        self.up = None;
        self.planes.clear();
        self.obstacles.clear();
        self.sectors.clear();
        self.steps.clear();
    }
}
