//! Made-up scenes with exact truth: for a first picture, for tests and benches, and for measuring
//! detectors where every plane is known.
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
mod pose;
mod room;
mod sensors;
mod shape;
mod spec;
mod surfaces;
mod truth;

pub use crate::util::random::Random;
pub use catalogue::{SCENES, SceneInfo, Staged, find};
pub use pose::{Camera, Pose};
pub use sensors::{SENSORS, SensorError, SensorInfo, SensorModel};
pub use spec::{MAX_FRAME_PIXELS, Spec};
pub use surfaces::{Place, Scene, Strip, Surface};
pub use truth::{Truth, TruthPlane};

use crate::error::Result;
use crate::map::{AnyView, DepthView};
use crate::sensor::Sensor;

/// The pixels of a map, row by row, top row first; 0 = missing.
#[derive(Clone, Debug, PartialEq)]
pub enum ScenePixels {
    /// 8-bit values.
    U8(Vec<u8>),
    /// 16-bit values.
    U16(Vec<u16>),
    /// Floating-point values.
    F32(Vec<f32>),
}

/// A map as a sensor would deliver it, and the truth behind it.
#[derive(Clone, Debug, PartialEq)]
pub struct SceneFrame {
    /// Columns.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// `width * height` values.
    pub pixels: ScenePixels,
    /// What the values mean, and the camera's intrinsics.
    pub sensor: Sensor,
    /// What is really there.
    pub truth: Truth,
}

impl SceneFrame {
    /// The map, for [`crate::Detector::detect`].
    pub fn view(&self) -> AnyView<'_> {
        const CHECKED: &str = "a frame's size was checked when it was made";
        let (width, height) = (self.width, self.height);
        match &self.pixels {
            ScenePixels::U8(pixels) => DepthView::new(pixels, width, height).expect(CHECKED).into(),
            ScenePixels::U16(pixels) => DepthView::new(pixels, width, height).expect(CHECKED).into(),
            ScenePixels::F32(pixels) => DepthView::new(pixels, width, height).expect(CHECKED).into(),
        }
    }

    /// The map's value at a pixel as a number; 0 = missing. `at` is `v * width + u`.
    pub fn value(&self, at: usize) -> f64 {
        match &self.pixels {
            ScenePixels::U8(pixels) => pixels[at].into(),
            ScenePixels::U16(pixels) => pixels[at].into(),
            ScenePixels::F32(pixels) => pixels[at].into(),
        }
    }

    /// The truth's labels where the sensor measured something, 0 elsewhere. Labels keep their
    /// numbers; one whose every pixel is missing does not occur.
    pub fn measured_labels(&self) -> Vec<u16> {
        let label = |(at, &label): (usize, &u16)| if self.value(at) > 0.0 { label } else { 0 };
        self.truth.labels.iter().enumerate().map(label).collect()
    }
}

/// What a sensor at the camera's place makes of a scene. The seed drives the sensor's noise alone.
///
/// # Errors
/// As [`Camera::check`].
///
/// ```
/// use depthplanes::scene::{Camera, Pose, Scene, SensorModel, render};
/// let mut scene = Scene::default();
/// // A wall two metres ahead.
/// scene.facet(&[[-9.0, 2.0, -9.0], [9.0, 2.0, -9.0], [9.0, 2.0, 9.0], [-9.0, 2.0, 9.0]]);
/// let camera = Camera::kinect(4, 3, Pose::at_height(1.0, 0.0))?;
/// let frame = render(&scene, &camera, SensorModel::CleanMm, 0)?;
/// assert_eq!(frame.value(0), 2000.0);
/// assert_eq!(frame.truth.planes[0].pixel_count, 12);
/// assert_eq!(frame.truth.planes[0].plane.normal, [0.0, 0.0, -1.0]);
/// # Ok::<(), depthplanes::Error>(())
/// ```
pub fn render(scene: &Scene, camera: &Camera, sensor: SensorModel, seed: u64) -> Result<SceneFrame> {
    camera.check()?;
    let seen = cast::cast(scene, camera);
    let pixels = sensor.pixels(&sensors::Exposure { scene, camera, seen: &seen }, seed);
    let truth = Truth::new(scene, camera, seen);
    let sensor = Sensor { measure: sensor.measure(camera), intrinsics: Some(camera.intrinsics), ..Sensor::default() };
    Ok(SceneFrame { width: camera.width, height: camera.height, pixels, sensor, truth })
}
