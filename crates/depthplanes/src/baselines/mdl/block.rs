//! The planes of blocks (section 4 of Yang and Förstner).
//!
//! In: the map in blocks. Out: for each pixel the patch it is on, a plane of its block, and the patches. In each
//! block random sampling finds up to three planes; as many of them are kept as make the shortest description.

use super::code::Code;
use super::merge::Region;
use crate::baselines::affine::Affine;
use crate::statistics::least_squares::Moments;
use crate::util::random::Random;

/// Most planes of a block.
const PLANES: usize = 3;
/// Most draws for a plane, and the probability of having missed it at which fewer are enough.
const DRAWS: usize = 200;
const MISSED: f64 = 0.01;
/// How often a plane is fitted to the pixels near it.
const FITS: usize = 4;

/// A pixel of a block.
#[derive(Clone, Copy)]
struct Spot {
    at: usize,
    place: [f64; 2],
    q: f64,
    weight: f64,
}

impl Spot {
    fn off(&self, [a, b, c]: [f64; 3]) -> f64 {
        self.q - (a * self.place[0] + b * self.place[1] + c)
    }
}

/// For each pixel the number of its patch, 0 for none, and the patches.
pub(super) fn describe(affine: &Affine, code: &Code, side: usize, random: &mut Random) -> (Vec<u32>, Vec<Region>) {
    let (columns, rows) = (affine.width.div_ceil(side), affine.height.div_ceil(side));
    let mut patches = vec![0; affine.q.len()];
    let mut regions: Vec<Region> = Vec::new();
    // The first patch of each block, and the end.
    let mut first = vec![0];
    for block in 0..columns * rows {
        let spots = spots(affine, code, [block % columns * side, block / columns * side], side);
        let planes = shortest(code, &spots, &candidates(code, &spots, random));
        let start = regions.len();
        regions.extend(planes.iter().map(|_| Region::new()));
        for spot in &spots {
            if let Some(plane) = nearest(code, spot, &planes) {
                patches[spot.at] = (start + plane + 1) as u32;
                regions[start + plane].add(&code.sums(spot.at, spot.place), spot.place);
            }
        }
        let before = [(block % columns > 0).then(|| block - 1), block.checked_sub(columns)];
        for other in before.into_iter().flatten().flat_map(|block| first[block]..first[block + 1]) {
            (start..regions.len()).for_each(|patch| regions[patch].neighbours.push(other));
        }
        first.push(regions.len());
    }
    (patches, regions)
}

/// The pixels of a block that count.
fn spots(affine: &Affine, code: &Code, [u0, v0]: [usize; 2], side: usize) -> Vec<Spot> {
    let rows = v0..(v0 + side).min(affine.height);
    let columns = u0..(u0 + side).min(affine.width);
    let pixels = rows.flat_map(|v| columns.clone().map(move |u| v * affine.width + u));
    let spot = |at| Spot { at, place: code.about(affine.place(at)), q: code.q[at], weight: code.weights[at] };
    pixels.map(spot).filter(|spot| spot.weight > 0.0).collect()
}

/// Up to three planes, each near most of the pixels that those before it left.
fn candidates(code: &Code, spots: &[Spot], random: &mut Random) -> Vec<[f64; 3]> {
    let mut left = spots.to_vec();
    let mut planes = Vec::new();
    // Fewer pixels than that cannot pay for a plane.
    while planes.len() < PLANES && left.len() as f64 * code.free() > code.plane() && left.len() > 3 {
        let Some(plane) = sample(code, &left, random) else { break };
        planes.push(plane);
        left.retain(|spot| !code.is_shorter(spot.at, spot.off(plane)));
    }
    planes
}

/// The plane through three pixels that most others are near, fitted to them.
fn sample(code: &Code, spots: &[Spot], random: &mut Random) -> Option<[f64; 3]> {
    let mut best = (0, None);
    let mut missed = 1.0;
    for _ in 0..DRAWS {
        if let Some(plane) = through([(); 3].map(|()| &spots[random.whole(0, spots.len() - 1)])) {
            let count = near(code, spots, plane).count();
            if count > best.0 {
                best = (count, Some(plane));
            }
        }
        missed *= 1.0 - (best.0 as f64 / spots.len() as f64).powi(3);
        if missed < MISSED {
            break;
        }
    }
    (0..FITS).try_fold(best.1?, |plane, _| fit(near(code, spots, plane)))
}

/// The pixels near a plane.
fn near<'a>(code: &Code, spots: &'a [Spot], plane: [f64; 3]) -> impl Iterator<Item = &'a Spot> + use<'a> {
    let near = code.near();
    spots.iter().filter(move |spot| spot.off(plane).powi(2) * spot.weight < near)
}

/// The least-squares plane of some pixels.
fn fit<'a>(mut spots: impl Iterator<Item = &'a Spot>) -> Option<[f64; 3]> {
    let &Spot { place: [u, v], q, .. } = spots.next()?;
    let mut sums = Moments { n: 1.0, ..Moments::default() };
    spots.for_each(|spot| sums.add(spot.place[0] - u, spot.place[1] - v, spot.q - q));
    let [a, b, c] = sums.fit()?.abc;
    Some([a, b, c + q - a * u - b * v])
}

/// The plane through three pixels, none if they lie on a line.
fn through([s, t, r]: [&Spot; 3]) -> Option<[f64; 3]> {
    let [du, dv, dq] = [t.place[0] - s.place[0], t.place[1] - s.place[1], t.q - s.q];
    let [eu, ev, eq] = [r.place[0] - s.place[0], r.place[1] - s.place[1], r.q - s.q];
    let det = du * ev - dv * eu;
    if det == 0.0 {
        return None;
    }
    let (a, b) = ((dq * ev - dv * eq) / det, (du * eq - dq * eu) / det);
    Some([a, b, s.q - a * s.place[0] - b * s.place[1]])
}

/// The first few planes, as many as make the shortest description.
fn shortest(code: &Code, spots: &[Spot], planes: &[[f64; 3]]) -> Vec<[f64; 3]> {
    let bits = |count: usize| {
        let spot = |spot: &Spot| match nearest(code, spot, &planes[..count]) {
            Some(plane) => code.on_plane(spot.at, spot.off(planes[plane])),
            None => code.free(),
        };
        let pixels: f64 = spots.iter().map(spot).sum();
        code.mask(spots.len(), count) + count as f64 * code.plane() + pixels
    };
    let count = (0..=planes.len()).min_by(|&a, &b| bits(a).total_cmp(&bits(b))).unwrap_or(0);
    planes[..count].to_vec()
}

/// The plane that a pixel is nearest to, if it costs less there than without one.
fn nearest(code: &Code, spot: &Spot, planes: &[[f64; 3]]) -> Option<usize> {
    let off = |&plane: &usize| spot.off(planes[plane]).abs();
    let nearest = (0..planes.len()).min_by(|a, b| off(a).total_cmp(&off(b)))?;
    code.is_shorter(spot.at, spot.off(planes[nearest])).then_some(nearest)
}
