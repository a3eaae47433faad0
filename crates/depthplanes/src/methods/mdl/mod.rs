//! mdl: as many planes as make the shortest description (Yang, Förstner, *Plane detection in point cloud data*,
//! TR-IGG-P-2010-01), from its description.
//!
//! In: any map; no camera is needed, for this works on columns, rows and q, where planes are affine and a pixel costs the
//! bits of its q. Out: connected pieces of planes of blocks of the map, merged where one plane describes both more shortly.
//! The number of planes is found, not given; all rests on the noise: what it does not hold, bows and waves of a sensor, is
//! described by more planes.

mod assign;
mod block;
mod code;
mod merge;

use super::affine::Affine;
use super::finish::{Finisher, MIN, STAGES, Wanted};
use super::pieces::SEED;
use super::{Job, Method, MethodInfo, Param, ParamKind};
use crate::camera::Sensor;
use crate::detection::Detection;
use crate::error::Result;
use crate::map::{AnyView, DepthView, Pixel};
use crate::noise::{Estimator, NoiseModel, SensorNoise, Space, Steps};
use crate::random::Random;
use crate::with_view;
use code::Code;

pub(super) static INFO: MethodInfo = MethodInfo {
    name: "mdl",
    about: "Finds the planes that describe blocks of the map most shortly, and merges them (Yang and Förstner 2010), from its description.",
    stages: &["noise", "blocks", "merge", STAGES[0], STAGES[1], STAGES[2], STAGES[3]],
    tells_curved: false,
    params: PARAMS,
    build: |values| {
        INFO.check(values)?;
        let &[min, noise, growth, side, seed] = values else { panic!("one value for each row of PARAMS") };
        let (min, side, seed) = (min as u32, side as usize, seed as u64);
        Ok(Box::new(Runner { min, noise, growth, side, seed, finisher: Finisher::default() }))
    },
};

const PARAMS: &[Param] = &[
    MIN,
    Param {
        name: "noise",
        default: 0.0,
        min: 0.0,
        max: f64::MAX,
        kind: ParamKind::Real,
        unit: "m or map units",
        meaning: "Standard deviation of depth at range 0 in metres, of disparity in map units; with `noise-growth` 0 as well it is the preset's, or else estimated from the map.",
        source: Some("Yang and Förstner 2010"),
    },
    Param {
        name: "noise-growth",
        default: 0.0,
        min: 0.0,
        max: f64::MAX,
        kind: ParamKind::Real,
        unit: "1/m",
        meaning: "What the standard deviation of depth grows by with the square of the range, 0.0014 for a Kinect v1; not used for disparity.",
        source: None,
    },
    Param {
        name: "block",
        default: 32.0,
        min: 8.0,
        max: 1024.0,
        kind: ParamKind::Whole,
        unit: "pixels",
        meaning: "Side of the blocks, each of which has three planes at most.",
        source: Some("Yang and Förstner 2010"),
    },
    SEED,
];

struct Runner {
    min: u32,
    noise: f64,
    growth: f64,
    side: usize,
    seed: u64,
    finisher: Finisher,
}

impl Method for Runner {
    fn info(&self) -> &'static MethodInfo {
        &INFO
    }

    fn run(&mut self, map: AnyView<'_>, job: &mut Job<'_>, out: &mut Detection) -> Result<()> {
        let noise = self.noise(map, &job.sensor)?;
        with_view!(map, map => self.mdl(map, &noise, job, out))
    }
}

impl Runner {
    fn mdl<T: Pixel>(
        &mut self,
        map: DepthView<'_, T>,
        noise: &NoiseModel,
        job: &mut Job<'_>,
        out: &mut Detection,
    ) -> Result<()> {
        let affine = Affine::of(&map, Space::of(job.sensor.measure));
        let code = Code::new(&affine, noise);
        job.done("noise");
        let (patches, regions) = block::describe(&affine, &code, self.side, &mut Random::new(self.seed));
        job.done("blocks");
        let (regions, region_of_patch) = merge::merge(regions, &code);
        let image = assign::assign(&affine, &code, &patches, &regions, &region_of_patch, self.min);
        job.done("merge");
        let image = DepthView::new(&image, map.width(), map.height())?;
        let wanted = Wanted { min: self.min, min_area: 0.0, noise: Some(noise), valid_pixels: affine.valid_pixels };
        self.finisher.finish(&map, &image, &wanted, job, out)
    }

    /// The noise stated, the sensor's, or that of the map.
    fn noise(&self, map: AnyView<'_>, sensor: &Sensor) -> Result<NoiseModel> {
        let (measure, is_depth) = (sensor.measure, matches!(Space::of(sensor.measure), Space::InverseDepth { .. }));
        let noise = |base, growth| match is_depth {
            true => SensorNoise::Depth { base, growth },
            false => SensorNoise::Value { sigma: base },
        };
        let is_stated = self.noise > 0.0 || (is_depth && self.growth > 0.0);
        let stated = is_stated.then(|| noise(self.noise, self.growth)).or(sensor.noise);
        let step = with_view!(map, map => Steps::default().of(&map));
        if let Some(model) = stated.and_then(|noise| NoiseModel::new(measure, noise, step)) {
            return Ok(model);
        }
        let mut estimator = Estimator::default();
        estimator.add(map, measure)?;
        // Too few blocks tell nothing: then the steps are all there is.
        let noise = estimator.estimate().map_or(noise(0.0, 0.0), |estimate| estimate.noise);
        Ok(NoiseModel::new(measure, noise, step).expect("noise of the map's own kind"))
    }
}
