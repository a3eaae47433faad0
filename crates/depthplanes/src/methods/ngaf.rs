//! NGaF, the paper's method (Hoa, Minh, Dung 2017, "Effective Method For Detecting Multi Planes From
//! Depth Maps"): enhance, group neighbours, keep large groups.
//!
//! In: any map; a camera only for metric planes. Out: surfaces of continuous depth. It is exact and
//! fast, and it sees continuity only: a wall that meets its floor is one group, a slanted plane
//! whose steps exceed theta falls into bands, a ball counts as a plane. Where that matters, use a
//! method that fits planes.

mod explain;

use super::records::Records;
use super::{Job, Method, MethodInfo, Param, ParamKind};
use crate::describe::{Describer, Seen, Tally};
use crate::detection::Detection;
use crate::enhance::{self, Enhancer};
use crate::error::{Error, Result};
use crate::explanation::Explanation;
use crate::group::{Grouper, Groups, LinkRule};
use crate::map::{AnyView, DepthView, Pixel};
use crate::noise::NoiseModel;
use crate::select::Selection;
use crate::with_view;

pub(super) static INFO: MethodInfo = MethodInfo {
    name: "ngaf",
    about: "Groups neighbours whose values differ by at most theta; a group of more than `min` pixels is a plane (Hoa, Minh, Dung 2017).",
    stages: &["enhance", "group", "select", "fit", "label"],
    tells_curved: false,
    params: PARAMS,
    build: |values| {
        INFO.check(values)?; // before any of them becomes a whole number
        Ngaf::from_values(values).try_into()
    },
};

const PARAMS: &[Param] = &[
    Param {
        name: "theta",
        default: 1.0,
        min: 0.0,
        max: f64::MAX,
        kind: ParamKind::Real,
        unit: "map units",
        meaning: "Largest difference between neighbours of one group; the paper takes 1 for near-perfect maps, 2 for sensors.",
        source: Some("paper, 3c"),
    },
    Param {
        name: "min",
        default: 32.0,
        min: 0.0,
        max: u32::MAX as f64,
        kind: ParamKind::Whole,
        unit: "pixels",
        meaning: "A group is a plane if it has more pixels than this; the paper takes 32, 64, 128, 256.",
        source: Some("paper, 3d"),
    },
    Param {
        name: "window",
        default: 0.0,
        min: *enhance::WINDOW.start() as f64,
        max: *enhance::WINDOW.end() as f64,
        kind: ParamKind::OddOrOff,
        unit: "pixels",
        meaning: "Side of the window whose mean fills a missing pixel, unless more than half of it is missing.",
        source: Some("paper, 3b"),
    },
    Param {
        name: "passes",
        default: 1.0,
        min: 1.0,
        max: 100.0,
        kind: ParamKind::Whole,
        unit: "times",
        meaning: "How often the map is enhanced, each pass reading what the one before left; without `window` it does nothing.",
        source: None,
    },
    Param {
        name: "max-rms",
        default: 0.0,
        min: 0.0,
        max: f64::MAX,
        kind: ParamKind::Real,
        unit: "map units",
        meaning: "Drops planes whose least-squares fit leaves a larger root mean square residual, or that have no fit; 0 for off.",
        source: None,
    },
    Param {
        name: "min-fill",
        default: 0.0,
        min: 0.0,
        max: 1.0,
        kind: ParamKind::Real,
        unit: "share",
        meaning: "Drops planes that cover a smaller share of their bounding box; 0 for off.",
        source: None,
    },
    Param {
        name: "margin",
        default: 0.0,
        min: 0.0,
        max: crate::map::MAX_SIDE as f64,
        kind: ParamKind::Whole,
        unit: "pixels",
        meaning: "Pixels closer than this to the map's edge do not count towards `min`.",
        source: None,
    },
];

/// Parameters of the method `ngaf`; the defaults are the paper's.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ngaf {
    /// Largest difference between neighbours of one group, map units, 0 and up (section 3c).
    pub theta: f64,
    /// A group is a plane if it has strictly more pixels than this (section 3d).
    pub min: u32,
    /// Side of the enhancing window, odd 3..=31, or 0 for no enhancing (section 3b).
    pub window: u32,
    /// How often to enhance, 1..=100. Ours.
    pub passes: u32,
    /// Largest rms residual of a plane's fit, map units; 0 for off. Ours.
    pub max_rms: f64,
    /// Least share of the bounding box that a plane covers, 0..=1; 0 for off. Ours.
    pub min_fill: f64,
    /// Pixels closer than this to the map's edge do not count towards `min`; 0 for off. Ours.
    pub margin: u32,
}

impl Ngaf {
    fn from_values(values: &[f64]) -> Self {
        let &[theta, min, window, passes, max_rms, min_fill, margin] = values else {
            panic!("one value for each row of PARAMS");
        };
        let (min, window, passes, margin) = (min as u32, window as u32, passes as u32, margin as u32);
        Ngaf { theta, min, window, passes, max_rms, min_fill, margin }
    }

    fn values(&self) -> [f64; 7] {
        let &Ngaf { theta, min, window, passes, max_rms, min_fill, margin } = self;
        [theta, min.into(), window.into(), passes.into(), max_rms, min_fill, margin.into()]
    }

    /// Whether a plane may be dropped after it was fitted.
    fn has_conditions(&self) -> bool {
        self.max_rms > 0.0 || self.min_fill > 0.0 || self.margin > 0
    }

    /// Our own conditions on a plane of a map of that size.
    fn accepts(&self, plane: &Tally) -> bool {
        let flat = self.max_rms == 0.0 || plane.fit.is_some_and(|fit| fit.rms <= self.max_rms);
        let filled = plane.pixel_count as f64 >= self.min_fill * plane.bounding_box.area() as f64;
        flat && filled && plane.inner_pixels > self.min as usize
    }
}

impl Default for Ngaf {
    fn default() -> Self {
        Self::from_values(&INFO.defaults())
    }
}

impl TryFrom<Ngaf> for Box<dyn Method> {
    type Error = Error;

    fn try_from(params: Ngaf) -> Result<Self> {
        INFO.check(&params.values())?;
        let mut runner = Runner { params, ..Runner::default() };
        runner.grouper.leave_out_singles(params.min >= 1);
        Ok(Box::new(runner))
    }
}

/// The method with its memory.
#[derive(Default)]
struct Runner {
    params: Ngaf,
    enhancer: Enhancer,
    grouper: Grouper,
    selection: Selection,
    describer: Describer,
}

impl Method for Runner {
    fn info(&self) -> &'static MethodInfo {
        &INFO
    }

    fn run(&mut self, map: AnyView<'_>, job: &mut Job<'_>, out: &mut Detection) -> Result<()> {
        with_view!(map, map => self.ngaf(map, job, out, &mut ()))
    }

    fn explain(&mut self, map: AnyView<'_>, job: &mut Job<'_>, at: [usize; 2]) -> Result<Explanation> {
        explain::explain(self, map, job, at)
    }
}

/// Told of a run as it goes on.
trait Watch {
    /// Large groups are selected from the map as it was grouped.
    fn selected<T: Pixel>(&mut self, map: &DepthView<'_, T>, groups: &Groups, selection: &Selection);

    /// They are described; our own conditions have dropped none yet.
    fn described(&mut self, tallies: &[Tally]);
}

/// Nobody looks.
impl Watch for () {
    fn selected<T: Pixel>(&mut self, _: &DepthView<'_, T>, _: &Groups, _: &Selection) {}

    fn described(&mut self, _: &[Tally]) {}
}

impl Runner {
    /// Section 3, stage by stage.
    fn ngaf<T: Pixel>(
        &mut self,
        map: DepthView<'_, T>,
        job: &mut Job<'_>,
        out: &mut Detection,
        watch: &mut impl Watch,
    ) -> Result<()> {
        let Runner { params, enhancer, grouper, selection, describer } = self;
        let (map, filled_pixels) = match params.window {
            0 => (map, 0),
            window => enhancer.enhance(&map, window, params.passes)?, // section 3b
        };
        job.done("enhance");
        let rule = LinkRule::new(map.validity(), params.theta)?;
        let groups = grouper.group(&map, &rule, job.threads); // section 3c
        job.done("group");
        selection.select(groups, params.min)?; // section 3d
        job.done("select");
        watch.selected(&map, groups, selection);
        let mut runs = selection.runs(groups);
        describer.tally(&map, runs, params.margin, &job.sensor, job.threads);
        watch.described(describer.tallies());
        if params.has_conditions() {
            selection.retain(groups, |index| params.accepts(&describer.tallies()[index]));
            describer.retain(|tally| params.accepts(tally));
            runs = selection.runs(groups);
        }
        let valid = groups.valid_pixels();
        let noise = job
            .sensor
            .noise
            .and_then(|noise| NoiseModel::new(job.sensor.measure, noise, if T::IS_INTEGER { 1.0 } else { 0.0 }));
        let seen = Seen { sensor: &job.sensor, noise: noise.as_ref(), valid_pixels: valid };
        describer.describe(&map, runs, &seen, job.threads, &mut out.planes);
        let mut records =
            Records { map: &map, groups, margin: params.margin, seen, threads: job.threads, selection, describer };
        records.join(job.joiner.as_deref_mut(), out);
        job.done("fit");
        selection.paint(groups, &mut out.labels);
        (out.width, out.height) = (map.width(), map.height());
        (out.valid_pixels, out.filled_pixels) = (valid - filled_pixels, filled_pixels);
        job.done("label");
        Ok(())
    }
}
