//! The ready scenes, by name.
//!
//! A row of [`SCENES`] makes a scene available to every [`super::Spec`]. Each is built from a seed: fixed scenes move
//! their furniture a little, random ones are drawn anew.

use super::clutter;
use super::exact::unit;
use super::pose::Pose;
use super::robot;
use super::room;
use super::staged::Staged;
use super::surfaces::{Place, Scene};
use crate::error::{Error, Result};
use crate::util::random::Random;

/// One row of [`SCENES`].
#[derive(Debug)]
#[non_exhaustive]
pub struct SceneInfo {
    /// The name in a [`super::Spec`].
    pub name: &'static str,
    /// One sentence.
    pub about: &'static str,
    /// Builds it from a seed; the same seed gives the same scene.
    pub build: fn(u64) -> Staged,
}

/// All ready scenes. The first is that of [`super::Spec::demo`].
pub const SCENES: &[SceneInfo] = &[
    SceneInfo {
        name: "room",
        about: "a furnished room: table, chair, shelves, sideboard, doorway, window, ramp, steps, pillar, balls",
        build: room::room,
    },
    SceneInfo {
        name: "stairs",
        about: "eight steps to a landing between walls, with a ramp and a handrail beside",
        build: room::stairs,
    },
    SceneInfo {
        name: "corridor",
        about: "a long corridor with doors, a side passage and a far end out of most sensors' range",
        build: room::corridor,
    },
    SceneInfo { name: "boxes", about: "boxes of all sizes on a floor before two walls", build: clutter::boxes },
    SceneInfo { name: "planes3", about: "three planes that meet in a corner, nothing else", build: planes3 },
    SceneInfo {
        name: "curved",
        about: "balls, columns and bent sheets on a floor: few planes, much that is none",
        build: curved,
    },
    SceneInfo {
        name: "random",
        about: "a room, a camera and clutter drawn from the seed: boxes, balls, columns, ramps",
        build: clutter::random,
    },
    SceneInfo {
        name: "robot",
        about: "a hall from a robot's height: boxes of 5 to 40 cm, and from the seed a ramp, three steps or a hole",
        build: robot::robot,
    },
];

/// The ready scene of that name.
///
/// # Errors
/// [`Error::Unknown`] with the names there are.
pub fn find(name: &str) -> Result<&'static SceneInfo> {
    SCENES.iter().find(|scene| scene.name == name).ok_or_else(|| Error::Unknown {
        what: "scene",
        given: name.to_string(),
        accepted: SCENES.iter().map(|scene| scene.name).collect::<Vec<_>>().join(", "),
    })
}

/// The seed turns the camera and moves the corner a little.
fn planes3(seed: u64) -> Staged {
    let mut random = Random::new(seed);
    let mut scene = Scene::default();
    let corner = Place::at(random.between(-0.2, 0.2), random.between(2.6, 3.2)).turned(45.0);
    let far = 9.0;
    scene.facet_at(corner, &[[0.0, 0.0, 0.0], [0.0, -far, 0.0], [-far, -far, 0.0], [-far, 0.0, 0.0]]);
    scene.facet_at(corner, &[[0.0, 0.0, 0.0], [-far, 0.0, 0.0], [-far, 0.0, far], [0.0, 0.0, far]]);
    scene.facet_at(corner, &[[0.0, 0.0, 0.0], [0.0, -far, 0.0], [0.0, -far, far], [0.0, 0.0, far]]);
    let pose =
        Pose { yaw_deg: random.between(-6.0, 6.0), roll_deg: random.between(-3.0, 3.0), ..Pose::at_height(1.4, 22.0) };
    Staged { scene, pose }
}

fn curved(seed: u64) -> Staged {
    let mut random = Random::new(seed);
    let mut scene = Scene::default();
    let mut near = |x: f64| x + random.between(-0.06, 0.06);
    let far = 6.0;
    scene.facet(&[[-far, -1.0, 0.0], [far, -1.0, 0.0], [far, far, 0.0], [-far, far, 0.0]]);
    scene.facet(&[[-far, 4.2, 0.0], [far, 4.2, 0.0], [far, 4.2, 4.0], [-far, 4.2, 4.0]]);
    scene.ball([near(-0.75), near(2.3), 0.35], 0.35);
    scene.ball([near(0.15), near(2.0), 0.14], 0.14);
    scene.ball([near(0.65), near(3.5), 0.6], 0.6);
    scene.column([near(-1.6), near(3.6), 0.0], 0.22, 3.0);
    scene.column([near(0.8), near(2.2), 0.0], 0.18, 0.5);
    scene.column([near(-0.35), near(3.3), 0.0], 0.4, 0.75);
    // A curtain's wave, a cushion against the wall and one on the floor, a roll lying down.
    let sagitta = 0.14 - (0.14f64 * 0.14 - 0.1 * 0.1).sqrt();
    for fold in 0..5 {
        let (x, out) = (1.2 + 0.2 * f64::from(fold), if fold % 2 == 0 { -1.0 } else { 1.0 });
        scene.sheet([x, 3.9 + sagitta * out, 1.2], [0.0, 0.0, 1.0], [0.0, out, 0.0], [2.4, 0.2], 0.14);
    }
    scene.sheet([near(-0.9), 4.05, 1.35], [1.0, 0.0, 0.0], [0.0, -1.0, 0.15], [0.9, 0.6], 0.7);
    scene.sheet([near(-1.3), near(2.7), 0.2], [0.8, 0.5, 0.0], [0.0, -0.3, 1.0], [0.7, 0.7], 0.9);
    let from = [near(0.25), near(2.75), 0.12];
    let along = unit([1.0, 0.35, 0.0]).unwrap_or([1.0, 0.0, 0.0]);
    scene.roll(from, [from[0] + 0.7 * along[0], from[1] + 0.7 * along[1], 0.12], 0.12);
    Staged { scene, pose: Pose::at_height(1.3, 14.0) }
}
