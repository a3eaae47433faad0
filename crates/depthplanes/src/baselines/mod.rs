//! Baselines: methods of other groups, reimplemented from their descriptions, to compare ours with.
//!
//! A baseline is one file, or a folder if it has stages of its own: a struct with its parameters that is a
//! [`baseline::Baseline`], and a row here. `affine.rs`, `cloud.rs`, `pieces.rs` and `a_contrario.rs` hold what several
//! share.

mod a_contrario;
mod affine;
mod baseline;
mod cloud;
mod fpdidm;
mod gradient;
mod hough;
mod mdl;
mod normals;
mod pieces;
mod ppdfdm;
mod ransac;
mod work;

use crate::methods::method::MethodInfo;
use baseline::row;

pub(crate) static RANSAC: MethodInfo = row::<ransac::Ransac>();
pub(crate) static PPDFDM: MethodInfo = row::<ppdfdm::Ppdfdm>();
pub(crate) static FPDIDM: MethodInfo = row::<fpdidm::Fpdidm>();
pub(crate) static HOUGH: MethodInfo = row::<hough::Hough>();
pub(crate) static NORMALS: MethodInfo = row::<normals::Normals>();
pub(crate) static MDL: MethodInfo = row::<mdl::Mdl>();
pub(crate) static GRADIENT: MethodInfo = row::<gradient::Gradient>();
