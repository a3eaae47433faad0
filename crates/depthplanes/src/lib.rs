//! Finds planes in depth and disparity maps, in real time, on ordinary hardware.
//!
//! The flow, read left to right:
//! `DepthView -> enhance -> group -> select -> fit -> Detection`.
//!
//! [`Detector`] runs a whole method over frame after frame; the stages stand alone as well.
//! [`outline`] makes polygons of what was found. [`metrics`] holds label images against the truth.

pub mod camera;
pub mod coplanar;
pub mod describe;
pub mod detection;
mod detector;
pub mod enhance;
pub mod error;
pub mod explanation;
pub mod fit;
pub mod group;
pub mod map;
pub mod methods;
pub mod metrics;
pub mod noise;
pub mod outline;
mod parallel;
mod random;
pub mod scene;
pub mod select;

pub use camera::{Hessian, Intrinsics, Measure, Sensor};
pub use coplanar::Coplanar;
pub use detection::{CovarianceSource, Detection, Part, Plane};
pub use detector::Detector;
pub use error::{Error, Result};
pub use explanation::Explanation;
pub use map::{AnyView, DepthView, Pixel};
pub use methods::{Ngaf, Planar};

/// The README's example is a documentation test.
#[cfg(doctest)]
#[doc = include_str!("../../../README.md")]
struct Readme;
