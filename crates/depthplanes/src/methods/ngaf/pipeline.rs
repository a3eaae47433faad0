//! One frame from a map to planes: the paper's section 3, stage by stage.

use super::enhance::{Enhancer, Fillable};
use super::parameters::Ngaf;
use crate::components::selection::Selection;
use crate::components::{Compiles, ConnectedComponents, Connectivity, Groups};
use crate::detection::Detection;
use crate::error::Result;
use crate::map::{DepthView, Pixel};
use crate::methods::method::Job;
use crate::methods::records::Records;
use crate::noise::stated_noise;
use crate::statistics::{PlaneStatistics, PlaneSums, Seen};

/// The method with its memory.
#[derive(Default)]
pub(super) struct Runner {
    pub(super) params: Ngaf,
    enhancer: Enhancer,
    components: ConnectedComponents,
    selection: Selection,
    statistics: PlaneStatistics,
}

impl Runner {
    /// The method with these parameters.
    pub(super) fn new(params: Ngaf) -> Self {
        let mut runner = Runner { params, ..Runner::default() };
        runner.components.leave_out_singles(params.min_pixels >= 1);
        runner
    }
}

/// Observes a run.
pub(super) trait Observer {
    /// Large groups were selected from the map as it was grouped.
    fn selected<T: Pixel>(&mut self, map: &DepthView<'_, T>, groups: &Groups, selection: &Selection);

    /// They were described; our own conditions have dropped none yet.
    fn described(&mut self, tallies: &[PlaneSums]);
}

/// No observer.
impl Observer for () {
    fn selected<T: Pixel>(&mut self, _: &DepthView<'_, T>, _: &Groups, _: &Selection) {}

    fn described(&mut self, _: &[PlaneSums]) {}
}

impl Runner {
    /// Section 3, stage by stage.
    pub(super) fn ngaf<T: Compiles + Fillable>(
        &mut self,
        map: DepthView<'_, T>,
        job: &mut Job<'_>,
        out: &mut Detection,
        observer: &mut impl Observer,
    ) -> Result<()> {
        let Runner { params, enhancer, components, selection, statistics } = self;
        let (map, filled_pixels) = match params.window {
            0 => (map, 0),
            window => enhancer.enhance(&map, window, params.passes)?, // section 3b
        };
        job.done("enhance");
        let rule = Connectivity::new(map.validity(), params.theta)?;
        let groups = components.group(&map, &rule, job.threads); // section 3c
        job.done("group");
        selection.select(groups, params.min_pixels)?; // section 3d
        job.done("select");
        observer.selected(&map, groups, selection);
        let mut runs = selection.runs(groups);
        statistics.tally(&map, runs, params.margin, &job.sensor, job.threads);
        observer.described(statistics.tallies());
        if params.has_conditions() {
            selection.retain(groups, |index| params.accepts(&statistics.tallies()[index]));
            statistics.retain(|tally| params.accepts(tally));
            runs = selection.runs(groups);
        }
        let valid = groups.valid_pixels();
        let noise = stated_noise::<T>(&job.sensor);
        let seen = Seen { sensor: &job.sensor, noise: noise.as_ref(), valid_pixels: valid };
        statistics.describe(&map, runs, &seen, job.threads, &mut out.planes);
        let mut records =
            Records { map: &map, groups, margin: params.margin, seen, threads: job.threads, selection, statistics };
        records.join(job.joiner.as_deref_mut(), out);
        job.done("fit");
        selection.paint(groups, &mut out.labels);
        (out.width, out.height) = (map.width(), map.height());
        (out.valid_pixels, out.filled_pixels) = (valid - filled_pixels, filled_pixels);
        out.noise = None; // No threshold depends on it.
        job.done("label");
        Ok(())
    }
}
