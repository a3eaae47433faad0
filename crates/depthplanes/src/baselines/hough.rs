//! hough: the randomised Hough transform in space (Borrmann, Elseberg, Lingemann, Nüchter, *The 3D Hough Transform for plane
//! detection in point clouds*, 2011), from its description.
//!
//! In: any map; lengths are in metres where unit and camera are known. Out: connected pieces of planes that triples
//! of points vote for. Votes are counted in a ball of cells, each about as large as any other but the two at the
//! poles. Planes that fall into one cell are not told apart; no normals are used, so that a plane takes a strip of
//! those it cuts.

use super::affine::Affine;
use super::baseline::{Baseline, Input, SEED, Segmented, Values};
use super::cloud::Cloud;
use super::pieces::{EPSILON, Pieces, Tolerance};
use crate::limits::MAX_PLANES;
use crate::methods::extraction::{MIN_PIXELS, STAGES};
use crate::methods::method::Job;
use crate::methods::parameter::{Param, ParamKind};
use crate::methods::rays::Plane3;
use crate::util::random::Random;
use crate::util::vec3::{Vec3, dot, sub, unit};
use std::f64::consts::{PI, TAU};

/// Cells along the distance; planes further off are not seen.
const SHELLS: usize = 512;
/// Half the side of the window that a triple is drawn from, as a share of the map's longer side (our choice: near points
/// are near in the image).
const NEAR: f64 = 0.1;
/// Shortest distance of two points of a triple, in epsilon: closer ones give the direction of the noise (our choice).
const APART: f64 = 2.0;
/// Longest distance, in epsilon.
const TOGETHER: f64 = 20.0;
/// Draws without a plane before it gives up: what is left then forms no planes (our choice).
const IDLE: usize = 200_000;
/// What a draw takes, in looks at a pixel.
const DRAW: usize = 16;

pub(super) struct Hough {
    min_pixels: usize,
    epsilon: f64,
    /// Radians.
    angle: f64,
    distance: f64,
    votes: usize,
    misses: usize,
    seed: u64,
}

impl Baseline for Hough {
    const NAME: &'static str = "hough";
    const ABOUT: &'static str = "Finds planes by the randomised Hough transform with a ball of cells (Borrmann et al. 2011), from its description.";
    const STAGES: &'static [&'static str] = &["points", "vote", STAGES[0], STAGES[1], STAGES[2], STAGES[3]];
    const PARAMS: &'static [Param] = &[
        MIN_PIXELS,
        EPSILON,
        Param {
            name: "angle",
            alias: None,
            default: 3.0,
            min: 1.0,
            max: 45.0,
            kind: ParamKind::Real,
            unit: "degrees",
            meaning: "Side of a cell on the sphere of directions.",
            source: Some("Borrmann et al. 2011"),
        },
        Param {
            name: "distance",
            alias: None,
            default: 0.0,
            min: 0.0,
            max: f64::MAX,
            kind: ParamKind::Real,
            unit: "m or median depths",
            meaning: "Depth of a cell in the plane's distance from the camera; 0 for twice `epsilon`.",
            source: Some("Borrmann et al. 2011"),
        },
        Param {
            name: "votes",
            alias: None,
            default: 10.0,
            min: 1.0,
            max: 10_000.0,
            kind: ParamKind::Whole,
            unit: "triples",
            meaning: "Votes that make a cell a plane.",
            source: Some("Borrmann et al. 2011"),
        },
        Param {
            name: "misses",
            alias: None,
            default: 100.0,
            min: 1.0,
            max: 10_000.0,
            kind: ParamKind::Whole,
            unit: "planes",
            meaning: "Stops after this many cells in a row whose planes have too few pixels.",
            source: Some("Borrmann et al. 2011"),
        },
        SEED,
    ];

    fn new(values: &Values<'_>) -> Self {
        Hough {
            min_pixels: values.whole(MIN_PIXELS.name),
            epsilon: values.of("epsilon"),
            angle: values.of("angle").to_radians(),
            distance: values.of("distance"),
            votes: values.whole("votes"),
            misses: values.whole("misses"),
            seed: values.whole("seed") as u64,
        }
    }

    fn segment(&self, map: &Input<'_>, job: &mut Job<'_>) -> Segmented {
        let cloud = Cloud::of(&map.affine, &map.sensor, 1);
        job.done("points");
        let image = self.vote(&map.affine, &cloud);
        job.done("vote");
        Segmented { image, noise: None }
    }
}

impl Hough {
    /// The region of every pixel, 0 for none (algorithm 2 of Borrmann et al.).
    fn vote(&self, affine: &Affine, cloud: &Cloud) -> Vec<u16> {
        let tolerance = Tolerance::new(self.epsilon, -1.0, cloud);
        let depth = if self.distance > 0.0 { self.distance } else { 2.0 * tolerance.epsilon };
        let mut ball = Ball::new(self.angle, depth);
        let mut triples = Triples { affine, random: Random::new(self.seed), epsilon: tolerance.epsilon };
        let mut pieces = Pieces::new(affine, cloud, tolerance, 0);
        let mut free = cloud.known.clone();
        let (mut misses, mut idle) = (0, 0);
        while free.len() > self.min_pixels && misses < self.misses && idle < IDLE && pieces.count() < MAX_PLANES {
            if pieces.work.is_spent() {
                break;
            }
            pieces.work.count(DRAW);
            idle += 1;
            let Some((plane, first)) = triples.draw(&free, &pieces) else { continue };
            let Some(cell) = ball.cell(&plane) else { continue };
            // A cell that was tried without success has more votes.
            if ball.vote(cell, plane, first) != self.votes {
                continue;
            }
            pieces.work.count(ball.votes.len());
            let Some((plane, voters)) = ball.winner(cell) else { continue };
            match pieces.take(&plane, &voters, self.min_pixels) {
                Some(_) => {
                    (misses, idle) = (0, 0);
                    pieces.work.count(free.len());
                    free.retain(|&at| pieces.is_free(at as usize));
                    ball.clear();
                }
                None => misses += 1,
            }
        }
        pieces.finish()
    }
}

/// Draws triples of points.
struct Triples<'a> {
    affine: &'a Affine,
    random: Random,
    epsilon: f64,
}

impl Triples<'_> {
    /// The plane through three free points that are neither too near nor too far from each other, and the first's pixel.
    fn draw(&mut self, free: &[u32], pieces: &Pieces<'_>) -> Option<(Plane3, u32)> {
        let first = free[self.random.whole(0, free.len() - 1)];
        let [second, third] = [self.beside(first, pieces)?, self.beside(first, pieces)?];
        let points = [first as usize, second, third].map(|at| pieces.cloud.points[at]);
        let [a, b, c] = points;
        let within = |a: Vec3, b: Vec3| {
            let apart = sub(a, b);
            let lengths = dot(apart, apart).sqrt() / self.epsilon;
            (APART..=TOGETHER).contains(&lengths)
        };
        if !(within(a, b) && within(b, c) && within(c, a)) {
            return None;
        }
        Some((Plane3::through(points)?, first))
    }

    /// A free pixel in the window around a pixel.
    fn beside(&mut self, at: u32, pieces: &Pieces<'_>) -> Option<usize> {
        let &Affine { width, height, .. } = self.affine;
        let reach = (width.max(height) as f64 * NEAR).ceil() as usize;
        let mut within =
            |place: usize, end: usize| self.random.whole(place.saturating_sub(reach), (place + reach).min(end - 1));
        let other = within(at as usize / width, height) * width + within(at as usize % width, width);
        pieces.is_free(other).then_some(other)
    }
}

/// Votes since the last plane, counted in the ball's cells: rings of equal height in angle, each of as many cells as make
/// them about square, in shells of equal depth. The ring at either pole is one cell: the normals of a plane that faces the
/// camera lie all around it.
struct Ball {
    /// Radians.
    angle: f64,
    depth: f64,
    /// The first cell of each ring, and the end.
    rings: Vec<usize>,
    counts: Vec<u32>,
    votes: Vec<Vote>,
}

#[derive(Clone, Copy)]
struct Vote {
    cell: usize,
    plane: Plane3,
    /// A pixel on it.
    at: u32,
}

impl Ball {
    fn new(angle: f64, depth: f64) -> Self {
        let count = (PI / angle).round().max(1.0);
        let angle = PI / count;
        let mut rings = vec![0];
        for ring in 0..count as usize {
            let around = (TAU * ((ring as f64 + 0.5) * angle).sin() / angle).round() as usize;
            let is_pole = ring == 0 || ring + 1 == count as usize;
            rings.push(rings[ring] + if is_pole { 1 } else { around });
        }
        let counts = vec![0; rings[rings.len() - 1] * SHELLS];
        Ball { angle, depth, rings, counts, votes: Vec::new() }
    }

    /// The cell of a plane, its normal turned away from the camera.
    fn cell(&self, plane: &Plane3) -> Option<usize> {
        let Plane3 { normal: [x, y, z], distance } = outward(*plane);
        let shell = distance / self.depth;
        if shell.is_nan() || shell >= SHELLS as f64 {
            return None;
        }
        let ring = ((z.clamp(-1.0, 1.0).acos() / self.angle) as usize).min(self.rings.len() - 2);
        let cells = self.rings[ring + 1] - self.rings[ring];
        let around = (y.atan2(x) / TAU).rem_euclid(1.0) * cells as f64;
        Some((self.rings[ring] + (around as usize).min(cells - 1)) * SHELLS + shell as usize)
    }

    /// Adds a vote; gives the cell's votes.
    fn vote(&mut self, cell: usize, plane: Plane3, at: u32) -> usize {
        self.counts[cell] += 1;
        self.votes.push(Vote { cell, plane: outward(plane), at });
        self.counts[cell] as usize
    }

    /// The mean plane of a cell's votes, and their pixels.
    fn winner(&self, cell: usize) -> Option<(Plane3, Vec<u32>)> {
        let votes: Vec<&Vote> = self.votes.iter().filter(|vote| vote.cell == cell).collect();
        let sum = |axis: usize| votes.iter().map(|vote| vote.plane.normal[axis]).sum();
        let normal = unit([0, 1, 2].map(sum))?;
        let distance = votes.iter().map(|vote| vote.plane.distance).sum::<f64>() / votes.len() as f64;
        Some((Plane3 { normal, distance }, votes.iter().map(|vote| vote.at).collect()))
    }

    /// Forgets all votes.
    fn clear(&mut self) {
        self.votes.drain(..).for_each(|vote| self.counts[vote.cell] = 0);
    }
}

/// The same plane, turned so that its distance is not negative.
fn outward(plane: Plane3) -> Plane3 {
    let sign = if plane.distance < 0.0 { -1.0 } else { 1.0 };
    Plane3 { normal: plane.normal.map(|x| x * sign), distance: plane.distance * sign }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::{Intrinsics, ValueKind};
    use crate::map::DepthView;
    use crate::methods::find;
    use crate::sensor::Sensor;

    fn slanted(x: f64, y: f64, z: f64) -> Plane3 {
        Plane3 { normal: unit([x, y, z]).unwrap(), distance: 1.01 }
    }

    #[test]
    fn either_pole_has_one_cell() {
        let ball = Ball::new(3f64.to_radians(), 0.02);
        for pole in [1.0, -1.0] {
            let cells = [(0.0, 0.0), (0.02, 0.0), (-0.02, 0.0), (0.0, 0.02), (0.0, -0.02)]
                .map(|(x, y)| ball.cell(&slanted(x, y, pole)).unwrap());
            assert_eq!(cells, [cells[0]; 5]);
        }
    }

    #[test]
    fn a_plane_and_the_same_turned_round_share_a_cell() {
        let ball = Ball::new(3f64.to_radians(), 0.02);
        for [x, y, z] in [[0.0, 0.0, 1.0], [0.3, -0.5, 0.2], [-1.0, 0.0, 0.0], [0.01, 0.9, -0.4]] {
            let plane = slanted(x, y, z);
            let turned = Plane3 { normal: plane.normal.map(|x| -x), distance: -plane.distance };
            assert_eq!(ball.cell(&plane), ball.cell(&turned));
        }
    }

    #[test]
    fn cells_are_about_as_large_as_each_other_but_at_the_poles() {
        let angle = 3f64.to_radians();
        let ball = Ball::new(angle, 0.02);
        for ring in 1..ball.rings.len() - 2 {
            let [low, high] = [ring, ring + 1].map(|ring| (ring as f64 * angle).cos());
            let cells = (ball.rings[ring + 1] - ball.rings[ring]) as f64;
            let squares = TAU * (low - high) / cells / (angle * angle);
            assert!((0.9..1.1).contains(&squares), "ring {ring}: {squares}");
        }
    }

    #[test]
    fn a_noisy_wall_that_faces_the_camera_is_found() {
        let mut random = Random::new(3);
        let wall: Vec<f32> = (0..160 * 120).map(|_| (2.0 + 0.004 * random.gaussian()) as f32).collect();
        let sensor = Sensor {
            value_kind: ValueKind::Depth { metres: 1.0 },
            intrinsics: Intrinsics::new(150.0, 150.0, 80.0, 60.0).ok(),
            ..Sensor::default()
        };
        let method = find("hough").unwrap().with(&[]).unwrap();
        let mut detector = crate::Detector::new(method).unwrap().sensor(sensor);
        let found = detector.detect(DepthView::new(&wall, 160, 120).unwrap()).unwrap();
        let sizes: Vec<_> = found.planes.iter().map(|plane| plane.pixel_count).collect();
        assert!(sizes.len() == 1 && sizes[0] > 160 * 118, "{sizes:?}");
    }
}
