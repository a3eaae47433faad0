//! What a sensor's error is at a given range.
//!
//! In: what is known of the sensor ([`SensorNoise`]), what the map's numbers mean, and the steps that they come in.
//! Out: a [`NoiseModel`], the variance of one pixel in the space where planes are affine ([`Space`]): inverse depth
//! for depth maps, the value itself for all others. The error of structured light and stereo is constant there, that
//! of time of flight is constant in depth; both parts add. [`Estimator`] estimates the noise from frames.

mod enlarged;
pub(crate) mod errors;
mod estimate;
mod expected;
mod lanes;
mod median;
mod model;
mod rounding;
pub(crate) mod scales;
pub(crate) mod sensor_noise;
mod space;
mod sparse;
mod steps;
mod table;

pub use enlarged::{Enlargement, EnlargementFinder};
pub(crate) use estimate::PADDED;
pub use estimate::{Estimate, Estimator};
pub(crate) use estimate::{noise_of_map, stated_noise};
pub use expected::ExpectedNoise;
pub use model::{NoiseModel, Patch};
pub use rounding::{Rounding, RoundingFinder};
pub use sensor_noise::SensorNoise;
pub(crate) use space::LARGEST_Q;
pub use space::Space;
pub use sparse::{Sparse, SparseFinder};
pub(crate) use steps::Steps;
pub use table::{MAX_ROWS, NoiseTable};
