//! Stage "curved", second part: regions that bow only because they hold tiles of the planes beside them.
//!
//! In: regions, how much they bow, and the larger planes beside each. Out: the same regions, some with fewer tiles, and
//! flat. Growth goes on over a shallow crease for as long as noise hides that the surface has turned off. A plane through
//! tiles of both surfaces suits each of them too well for one to go over by itself ([`super::settle`]), yet
//! all together they bow.

use super::bows::{Bows, LEAST, most_bow};
use super::curved::CellBox;
use super::explained::{Explainer, MOST};
use super::grid::Grid;
use super::grow::{Region, Regions};
use super::quadratic::{Frame, Sums};
use crate::group::reserve_to;

/// Times that tiles and plane are sought in turn; most settle after three.
const ROUNDS: usize = 8;
/// Share of a region that has to be left.
const LEFT: f64 = 0.5;
/// What is left may bow by this share of what others may: a facet of a curved surface bows less when its edges are
/// taken off, but does not become flat.
const FLAT: f64 = 0.5;

/// Relieves regions; reuses its memory.
#[derive(Debug, Default)]
pub(super) struct Relief {
    /// The tiles of a region.
    tiles: Vec<Tile>,
}

/// A tile of a region.
#[derive(Clone, Copy, Debug)]
struct Tile {
    at: usize,
    /// The region whose plane it suits best.
    suits: u32,
}

impl Relief {
    /// Gives tiles of the regions that bow to larger planes beside them, where what is left is flat; whether there were any.
    pub(super) fn relieve(
        &mut self,
        grid: &mut Grid,
        regions: &mut Regions,
        explainer: &Explainer,
        bows: &Bows,
        boxes: &[CellBox],
        confidence: f64,
    ) -> bool {
        reserve_to(&mut self.tiles, grid.len());
        let is_surface = |id: u32| !explainer.is_explained[id as usize];
        let mut any = false;
        for id in (0..regions.all.len() as u32).filter(|&id| is_surface(id) && bows.is_bowed(id)) {
            let (mut flat, mut count) = ([0; MOST], 0);
            for &other in explainer.larger(id).iter().filter(|&&other| is_surface(other) && !bows.is_bowed(other)) {
                flat[count] = other;
                count += 1;
            }
            if let Some(left) = self.left(grid, &regions.all, id, &flat[..count], &boxes[id as usize], confidence) {
                regions.all[id as usize] = left;
                for tile in self.tiles.iter().filter(|tile| tile.suits != id) {
                    grid.region[tile.at] = tile.suits;
                    let other = &mut regions.all[tile.suits as usize];
                    other.take(&grid.cell(grid.place(tile.at)));
                }
                flat[..count].iter().for_each(|&other| regions.all[other as usize].refit());
                any = true;
            }
        }
        any
    }

    /// What is left of a region when its tiles go to the planes that they suit best, if enough is and that is flat.
    fn left(
        &mut self,
        grid: &Grid,
        all: &[Region],
        id: u32,
        others: &[u32],
        around: &CellBox,
        confidence: f64,
    ) -> Option<Region> {
        self.list(grid, id, around);
        let mut own = all[id as usize];
        let pixels = own.sums.n;
        let enough = LEAST.max(LEFT * pixels);
        for _ in 0..ROUNDS {
            let mut any = false;
            for Tile { at, suits } in &mut self.tiles {
                let cell = grid.cell(grid.place(*at));
                let about = |region: &Region| cell.squares_about(region.abc, region.origin);
                let (mut best, mut least) = (id, about(&own));
                for &other in others {
                    let squares = about(&all[other as usize]);
                    let is_better = squares < least && squares <= cell.most_squares(confidence);
                    (best, least) = if is_better { (other, squares) } else { (best, least) };
                }
                match (*suits == id, best == id) {
                    (true, false) => own.give(&cell),
                    (false, true) => own.take(&cell),
                    _ => (),
                }
                any |= *suits != best;
                *suits = best;
            }
            if !any || own.sums.n < enough {
                break;
            }
            own.refit();
        }
        ((enough..pixels).contains(&own.sums.n) && self.is_flat(grid, id, &own)).then_some(own)
    }

    fn list(&mut self, grid: &Grid, id: u32, around: &CellBox) {
        self.tiles.clear();
        for row in around.first[1]..=around.last[1] {
            let columns = row * grid.columns + around.first[0]..=row * grid.columns + around.last[0];
            let own = columns.filter(|&at| grid.region[at] == id);
            self.tiles.extend(own.map(|at| Tile { at, suits: id }));
        }
    }

    /// Whether the tiles that are left to a region lie flat on its plane.
    fn is_flat(&self, grid: &Grid, id: u32, own: &Region) -> bool {
        let (mut sums, frame) = (Sums::default(), Frame::of(own));
        for tile in self.tiles.iter().filter(|tile| tile.suits == id) {
            let place = grid.place(tile.at);
            let column = place.column as usize;
            sums.add_run(grid, place.row as usize, column..column + 1, own, own, &frame);
        }
        sums.bow() <= (FLAT * most_bow(sums.pixels)).powi(2) * sums.pixels
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Measure;
    use crate::map::DepthView;
    use crate::methods::planar::field::Field;
    use crate::methods::planar::pyramid::Pyramid;
    use crate::noise::{NoiseModel, SensorNoise, Space};
    use crate::random::Random;

    const SIDE: usize = 64;
    const SIGMA: f64 = 0.25;
    /// The tile's column from which on tiles are of the region that is looked at.
    const FROM: usize = 6;

    /// Tiles of a map, half of whose noise is not there, in two regions side by side.
    fn halves(of: impl Fn(f64) -> f64) -> (Pyramid, [Region; 2]) {
        let mut random = Random::new(5);
        let map: Vec<f32> = (0..SIDE * SIDE)
            .map(|at| (100.0 + of((at % SIDE) as f64) + 0.5 * SIGMA * random.gaussian()) as f32)
            .collect();
        let (mut field, mut pyramid) = (Field::default(), Pyramid::default());
        let view = DepthView::new(&map, SIDE, SIDE).unwrap();
        field.prepare(&view);
        pyramid.sum(&view, Space::Value, 1, &mut field);
        let noise = NoiseModel::new(Measure::Disparity, SensorNoise::Value { sigma: SIGMA }, 0.0).unwrap();
        pyramid.expect(&noise, 3.0, 1);
        let grid = &mut pyramid.grids[0];
        let mut halves: [Vec<usize>; 2] = Default::default();
        let measured: Vec<usize> = (0..grid.len()).filter(|&at| grid.pixels(at) > 0.0).collect();
        for at in measured {
            let half = usize::from(at % grid.columns >= FROM);
            grid.region[at] = half as u32;
            halves[half].push(at);
        }
        let regions = halves.map(|tiles| {
            let mut region = Region::of(&grid.cell(grid.place(tiles[0])));
            tiles[1..].iter().for_each(|&at| region.take(&grid.cell(grid.place(at))));
            region.refit();
            region
        });
        (pyramid, regions)
    }

    /// What is left of the right half.
    fn left((pyramid, regions): &(Pyramid, [Region; 2])) -> Option<f64> {
        let around = CellBox { first: [FROM, 0], last: [SIDE / 4 - 1, SIDE / 4 - 1] };
        let left = Relief::default().left(&pyramid.grids[0], regions, 1, &[0], &around, 3.0);
        left.map(|region| region.sums.n)
    }

    #[test]
    fn a_region_that_grew_over_a_crease_gives_back_what_lies_before_it() {
        // The crease is in column 36, three tiles inside the right half; of the first tile behind it much is near to both.
        let bent = halves(|u| 0.12 * (u - 36.0).max(0.0));
        let behind = ((SIDE - 36) * SIDE) as f64;
        let found = left(&bent).expect("two flat halves");
        assert!((0.85 * behind..=1.01 * behind).contains(&found), "{found} of {behind}");
    }

    #[test]
    fn a_curved_region_stays_as_it_is() {
        // A column: a parabola from the edge of the left half on.
        assert_eq!(left(&halves(|u| 0.0025 * (u - 24.0).max(0.0).powi(2))), None);
        // What is flat has nothing to give.
        assert_eq!(left(&halves(|u| 0.2 * (u - 24.0).max(0.0))), None);
    }
}
