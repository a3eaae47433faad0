//! What a robot meets: a floor with boxes, a ramp, a step or a hole on its way.
//!
//! Lengths are metres. The seed draws the robot's camera and what stands where.

use super::pose::Pose;
use super::staged::Staged;
use super::surfaces::{Place, Scene};
use crate::util::random::Random;

/// What lies across the way, beside boxes.
enum Way {
    Level,
    Ramp,
    Steps,
    Hole,
}

pub(super) fn robot(seed: u64) -> Staged {
    let mut random = Random::new(seed);
    let random = &mut random;
    let mut scene = Scene::default();
    let (half, far) = (random.between(1.6, 3.5), random.between(3.6, 7.0));
    let way = match random.whole(0, 4) {
        0 => Way::Ramp,
        1 => Way::Steps,
        2 => Way::Hole,
        _ => Way::Level,
    };
    let (x, y) = (random.between(-0.6, 0.6), random.between(2.2, 3.0));
    match way {
        Way::Hole => floor_around(&mut scene, [half, far], [x - 0.35, x + 0.35, y - 0.9, y - 0.2], 0.5),
        _ => floor_around(&mut scene, [half, far], [0.0; 4], 0.0),
    }
    for side in [-half, half] {
        scene.facet(&[[side, -1.0, 0.0], [side, far, 0.0], [side, far, 2.5], [side, -1.0, 2.5]]);
    }
    scene.facet(&[[-half, far, 0.0], [half, far, 0.0], [half, far, 2.5], [-half, far, 2.5]]);
    let turned = Place::at(x, y).turned(random.between(-25.0, 25.0));
    match way {
        Way::Ramp => scene.ramp(turned, [random.between(0.6, 1.0), 1.2, random.between(0.12, 0.3)]),
        Way::Steps => scene.stairs(turned, [1.0, 0.9, 0.51], 3),
        Way::Level | Way::Hole => (),
    }
    // Boxes beside the way and before it, a book's height to a crate's.
    for row in 0..random.whole(2, 5) {
        let side = if random.uniform() < 0.5 { -1.0 } else { 1.0 };
        let place = Place::at(x + side * random.between(0.7, 1.2), 1.2 + 0.6 * row as f64);
        let [w, l, h] = [random.between(0.05, 0.2), random.between(0.05, 0.2), random.between(0.05, 0.4)];
        scene.block(place.turned(random.between(0.0, 90.0)), [-w, -l, 0.0], [w, l, h]);
    }
    let pose = Pose {
        roll_deg: random.between(-4.0, 4.0),
        yaw_deg: random.between(-12.0, 12.0),
        ..Pose::at_height(random.between(0.3, 1.1), random.between(12.0, 32.0))
    };
    Staged { scene, pose }
}

/// A floor to the walls at x = -half, x = half and y = far, around a hole [x0, x1, y0, y1] of that depth.
fn floor_around(scene: &mut Scene, [half, far]: [f64; 2], [x0, x1, y0, y1]: [f64; 4], depth: f64) {
    let near = -1.0;
    let part = |[x0, x1, y0, y1]: [f64; 4]| vec![[x0, y0, 0.0], [x1, y0, 0.0], [x1, y1, 0.0], [x0, y1, 0.0]];
    if depth == 0.0 {
        scene.facets_at(Place::at(0.0, 0.0), &[part([-half, half, near, far])]);
        return;
    }
    let around = [[-half, x0, near, far], [x1, half, near, far], [x0, x1, near, y0], [x0, x1, y1, far]];
    scene.facets_at(Place::at(0.0, 0.0), &around.map(part));
    // Its ground and its four sides, without a lid.
    let ground = [[x0, y0, -depth], [x1, y0, -depth], [x1, y1, -depth], [x0, y1, -depth]];
    scene.facet(&ground);
    for side in 0..4 {
        let (a, b) = (ground[side], ground[(side + 1) % 4]);
        scene.facet(&[a, b, [b[0], b[1], 0.0], [a[0], a[1], 0.0]]);
    }
}
