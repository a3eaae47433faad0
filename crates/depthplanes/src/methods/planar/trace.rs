//! What the stages of a run saw of one pixel.
//!
//! In: a run at its [`Checkpoint`]s, and what came of it. Out: findings for an explanation. They are read from what
//! the stages leave in their buffers; nothing is kept for it in an ordinary run.

use super::block::{PixelCandidates, candidates_of_pixel};
use super::curved::Evidence;
use super::grid::{Grid, NONE};
use super::grow::fewest;
use super::pipeline::{Checkpoint, Runner};
use super::region::{CURVED_LABEL, Region};
use super::thresholds::GRAZING;
use crate::camera::{HessianNormalForm, ValueKind};
use crate::detection::Detection;
use crate::explanation::{Finding, Limit};
use crate::methods::noise::stated;
use crate::methods::rays::Rays;
use crate::noise::scales::RAY;
use crate::noise::{NoiseModel, SensorNoise, Space};
use crate::sensor::Sensor;

/// Unit of everything that is measured in noise.
const DEVIATIONS: &str = "standard deviations";

/// What happened to the region that a pixel's tile went to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Fate {
    /// The tile went to none.
    None,
    /// Dropped for its size, so many pixels.
    Small(f64),
    /// A facet of a curved surface.
    Curved,
    /// Its pixels lie on larger planes.
    Redundant,
    /// Seen edge-on.
    EdgeOn,
    /// It is a plane.
    Kept,
}

/// A plane that the pixel was held against.
#[derive(Clone, Copy, Debug)]
pub(super) struct Against {
    pub(super) id: u32,
    /// Standard deviations.
    pub(super) off: f64,
    pub(super) is_curved: bool,
    pub(super) pixels: f64,
}

/// What was seen of one pixel.
pub(super) struct Trace {
    pub(super) at: [usize; 2],
    pub(super) sensor: Sensor,
    pub(super) findings: Vec<Finding>,
    /// Not a number where nothing was measured.
    pub(super) q: f64,
    /// Valid pixels of its tile, and the tile's roughness.
    pub(super) tile: [f64; 2],
    pub(super) fate: Fate,
    /// Its bow as a multiple of what is taken for flat, if that is what makes it curved.
    pub(super) bow: Option<f64>,
    pub(super) against: Vec<Against>,
    /// Most that is accepted, standard deviations.
    pub(super) most: f64,
    /// Region image at the pixel.
    pub(super) assigned: u16,
    /// Whether the pixel went to a curved region.
    pub(super) is_on_curved: bool,
    /// Pixels of the connected piece it is in.
    pub(super) piece: usize,
    pub(super) is_large: bool,
    pub(super) noise: Option<NoiseModel>,
}

impl Trace {
    pub(super) fn new(at: [usize; 2], sensor: Sensor) -> Self {
        Trace {
            at,
            sensor,
            findings: Vec::new(),
            q: f64::NAN,
            tile: [0.0; 2],
            fate: Fate::None,
            bow: None,
            against: Vec::new(),
            most: 0.0,
            assigned: 0,
            is_on_curved: false,
            piece: 0,
            is_large: false,
            noise: None,
        }
    }

    pub(super) fn look(&mut self, checkpoint: Checkpoint, run: &Runner, noise: &NoiseModel) {
        self.noise = Some(*noise);
        self.q = run.affine.q[self.at[1] * run.affine.stride + self.at[0]].into();
        match checkpoint {
            Checkpoint::Grown => self.look_at_cells(run),
            Checkpoint::Merged => self.look_at_region(run),
            Checkpoint::Shown => self.look_at_smooth(run, noise),
            Checkpoint::Judged => self.look_at_judgement(run, noise),
            Checkpoint::Assigned => self.look_at_planes(run, noise),
        }
    }

    /// Index of the cell of a grid that the pixel lies in.
    fn cell(&self, grid: &Grid) -> usize {
        self.at[1] / grid.side * grid.columns + self.at[0] / grid.side
    }

    /// The pixel itself and the noise expected there.
    pub(super) fn pixel(&self, value: f64) -> Finding {
        let finding = Finding::new("map", "the pixel", if self.q.is_nan() { "not measured" } else { "" })
            .with("value", value, "")
            .refusing(self.q.is_nan());
        if self.q.is_nan() {
            return finding;
        }
        let finding = match self.sensor.value_kind.depth_m(value) {
            Some(depth) => finding.with("depth", depth, "m"),
            None => finding,
        };
        match self.sensor.value_kind {
            ValueKind::Depth { .. } => finding.with("inverse depth", self.q, "1/m"),
            _ => finding,
        }
    }

    fn look_at_cells(&mut self, run: &Runner) {
        self.describe_noise(run);
        for grid in run.pyramid.grids.iter().rev() {
            let at = self.cell(grid);
            let (n, least) = (f64::from(grid.pixels(at)), f64::from(fewest(grid)));
            let roughness = f64::from(grid.roughness[at]);
            let first = self.at.map(|place| place / grid.side * grid.side);
            let [u, v] = first.map(|first| format!("{first}..{}", first + grid.side - 1));
            let is_flat = roughness <= 1.0;
            let outcome = match (n >= least, is_flat) {
                (true, true) => "flat, may start a region",
                (true, false) => "too rough to start a region",
                (false, _) => "too few pixels to start a region",
            };
            let subject = format!("cell of {0} x {0}, columns {u}, rows {v}", grid.side);
            let finding = Finding::new("tiles", subject, outcome).with("pixels", n, "").limit(Limit::AtLeast(least));
            let finding = if n >= 4.0 && roughness.is_finite() {
                let rms = f64::from(grid.scatter(at)).sqrt();
                let finding = finding.with("rms about its own plane", rms, DEVIATIONS);
                finding.with("roughness", roughness, "").limit(Limit::AtMost(1.0))
            } else {
                finding
            };
            self.tile = [n, roughness];
            self.findings.push(finding);
        }
    }

    fn describe_noise(&mut self, run: &Runner) {
        let Some(noise) = self.noise.filter(|_| self.q.is_finite()) else { return };
        let space = Space::of(self.sensor.value_kind);
        let source = self.source(stated(space, run.params.noise, run.params.noise_growth), self.sensor.noise);
        let sigma = noise.variance(self.q).sqrt();
        let finding = Finding::new("tiles", "noise expected of the pixel", source);
        let finding = match space {
            Space::InverseDepth { .. } => finding.with("of depth", 1e3 * sigma / (self.q * self.q), "mm"),
            Space::Value => finding.with("of the value", sigma, "map units"),
        };
        self.findings.push(finding);
        self.describe_smooth(run, noise);
        let source = match (run.params.lateral_noise > 0.0, noise.ray() > RAY[0]) {
            (true, _) => "from the parameters",
            (false, true) => "estimated from the map",
            (false, false) => "the least that is expected",
        };
        let finding = Finding::new("tiles", "lateral noise", source);
        self.findings.push(finding.with("within", noise.ray(), "pixels"));
    }

    fn describe_smooth(&mut self, run: &Runner, noise: NoiseModel) {
        let space = Space::of(self.sensor.value_kind);
        let stated = stated(space, run.params.smooth_noise, run.params.smooth_noise_growth);
        let source = self.source(stated, self.sensor.smooth_noise);
        let finding = Finding::new("tiles", "the part that its neighbours share", source);
        self.findings.push(self.with_smooth(finding, &noise));
    }

    /// The smooth part as large cells or regions show it, and what the region has become by it.
    fn look_at_smooth(&mut self, run: &Runner, noise: &NoiseModel) {
        if !self.q.is_finite() {
            return;
        }
        let finding = Finding::new(
            "merge",
            "the part that its neighbours share",
            "over long ways, as large cells or regions show it",
        );
        self.findings.push(self.with_smooth(finding, noise));
        let grid = &run.pyramid.grids[0];
        if let Some(region) = run.regions.all.get(grid.region[self.cell(grid)] as usize) {
            let finding = Finding::new("merge", "the region of the tile, merged by that", "");
            self.findings.push(finding.with("pixels", region.sums.n, ""));
        }
    }

    fn with_smooth(&self, finding: Finding, noise: &NoiseModel) -> Finding {
        let sigma = noise.smooth_sigma(self.q);
        match Space::of(self.sensor.value_kind) {
            Space::InverseDepth { .. } => finding.with("of depth", 1e3 * sigma / (self.q * self.q), "mm"),
            Space::Value => finding.with("of the value", sigma, "map units"),
        }
    }

    /// Where a part of the noise is from.
    fn source(&self, stated: Option<SensorNoise>, of_sensor: Option<SensorNoise>) -> &'static str {
        match (stated, of_sensor) {
            (Some(_), _) => "from the parameters",
            (None, Some(noise)) if NoiseModel::new(self.sensor.value_kind, noise, 0.0).is_some() => {
                "the sensor's, from its preset or table"
            }
            _ => "estimated from the map",
        }
    }

    /// The region of the tile as it grew and was merged, and whether it is large enough.
    fn look_at_region(&mut self, run: &Runner) {
        let grid = &run.pyramid.grids[0];
        let id = grid.region[self.cell(grid)];
        if id == NONE {
            self.findings.push(Finding::new("grow", "the tile", "went to no region"));
            return;
        }
        let root = run.merger.root(id);
        let region = &run.regions.all[root as usize];
        let merged = (0..run.regions.all.len() as u32).filter(|&other| run.merger.root(other) == root).count();
        let subject = match merged {
            1 => "the region of the tile".to_string(),
            count => format!("the region of the tile, merged of {count}"),
        };
        let is_small = region.sums.n < run.params.least();
        let least = Limit::AtLeast(run.params.least());
        let finding = Finding::new("merge", subject, if is_small { "dropped, too small" } else { "" })
            .with("pixels", region.sums.n, "")
            .limit(least)
            .with("rms", (region.squares / region.variance).sqrt(), DEVIATIONS)
            .refusing(is_small);
        self.findings.push(self.with_plane(finding, region));
        if is_small {
            self.fate = Fate::Small(region.sums.n);
        }
    }

    /// Adds the plane in metres, where the camera is known.
    fn with_plane(&self, finding: Finding, region: &Region) -> Finding {
        let [a, b, _] = region.abc;
        let c = region.at(0.0, 0.0);
        let abc = match self.sensor.value_kind {
            ValueKind::Depth { .. } => [a, b, c],
            ValueKind::InverseDepth { slope, offset } => [slope * a, slope * b, slope * c + offset],
            ValueKind::Disparity => return finding,
        };
        match self.sensor.intrinsics.and_then(|camera| HessianNormalForm::from_inverse_depth(abc, &camera)) {
            Some(plane) => {
                let [x, y, z] = plane.normal;
                finding
                    .with("distance", plane.distance, "m")
                    .with("normal x", x, "")
                    .with("normal y", y, "")
                    .with("normal z", z, "")
            }
            None => finding,
        }
    }

    /// Whether the region is curved or explained by larger planes.
    fn look_at_judgement(&mut self, run: &Runner, noise: &NoiseModel) {
        let grid = &run.pyramid.grids[0];
        let id = grid.region[self.cell(grid)];
        if id == NONE {
            return;
        }
        let sign = run.curvature.evidence[id as usize];
        let outcome = match sign {
            None => "not curved".to_string(),
            Some(Evidence::Bow) => "curved: it bows".to_string(),
            Some(Evidence::Continuity(other)) => {
                let pixels = run.regions.all[other as usize].sums.n;
                format!("curved: it runs on smoothly into a neighbour of {pixels} pixels, on one quadratic")
            }
            Some(Evidence::Surroundings) => "curved: one quadratic runs through it and what is around it".to_string(),
            Some(Evidence::Turns) => "curved: off its border the surface goes on and turns gently".to_string(),
            Some(Evidence::Folds) => "curved: it turns gently into neighbours of its size".to_string(),
        };
        let finding = Finding::new("judge", "is it flat?", outcome).refusing(sign.is_some());
        let bow = run.curvature.bows.rms(id, &run.regions.all[id as usize]);
        self.bow = bow.filter(|_| sign == Some(Evidence::Bow)).map(|[bow, most]| bow / most);
        let finding = match bow {
            Some([bow, most]) => finding.with("bow", bow, DEVIATIONS).limit(Limit::AtMost(most)),
            None => finding,
        };
        self.findings.push(finding);
        let planes = run.params.planes(&run.regions.all, noise, false);
        let share = run.redundancy.share(&run.affine, grid, &planes, &run.curvature.boxes, id);
        let is_redundant = run.redundancy.is_redundant[id as usize];
        if let Some([share, most]) = share {
            let outcome = if is_redundant { "dropped, no surface of its own" } else { "a surface of its own" };
            let finding = Finding::new("judge", "its pixels on larger planes beside it", outcome);
            let finding = finding.with("share", share, "").limit(Limit::AtMost(most));
            self.findings.push(finding.refusing(is_redundant));
        }
        let region = &run.regions.all[id as usize];
        let rays = Rays::of(&self.sensor, run.affine.width, run.affine.height);
        let is_edge_on = region.is_edge_on(&rays);
        if is_edge_on {
            let finding = Finding::new("judge", "is it seen edge-on?", "dropped, it runs away from the camera");
            let finding =
                finding.with("angle to the ray", region.grazing_deg(&rays), "degrees").limit(Limit::AtLeast(GRAZING));
            self.findings.push(finding.refusing(true));
        }
        self.fate = match (sign, is_redundant) {
            _ if is_edge_on => Fate::EdgeOn,
            (_, true) => Fate::Redundant,
            (Some(_), _) => Fate::Curved,
            _ => Fate::Kept,
        };
    }

    /// Which planes the pixel is held against, and how far off it is.
    fn look_at_planes(&mut self, run: &Runner, noise: &NoiseModel) {
        let [tiles, blocks, ..] = &run.pyramid.grids;
        let PixelCandidates { ids, middle, factor } = candidates_of_pixel([tiles, blocks], self.at);
        let [u, v] = self.at.map(|place| place as f64);
        self.most = factor * run.params.inlier_threshold;
        let label = run.image[self.at[1] * run.affine.stride + self.at[0]];
        (self.assigned, self.is_on_curved) = if label == CURVED_LABEL { (0, true) } else { (label, false) };
        let planes = run.params.planes(&run.regions.all, noise, false);
        let held = ids.into_iter().map(|id| {
            let region = planes.region(id);
            let sigma = planes.variance(region, region.at(middle[0], middle[1])).sqrt();
            let off = (self.q - region.at(u, v)).abs() / sigma;
            Against { id, off, is_curved: region.is_curved, pixels: region.sums.n }
        });
        self.against = held.collect();
        self.against.sort_by(|a, b| a.off.total_cmp(&b.off));
    }

    /// What the last stages made of it.
    pub(super) fn conclude(&mut self, run: &Runner, out: &Detection) {
        if self.q.is_nan() {
            return;
        }
        if self.against.is_empty() {
            self.findings.push(Finding::new("assign", "the pixel", "no region within a block of 8 x 8").refusing(true));
        }
        for against in &self.against {
            let label = run.label_of(out, against.id);
            let name = match against.is_curved {
                true => format!("a curved facet of {} pixels", against.pixels),
                false => named(label, against.pixels),
            };
            let outcome = match against.off <= self.most {
                true if u32::from(self.assigned) == against.id + 1 => "taken",
                true if against.is_curved => "near, but gives no plane",
                true => "near, but another goes before it",
                false => "too far",
            };
            let finding = Finding::new("assign", format!("the pixel against {name}"), outcome);
            self.findings.push(finding.with("off", against.off, DEVIATIONS).limit(Limit::AtMost(self.most)));
        }
        if self.assigned > 0 {
            self.conclude_piece(run);
        }
    }

    /// What became of its connected piece.
    fn conclude_piece(&mut self, run: &Runner) {
        let groups = run.extraction.components.groups();
        self.piece = groups.sizes()[groups.at(self.at) as usize] as usize;
        self.is_large = self.piece > run.params.min_pixels as usize;
        let outcome = if self.is_large { "large enough" } else { "too small" };
        let limit = Limit::MoreThan(run.params.min_pixels.into());
        let finding = Finding::new("group", "its connected piece", outcome).with("pixels", self.piece as f64, "");
        self.findings.push(finding.limit(limit).refusing(!self.is_large));
    }
}

/// A region in words, by the label of its plane, 0 for none.
fn named(label: u16, pixels: f64) -> String {
    if label > 0 { format!("plane {label}") } else { format!("a region of {pixels} pixels") }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::methods::planar::testing::{Made, SENSOR, SIGMA, Stages, noise, patchy};

    #[test]
    fn the_cells_that_a_pixel_lies_in_are_told_with_their_own_pixels_the_largest_first() {
        let made = patchy(4);
        let stages = Stages::grown(&made, noise(0.0));
        for at in [[0, 0], [149, 89], [77, 33], [18, 60], [120, 5]] {
            let mut trace = Trace::new(at, SENSOR);
            trace.look(Checkpoint::Grown, &stages.run, &stages.noise);
            let q = made.q[at[1] * made.width + at[0]];
            assert!(trace.q == f64::from(q) || (trace.q.is_nan() && q.is_nan()));
            let cells: Vec<&Finding> =
                trace.findings.iter().filter(|finding| finding.subject.starts_with("cell")).collect();
            assert_eq!(cells.len(), stages.run.pyramid.grids.len());
            for (finding, grid) in cells.iter().zip(stages.run.pyramid.grids.iter().rev()) {
                let [u, v] = at.map(|place| place / grid.side * grid.side);
                let subject = format!(
                    "cell of {0} x {0}, columns {u}..{1}, rows {v}..{2}",
                    grid.side,
                    u + grid.side - 1,
                    v + grid.side - 1
                );
                let own = f64::from(grid.pixels(trace.cell(grid)));
                let place = [u / grid.side, v / grid.side];
                let expected = crate::methods::planar::testing::pixels_that_count(&made, grid.side, place).len() as f64;
                assert_eq!((&finding.subject, finding.quantities[0].value, own), (&subject, expected, expected));
                let starts = finding.outcome == "flat, may start a region";
                let is_flat = grid.roughness[trace.cell(grid)] <= 1.0;
                assert_eq!(starts, is_flat && finding.quantities[0].limit.unwrap().holds(own), "{finding:?}");
            }
        }
    }

    #[test]
    fn the_planes_that_a_pixel_is_held_against_are_told_by_how_far_off_it_is_the_nearest_first() {
        let made = Made::noisy([128, 64], 5, |u, v| 40.0 + 0.02 * v + if u < 64.0 { 0.0 } else { 20.0 * SIGMA });
        let mut stages = Stages::tiles(&made, noise(0.0));
        stages.divide(|column, _| u32::from(column >= 16));
        let run = &mut stages.run;
        run.image = (0..run.affine.q.len()).map(|at| 1 + u16::from(at % run.affine.stride >= 64)).collect();
        for (u, expected) in [(10, &[0][..]), (62, &[0, 1]), (66, &[1, 0]), (120, &[1])] {
            let mut trace = Trace::new([u, 20], SENSOR);
            trace.look(Checkpoint::Assigned, &stages.run, &stages.noise);
            assert_eq!(trace.against.iter().map(|against| against.id).collect::<Vec<_>>(), expected);
            for against in &trace.against {
                let region = &stages.all()[against.id as usize];
                let q = f64::from(made.q[20 * 128 + u]);
                let off = (q - region.at(u as f64, 20.0)).abs() / (SIGMA * region.excess().max(1.0).sqrt());
                assert!((against.off - off).abs() < 1e-3 && against.pixels == region.sums.n, "{against:?}, not {off}");
            }
            assert_eq!(u32::from(trace.assigned), expected[0] + 1);
            let times = if expected.len() == 1 { 2.0 } else { 1.0 };
            assert_eq!(trace.most, times * stages.run.params.inlier_threshold);
        }
    }

    #[test]
    fn the_fate_of_a_region_is_why_it_gives_no_plane() {
        let made = Made::noisy([128, 64], 5, |u, v| 40.0 + 0.02 * v + if u < 64.0 { 0.0 } else { 20.0 * SIGMA });
        let fate = |evidence: Option<Evidence>, is_redundant: bool| {
            let mut stages = Stages::tiles(&made, noise(0.0));
            stages.divide(|column, row| if row > 12 { NONE } else { u32::from(column >= 16) });
            stages.list_edges();
            stages.judge();
            stages.run.curvature.evidence[1] = evidence;
            stages.run.redundancy.is_redundant[1] = is_redundant;
            let mut trace = Trace::new([100, 20], SENSOR);
            trace.look(Checkpoint::Judged, &stages.run, &stages.noise);
            let refuses = trace.findings.iter().any(|finding| finding.refuses);
            assert_eq!(refuses, evidence.is_some());
            let mut none = Trace::new([100, 60], SENSOR);
            none.look(Checkpoint::Judged, &stages.run, &stages.noise);
            assert_eq!((none.fate, none.findings.len()), (Fate::None, 0));
            trace.fate
        };
        assert_eq!(fate(None, false), Fate::Kept);
        assert_eq!(fate(Some(Evidence::Bow), false), Fate::Curved);
        assert_eq!(fate(Some(Evidence::Continuity(0)), false), Fate::Curved);
        assert_eq!(fate(None, true), Fate::Redundant);
    }

    #[test]
    fn the_label_of_a_region_is_the_one_that_most_of_its_pixels_have() {
        let mut stages = Stages::tiles(&Made::exact([128, 16], |u, _| 40.0 + u as f64), noise(0.0));
        stages.divide(|column, _| column as u32 / 12);
        let Stages { run, .. } = &mut stages;
        let stride = run.affine.stride;
        // Regions 0 and 1 have pixels, region 2 none.
        run.image = (0..run.affine.q.len()).map(|at| 1 + u16::from(at % stride >= 50)).collect();
        run.contacts.join([].into_iter(), &mut run.regions.all, &mut run.image, 1);
        let label = |at: usize| match at % 128 {
            0..20 => 3,
            20..28 => 1,
            28..50 => 0,
            50..100 => 2,
            _ => 1,
        };
        let plane = |label: u16| {
            crate::detection::Plane::new(
                label,
                1,
                crate::detection::PixelBox { u_min: 0, v_min: 0, u_max: 0, v_max: 0 },
            )
        };
        let out = Detection {
            width: 128,
            height: 16,
            labels: (0..128 * 16).map(label).collect(),
            planes: (1..4).map(plane).collect(),
            ..Detection::default()
        };
        assert_eq!([0, 1, 2].map(|id| run.label_of(&out, id)), [3, 2, 0]);
    }
}
