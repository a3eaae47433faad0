//! Finds planes in depth and disparity maps, in real time, on ordinary hardware.
//!
//! Your own pixels and your own camera:
//!
//! ```
//! use depthplanes::{DepthView, Detector, Intrinsics, Sensor, ValueKind};
//! // A wall 2 m away, 16-bit millimetres, row by row; 0 is missing.
//! let (width, height) = (64, 48);
//! let depth_mm = vec![2000u16; width * height];
//! let sensor = Sensor::default()
//!     .value_kind(ValueKind::depth(0.001)?) // metres in a unit of the map
//!     .intrinsics(Intrinsics::new(58.0, 58.0, 31.5, 23.5)?); // fx, fy, cx, cy, pixels
//! let mut detector = Detector::default().sensor(sensor); // keep it: later frames allocate nothing
//! let found = detector.detect(DepthView::new(&depth_mm, width, height)?)?;
//! let wall = &found.planes[0]; // the largest first
//! assert_eq!((wall.label, wall.pixel_count), (1, width * height));
//! assert!((wall.distance_m().unwrap() - 2.0).abs() < 1e-6);
//! assert!((wall.normal().unwrap()[2] + 1.0).abs() < 1e-9); // towards the camera
//! assert_eq!(found.labels[0], 1); // one label a pixel, 0 for none
//! # Ok::<(), depthplanes::Error>(())
//! ```
//!
//! | to | look at |
//! |---|---|
//! | find planes in frame after frame, with parameters, on threads | [`Detector`], [`Planar`], [`Ngaf`] |
//! | hand over pixels with a stride, holes, several types | [`DepthView`], [`AnyView`] |
//! | say what the numbers mean, which camera, how noisy | [`Sensor`], [`ValueKind`], [`Intrinsics`], [`noise`] |
//! | read the answer | [`Detection`], [`Plane`], [`detection::MetricPlane`] |
//! | make polygons, hulls, rectangles of it | [`outline::Outliner`] |
//! | find the floor, how the camera stands above it, and what each plane is | [`ground::GroundFinder`] |
//! | keep each plane's identity from frame to frame | [`track::Tracker`] |
//! | join the pieces of one plane | [`Detector::merge_coplanar`] |
//! | ask why a pixel has no plane | [`Detector::explain`] |
//! | hold an answer against a truth | [`metrics`] |
//! | make frames whose truth is known | [`scene`] |
//! | describe the planes of another program's label image | [`describe_labels`] |
//! | run the baselines, list all parameters | [`methods`], `Detector::new(methods::find("ransac")?)` |
//!
//! `examples/` has programs to copy from: `own_pixels`, `camera_loop`, `floor_height`; those of the crate `depthplanes-io`, which
//! reads and writes files, are `detect_png`, `overlay`, `planes_to_ply`.
//!
//! | feature | |
//! |---|---|
//! | `parallel`, on by default | large maps on rayon's threads; the answer is the same for any number |
//! | `serde` | detections, sensors and parameters can be written and read by serde, explanations written; with serde_json, its feature `float_roundtrip` keeps every digit |
//!
//! It compiles for any target, WebAssembly among them, with `default-features = false`.

mod baselines;
pub mod camera;
mod components;
pub mod coplanar;
pub mod detection;
mod detector;
pub mod error;
pub mod explanation;
pub mod ground;
mod labelled;
mod lens;
pub mod limits;
pub mod map;
pub mod methods;
pub mod metrics;
pub mod noise;
pub mod outline;
pub mod scene;
mod sensor;
mod statistics;
#[cfg(test)]
mod tests;
pub mod track;
mod util;

pub use camera::{HessianNormalForm, Intrinsics, ValueKind};
pub use coplanar::Coplanar;
pub use detection::{CovarianceSource, Detection, Part, Plane};
pub use detector::Detector;
pub use error::{Error, Result};
pub use explanation::Explanation;
pub use labelled::describe_labels;
pub use lens::distortion::{Distortion, DistortionModel};
pub use map::{AnyView, DepthView, Pixel};
pub use methods::{Ngaf, Planar};
pub use sensor::Sensor;

/// Stages by themselves, for the tests, oracles and benchmarks of this project. No part of the interface: any version may
/// change them.
#[doc(hidden)]
pub mod internals {
    pub use crate::components::selection::{LabelledRun, Selection};
    pub use crate::components::{Compiles, ConnectedComponents, Connectivity, Groups, Kernel, Run, best, kernels};
    pub use crate::methods::{Enhancer, Fillable};
    pub use crate::statistics::least_squares::{AffineFit, Moments, ValueSums, hessian_normal_form, metric_covariance};
    pub use crate::statistics::{PlaneStatistics, PlaneSums, Seen};
}
