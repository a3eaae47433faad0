//! The answer: a label image of the input's shape and one record for each plane.

use crate::camera::HessianNormalForm;
use crate::noise::ExpectedNoise;

/// What a method found in one map. A [`crate::Detector`] owns one and reuses its memory.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct Detection {
    /// Columns of the map and of `labels`.
    pub width: usize,
    /// Rows of the map and of `labels`.
    pub height: usize,
    /// Row by row, `width * height`: 0 = no plane, 1.. = `planes[label - 1]`.
    pub labels: Vec<u16>,
    /// By decreasing pixel count; equal counts by first pixel in raster order.
    pub planes: Vec<Plane>,
    /// The planes that became one with others, as they were before coplanar planes were joined
    /// ([`crate::Detector::merge_coplanar`]): by label of the union, then by their own.
    pub parts: Vec<Part>,
    /// Valid pixels of the map that was given.
    pub valid_pixels: usize,
    /// Missing pixels that enhancing filled (paper, section 3b).
    pub filled_pixels: usize,
    /// Curved surfaces, if they were asked for ([`crate::Detector::curved`]) and the method tells them apart.
    pub curved: Option<Curved>,
    /// The noise that was expected of the map's pixels; `None` of methods that need none.
    pub noise: Option<ExpectedNoise>,
}

/// Curved surfaces, which are no planes.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct Curved {
    /// Row by row, `width * height`: 0 = none, 1.. = `regions[label - 1]`. A pixel with a label here has no plane.
    pub labels: Vec<u16>,
    /// By decreasing pixel count; equal counts by first pixel in raster order.
    pub regions: Vec<CurvedRegion>,
}

/// A connected curved surface.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct CurvedRegion {
    /// Its value in the label image of curved regions, 1..=65535.
    pub label: u16,
    /// Pixels that carry the label.
    pub pixel_count: usize,
    /// Smallest box around the pixels.
    pub bounding_box: PixelBox,
    /// Mean (u, v) of the pixels.
    pub centroid: [f64; 2],
}

impl Detection {
    /// Pixels that belong to some plane.
    pub fn labelled_pixels(&self) -> usize {
        self.planes.iter().map(|plane| plane.pixel_count).sum()
    }

    /// The plane with that label; `None` for 0 and for a label that does not occur.
    pub fn plane(&self, label: u16) -> Option<&Plane> {
        self.planes.get(usize::from(label).checked_sub(1)?)
    }

    /// (u, v) of the pixels of the plane with that label, row by row; none for a label that does not occur.
    ///
    /// ```
    /// use depthplanes::{DepthView, Detector};
    /// let depth_mm: Vec<u16> = (0..40 * 16).map(|at| if at % 40 < 20 { 1000 } else { 2000 }).collect();
    /// let mut detector = Detector::default();
    /// let found = detector.detect(DepthView::new(&depth_mm, 40, 16)?)?;
    /// assert_eq!(found.pixels_of(2).next(), Some([20, 0]));
    /// assert_eq!(found.pixels_of(2).count(), found.planes[1].pixel_count);
    /// # Ok::<(), depthplanes::Error>(())
    /// ```
    pub fn pixels_of(&self, label: u16) -> impl Iterator<Item = [usize; 2]> + '_ {
        let bounds = self.plane(label).map(|plane| plane.bounding_box);
        bounds.into_iter().flat_map(move |PixelBox { u_min, v_min, u_max, v_max }| {
            let (columns, rows) = (u_min as usize..=u_max as usize, v_min as usize..=v_max as usize);
            let places = rows.flat_map(move |v| columns.clone().map(move |u| [u, v]));
            places.filter(move |&[u, v]| self.labels[v * self.width + u] == label)
        })
    }

    /// The parts of the plane with that label; none unless it was joined from several.
    pub fn parts_of(&self, label: u16) -> &[Part] {
        let end = |label: u16| self.parts.partition_point(|part| part.of <= label);
        &self.parts[end(label.saturating_sub(1))..end(label)]
    }

    /// Share (0..=1) of the valid and filled pixels that belong to some plane, the paper's
    /// "percentage of valid points"; 0 for a map without a valid pixel.
    pub fn labelled_share(&self) -> f64 {
        share(self.labelled_pixels(), self.valid_pixels + self.filled_pixels)
    }
}

pub(crate) fn share(part: usize, whole: usize) -> f64 {
    if whole == 0 { 0.0 } else { part as f64 / whole as f64 }
}

/// One plane.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct Plane {
    /// Its value in the label image, 1..=65535.
    pub label: u16,
    /// Pixels that carry the label.
    pub pixel_count: usize,
    /// `pixel_count` as a share (0..=1) of the map's valid (and filled) pixels.
    pub share_of_valid: f64,
    /// Smallest box around the pixels.
    pub bounding_box: PixelBox,
    /// Mean (u, v) of the pixels.
    pub centroid: [f64; 2],
    /// The least-squares plane in the map's own units; `None` if the pixels lie in one row or one
    /// column, where no plane is determined. Its numbers are finite.
    pub fit: Option<MapFit>,
    /// The plane in camera coordinates; `None` without intrinsics and a metric value kind, without a fit, if a pixel lies
    /// at or behind infinity, or if one of its numbers would not be finite.
    pub metric: Option<MetricPlane>,
}

impl Plane {
    /// A plane of which only its pixels are known, for detections that were made elsewhere.
    pub fn new(label: u16, pixel_count: usize, bounding_box: PixelBox) -> Self {
        let PixelBox { u_min, v_min, u_max, v_max } = bounding_box;
        let centroid = [[u_min, u_max], [v_min, v_max]].map(|[low, high]| (f64::from(low) + f64::from(high)) / 2.0);
        Plane { label, pixel_count, share_of_valid: 0.0, bounding_box, centroid, fit: None, metric: None }
    }

    /// Unit normal towards the camera, camera coordinates (x right, y down, z forward); `None` unless unit and camera are
    /// known.
    pub fn normal(&self) -> Option<[f64; 3]> {
        Some(self.metric?.plane.normal)
    }

    /// Distance of the camera from the plane, metres; `None` unless unit and camera are known.
    pub fn distance_m(&self) -> Option<f64> {
        Some(self.metric?.plane.distance)
    }
}

/// One of several planes that were joined into one.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Part {
    /// Label of the plane that it is now a part of.
    pub of: u16,
    /// The plane before, with the label that it had then.
    pub plane: Plane,
}

/// Columns `u_min..=u_max`, rows `v_min..=v_max`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct PixelBox {
    /// Leftmost column.
    pub u_min: u32,
    /// Topmost row.
    pub v_min: u32,
    /// Rightmost column, inclusive.
    pub u_max: u32,
    /// Bottom row, inclusive.
    pub v_max: u32,
}

impl PixelBox {
    /// Pixels inside the box.
    pub fn area(&self) -> usize {
        (self.u_max - self.u_min + 1) as usize * (self.v_max - self.v_min + 1) as usize
    }
}

/// `value = gradient[0] u + gradient[1] v + offset`, least squares over the plane's pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct MapFit {
    /// The depth gradient (-A/C, -B/C) of the paper's eq. 5, map units per pixel along u and v.
    pub gradient: [f64; 2],
    /// The plane's value at pixel (0, 0), map units.
    pub offset: f64,
    /// Root mean square residual, map units.
    pub rms: f64,
}

/// A plane in metres and camera coordinates (x right, y down, z forward).
///
/// Fitted by least squares where the sensor's error is near constant: in inverse depth for depth
/// maps, in disparity for disparity maps.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct MetricPlane {
    /// `normal . P + distance = 0`, the normal towards the camera.
    pub plane: HessianNormalForm,
    /// Root mean square distance of the points from the plane, metres.
    pub rms_m: f64,
    /// Mean of the points, metres.
    pub centroid_m: [f64; 3],
    /// Area of the part of the fitted plane that is seen through its pixels' squares, square metres; `None` if one of
    /// the squares reaches infinity on the plane.
    pub area_m2: Option<f64>,
    /// Covariance of (nx, ny, nz, distance), row by row. The normal's part has rank 2, since a unit vector cannot
    /// change its length.
    pub covariance: [[f64; 4]; 4],
    /// Share (0..=1) of the covariance by errors that differ from frame to frame, which averaging over frames reduces. The
    /// rest, from the smooth part of the noise, repeats while the camera stands still. 1 where the noise is not known.
    pub white_share: f64,
    /// What the covariance rests on.
    pub covariance_from: CovarianceSource,
}

impl MetricPlane {
    /// A plane of which only its equation and the mean of its points are known, for detections that were made elsewhere.
    pub fn new(plane: HessianNormalForm, centroid_m: [f64; 3]) -> Self {
        let covariance_from = CovarianceSource::Residuals;
        MetricPlane {
            plane,
            rms_m: 0.0,
            centroid_m,
            area_m2: None,
            covariance: [[0.0; 4]; 4],
            white_share: 1.0,
            covariance_from,
        }
    }
}

/// What a covariance was propagated from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum CovarianceSource {
    /// The noise of the sensor, stated or estimated: its white part, its smooth part, and the rounding of its values.
    /// If the residuals have a significantly larger variance than that (three standard deviations of a chi-squared),
    /// the covariance is larger by what they show.
    Noise,
    /// The residuals of the fit, as independent errors: the noise of the sensor is not known.
    Residuals,
}

impl CovarianceSource {
    /// `noise` or `residuals`, as in records.
    pub fn name(self) -> &'static str {
        match self {
            CovarianceSource::Noise => "noise",
            CovarianceSource::Residuals => "residuals",
        }
    }
}
