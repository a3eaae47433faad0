//! The last stages of a method that says for each pixel which region it belongs to.
//!
//! In: a region image. Out: the detection: connected pieces of a region with more than `min-pixels` pixels, by decreasing size,
//! fitted, described and painted.

use super::method::Job;
use super::parameter::{Param, ParamKind};
use super::records::Records;
use crate::components::selection::Selection;
use crate::components::{ConnectedComponents, Connectivity};
use crate::detection::{Curved, CurvedRegion, Detection};
use crate::error::Result;
use crate::map::{DepthView, Pixel};
use crate::noise::NoiseModel;
use crate::statistics::{PlaneStatistics, Seen};

/// Extracts planes from region images; reuses its memory.
#[derive(Default)]
pub(crate) struct Extraction {
    pub(crate) components: ConnectedComponents,
    pub(crate) selection: Selection,
    pub(crate) statistics: PlaneStatistics,
}

/// What a method knows of its regions beside their pixels.
#[derive(Clone, Copy)]
pub(crate) struct Wanted<'a> {
    /// A plane has strictly more pixels than this.
    pub(crate) min_pixels: u32,
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
pub(crate) const MIN_PIXELS: Param = Param {
    name: "min-pixels",
    alias: Some("min"),
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
        let Extraction { components, selection, statistics } = self;
        let &Wanted { min_pixels, min_area, noise, valid_pixels } = wanted;
        components.group(image, &Connectivity::new(image.validity(), 0.0)?, job.threads);
        unite(components);
        let groups = components.groups();
        job.done("group");
        selection.select(groups, min_pixels)?;
        job.done("select");
        let runs = selection.runs(groups);
        statistics.tally(map, runs, 0, &job.sensor, job.threads);
        // The noise as the residuals of all planes show it, before some of them are joined.
        let noise = noise.map(|noise| statistics.as_residuals_show(noise, &job.sensor));
        let seen = Seen { sensor: &job.sensor, noise: noise.as_ref(), valid_pixels };
        statistics.describe(map, runs, &seen, job.threads, &mut out.planes);
        let mut records = Records { map, groups, margin: 0, seen, threads: job.threads, selection, statistics };
        records.join(job.joiner.as_deref_mut(), out);
        if min_area > 0.0 {
            records.drop_smaller(min_area, out);
        }
        job.done("fit");
        selection.paint(groups, &mut out.labels);
        (out.width, out.height) = (map.width(), map.height());
        (out.valid_pixels, out.filled_pixels) = (valid_pixels, 0);
        out.noise = wanted.noise.and_then(NoiseModel::expected);
        job.done("label");
        Ok(())
    }

    /// The curved regions of a region image (0 = none): connected pieces of one region with more than `min-pixels` pixels; `unite`
    /// may put groups together before they are counted. `old`: memory to reuse.
    ///
    /// # Errors
    /// [`crate::Error::TooManyPlanes`] if they are more than labels can name.
    pub(crate) fn extract_curved<T: Pixel>(
        &mut self,
        map: &DepthView<'_, T>,
        ids: &DepthView<'_, u16>,
        min_pixels: u32,
        unite: impl FnOnce(&mut ConnectedComponents),
        job: &Job<'_>,
        old: Option<Curved>,
    ) -> Result<Curved> {
        let Extraction { components, selection, statistics } = self;
        components.group(ids, &Connectivity::new(ids.validity(), 0.0)?, job.threads);
        unite(components);
        let groups = components.groups();
        selection.select(groups, min_pixels)?;
        statistics.tally(map, selection.runs(groups), 0, &job.sensor, job.threads);
        let Curved { mut labels, mut regions } = old.unwrap_or_default();
        selection.paint(groups, &mut labels);
        regions.clear();
        regions.extend((1..).zip(statistics.tallies()).map(|(label, tally)| CurvedRegion {
            label,
            pixel_count: tally.pixel_count,
            bounding_box: tally.bounding_box,
            centroid: tally.centroid,
        }));
        Ok(Curved { labels, regions })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sensor::Sensor;

    #[test]
    fn curved_regions_are_the_connected_pieces_of_more_than_min_pixels() {
        // Number 2 in two pieces, of 12 pixels and of 4; number 1 of 6.
        let ids: Vec<u16> =
            [[0, 2, 2, 2, 2, 0, 2, 2], [0, 2, 2, 2, 2, 0, 2, 2], [0, 2, 2, 2, 2, 0, 0, 0], [1, 1, 1, 1, 1, 1, 0, 0]]
                .concat();
        let pixels = [40.0f32; 32];
        let map = DepthView::new(&pixels, 8, 4).unwrap();
        let view = DepthView::new(&ids, 8, 4).unwrap().valid_range(1, u16::MAX).unwrap();
        let job = Job { sensor: Sensor::default(), threads: 1, curved: true, joiner: None, observer: &mut |_| () };
        let mut old = None;
        for (min_pixels, expected) in [(0, &[12, 6, 4][..]), (4, &[12, 6]), (5, &[12, 6]), (6, &[12]), (12, &[])] {
            let found = Extraction::default().extract_curved(&map, &view, min_pixels, |_| (), &job, old).unwrap();
            assert_eq!(
                found.regions.iter().map(|region| region.pixel_count).collect::<Vec<_>>(),
                expected,
                "min-pixels {min_pixels}"
            );
            for region in &found.regions {
                assert_eq!(found.labels.iter().filter(|&&label| label == region.label).count(), region.pixel_count);
            }
            if let Some(first) = found.regions.first() {
                assert_eq!((first.centroid, first.bounding_box.u_max), ([2.5, 1.0], 4));
            }
            old = Some(found);
        }
    }
}
