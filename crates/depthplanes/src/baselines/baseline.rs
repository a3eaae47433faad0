//! The shape of the baselines: each says for every pixel which region it belongs to, and the rest is the same for all.
//!
//! In: a [`Baseline`], its parameters and its search. Out: its row of the table of methods, and the method, with the memory
//! of its last stages.

use super::affine::Affine;
use crate::detection::Detection;
use crate::error::Result;
use crate::map::{AnyView, DepthView, with_view};
use crate::methods::extraction::{Extraction, MIN_PIXELS, Wanted};
use crate::methods::method::{Job, Method, MethodInfo};
use crate::methods::parameter::{Param, ParamKind, position};
use crate::noise::{NoiseModel, Space, noise_of_map};
use crate::sensor::Sensor;

/// The parameter of methods that draw at random.
pub(super) const SEED: Param = Param {
    name: "seed",
    alias: None,
    default: 1.0,
    min: 0.0,
    max: u32::MAX as f64,
    kind: ParamKind::Whole,
    unit: "number",
    meaning: "Which random draws to make; the same number gives the same answer.",
    source: None,
};

/// A method of another group, reimplemented from its description.
pub(super) trait Baseline: Send + Sized + 'static {
    /// Name, in flags and tables.
    const NAME: &'static str;
    /// One sentence: what it finds, and whose it is.
    const ABOUT: &'static str;
    /// Its own stages, and then those of [`Extraction::extract`].
    const STAGES: &'static [&'static str];
    /// Its parameters, [`MIN_PIXELS`] among them.
    const PARAMS: &'static [Param];

    /// The method with the values of its parameters.
    fn new(values: &Values<'_>) -> Self;

    /// The region of every pixel. `job.done(stage)` is called as each of its own stages ends.
    fn segment(&self, map: &Input<'_>, job: &mut Job<'_>) -> Segmented;
}

/// The row of the table of methods.
pub(super) const fn row<B: Baseline>() -> MethodInfo {
    MethodInfo {
        name: B::NAME,
        about: B::ABOUT,
        stages: B::STAGES,
        tells_curved: false,
        bytes_per_pixel: [144, 144],
        params: B::PARAMS,
        build: |values| {
            let values = Values { params: B::PARAMS, values };
            Box::new(Runner {
                min_pixels: values.whole(MIN_PIXELS.name) as u32,
                baseline: B::new(&values),
                extraction: Extraction::default(),
            })
        },
    }
}

/// The values of a method's parameters.
pub(super) struct Values<'a> {
    params: &'static [Param],
    values: &'a [f64],
}

impl Values<'_> {
    /// The value of a parameter, which has to be one of the method's.
    pub(super) fn of(&self, name: &str) -> f64 {
        let at = position(self.params, name).expect("a parameter of the method");
        self.values[at]
    }

    /// The value of a parameter that is a whole number.
    pub(super) fn whole(&self, name: &str) -> usize {
        self.of(name) as usize
    }
}

/// A map and what is known of it.
pub(super) struct Input<'a> {
    pub(super) view: AnyView<'a>,
    pub(super) affine: Affine,
    pub(super) sensor: Sensor,
}

impl Input<'_> {
    /// The sensor's noise as stated, or else as the map shows it.
    pub(super) fn noise(&self) -> NoiseModel {
        with_view!(self.view, map => noise_of_map(&map, &self.sensor))
    }
}

/// What a method finds.
pub(super) struct Segmented {
    /// For each pixel the number of its region, 0 for none.
    pub(super) image: Vec<u16>,
    /// The map's noise, if the method has to know it.
    pub(super) noise: Option<NoiseModel>,
}

/// A baseline and the memory of its last stages.
struct Runner<B> {
    /// A plane has strictly more pixels than this.
    min_pixels: u32,
    baseline: B,
    extraction: Extraction,
}

impl<B: Baseline> Method for Runner<B> {
    fn info(&self) -> &'static MethodInfo {
        const { &row::<B>() }
    }

    fn run(&mut self, view: AnyView<'_>, job: &mut Job<'_>, out: &mut Detection) -> Result<()> {
        let (sensor, space) = (job.sensor, Space::of(job.sensor.value_kind));
        let input = Input { view, affine: with_view!(view, map => Affine::of(&map, space)), sensor };
        let Segmented { image, noise } = self.baseline.segment(&input, job);
        let image = DepthView::new(&image, view.width(), view.height())?;
        let wanted = Wanted {
            min_pixels: self.min_pixels,
            min_area: 0.0,
            noise: noise.as_ref(),
            valid_pixels: input.affine.valid_pixels,
        };
        with_view!(view, map => self.extraction.extract(&map, &image, &wanted, job, out))
    }
}
