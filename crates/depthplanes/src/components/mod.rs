//! Neighbour grouping (paper, section 3c): the 4-connected components of the links between valid
//! neighbours whose values differ by at most theta.
//!
//! In: a map and theta. Out: [`Groups`], every valid pixel in exactly one group (but for lone pixels
//! where [`ConnectedComponents::leave_out_singles`] allows to skip them). Why runs of linked
//! pixels instead of pixels: links of a row fit 64 to a machine word, so a row costs a few vector
//! instructions and only the places where a run first touches a run above cost a step each. The
//! answer is the same for every kernel and any number of threads, since components do not depend on
//! the order of unions and groups are numbered by their first pixel.
//!
//! How: `scan::scan` labels a strip of rows, `scan::stitch` unites the labels of neighbouring
//! strips, `union_find::flatten` numbers the groups and adds up their sizes.

pub(crate) mod boundary;
mod connected_components;
mod connectivity;
pub(crate) mod gaps;
mod isa;
mod kernels;
mod labels;
mod scan;
mod scratch;
pub(crate) mod selection;
mod strip;

pub use connected_components::{ConnectedComponents, Groups, Run};
pub use connectivity::Connectivity;
pub use kernels::{Compiles, Kernel, best, kernels};
