//! The furnished scenes: a room, a staircase, a corridor.
//!
//! Lengths are metres of ordinary furniture. The seed moves and turns what could be moved.

use super::pose::Pose;
use super::staged::Staged;
use super::surfaces::{Place, Scene};
use crate::util::random::Random;

/// A rectangle in a wall: from and to along the wall, then from and to above the floor.
type Opening = [f64; 4];

/// A place near another, within what somebody might have pushed it.
fn moved(place: Place, random: &mut Random) -> Place {
    let Place { origin_m: [x, y, z], yaw_deg } = place;
    let nudge = [random.between(-0.05, 0.05), random.between(-0.05, 0.05)];
    Place { origin_m: [x + nudge[0], y + nudge[1], z], yaw_deg: yaw_deg + random.between(-5.0, 5.0) }
}

/// A wall along the place's x axis; its openings come in order of x and do not touch. One plane, many parts.
fn wall(scene: &mut Scene, place: Place, [from, to]: [f64; 2], height: f64, openings: &[Opening]) {
    let mut parts = Vec::new();
    let mut part = |[x0, x1, z0, z1]: Opening| {
        if x0 < x1 && z0 < z1 {
            parts.push(vec![[x0, 0.0, z0], [x1, 0.0, z0], [x1, 0.0, z1], [x0, 0.0, z1]]);
        }
    };
    let mut start = from;
    for &[x0, x1, z0, z1] in openings {
        part([start, x0, 0.0, height]);
        part([x0, x1, 0.0, z0]);
        part([x0, x1, z1, height]);
        start = x1;
    }
    part([start, to, 0.0, height]);
    scene.facets_at(place, &parts);
}

/// The four inner sides of an opening, and its back unless one can look through.
fn reveal(scene: &mut Scene, place: Place, [x0, x1, z0, z1]: Opening, depth: f64, open: bool) {
    for x in [x0, x1] {
        scene.facet_at(place, &[[x, 0.0, z0], [x, depth, z0], [x, depth, z1], [x, 0.0, z1]]);
    }
    for z in [z0, z1].into_iter().filter(|&z| z > 0.0) {
        scene.facet_at(place, &[[x0, 0.0, z], [x1, 0.0, z], [x1, depth, z], [x0, depth, z]]);
    }
    if !open {
        scene.facet_at(place, &[[x0, depth, z0], [x1, depth, z0], [x1, depth, z1], [x0, depth, z1]]);
    }
}

/// Four legs at the corners of a rectangle of half sides `w`, `l`.
fn legs(scene: &mut Scene, place: Place, [w, l]: [f64; 2], height: f64) {
    let half = 0.025;
    for (x, y) in [(-w, -l), (w, -l), (w, l), (-w, l)] {
        scene.block(place, [x - half, y - half, 0.0], [x + half, y + half, height]);
    }
}

/// 1.3 x 0.75 m, 0.74 m high, with an open laptop, a box and a ball on it.
fn table(scene: &mut Scene, place: Place) {
    legs(scene, place, [0.58, 0.31], 0.71);
    scene.block(place, [-0.65, -0.375, 0.71], [0.65, 0.375, 0.74]);
    let top = place.raised(0.74);
    let laptop = Place { origin_m: top.point([0.22, -0.02, 0.0]), yaw_deg: place.yaw_deg - 12.0 };
    scene.block(laptop, [-0.18, -0.13, 0.0], [0.18, 0.12, 0.02]);
    scene.facet_at(laptop, &[[-0.18, 0.12, 0.02], [0.18, 0.12, 0.02], [0.18, 0.22, 0.25], [-0.18, 0.22, 0.25]]);
    let parcel = Place { origin_m: top.point([-0.4, 0.1, 0.0]), yaw_deg: place.yaw_deg + 25.0 };
    scene.block(parcel, [-0.14, -0.1, 0.0], [0.14, 0.1, 0.2]);
    scene.ball(top.point([-0.12, -0.14, 0.09]), 0.09);
}

/// Seat at 0.45 m, back to 0.9 m; looks along its -y.
fn chair(scene: &mut Scene, place: Place) {
    legs(scene, place, [0.19, 0.19], 0.42);
    scene.block(place, [-0.22, -0.22, 0.42], [0.22, 0.22, 0.46]);
    let lean = 0.07;
    let (low, high) = ([0.19, 0.46], [0.19 + lean, 0.92]);
    for thick in [0.0, 0.03] {
        let (y0, y1) = (low[0] + thick, high[0] + thick);
        scene.facet_at(place, &[[-0.21, y0, low[1]], [0.21, y0, low[1]], [0.21, y1, high[1]], [-0.21, y1, high[1]]]);
    }
}

/// Shelves between two sides, open to the place's -y; `size` is width, depth, height.
fn bookcase(scene: &mut Scene, place: Place, [width, depth, height]: [f64; 3], shelves: usize) {
    let w = width / 2.0;
    scene.block(place, [-w, 0.0, 0.0], [-w + 0.03, depth, height]);
    scene.block(place, [w - 0.03, 0.0, 0.0], [w, depth, height]);
    scene.facet_at(place, &[[-w, depth, 0.0], [w, depth, 0.0], [w, depth, height], [-w, depth, height]]);
    for shelf in 0..=shelves {
        let z = 0.05 + (height - 0.08) * shelf as f64 / shelves as f64;
        scene.block(place, [-w + 0.03, 0.0, z], [w - 0.03, depth, z + 0.03]);
    }
}

pub(super) fn room(seed: u64) -> Staged {
    let mut random = Random::new(seed);
    let mut near = |place: Place| moved(place, &mut random);
    let mut scene = Scene::default();
    let scene_mut = &mut scene;
    let height = 2.6;
    scene_mut.facet(&[[-2.0, -1.0, 0.0], [3.0, -1.0, 0.0], [3.0, 6.6, 0.0], [-2.0, 6.6, 0.0]]);
    let (back, left) = (Place::at(0.0, 4.6), Place::at(-2.0, 0.0).turned(90.0));
    let (window, door) = ([-1.05, -0.05, 1.15, 1.95], [0.85, 1.7, 0.0, 2.05]);
    wall(scene_mut, back, [-2.0, 3.0], height, &[window, door]);
    reveal(scene_mut, back, window, 0.25, false);
    reveal(scene_mut, back, door, 0.14, true);
    wall(scene_mut, left, [-1.0, 4.6], height, &[]);
    wall(scene_mut, Place::at(0.0, 6.6), [-2.0, 3.0], height, &[]);
    // The door's leaf, open into the room.
    let hinge = near(Place::at(1.7, 4.58)).turned(-68.0);
    scene_mut.block(hinge, [-0.02, -0.04, 0.0], [0.8, 0.0, 2.03]);
    bookcase(scene_mut, Place::at(-1.68, 3.45).turned(90.0), [1.0, 0.3, 1.75], 4);
    let sideboard = Place::at(-0.75, 4.12);
    scene_mut.block(sideboard, [-0.75, 0.0, 0.0], [0.75, 0.46, 0.82]);
    scene_mut.block(near(sideboard.raised(0.82)), [-0.6, 0.1, 0.0], [-0.3, 0.35, 0.22]);
    scene_mut.column(sideboard.point([0.5, 0.22, 0.82]), 0.09, 0.3);
    table(scene_mut, near(Place::at(-0.45, 2.75).turned(14.0)));
    chair(scene_mut, near(Place::at(0.5, 2.6).turned(-62.0)));
    scene_mut.ramp(near(Place::at(1.15, 3.0).turned(8.0)), [0.7, 0.95, 0.28]);
    scene_mut.stairs(near(Place::at(-1.2, 2.45).turned(35.0)), [0.42, 0.5, 0.44], 2);
    scene_mut.column([0.5, 4.1, 0.0], 0.13, height);
    scene_mut.column(near(Place::at(0.15, 2.2)).origin_m, 0.14, 0.32);
    let ball = near(Place::at(0.92, 2.35)).raised(0.16);
    scene_mut.ball(ball.origin_m, 0.16);
    let pose = Pose { yaw_deg: 7.0, ..Pose::at_height(1.55, 15.0) };
    Staged { scene, pose }
}

pub(super) fn stairs(seed: u64) -> Staged {
    let mut random = Random::new(seed);
    let mut scene = Scene::default();
    scene.facet(&[[-1.0, -1.0, 0.0], [3.0, -1.0, 0.0], [3.0, 6.5, 0.0], [-1.0, 6.5, 0.0]]);
    wall(&mut scene, Place::at(-1.0, 0.0).turned(90.0), [-1.0, 6.5], 3.6, &[[4.9, 5.8, 1.36, 3.4]]);
    reveal(&mut scene, Place::at(-1.0, 0.0).turned(90.0), [4.9, 5.8, 1.36, 3.4], 0.12, false);
    wall(&mut scene, Place::at(0.0, 6.0), [-1.0, 2.2], 3.6, &[]);
    wall(&mut scene, Place::at(2.2, 0.0).turned(-90.0), [-6.5, 1.0], 3.6, &[]);
    scene.stairs(Place::at(-0.4, 2.2), [1.2, 2.24, 1.36], 8);
    scene.block(Place::at(-0.4, 4.44), [-0.6, 0.0, 0.0], [1.4, 1.56, 1.36]);
    scene.ramp(moved(Place::at(0.75, 2.3), &mut random), [0.7, 2.1, 0.6]);
    // Handrail: posts and a round bar.
    for step in 0..4 {
        let (y, z) = (2.35 + 0.6 * f64::from(step), 0.17 + 0.364 * f64::from(step));
        scene.block(Place::at(0.25, y), [-0.02, -0.02, 0.0], [0.02, 0.02, z + 0.85]);
    }
    scene.roll([0.25, 2.25, 0.98], [0.25, 4.3, 2.22], 0.03);
    let pose = Pose { yaw_deg: 4.0 + random.between(-3.0, 3.0), ..Pose::at_height(1.85, 13.0) };
    Staged { scene, pose }
}

pub(super) fn corridor(seed: u64) -> Staged {
    let mut random = Random::new(seed);
    let mut scene = Scene::default();
    let (half, height, end) = (1.0, 2.5, 13.0);
    for z in [0.0, height] {
        scene.facet(&[[-4.0, -1.0, z], [4.0, -1.0, z], [4.0, end, z], [-4.0, end, z]]);
    }
    wall(&mut scene, Place::at(0.0, end), [-half, half], height, &[]);
    let left = Place::at(-half, 0.0).turned(90.0);
    let doors = [[2.9, 3.8, 0.0, 2.05], [5.6, 6.5, 0.0, 2.05], [8.6, 9.5, 0.0, 2.05]];
    wall(&mut scene, left, [-1.0, end], height, &doors);
    doors.into_iter().for_each(|door| reveal(&mut scene, left, door, 0.15, false));
    // Seen from the right wall, forward is towards smaller x.
    let right = Place::at(half, 0.0).turned(-90.0);
    wall(&mut scene, right, [-end, 1.0], height, &[[-6.2, -4.6, 0.0, height]]);
    for y in [4.6, 6.2] {
        scene.facet(&[[half, y, 0.0], [4.0, y, 0.0], [4.0, y, height], [half, y, height]]);
    }
    scene.block(Place::at(0.0, 4.2), [-half, 0.0, height - 0.3], [half, 0.3, height]);
    scene.block(Place::at(0.62, 2.6), [0.0, 0.0, 0.0], [0.38, 0.9, 1.0]);
    let bench = moved(Place::at(-0.72, 4.5), &mut random);
    scene.block(bench, [-0.2, -0.5, 0.4], [0.2, 0.5, 0.46]);
    legs(&mut scene, bench, [0.16, 0.44], 0.4);
    scene.column(moved(Place::at(0.7, 4.05), &mut random).origin_m, 0.16, 0.55);
    scene.block(moved(Place::at(0.45, 7.6), &mut random), [-0.3, -0.3, 0.0], [0.3, 0.3, 0.6]);
    let leaf = Place::at(-half, 6.5).turned(-60.0 + random.between(-10.0, 10.0));
    scene.block(leaf, [0.0, -0.02, 0.0], [0.85, 0.02, 2.03]);
    let pose = Pose { yaw_deg: random.between(-3.0, 3.0), ..Pose::at_height(1.45, 5.0) };
    Staged { scene, pose }
}
