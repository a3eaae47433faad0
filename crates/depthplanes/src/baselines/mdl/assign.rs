//! The region of every pixel.
//!
//! In: regions and the patches they consist of. Out: an image of numbers, 0 for no region. A region gets a number if
//! its plane saves more bits than it costs; the bits are saved against describing its pixels by larger regions beside
//! it or without a plane.

use super::code::Code;
use super::merge::Region;
use crate::baselines::affine::Affine;
use crate::limits::MAX_PLANES;

/// Regions of half of `min-pixels` pixels or fewer get no number. It is half, since the rest of a plane may be in blocks
/// where other planes are described.
pub(super) fn assign(
    affine: &Affine,
    code: &Code,
    patches: &[u32],
    regions: &[Region],
    region_of_patch: &[usize],
    min_pixels: usize,
) -> Vec<u16> {
    let larger = larger(regions);
    let region = |at: usize| (patches[at] as usize).checked_sub(1).map(|patch| region_of_patch[patch]);
    let off = |at: usize, [a, b, c]: [f64; 3]| {
        let [u, v] = code.about(affine.place(at));
        code.q[at] - (a * u + b * v + c)
    };
    let bits = |at: usize, plane: Option<[f64; 3]>| plane.map_or(f64::MAX, |plane| code.on_plane(at, off(at, plane)));

    let mut saved = vec![0.0; regions.len()];
    for (at, of) in (0..patches.len()).filter_map(|at| Some((at, region(at)?))) {
        let others = larger[of].iter().map(|&other| bits(at, regions[other].plane));
        saved[of] += others.fold(code.free(), f64::min) - bits(at, regions[of].plane).min(code.free());
    }

    let mut numbers = vec![0; regions.len()];
    let mut planes = Vec::new();
    for (at, region) in regions.iter().enumerate() {
        let is_kept = saved[at] > code.plane() && region.pixels > min_pixels / 2 && planes.len() < MAX_PLANES;
        if let Some(plane) = region.plane.filter(|_| is_kept) {
            planes.push(plane);
            numbers[at] = planes.len() as u16;
        }
    }

    let takes = |at: usize, number: u16| code.is_shorter(at, off(at, planes[usize::from(number) - 1]));
    let number = |at: usize| {
        let Some(of) = region(at) else { return 0 };
        let kept = larger[of].iter().map(|&other| numbers[other]).filter(|&number| number > 0 && takes(at, number));
        let distance = |&number: &u16| off(at, planes[usize::from(number) - 1]).abs();
        match numbers[of] {
            0 => kept.min_by(|a, b| distance(a).total_cmp(&distance(b))).unwrap_or(0),
            own => own,
        }
    };
    let mut image: Vec<u16> = (0..patches.len()).map(number).collect();
    // A plane may have too few pixels in a block to be described there.
    affine.spread(&mut image, takes);
    image
}

/// For each region those of more pixels beside it.
fn larger(regions: &[Region]) -> Vec<Vec<usize>> {
    let is_larger = |a: usize, b: usize| (regions[b].pixels, b) > (regions[a].pixels, a);
    let larger = |at: usize| regions[at].neighbours.iter().copied().filter(|&other| is_larger(at, other)).collect();
    (0..regions.len()).map(larger).collect()
}
