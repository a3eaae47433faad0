//! The detectors, and the table that names them.
//!
//! A row of [`METHODS`] gives a method its flag, its keyword, its help and its contract tests.

pub(crate) mod extraction;
pub(crate) mod method;
mod ngaf;
pub(crate) mod noise;
pub(crate) mod parameter;
mod planar;
pub(crate) mod rays;
mod records;
mod reduced;
mod spread;
mod tries;

use crate::baselines;
use crate::error::{Error, Result};
use method::names;
pub use method::{Configured, MethodInfo, Parameters};
pub use ngaf::Ngaf;
#[doc(hidden)]
pub use ngaf::{Enhancer, Fillable};
pub use parameter::{Param, ParamKind};
pub use planar::Planar;

/// All methods. The first is the default.
pub static METHODS: &[&MethodInfo] = &[
    &planar::INFO,
    &ngaf::INFO,
    &baselines::RANSAC,
    &baselines::PPDFDM,
    &baselines::FPDIDM,
    &baselines::HOUGH,
    &baselines::NORMALS,
    &baselines::MDL,
    &baselines::GRADIENT,
];

/// The method of that name.
///
/// # Errors
/// [`Error::Unknown`] with the names there are.
pub fn find(name: &str) -> Result<&'static MethodInfo> {
    METHODS.iter().copied().find(|method| method.name == name).ok_or_else(|| Error::Unknown {
        what: "method",
        given: name.to_string(),
        accepted: names(METHODS.iter().map(|method| method.name)),
    })
}

/// The method to take where none is named: the first of [`METHODS`].
pub fn default() -> &'static MethodInfo {
    METHODS[0]
}
