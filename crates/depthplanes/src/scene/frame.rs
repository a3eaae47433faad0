//! A map as a sensor would deliver it, and the truth behind it.

use super::truth::Truth;
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
#[non_exhaustive]
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
