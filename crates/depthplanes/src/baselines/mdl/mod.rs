//! mdl: as many planes as make the shortest description (Yang, Förstner, *Plane detection in point cloud data*,
//! TR-IGG-P-2010-01), from its description.
//!
//! In: any map; no camera is needed, for this works on columns, rows and q, where planes are affine and a pixel costs
//! the bits of its q. Out: connected pieces of planes of blocks of the map, merged where one plane describes both in
//! fewer bits. The number of planes is found, not given. All rests on the noise: error that it does not include, such
//! as bows and waves of a sensor, is described by more planes.

mod assign;
mod block;
mod code;
mod merge;

use super::baseline::{Baseline, Input, SEED, Segmented, Values};
use crate::map::with_view;
use crate::methods::extraction::{MIN_PIXELS, STAGES};
use crate::methods::method::Job;
use crate::methods::noise::{NOISE, NOISE_GROWTH, of_kind, stated};
use crate::methods::parameter::{Param, ParamKind};
use crate::noise::{Estimator, NoiseModel, Space, Steps};
use crate::util::random::Random;
use code::Code;

pub(super) struct Mdl {
    min_pixels: usize,
    noise: f64,
    growth: f64,
    side: usize,
    seed: u64,
}

impl Baseline for Mdl {
    const NAME: &'static str = "mdl";
    const ABOUT: &'static str = "Finds the planes that describe the map's blocks in the fewest bits, and merges them (Yang and Förstner 2010), from its description.";
    const STAGES: &'static [&'static str] = &["noise", "blocks", "merge", STAGES[0], STAGES[1], STAGES[2], STAGES[3]];
    const PARAMS: &'static [Param] = &[
        MIN_PIXELS,
        Param { source: Some("Yang and Förstner 2010"), ..NOISE },
        NOISE_GROWTH,
        Param {
            name: "block",
            alias: None,
            default: 32.0,
            min: 8.0,
            max: 1024.0,
            kind: ParamKind::Whole,
            unit: "pixels",
            meaning: "Side of the blocks; a block has at most three planes.",
            source: Some("Yang and Förstner 2010"),
        },
        SEED,
    ];

    fn new(values: &Values<'_>) -> Self {
        Mdl {
            min_pixels: values.whole(MIN_PIXELS.name),
            noise: values.of("noise"),
            growth: values.of("noise-growth"),
            side: values.whole("block"),
            seed: values.whole("seed") as u64,
        }
    }

    fn segment(&self, map: &Input<'_>, job: &mut Job<'_>) -> Segmented {
        let (affine, noise) = (&map.affine, self.noise(map));
        let code = Code::new(affine, &noise);
        job.done("noise");
        let (patches, regions) = block::describe(affine, &code, self.side, &mut Random::new(self.seed));
        job.done("blocks");
        let (regions, region_of_patch) = merge::merge(regions, &code);
        let image = assign::assign(affine, &code, &patches, &regions, &region_of_patch, self.min_pixels);
        job.done("merge");
        Segmented { image, noise: Some(noise) }
    }
}

impl Mdl {
    /// The noise stated, the sensor's, or that of the map.
    fn noise(&self, map: &Input<'_>) -> NoiseModel {
        let value_kind = map.sensor.value_kind;
        let step = with_view!(map.view, map => Steps::default().of(&map));
        let model = |noise| NoiseModel::new(value_kind, noise, step);
        let estimated = || {
            let mut estimator = Estimator::default();
            estimator.add(map.view, value_kind).ok()?;
            model(estimator.estimate().ok()?.noise)
        };
        let stated = stated(Space::of(value_kind), self.noise, self.growth);
        let noise = stated.or(map.sensor.noise).and_then(model).or_else(estimated);
        // Too few blocks tell nothing: then the steps are all there is.
        noise.or_else(|| model(of_kind(Space::of(value_kind), 0.0, 0.0))).expect("noise of the map's own kind")
    }
}
