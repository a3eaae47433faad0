//! NGaF, the paper's method (Hoa, Minh, Dung 2017, "Effective Method For Detecting Multi Planes From
//! Depth Maps"): enhance, group neighbours, keep large groups.
//!
//! In: any map; a camera only for metric planes. Out: surfaces of continuous depth. It is exact and
//! fast, and it sees continuity only: a wall that meets its floor is one group, a slanted plane
//! whose steps exceed theta falls into bands, a ball counts as a plane. Where that matters, use a
//! method that fits planes.

mod enhance;
mod explain;
mod parameters;
mod pipeline;

use super::method::sealed::Sealed;
use super::method::{Configured, Job, Method, MethodInfo, Parameters};
use super::parameter::check;
use crate::detection::Detection;
use crate::error::Result;
use crate::explanation::Explanation;
use crate::map::{AnyView, with_view};
pub use enhance::{Enhancer, Fillable};
use explain::explain;
pub use parameters::Ngaf;
use parameters::PARAMS;
use pipeline::Runner;

pub(super) static INFO: MethodInfo = MethodInfo {
    name: "ngaf",
    about: "Groups neighbours whose values differ by at most theta; a group of more than `min-pixels` pixels is a \
            plane (Hoa, Minh, Dung 2017).",
    stages: &["enhance", "group", "select", "fit", "label"],
    tells_curved: false,
    bytes_per_pixel: [16, 64],
    params: PARAMS,
    build: |values| Box::new(Runner::new(Ngaf::from_values(values))),
};

impl Sealed for Ngaf {}

impl Parameters for Ngaf {
    fn configured(self) -> Result<Configured> {
        check(PARAMS, &self.values())?;
        Ok(Configured(Box::new(Runner::new(self))))
    }
}

impl Method for Runner {
    fn info(&self) -> &'static MethodInfo {
        &INFO
    }

    fn run(&mut self, map: AnyView<'_>, job: &mut Job<'_>, out: &mut Detection) -> Result<()> {
        with_view!(map, map => self.ngaf(map, job, out, &mut ()))
    }

    fn explain(&mut self, map: AnyView<'_>, job: &mut Job<'_>, at: [usize; 2]) -> Result<Explanation> {
        explain(self, &INFO, map, job, at)
    }
}
