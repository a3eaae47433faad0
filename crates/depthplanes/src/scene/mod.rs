//! Synthetic scenes with exact truth: for a first picture, for tests and benches, and for measuring detectors where
//! every plane is known.
//!
//! In: a [`Scene`] of facets, discs, balls and cylinders, a placed [`Camera`], a [`SensorModel`] and a seed.
//! Out: a [`SceneFrame`]: the map that such a sensor would deliver, and the [`Truth`] behind it.
//! Surfaces are cast exactly, one ray through each pixel's centre, so the truth is exact to
//! rounding. The same seed gives the same bytes on every platform: only operations that IEEE 754
//! rounds in one way are used, with our own sines and Gaussian draws.
//!
//! Not a renderer: no colour, no light, no texture, and sensor errors are drawn from a model, not
//! traced. Results on these scenes say how a method deals with geometry and with the stated noise;
//! they do not replace results on recorded frames.
//!
//! ```
//! use depthplanes::scene::Spec;
//! let frame = "room:seed=7,sensor=kinect_white,size=320x240".parse::<Spec>()?.frame()?;
//! assert_eq!((frame.view().width(), frame.view().height()), (320, 240));
//! assert!(frame.truth.planes.len() > 10);
//! // The largest plane, where the camera sees it without noise.
//! let truth = &frame.truth;
//! let at = truth.labels.iter().position(|&label| label == 1).unwrap();
//! let ray = frame.sensor.intrinsics.unwrap().ray((at % 320) as f64, (at / 320) as f64);
//! let [x, y, z] = ray.map(|r| r * truth.depth_m[at]);
//! let plane = truth.planes[0].plane;
//! let [nx, ny, nz] = plane.normal;
//! assert!((nx * x + ny * y + nz * z + plane.distance).abs() < 1e-9);
//! # Ok::<(), depthplanes::Error>(())
//! ```

mod cast;
mod catalogue;
mod clutter;
mod exact;
mod frame;
mod pose;
mod render;
mod robot;
mod room;
mod sensors;
mod shape;
mod spec;
mod staged;
mod surfaces;
mod truth;
mod walk;

pub use crate::util::random::Random;
pub use catalogue::{SCENES, SceneInfo, find};
pub use frame::{SceneFrame, ScenePixels};
pub use pose::{Camera, Pose};
pub use render::render;
pub use sensors::{SENSORS, SensorError, SensorInfo, SensorModel};
pub use spec::{MAX_FRAME_PIXELS, Spec};
pub use staged::Staged;
pub use surfaces::{Place, Scene, Strip, Surface};
pub use truth::{Truth, TruthPlane};
pub use walk::Walk;
