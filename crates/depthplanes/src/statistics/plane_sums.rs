//! The first pass over a plane's pixels: how many there are, where they lie, and the planes of least squares through them.

use super::covariance::Known;
use super::least_squares::{AffineFit, Moments, ValueSums};
use super::parts::ByLabel;
use crate::camera::{Intrinsics, ValueKind};
use crate::components::selection::LabelledRun;
use crate::detection::PixelBox;
use crate::map::{DepthView, Pixel};
use crate::noise::Patch;
use crate::sensor::Sensor;

/// What the first pass knows of a plane.
#[derive(Clone, Copy, Debug)]
pub struct PlaneSums {
    /// Its pixels.
    pub pixel_count: usize,
    /// Its pixels that are at least the margin away from the map's edge.
    pub inner_pixels: usize,
    /// Smallest box around its pixels.
    pub bounding_box: PixelBox,
    /// Mean (u, v) of its pixels.
    pub centroid: [f64; 2],
    /// Least-squares plane in the map's own units.
    pub fit: Option<AffineFit>,
    /// Least-squares plane in inverse depth, 1/m, where that is known.
    pub(super) inverse_depth: Option<AffineFit>,
    /// Its first pixel.
    origin: [f64; 2],
    value: Quantity<Moments>,
    inverse: Quantity<Moments>,
}

/// Sums of one quantity about its value at the first pixel.
#[derive(Clone, Copy, Debug, Default)]
struct Quantity<S> {
    first: f64,
    sums: S,
}

/// What the first pass sums of the pixels of a plane in one part of the map.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sums {
    pixel_count: usize,
    inner_pixels: usize,
    bounding_box: PixelBox,
    origin: [f64; 2],
    /// Where its pixels lie about `origin`.
    places: Moments,
    value: Quantity<ValueSums>,
    inverse: Quantity<ValueSums>,
}

/// Sums the pixels of labelled runs.
#[inline(always)]
pub(super) fn sum<T: Pixel>(
    by_label: &mut ByLabel<Sums>,
    map: &DepthView<'_, T>,
    runs: &[LabelledRun],
    inverse: Option<impl Fn(T) -> f64 + Copy>,
    inner: &Margin,
) {
    for run in runs {
        let values = run.of(map);
        let sums = by_label.of(run.label, || {
            Sums::beginning(run, values[0].into(), inverse.map_or(0.0, |inverse| inverse(values[0])))
        });
        sums.pixel_count += values.len();
        sums.inner_pixels += inner.pixels(run);
        sums.bounding_box.include(run);
        let (u, v) = (f64::from(run.u_first) - sums.origin[0], f64::from(run.v) - sums.origin[1]);
        sums.places.add_places(u, v, values.len());
        sums.value.add(u, v, values, |value| value.into());
        if let Some(inverse) = inverse {
            sums.inverse.add(u, v, values, inverse);
        }
    }
}

impl Sums {
    /// Sums without a pixel, about the first pixel of a run.
    fn beginning(run: &LabelledRun, value: f64, inverse: f64) -> Self {
        Sums {
            pixel_count: 0,
            inner_pixels: 0,
            bounding_box: PixelBox::NOTHING,
            origin: [run.u_first.into(), run.v.into()],
            places: Moments::default(),
            value: Quantity { first: value, sums: ValueSums::default() },
            inverse: Quantity { first: inverse, sums: ValueSums::default() },
        }
    }
}

impl PlaneSums {
    /// A plane without a pixel.
    pub(super) fn none() -> Self {
        PlaneSums {
            pixel_count: 0,
            inner_pixels: 0,
            bounding_box: PixelBox::NOTHING,
            centroid: [0.0; 2],
            fit: None,
            inverse_depth: None,
            origin: [0.0; 2],
            value: Quantity::default(),
            inverse: Quantity::default(),
        }
    }

    /// Adds what was summed of some of its pixels.
    pub(super) fn add(&mut self, sums: &Sums) {
        if self.pixel_count == 0 {
            self.origin = sums.origin;
            (self.value.first, self.inverse.first) = (sums.value.first, sums.inverse.first);
        }
        self.pixel_count += sums.pixel_count;
        self.inner_pixels += sums.inner_pixels;
        self.bounding_box.unite(&sums.bounding_box);
        let off = [0, 1].map(|axis| sums.origin[axis] - self.origin[axis]);
        self.value.merge(&sums.value, &sums.places, off);
        self.inverse.merge(&sums.inverse, &sums.places, off);
    }

    pub(super) fn finish(&mut self, sensor: &Sensor) {
        let [u, v] = self.origin;
        let places = &self.value.sums;
        self.centroid = [u + places.u / places.n, v + places.v / places.n];
        self.fit = self.value.fit(self.origin);
        self.inverse_depth = match sensor.value_kind {
            ValueKind::Depth { .. } => self.inverse.fit(self.origin),
            ValueKind::InverseDepth { slope, offset } => self.fit.map(|fit| fit.scaled(slope, offset)),
            ValueKind::Disparity => None,
        };
    }

    /// Sum of its points, metres, if its values are depths.
    pub(super) fn points(&self, metres: f64, camera: &Intrinsics) -> [f64; 3] {
        let Quantity { first, sums } = &self.value;
        let ray = camera.ray(self.origin[0], self.origin[1]);
        let z = sums.q + first * sums.n;
        let (uz, vz) = (sums.uq + first * sums.u, sums.vq + first * sums.v); // about the origin
        [ray[0] * z + uz / camera.fx, ray[1] * z + vz / camera.fy, z].map(|sum| sum * metres)
    }

    /// Its plane in the space where the noise is known.
    pub(super) fn known(&self, sensor: &Sensor) -> Option<Known> {
        // Noise is known in map units where these are affine in inverse depth.
        let (fit, slope) = match sensor.value_kind {
            ValueKind::Depth { .. } => (self.inverse_depth?, 1.0),
            ValueKind::InverseDepth { slope, .. } => (self.fit?, slope),
            ValueKind::Disparity => return None,
        };
        let PixelBox { u_min, v_min, u_max, v_max } = self.bounding_box;
        let extent = [u_max - u_min + 1, v_max - v_min + 1].map(f64::from);
        let patch = Patch { gradient: [fit.abc[0], fit.abc[1]], extent, pixels: fit.n };
        Some(Known { fit, patch, q: fit.at(self.centroid[0], self.centroid[1]), slope })
    }
}

impl Quantity<ValueSums> {
    #[inline(always)]
    fn add<T: Copy>(&mut self, u: f64, v: f64, values: &[T], quantity: impl Fn(T) -> f64) {
        let first = self.first;
        self.sums.add(u, v, values, |value| quantity(value) - first);
    }
}

impl Quantity<Moments> {
    /// Adds sums of other pixels, whose origin is off by so much.
    fn merge(&mut self, other: &Quantity<ValueSums>, places: &Moments, [u, v]: [f64; 2]) {
        self.sums.merge(&places.with(&other.sums).moved([u, v, other.first - self.first]));
    }

    fn fit(&self, [u, v]: [f64; 2]) -> Option<AffineFit> {
        self.sums.fit().map(|fit| fit.moved([u, v, self.first]))
    }
}

impl PixelBox {
    const NOTHING: PixelBox = PixelBox { u_min: u32::MAX, v_min: u32::MAX, u_max: 0, v_max: 0 };

    fn unite(&mut self, other: &PixelBox) {
        self.u_min = self.u_min.min(other.u_min);
        self.u_max = self.u_max.max(other.u_max);
        self.v_min = self.v_min.min(other.v_min);
        self.v_max = self.v_max.max(other.v_max);
    }

    fn include(&mut self, run: &LabelledRun) {
        self.u_min = self.u_min.min(run.u_first);
        self.u_max = self.u_max.max(run.u_last);
        self.v_min = self.v_min.min(run.v);
        self.v_max = self.v_max.max(run.v);
    }
}

/// The pixels at least `margin` away from the map's edge.
pub(super) struct Margin {
    pub(super) margin: u32,
    pub(super) width: u32,
    pub(super) height: u32,
}

impl Margin {
    fn pixels(&self, run: &LabelledRun) -> usize {
        let rows = self.margin..self.height.saturating_sub(self.margin);
        if !rows.contains(&run.v) {
            return 0;
        }
        let (first, end) = (run.u_first.max(self.margin), (run.u_last + 1).min(self.width.saturating_sub(self.margin)));
        end.saturating_sub(first) as usize
    }
}
