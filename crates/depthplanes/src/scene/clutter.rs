//! Scenes drawn from a seed: where boxes, balls, columns and ramps happen to stand.

use super::pose::Pose;
use super::staged::Staged;
use super::surfaces::{Place, Scene};
use crate::util::random::Random;

/// A piece of floor with the circles already taken.
struct Floor {
    x_m: [f64; 2],
    y_m: [f64; 2],
    taken: Vec<([f64; 2], f64)>,
}

impl Floor {
    /// A free circle of that radius; `None` after 30 draws that were not free.
    fn spot(&mut self, radius: f64, random: &mut Random) -> Option<[f64; 2]> {
        for _ in 0..30 {
            let spot @ [x, y] = [random.between(self.x_m[0], self.x_m[1]), random.between(self.y_m[0], self.y_m[1])];
            let free = |&([cx, cy], r): &([f64; 2], f64)| {
                let (dx, dy, least) = (x - cx, y - cy, r + radius);
                dx * dx + dy * dy > least * least
            };
            if self.taken.iter().all(free) {
                self.taken.push((spot, radius));
                return Some(spot);
            }
        }
        None
    }
}

/// A box somewhere free, sometimes with a smaller one on top.
fn add_box(scene: &mut Scene, floor: &mut Floor, random: &mut Random) {
    let (w, l, h) = (random.between(0.08, 0.4), random.between(0.08, 0.4), random.between(0.1, 1.1));
    let Some([x, y]) = floor.spot((w * w + l * l).sqrt(), random) else { return };
    let place = Place::at(x, y).turned(random.between(0.0, 90.0));
    scene.block(place, [-w, -l, 0.0], [w, l, h]);
    if random.uniform() < 0.4 {
        let (w, l) = (w * random.between(0.4, 0.7), l * random.between(0.4, 0.7));
        let top = place.raised(h).turned(random.between(-20.0, 20.0));
        scene.block(top, [-w, -l, 0.0], [w, l, random.between(0.06, 0.4)]);
    }
}

/// Floor, back wall and two side walls, closed by a ceiling; `size` is width, length and height,
/// the camera's end of it at y = -0.5.
fn shell(scene: &mut Scene, [width, length, height]: [f64; 3]) {
    let (w, near, far) = (width / 2.0, -0.5, length);
    for z in [0.0, height] {
        scene.facet(&[[-w, near, z], [w, near, z], [w, far, z], [-w, far, z]]);
    }
    scene.facet(&[[-w, far, 0.0], [w, far, 0.0], [w, far, height], [-w, far, height]]);
    for x in [-w, w] {
        scene.facet(&[[x, near, 0.0], [x, far, 0.0], [x, far, height], [x, near, height]]);
    }
}

pub(super) fn boxes(seed: u64) -> Staged {
    let mut random = Random::new(seed);
    let mut scene = Scene::default();
    let corner = Place::at(-1.6, 4.6).turned(random.between(-8.0, 8.0));
    let far = 8.0;
    scene.facet(&[[-far, -1.0, 0.0], [far, -1.0, 0.0], [far, far, 0.0], [-far, far, 0.0]]);
    scene.facet_at(corner, &[[0.0, 0.0, 0.0], [far, 0.0, 0.0], [far, 0.0, 4.0], [0.0, 0.0, 4.0]]);
    scene.facet_at(corner, &[[0.0, 0.0, 0.0], [0.0, -far, 0.0], [0.0, -far, 4.0], [0.0, 0.0, 4.0]]);
    let mut floor = Floor { x_m: [-1.2, 1.6], y_m: [1.7, 4.2], taken: Vec::new() };
    for _ in 0..12 {
        add_box(&mut scene, &mut floor, &mut random);
    }
    Staged { scene, pose: Pose::at_height(1.6, 20.0) }
}

pub(super) fn random(seed: u64) -> Staged {
    let mut random = Random::new(seed);
    let random = &mut random;
    let mut scene = Scene::default();
    let size @ [width, length, _] = [random.between(2.6, 6.0), random.between(3.2, 7.5), random.between(2.3, 3.2)];
    shell(&mut scene, size);
    let reach = width / 2.0 - 0.3;
    let mut floor = Floor { x_m: [-reach, reach], y_m: [1.4, length - 0.4], taken: Vec::new() };
    for _ in 0..random.whole(4, 10) {
        add_box(&mut scene, &mut floor, random);
    }
    for _ in 0..random.whole(0, 3) {
        let radius = random.between(0.08, 0.4);
        if let Some([x, y]) = floor.spot(radius, random) {
            scene.ball([x, y, radius], radius);
        }
    }
    for _ in 0..random.whole(0, 3) {
        let (radius, height) = (random.between(0.06, 0.3), random.between(0.4, 2.6));
        if let Some([x, y]) = floor.spot(radius, random) {
            scene.column([x, y, 0.0], radius, height);
        }
    }
    for _ in 0..random.whole(0, 2) {
        let ramp = [random.between(0.4, 0.9), random.between(0.6, 1.4), random.between(0.1, 0.5)];
        if let Some([x, y]) = floor.spot(0.7, random) {
            scene.ramp(Place::at(x, y).turned(random.between(-180.0, 180.0)), ramp);
        }
    }
    let pose = Pose {
        position_m: [random.between(-0.5, 0.5), 0.0, random.between(0.9, 1.9)],
        yaw_deg: random.between(-20.0, 20.0),
        pitch_deg: random.between(5.0, 28.0),
        roll_deg: random.between(-6.0, 6.0),
    };
    Staged { scene, pose }
}
