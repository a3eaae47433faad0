//! The last stages of a method that says for each pixel which region it belongs to.
//!
//! In: a region image. Out: the detection: connected pieces of a region with more than `min` pixels, by decreasing size,
//! fitted, described and painted.

use super::method::Job;
use super::parameter::{Param, ParamKind};
use super::records::Records;
use crate::components::selection::Selection;
use crate::components::{ConnectedComponents, Connectivity};
use crate::detection::Detection;
use crate::error::Result;
use crate::map::{DepthView, Pixel};
use crate::noise::NoiseModel;
use crate::statistics::{PlaneStatistics, Seen};

/// Extracts planes from region images; reuses its memory.
#[derive(Default)]
pub(crate) struct Extraction {
    pub(crate) grouper: ConnectedComponents,
    pub(crate) selection: Selection,
    pub(crate) describer: PlaneStatistics,
}

/// What a method knows of its regions beside their pixels.
#[derive(Clone, Copy)]
pub(crate) struct Wanted<'a> {
    /// A plane has strictly more pixels than this.
    pub(crate) min: u32,
    /// A plane has at least this area, m2; 0 for off.
    pub(crate) min_area: f64,
    /// What is known of the map's noise.
    pub(crate) noise: Option<&'a NoiseModel>,
    /// Valid pixels of the map.
    pub(crate) valid_pixels: usize,
}

/// The stages of [`Extraction::extract`], in order.
pub(crate) const STAGES: [&str; 4] = ["group", "select", "fit", "label"];

/// The parameter that all methods have.
pub(crate) const MIN: Param = Param {
    name: "min",
    default: 100.0,
    min: 0.0,
    max: u32::MAX as f64,
    kind: ParamKind::Whole,
    unit: "pixels",
    meaning: "A plane has more pixels than this.",
    source: None,
};

impl Extraction {
    /// Makes a detection of a region image (0 = no region). The observer is told of [`STAGES`].
    ///
    /// # Errors
    /// [`crate::Error::TooManyPlanes`].
    pub(crate) fn extract<T: Pixel>(
        &mut self,
        map: &DepthView<'_, T>,
        image: &DepthView<'_, u16>,
        wanted: &Wanted<'_>,
        job: &mut Job<'_>,
        out: &mut Detection,
    ) -> Result<()> {
        self.extract_united(map, image, wanted, |_| (), job, out)
    }

    /// As [`Extraction::extract`]; `unite` may put groups together before they are counted.
    ///
    /// # Errors
    /// [`crate::Error::TooManyPlanes`].
    pub(crate) fn extract_united<T: Pixel>(
        &mut self,
        map: &DepthView<'_, T>,
        image: &DepthView<'_, u16>,
        wanted: &Wanted<'_>,
        unite: impl FnOnce(&mut ConnectedComponents),
        job: &mut Job<'_>,
        out: &mut Detection,
    ) -> Result<()> {
        let Extraction { grouper, selection, describer } = self;
        let &Wanted { min, min_area, noise, valid_pixels } = wanted;
        grouper.group(image, &Connectivity::new(image.validity(), 0.0)?, job.threads);
        unite(grouper);
        let groups = grouper.groups();
        job.done("group");
        selection.select(groups, min)?;
        job.done("select");
        let runs = selection.runs(groups);
        describer.tally(map, runs, 0, &job.sensor, job.threads);
        // The noise as the residuals of all planes show it, before some of them are joined.
        let noise = noise.map(|noise| describer.as_residuals_show(noise, &job.sensor));
        let seen = Seen { sensor: &job.sensor, noise: noise.as_ref(), valid_pixels };
        describer.describe(map, runs, &seen, job.threads, &mut out.planes);
        let mut records = Records { map, groups, margin: 0, seen, threads: job.threads, selection, describer };
        records.join(job.joiner.as_deref_mut(), out);
        if min_area > 0.0 {
            records.drop_smaller(min_area, out);
        }
        job.done("fit");
        selection.paint(groups, &mut out.labels);
        (out.width, out.height) = (map.width(), map.height());
        (out.valid_pixels, out.filled_pixels) = (valid_pixels, 0);
        job.done("label");
        Ok(())
    }
}
