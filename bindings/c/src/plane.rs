//! A plane as numbers in a row, and the rings of its outline.

use depthplanes::Plane;

/// A closed ring of an outline; its last point is joined to the first.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct dp_ring {
    /// Its points (u, v) in pixels, centres of pixels at whole numbers.
    pub points_px: *const [f64; 2],
    /// The same points on the plane, metres in camera coordinates; null if these are not known.
    pub points_m: *const [f64; 3],
    /// How many points there are, 3 or more.
    pub point_count: usize,
    /// Whether it is a hole in the last ring before it that is none. Outer rings run counter-clockwise seen from the camera,
    /// holes clockwise.
    pub is_hole: bool,
}

/// A plane. What is in metres is in camera coordinates: x right, y down, z forward. It is NaN unless `is_metric`.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct dp_plane {
    /// Its value in the label image: k + 1 of the plane at place k.
    pub label: u16,
    /// Whether what is in metres is known: the unit of the numbers and the camera are, and no pixel lies at infinity.
    pub is_metric: bool,
    /// Pixels that carry the label.
    pub pixel_count: usize,
    /// `pixel_count` as a share (0 to 1) of the map's valid pixels.
    pub share_of_valid: f64,
    /// Leftmost column of its pixels.
    pub u_min: u32,
    /// Topmost row.
    pub v_min: u32,
    /// Rightmost column, inclusive.
    pub u_max: u32,
    /// Bottom row, inclusive.
    pub v_max: u32,
    /// Mean (u, v) of its pixels.
    pub centroid_px: [f64; 2],
    /// (a, b, c) of value = a u + b v + c in map units, by least squares; NaN if its pixels lie in one row or one column.
    pub fit: [f64; 3],
    /// Root mean square residual of that fit, map units; NaN as `fit`.
    pub fit_rms: f64,
    /// Unit normal, towards the camera.
    pub normal: [f64; 3],
    /// Distance of the camera from the plane, perpendicular, metres, never below 0.
    pub distance_m: f64,
    /// (a, b, c, d) of a x + b y + c z + d = 0: normal and distance.
    pub plane_model: [f64; 4],
    /// Root mean square distance of its points from the plane, metres.
    pub rms_m: f64,
    /// Mean of its points, metres.
    pub centroid_m: [f64; 3],
    /// Area of what is seen of it, square metres; NaN also where it reaches infinity.
    pub area_m2: f64,
    /// Covariance of (nx, ny, nz, distance), row by row, from the noise of the sensor.
    pub covariance: [[f64; 4]; 4],
    /// The rings of its outline, each outer ring followed by its holes; null unless outlines are made
    /// (`dp_detector_set_outlines`).
    pub rings: *const dp_ring,
    /// How many rings there are.
    pub ring_count: usize,
}

impl From<&Plane> for dp_plane {
    fn from(plane: &Plane) -> Self {
        let (bounds, metric) = (plane.bounding_box, plane.metric);
        let equation = metric.map(|metric| metric.plane);
        let normal = equation.map_or([f64::NAN; 3], |plane| plane.normal);
        let distance_m = equation.map_or(f64::NAN, |plane| plane.distance);
        dp_plane {
            label: plane.label,
            is_metric: metric.is_some(),
            pixel_count: plane.pixel_count,
            share_of_valid: plane.share_of_valid,
            u_min: bounds.u_min,
            v_min: bounds.v_min,
            u_max: bounds.u_max,
            v_max: bounds.v_max,
            centroid_px: plane.centroid,
            fit: plane.fit.map_or([f64::NAN; 3], |fit| [fit.gradient[0], fit.gradient[1], fit.offset]),
            fit_rms: plane.fit.map_or(f64::NAN, |fit| fit.rms),
            normal,
            distance_m,
            plane_model: [normal[0], normal[1], normal[2], distance_m],
            rms_m: metric.map_or(f64::NAN, |metric| metric.rms_m),
            centroid_m: metric.map_or([f64::NAN; 3], |metric| metric.centroid_m),
            area_m2: metric.and_then(|metric| metric.area_m2).unwrap_or(f64::NAN),
            covariance: metric.map_or([[f64::NAN; 4]; 4], |metric| metric.covariance),
            rings: std::ptr::null(),
            ring_count: 0,
        }
    }
}
