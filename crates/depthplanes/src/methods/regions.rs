//! The shape that most methods have: they say for each pixel which region it belongs to, and the rest is the same for all.
//!
//! In: a method's parameters as a [`Segment`]. Out: the method, with the memory of its last stages.

use super::affine::Affine;
use super::finish::{Finisher, Wanted};
use super::{Job, Method, MethodInfo, Param, ParamKind};
use crate::camera::Sensor;
use crate::detection::Detection;
use crate::error::Result;
use crate::map::{AnyView, DepthView};
use crate::noise::{NoiseModel, Space};
use crate::with_view;

/// The parameter of methods that draw lots.
pub(super) const SEED: Param = Param {
    name: "seed",
    default: 1.0,
    min: 0.0,
    max: u32::MAX as f64,
    kind: ParamKind::Whole,
    unit: "number",
    meaning: "Which random draws to make; the same number gives the same answer.",
    source: None,
};

/// Finds the regions of a map.
pub(super) trait Segment: Send + 'static {
    /// Its row in [`super::METHODS`].
    const INFO: &'static MethodInfo;

    /// A plane has more pixels than this.
    fn min(&self) -> usize;

    /// The region of every pixel. `job.done(stage)` is called as each stage ends.
    fn segment(&self, map: &Input<'_>, job: &mut Job<'_>) -> Segmented;
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
        with_view!(self.view, map => NoiseModel::of_map(&map, &self.sensor))
    }
}

/// What a method finds.
pub(super) struct Segmented {
    /// For each pixel the number of its region, 0 for none.
    pub(super) image: Vec<u16>,
    /// The map's noise, if the method has to know it.
    pub(super) noise: Option<NoiseModel>,
}

/// A method of that shape.
pub(super) struct Runner<S> {
    segment: S,
    finisher: Finisher,
}

impl<S: Segment> Runner<S> {
    /// The method with these parameters.
    pub(super) fn boxed(segment: S) -> Box<dyn Method> {
        Box::new(Runner { segment, finisher: Finisher::default() })
    }
}

impl<S: Segment> Method for Runner<S> {
    fn info(&self) -> &'static MethodInfo {
        S::INFO
    }

    fn run(&mut self, view: AnyView<'_>, job: &mut Job<'_>, out: &mut Detection) -> Result<()> {
        let (sensor, space) = (job.sensor, Space::of(job.sensor.measure));
        let input = Input { view, affine: with_view!(view, map => Affine::of(&map, space)), sensor };
        let Segmented { image, noise } = self.segment.segment(&input, job);
        let image = DepthView::new(&image, view.width(), view.height())?;
        let (min, valid_pixels) = (self.segment.min() as u32, input.affine.valid_pixels);
        let wanted = Wanted { min, min_area: 0.0, noise: noise.as_ref(), valid_pixels };
        with_view!(view, map => self.finisher.finish(&map, &image, &wanted, job, out))
    }
}
