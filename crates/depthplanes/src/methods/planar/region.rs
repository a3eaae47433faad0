//! A region of cells on one plane, and how far from its plane the noise lets a pixel lie.

use super::grid::{Cell, Grid};
use super::layout::AffineMap;
use super::thresholds::GRAZING;
use crate::error::Result;
use crate::map::DepthView;
use crate::methods::rays::Rays;
use crate::noise::NoiseModel;
use crate::statistics::least_squares::Moments;
use crate::util::memory::reserve_to;
use crate::util::runs::each_run;
use crate::util::switches::is_on;
use crate::util::vec3::{Vec3, dot};

/// Below so many pixels a region's plane is too uncertain to be held against a neighbour: the cell is
/// tested against the plane of both.
const UNCERTAIN_PIXELS: f64 = 144.0;
/// A plane is fitted anew when its region has grown by this factor.
const REFIT_GROWTH: f64 = 1.125;

/// Cells on one plane.
#[derive(Clone, Copy, Debug)]
pub(super) struct Region {
    /// Sums about `origin`.
    pub(super) sums: Moments,
    /// (u, v, q) that sums and plane stand about.
    pub(super) origin: [f64; 3],
    /// The least-squares plane about `origin`.
    pub(super) abc: [f64; 3],
    /// Mean (u, v) of its pixels.
    pub(super) middle: [f64; 2],
    /// Squared residuals about it.
    pub(super) squares: f64,
    /// Sum of the pixels' variances.
    pub(super) variance: f64,
    /// Sum of the variances of the smooth part.
    pub(super) smooth: f64,
    /// Whether it is a facet of a curved surface.
    pub(super) is_curved: bool,
    /// Pixels at which its plane was fitted.
    fitted_at: f64,
}

impl Region {
    pub(super) fn of(cell: &Cell) -> Self {
        let mut region = Region {
            sums: cell.moments(cell.origin()),
            origin: cell.origin(),
            abc: [0.0; 3],
            middle: [0.0; 2],
            squares: 0.0,
            variance: cell.variance * cell.n,
            smooth: cell.smooth * cell.n,
            is_curved: false,
            fitted_at: 0.0,
        };
        region.refit();
        region
    }

    /// The plane's q at a pixel.
    #[inline(always)]
    pub(super) fn at(&self, u: f64, v: f64) -> f64 {
        let [u0, v0, q0] = self.origin;
        self.abc[0] * (u - u0) + self.abc[1] * (v - v0) + self.abc[2] + q0
    }

    /// n of its plane in space, `n . point = 1`.
    pub(super) fn inverse(&self, rays: &Rays) -> Vec3 {
        rays.inverse([self.abc[0], self.abc[1]], |u, v| self.at(u, v))
    }

    /// The plane about a pixel: its slope along u and v, and q there.
    #[inline(always)]
    pub(super) fn about(&self, [u, v]: [usize; 2]) -> [f32; 3] {
        let [a, b, _] = self.abc.map(|number| number as f32);
        [a, b, self.at(u as f64, v as f64) as f32]
    }

    /// The angle at which its plane is seen in its middle, degrees; 0 where it runs towards the camera, 90 where it faces it.
    pub(super) fn grazing_deg(&self, rays: &Rays) -> f64 {
        let [u, v] = self.middle;
        let (normal, point) = (self.inverse(rays), rays.at([u, v], self.at(u, v)));
        // normal . point is 1.
        (1.0 / (dot(normal, normal) * dot(point, point)).sqrt()).min(1.0).asin().to_degrees()
    }

    /// Its squared residuals as a multiple of what the noise leaves. A wall that a camera bows lies off its plane by more
    /// than any small patch of it shows.
    #[inline(always)]
    pub(super) fn excess(&self) -> f64 {
        self.squares / (self.variance + self.smooth)
    }

    /// Fits its plane to its sums.
    pub(super) fn refit(&mut self) {
        if let Some(fit) = self.sums.fit() {
            self.abc = fit.abc;
            self.squares = fit.rms * fit.rms * fit.n;
        }
        let [u, v, _] = self.origin;
        self.middle = [u + self.sums.u / self.sums.n, v + self.sums.v / self.sums.n];
        self.fitted_at = self.sums.n;
    }

    /// Takes a cell's pixels in; the plane stays as it is.
    #[inline(always)]
    pub(super) fn take(&mut self, cell: &Cell) {
        self.sums.merge(&cell.moments(self.origin));
        self.variance += cell.variance * cell.n;
        self.smooth += cell.smooth * cell.n;
    }

    /// Gives a cell's pixels away; the plane stays as it is.
    pub(super) fn give(&mut self, cell: &Cell) {
        self.sums.remove(&cell.moments(self.origin));
        self.variance -= cell.variance * cell.n;
        self.smooth -= cell.smooth * cell.n;
    }

    /// Takes a cell in if its pixels lie on the plane.
    #[inline(always)]
    pub(super) fn takes(&mut self, cell: &Cell, only_flat: bool, inlier_threshold: f64) -> bool {
        let most = if only_flat { cell.most_joining() } else { cell.most_squares(inlier_threshold) };
        if self.sums.n < UNCERTAIN_PIXELS {
            return self.takes_anew(cell, most);
        }
        if cell.squares_about(self.abc, self.origin) > most {
            return false;
        }
        self.take(cell);
        if self.sums.n >= REFIT_GROWTH * self.fitted_at
            && let Some(fit) = self.sums.fit()
        {
            self.aim(fit.abc);
        }
        true
    }

    /// Takes a cell in if its pixels lie on the plane of both.
    #[inline(always)]
    fn takes_anew(&mut self, cell: &Cell, most: f64) -> bool {
        let mut both = self.sums;
        both.merge(&cell.moments(self.origin));
        let Some(fit) = both.fit() else { return false };
        let takes = cell.squares_about(fit.abc, self.origin) <= most;
        if takes {
            self.take(cell);
            self.aim(fit.abc);
        }
        takes
    }

    /// Sets its plane alone: while it grows nobody asks for what else [`Region::refit`] finds.
    #[inline(always)]
    fn aim(&mut self, abc: [f64; 3]) {
        self.abc = abc;
        self.fitted_at = self.sums.n;
    }

    /// Takes another region's pixels in.
    pub(super) fn absorb(&mut self, other: &Region) {
        self.sums.merge(&self.sums_of(other));
        self.variance += other.variance;
        self.smooth += other.smooth;
        self.refit();
    }

    /// Sums of another region about this one's origin.
    #[inline(always)]
    pub(super) fn sums_of(&self, other: &Region) -> Moments {
        let [u, v, q] = self.origin;
        other.sums.moved([other.origin[0] - u, other.origin[1] - v, other.origin[2] - q])
    }

    /// Sum of a cell's squared residuals about its plane.
    #[inline(always)]
    pub(super) fn squares_of(&self, cell: &Cell) -> f64 {
        cell.squares_about(self.abc, self.origin)
    }

    /// Whether it is seen too much edge-on for a plane.
    pub(super) fn is_edge_on(&self, rays: &Rays) -> bool {
        is_on("edge-on") && self.grazing_deg(rays) < GRAZING
    }
}

/// Variance of q that a slope `(a, b)` of q makes of a ray that is known to within `ray` pixels.
#[inline(always)]
pub(super) fn of_slope(ray: f32, a: f32, b: f32) -> f32 {
    ray * ray * (a * a + b * b)
}

/// The regions of a map and the noise to expect.
#[derive(Clone, Copy)]
pub(super) struct Planes<'a> {
    pub(super) regions: &'a [Region],
    pub(super) noise: &'a NoiseModel,
    /// How far from a plane its pixels may lie, standard deviations.
    pub(super) inlier_threshold: f64,
    /// Whether curved regions have labels, and planes have none.
    pub(super) curved: bool,
}

/// The label of what belongs to a curved region while planes are sought.
pub(super) const CURVED_LABEL: u16 = u16::MAX;

impl Planes<'_> {
    #[inline(always)]
    pub(super) fn region(&self, id: u32) -> &Region {
        &self.regions[id as usize]
    }

    /// A region's label in the region image while planes are sought: [`CURVED_LABEL`] for all that are curved; while curved ones
    /// are, 0 for planes.
    #[inline(always)]
    pub(super) fn label(&self, id: u32) -> u16 {
        match (self.region(id).is_curved, self.curved) {
            (true, false) => CURVED_LABEL,
            (false, true) => 0,
            _ => id as u16 + 1,
        }
    }

    /// Variance of a pixel about a region's plane at q: the noise, and what the slope makes of the ray; in a region that
    /// bows by more than that, so much more.
    #[inline(always)]
    pub(super) fn variance(&self, region: &Region, q: f64) -> f64 {
        let [a, b, _] = region.abc.map(|number| number as f32);
        // The two parts of a ray are taken at their worst, off to the same side.
        let expected = self.noise.variance(q)
            + self.noise.smooth_sigma(q).powi(2)
            + f64::from(of_slope((self.noise.ray() + self.noise.smooth_ray()) as f32, a, b));
        if is_on("excess") { region.excess().max(1.0) * expected } else { expected }
    }

    /// Square of the largest distance from a region's plane at q.
    #[inline(always)]
    pub(super) fn inlier_threshold_squared(&self, region: &Region, q: f64) -> f64 {
        self.inlier_threshold * self.inlier_threshold * self.variance(region, q)
    }
}

/// A region image as a map of numbers, [`CURVED_LABEL`] and 0 missing.
pub(super) fn of_image<'a>(image: &'a [u16], affine: &AffineMap) -> Result<DepthView<'a, u16>> {
    let AffineMap { width, height, stride, .. } = *affine;
    DepthView::with_stride(&image[..stride * height], width, height, stride)?.valid_range(1, CURVED_LABEL - 1)
}

/// Columns and rows of cells around a region.
#[derive(Clone, Copy, Debug)]
pub(super) struct CellBox {
    pub(super) first: [usize; 2],
    pub(super) last: [usize; 2],
}

impl CellBox {
    const NOTHING: CellBox = CellBox { first: [usize::MAX; 2], last: [0; 2] };

    pub(super) fn area(&self) -> usize {
        (self.last[0] + 1).saturating_sub(self.first[0]) * (self.last[1] + 1).saturating_sub(self.first[1])
    }

    fn include(&mut self, columns: [usize; 2], row: usize) {
        self.first = [self.first[0].min(columns[0]), self.first[1].min(row)];
        self.last = [self.last[0].max(columns[1]), self.last[1].max(row)];
    }

    /// The box in cells that are `1 << level` times as large, with its own size added on every side.
    pub(super) fn widened(self, level: usize, grid: &Grid) -> CellBox {
        let (first, last) = (self.first.map(|place| place >> level), self.last.map(|place| place >> level));
        let reach = [0, 1].map(|axis| last[axis].saturating_sub(first[axis]) + 2);
        let most = [grid.columns - 1, grid.rows - 1];
        CellBox {
            first: [0, 1].map(|axis| first[axis].saturating_sub(reach[axis])),
            last: [0, 1].map(|axis| (last[axis] + reach[axis]).min(most[axis])),
        }
    }
}

/// Finds the columns and rows of every region.
pub(super) fn find_boxes(grid: &Grid, all: &[Region], boxes: &mut Vec<CellBox>) {
    reserve_to(boxes, grid.len());
    boxes.resize(all.len(), CellBox::NOTHING);
    for (row, ids) in grid.region.chunks_exact(grid.columns).enumerate() {
        each_run(ids, 0, |id, columns| boxes[id as usize].include([columns.start, columns.end - 1], row));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::{Intrinsics, ValueKind};
    use crate::methods::planar::grid::{NONE, Place};
    use crate::methods::planar::testing::{Made, SIGMA, Stages, THRESHOLD, noise, patchy, plane_of, planes};
    use crate::sensor::Sensor;
    use crate::util::random::Random;

    /// Focal length, pixels.
    const FOCAL: f64 = 585.0;

    /// A plane of 128 x 64 pixels, 40 in the middle.
    fn slope(u: f64, v: f64) -> f64 {
        40.0 + 0.05 * (u - 64.0) - 0.03 * (v - 32.0)
    }

    #[test]
    fn a_region_that_takes_cells_in_and_gives_them_away_is_what_it_was() {
        let stages = Stages::tiles(&patchy(3), noise(0.01));
        let grid = stages.grid();
        let cells: Vec<Cell> =
            (0..grid.len()).filter(|&at| grid.pixels(at) > 0.0).map(|at| grid.cell(grid.place(at))).collect();
        let mut region = Region::of(&cells[0]);
        cells[1..9].iter().for_each(|cell| region.take(cell));
        region.refit();
        let before = region;
        cells[20..40].iter().for_each(|cell| region.take(cell));
        region.refit();
        assert!(region.sums.n > before.sums.n && region.abc != before.abc);
        cells[20..40].iter().rev().for_each(|cell| region.give(cell));
        region.refit();
        assert_eq!(region.sums.n, before.sums.n);
        for (now, then) in [
            (region.squares, before.squares),
            (region.variance, before.variance),
            (region.smooth, before.smooth),
            (region.middle[0], before.middle[0]),
            (region.middle[1], before.middle[1]),
            (region.at(0.0, 0.0), before.at(0.0, 0.0)),
            (region.at(100.0, 50.0), before.at(100.0, 50.0)),
        ] {
            assert!((now - then).abs() <= 1e-9 * then.abs().max(1.0), "{now}, before it was {then}");
        }
    }

    #[test]
    fn a_region_that_takes_another_in_has_the_plane_of_the_pixels_of_both() {
        let made = patchy(9);
        let mut stages = Stages::tiles(&made, noise(0.01));
        stages.divide(|column, row| u32::from(row > 9 || column + row > 60));
        let [mut one, other] = [stages.all()[0], stages.all()[1]];
        one.absorb(&other);
        let grid = stages.grid();
        // Tiles that have no plane have no region.
        let pixels = [made.pixels_of(grid, 0), made.pixels_of(grid, 1)].concat();
        let ([a, b, c], squares) = plane_of(&pixels, [0.0; 2]);
        assert_eq!(one.sums.n, pixels.len() as f64);
        for [u, v] in [[0.0, 0.0], [149.0, 0.0], [0.0, 89.0], [149.0, 89.0]] {
            let expected = a * u + b * v + c;
            assert!((one.at(u, v) - expected).abs() < 1e-4, "{}, not {expected}", one.at(u, v));
        }
        assert!((one.squares / squares - 1.0).abs() < 1e-5, "{} squares, not {squares}", one.squares);
        assert!((one.variance / (one.sums.n * SIGMA * SIGMA) - 1.0).abs() < 1e-5);
        assert!((one.smooth / (one.sums.n * 1e-4) - 1.0).abs() < 1e-5);
        let middle = [0, 1].map(|axis| pixels.iter().map(|pixel| pixel[axis]).sum::<f64>() / pixels.len() as f64);
        (0..2).for_each(|axis| assert!((one.middle[axis] - middle[axis]).abs() < 1e-6));
    }

    #[test]
    fn a_region_takes_a_cell_of_its_own_plane_in_and_refuses_one_that_is_off() {
        // The right half is twelve deviations off.
        let step = |u: f64, v: f64| slope(u, v) + if u >= 64.0 { 12.0 * SIGMA } else { 0.0 };
        let made = Made::noisy([128, 64], 5, step);
        let stages = Stages::tiles(&made, noise(0.0));
        let grid = stages.grid();
        // Of few tiles beside the step, which are fitted anew with each cell, and of many, whose plane is known.
        for first in [4, 40] {
            let mut region = Region::of(&grid.cell(Place::new(15, 4)));
            (1..first).for_each(|at| region.take(&grid.cell(Place::new(15 - at % 8, 4 + at / 8))));
            region.refit();
            let before = region.sums;
            assert!(!region.takes(&grid.cell(Place::new(16, 4)), true, THRESHOLD), "beyond the step, {first} tiles");
            assert_eq!(region.sums, before);
            for column in 0..8 {
                let before = region.sums.n;
                assert!(region.takes(&grid.cell(Place::new(column, 12)), true, THRESHOLD), "{column} of its own plane");
                assert_eq!(region.sums.n, before + 16.0);
            }
            let before = region.sums;
            for column in 16..32 {
                let cell = grid.cell(Place::new(column, 8));
                assert!(!region.takes(&cell, true, THRESHOLD), "{column} lies off the plane of {first}");
            }
            assert_eq!(region.sums, before);
        }
    }

    #[test]
    fn what_is_seen_at_a_grazing_angle_is_seen_edge_on() {
        // q changes by a share of what it is from that at infinite range: by 1 / (f tan angle).
        let at = |degrees: f64, q: f64, infinity: f64| {
            let share = 1.0 / (FOCAL * degrees.to_radians().tan());
            let made = Made::exact([16, 16], |u, v| {
                q + share * (q - infinity) * (0.6 * (u as f64 - 7.5) + 0.8 * (v as f64 - 7.5))
            });
            let stages = Stages::tiles(&made, noise(0.0));
            Region::of(&stages.run.pyramid.grids[2].cell(Place::new(0, 0)))
        };
        let rig = ValueKind::InverseDepth { slope: 0.01, offset: -0.3 }; // 30 is infinitely far
        let camera = Intrinsics::new(FOCAL, FOCAL, 7.5, 7.5).unwrap();
        for (value_kind, infinity) in
            [(ValueKind::Disparity, 0.0), (ValueKind::Depth { metres: 1.0 }, 0.0), (rig, 30.0)]
        {
            let rays = Rays::of(&Sensor::default().value_kind(value_kind).intrinsics(camera), 16, 16);
            for degrees in [1.1, 1.3, 30.0] {
                let region = at(degrees, 40.0, infinity);
                assert!((region.grazing_deg(&rays) - degrees).abs() < 1e-3, "{value_kind:?}");
                assert_eq!(region.is_edge_on(&rays), degrees < GRAZING, "{value_kind:?}");
            }
        }
    }

    #[test]
    fn the_box_of_a_region_is_the_smallest_around_its_tiles() {
        let mut random = Random::new(11);
        let made = Made::noisy([250, 60], 5, slope);
        let stages = Stages::tiles(&made, noise(0.0));
        let mut boxes = Vec::new();
        for _ in 0..30 {
            let mut grid = Grid { columns: 64, rows: 16, ..Grid::new(4) };
            let mut id = 0;
            let mut next = |_| {
                if random.uniform() < 0.3 {
                    id = [NONE, 0, 1, 2, 3, 4][random.whole(0, 5)];
                }
                id
            };
            grid.region = (0..64 * 16).map(&mut next).collect();
            let all = vec![Region::of(&stages.grid().cell(Place::new(0, 0))); 5];
            find_boxes(&grid, &all, &mut boxes);
            assert_eq!(boxes.len(), 5);
            for (id, found) in (0..5).zip(&boxes) {
                let own: Vec<[usize; 2]> =
                    (0..64 * 16).filter(|&at| grid.region[at] == id).map(|at| [at % 64, at / 64]).collect();
                let ends = |axis: usize| {
                    let places = own.iter().map(|place| place[axis]);
                    [places.clone().min().unwrap(), places.max().unwrap()]
                };
                let [[left, right], [top, bottom]] = [ends(0), ends(1)];
                assert_eq!((found.first, found.last), ([left, top], [right, bottom]));
                assert_eq!(found.area(), (right + 1 - left) * (bottom + 1 - top));
            }
        }
    }

    #[test]
    fn a_box_widened_by_its_own_size_holds_as_much_on_each_side_and_ends_at_the_map() {
        let grid = Grid { columns: 40, rows: 30, ..Grid::new(8) };
        let wide = CellBox { first: [20, 24], last: [27, 31] }.widened(1, &grid);
        assert_eq!((wide.first, wide.last), ([5, 7], [18, 20]));
        let wide = CellBox { first: [2, 50], last: [31, 57] }.widened(1, &grid);
        assert_eq!((wide.first, wide.last), ([0, 20], [31, 29]));
    }

    #[test]
    fn a_deviation_in_a_region_that_bows_is_its_own_root_mean_square() {
        let bowl = |u: f64, v: f64| slope(u, v) + 5.0 * SIGMA * ((u - 64.0) / 40.0).powi(2);
        for (bends, times) in [(false, 1.0..1.01), (true, 1.5..20.0)] {
            let made = Made::noisy([128, 64], 6, |u, v| if bends { bowl(u, v) } else { slope(u, v) });
            let mut stages = Stages::tiles(&made, noise(0.01));
            stages.divide(|_, _| 0);
            let region = &stages.all()[0];
            let planes = planes(stages.all(), &stages.noise);
            let expected = SIGMA * SIGMA + 1e-4;
            let rms = (plane_of(&made.pixels(0..128, 0..64), [0.0; 2]).1 / (128.0 * 64.0)).sqrt();
            let share = planes.variance(region, 40.0) / expected;
            assert!(times.contains(&share), "{share} times the noise");
            assert!(!bends || (planes.variance(region, 40.0).sqrt() / rms - 1.0).abs() < 1e-3);
            let most = planes.inlier_threshold_squared(region, 40.0);
            assert!((most / (THRESHOLD * THRESHOLD * planes.variance(region, 40.0)) - 1.0).abs() < 1e-12);
        }
    }

    #[test]
    fn labels_are_numbers_from_1_on_and_curved_regions_have_one_of_their_own() {
        let made = Made::noisy([128, 64], 7, slope);
        let mut stages = Stages::tiles(&made, noise(0.0));
        stages.divide(|column, _| u32::from(column > 15));
        stages.run.regions.all[1].is_curved = true;
        let of_planes = planes(stages.all(), &stages.noise);
        assert_eq!([0, 1].map(|id| of_planes.label(id)), [1, CURVED_LABEL]);
        let of_curved = Planes { curved: true, ..of_planes };
        assert_eq!([0, 1].map(|id| of_curved.label(id)), [0, 2]);
        // An image of them has neither those of no region nor the curved ones.
        let AffineMap { stride, rows, .. } = stages.run.affine;
        let image: Vec<u16> = (0..stride * rows).map(|at| [0, 1, CURVED_LABEL, 3][at % 4]).collect();
        let view = of_image(&image, &stages.run.affine).unwrap();
        assert_eq!((view.width(), view.height()), (128, 64));
        assert_eq!(view.valid_pixels(), 64 * 64);
    }
}
