//! Lenses that distort: formulas ([`distortion`]), and maps made as a pinhole camera would have made them (`rectify`), in
//! which planes are affine in inverse depth again.

mod carry;
pub(crate) mod distortion;
mod rectify;
mod table;

pub(crate) use carry::Lens;
