//! planar: true planes.
//!
//! In: any map; a camera only for metric planes. Out: connected regions that one plane explains to
//! within the sensor's noise. The paper's idea that a plane has one gradient (eq. 5), in the space
//! where it is exact: inverse depth or disparity, `q = a u + b v + c`.

mod assign;
mod block;
mod counts;
mod crease;
mod curvature;
mod curved;
mod explain;
mod extend;
mod grid;
mod grow;
mod layout;
mod merge;
mod parameters;
mod pipeline;
mod pyramid;
mod redundant;
mod refine;
mod region;
mod source;
mod thresholds;
mod tiles;
mod trace;

use super::extraction::STAGES;
use super::method::sealed::Sealed;
use super::method::{Configured, Job, Method, MethodInfo, Parameters};
use super::parameter::check;
use crate::detection::Detection;
use crate::error::Result;
use crate::explanation::Explanation;
use crate::map::{AnyView, with_view};
use crate::noise::PADDED;
use counts::Counts;
use parameters::PARAMS;
pub use parameters::Planar;
use pipeline::Runner;

pub(super) static INFO: MethodInfo = MethodInfo {
    name: "planar",
    about: "Finds true planes: regions that one plane explains to within the sensor's noise, in inverse depth or disparity.",
    stages: &["tiles", "grow", "merge", "judge", "assign", STAGES[0], STAGES[1], STAGES[2], STAGES[3]],
    tells_curved: true,
    bytes_per_pixel: [24, 264],
    params: PARAMS,
    build: |values| Box::new(Whole::new(Planar::from_values(values))),
};

/// What `depthplanes noise` looks at is what is looked at here.
const _: () = assert!(PADDED[0] == layout::COLUMNS && PADDED[1] == layout::ROWS);

impl Sealed for Planar {}

impl Parameters for Planar {
    fn configured(self) -> Result<Configured> {
        check(PARAMS, &self.values())?;
        Ok(Configured(Box::new(Whole::new(self))))
    }
}

/// The method on any map: on the counts that floats are ([`counts`]), and on what a map was measured at
/// ([`source`]).
struct Whole {
    runner: Runner,
    counts: Counts,
}

impl Whole {
    fn new(params: Planar) -> Self {
        Whole { runner: Runner { params, ..Runner::default() }, counts: Counts::default() }
    }
}

impl Method for Whole {
    fn info(&self) -> &'static MethodInfo {
        &INFO
    }

    fn run(&mut self, map: AnyView<'_>, job: &mut Job<'_>, out: &mut Detection) -> Result<()> {
        with_view!(map, map => self.counts.run(&mut self.runner, &map, job, out))
    }

    fn explain(&mut self, map: AnyView<'_>, job: &mut Job<'_>, at: [usize; 2]) -> Result<Explanation> {
        with_view!(map, map => self.counts.explain(&mut self.runner, &INFO, &map, job, at))
    }
}

#[cfg(test)]
mod testing;
