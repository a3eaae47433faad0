//! Small tools that know nothing of maps or planes.

pub(crate) mod bits;
pub(crate) mod memory;
pub(crate) mod parallel;
pub(crate) mod random;
pub(crate) mod runs;
pub(crate) mod simd;
pub(crate) mod switches;
pub(crate) mod union_find;
pub(crate) mod vec3;
