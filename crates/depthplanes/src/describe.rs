//! From labelled pixels to plane records: counts, boxes, least-squares planes, metric planes.
//!
//! In: the map and its labelled runs in raster order. Out: one [`Plane`] for each label. Two passes
//! over the labelled pixels only: the first sums, the second, where a camera is known, measures
//! distances from the fitted planes. Sums are taken in raster order, whatever the number of threads.

use crate::camera::{Intrinsics, Measure, Sensor};
use crate::detection::{CovarianceSource, MapFit, MetricPlane, PixelBox, Plane, share};
use crate::fit::{self, AffineFit, LANES, Lanes, Moments, ValueSums, in_lanes};
use crate::group::vectorised;
use crate::map::{DepthView, Pixel};
use crate::noise::{NoiseModel, Patch};
use crate::select::LabelledRun;

/// What the first pass knows of a plane.
#[derive(Clone, Copy, Debug)]
pub struct Tally {
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
    inverse_depth: Option<AffineFit>,
    origin: [f64; 2],
    /// Where its pixels lie about `origin`.
    places: Moments,
    value: Quantity,
    inverse: Quantity,
}

/// Sums of one quantity about its value at the plane's first pixel.
#[derive(Clone, Copy, Debug, Default)]
struct Quantity {
    first: f64,
    sums: ValueSums,
}

/// Describes planes; reuses its memory from map to map.
#[derive(Debug, Default)]
pub struct Describer {
    tallies: Vec<Tally>,
    distances: Vec<Distances>,
}

/// What the second pass has to know beside the pixels.
#[derive(Clone, Copy, Debug)]
pub struct Seen<'a> {
    /// What the numbers mean, and the camera.
    pub sensor: &'a Sensor,
    /// The noise of the map, if it is known.
    pub noise: Option<&'a NoiseModel>,
    /// Valid pixels of the map.
    pub valid_pixels: usize,
}

/// What the second pass sums for a plane.
#[derive(Clone, Copy, Debug, Default)]
struct Distances {
    /// Sum of (z (q - q of the plane))^2.
    squares: Lanes,
    /// Sum of the points, metres.
    point: [f64; 3],
    /// The plane's part behind its pixels' squares, in units of `1 / (distance |fx fy|)`, m^3.
    area: f64,
    /// Whether some pixel's square reaches infinity on the plane.
    reaches_infinity: bool,
    /// Whether some pixel lies at or behind infinity, which leaves the plane without metric values.
    behind_infinity: bool,
}

/// 1 / value, to within some units of the last place. Single precision and one step of Newton's method take a third of
/// the time of a division; only whole numbers are sure to stay within its range.
#[inline(always)]
fn reciprocal<T: Pixel>(value: T) -> f64 {
    let wide: f64 = value.into();
    if !T::IS_INTEGER {
        return 1.0 / wide;
    }
    let near = f64::from(1.0 / value.to_f32());
    near * (2.0 - wide * near)
}

impl Describer {
    /// First pass. Labels are 1, 2, .. in `runs`, and none is left out.
    pub fn tally<T: Pixel>(&mut self, map: &DepthView<'_, T>, runs: &[LabelledRun], margin: u32, sensor: &Sensor) {
        self.tallies.clear();
        self.tallies.reserve(crate::select::MAX_PLANES.min(map.area()));
        let inner = Margin { margin, width: map.width() as u32, height: map.height() as u32 };
        // Planes of depth maps are affine in inverse depth; all others in the map's own values.
        let inverse = match (sensor.intrinsics, sensor.measure) {
            (Some(_), Measure::Depth { metres }) => {
                let per_metre = 1.0 / metres;
                Some(move |value: T| per_metre * reciprocal(value))
            }
            _ => None,
        };
        vectorised(
            #[inline(always)]
            || self.sum(map, runs, inverse, &inner),
        );
        self.tallies.iter_mut().for_each(|tally| tally.finish(sensor));
    }

    #[inline(always)]
    fn sum<T: Pixel>(
        &mut self,
        map: &DepthView<'_, T>,
        runs: &[LabelledRun],
        inverse: Option<impl Fn(T) -> f64 + Copy>,
        inner: &Margin,
    ) {
        for run in runs {
            let values = run.of(map);
            let at = usize::from(run.label) - 1;
            if at >= self.tallies.len() {
                self.tallies.resize_with(at + 1, Tally::none);
            }
            let tally = &mut self.tallies[at];
            if tally.pixel_count == 0 {
                tally.begin(run, values[0].into(), inverse.map_or(0.0, |inverse| inverse(values[0])));
            }
            tally.pixel_count += values.len();
            tally.inner_pixels += inner.pixels(run);
            tally.bounding_box.include(run);
            let (u, v) = (f64::from(run.u_first) - tally.origin[0], f64::from(run.v) - tally.origin[1]);
            tally.places.add_places(u, v, values.len());
            tally.value.add(u, v, values, |value| value.into());
            if let Some(inverse) = inverse {
                tally.inverse.add(u, v, values, inverse);
            }
        }
    }

    /// The planes' tallies; label 1 is the first.
    pub fn tallies(&self) -> &[Tally] {
        &self.tallies
    }

    /// Drops tallies; the labels of the others move up.
    pub fn retain(&mut self, keep: impl FnMut(&Tally) -> bool) {
        self.tallies.retain(keep);
    }

    /// Second pass: the records, in order of label. Shares are taken of the map's `valid_pixels`, covariances from
    /// the noise if it is known.
    pub fn describe<T: Pixel>(
        &mut self,
        map: &DepthView<'_, T>,
        runs: &[LabelledRun],
        seen: &Seen<'_>,
        planes: &mut Vec<Plane>,
    ) {
        let Seen { sensor, valid_pixels, .. } = *seen;
        planes.clear();
        planes.reserve(self.tallies.capacity());
        self.distances.clear();
        match (sensor.intrinsics, sensor.measure) {
            (Some(camera), Measure::Depth { metres }) => {
                self.measure_distances(map, runs, None, |value| metres * value.into());
                for (distances, tally) in self.distances.iter_mut().zip(&self.tallies) {
                    distances.point = tally.points(metres, &camera);
                }
            }
            (Some(camera), Measure::InverseDepth { slope, offset }) => {
                self.measure_distances(map, runs, Some(&camera), |value| (slope * value.into() + offset).recip());
            }
            _ => (),
        }
        planes.extend((1..).zip(&self.tallies).map(|(label, tally)| {
            let fit =
                tally.fit.map(|fit| MapFit { gradient: [fit.abc[0], fit.abc[1]], offset: fit.abc[2], rms: fit.rms });
            let metric = || self.distances.get(usize::from(label) - 1)?.metric(tally, seen);
            Plane {
                label,
                pixel_count: tally.pixel_count,
                share_of_valid: share(tally.pixel_count, valid_pixels),
                bounding_box: tally.bounding_box,
                centroid: tally.centroid,
                fit,
                metric: metric(),
            }
        }));
    }

    /// Sums what the records need of every pixel's depth; its point only with a camera.
    fn measure_distances<T: Pixel>(
        &mut self,
        map: &DepthView<'_, T>,
        runs: &[LabelledRun],
        camera: Option<&Intrinsics>,
        depth_m: impl Fn(T) -> f64,
    ) {
        self.distances.reserve(self.tallies.capacity());
        self.distances.resize(self.tallies.len(), Distances::default());
        vectorised(
            #[inline(always)]
            || {
                for run in runs {
                    let at = usize::from(run.label) - 1;
                    if let Some(plane) = &self.tallies[at].inverse_depth {
                        self.distances[at].add(run, run.of(map), plane, camera, &depth_m);
                    }
                }
            },
        );
    }
}

impl Tally {
    /// A plane without a pixel.
    fn none() -> Self {
        Tally {
            pixel_count: 0,
            inner_pixels: 0,
            bounding_box: PixelBox { u_min: u32::MAX, v_min: u32::MAX, u_max: 0, v_max: 0 },
            centroid: [0.0; 2],
            fit: None,
            inverse_depth: None,
            origin: [0.0; 2],
            places: Moments::default(),
            value: Quantity::default(),
            inverse: Quantity::default(),
        }
    }

    fn begin(&mut self, run: &LabelledRun, value: f64, inverse: f64) {
        self.origin = [run.u_first.into(), run.v.into()];
        self.value.first = value;
        self.inverse.first = inverse;
    }

    fn finish(&mut self, sensor: &Sensor) {
        let [u, v] = self.origin;
        let places = &self.places;
        self.centroid = [u + places.u / places.n, v + places.v / places.n];
        self.fit = self.value.fit(places, self.origin);
        self.inverse_depth = match sensor.measure {
            Measure::Depth { .. } => self.inverse.fit(places, self.origin),
            Measure::InverseDepth { slope, offset } => self.fit.map(|fit| fit.scaled(slope, offset)),
            Measure::Disparity => None,
        };
    }
}

impl Tally {
    /// Sum of its points, metres, if its values are depths.
    fn points(&self, metres: f64, camera: &Intrinsics) -> [f64; 3] {
        let (first, sums) = (self.value.first, self.places.with(&self.value.sums));
        let ray = camera.ray(self.origin[0], self.origin[1]);
        let z = sums.q + first * sums.n;
        let (uz, vz) = (sums.uq + first * sums.u, sums.vq + first * sums.v); // about the origin
        [ray[0] * z + uz / camera.fx, ray[1] * z + vz / camera.fy, z].map(|sum| sum * metres)
    }

    /// Covariance of the coefficients in inverse depth by the noise; larger if the residuals are, by more than three
    /// standard deviations of their chi-squared. `None` if the noise is 0.
    fn covariance_by(&self, noise: &NoiseModel, sensor: &Sensor) -> Option<[[f64; 3]; 3]> {
        // Noise is known in map units where these are affine in inverse depth.
        let (fit, slope) = match sensor.measure {
            Measure::Depth { .. } => (self.inverse_depth?, 1.0),
            Measure::InverseDepth { slope, .. } => (self.fit?, slope),
            Measure::Disparity => return None,
        };
        let PixelBox { u_min, v_min, u_max, v_max } = self.bounding_box;
        let extent = [u_max - u_min + 1, v_max - v_min + 1].map(f64::from);
        let patch = Patch { gradient: [fit.abc[0], fit.abc[1]], extent, pixels: fit.n };
        let (covariance, expected) = fit.covariance_by(|q| noise.variance_in(&patch, q));
        if expected <= 0.0 {
            return None;
        }
        let ratio = fit.variance() / expected;
        let excess = if ratio > 1.0 + 3.0 * (2.0 / fit.n).sqrt() { ratio } else { 1.0 };
        Some(covariance.map(|row| row.map(|x| x * excess * slope * slope)))
    }
}

impl Quantity {
    #[inline(always)]
    fn add<T: Copy>(&mut self, u: f64, v: f64, values: &[T], quantity: impl Fn(T) -> f64) {
        let first = self.first;
        self.sums.add(u, v, values, |value| quantity(value) - first);
    }

    fn fit(&self, places: &Moments, [u, v]: [f64; 2]) -> Option<AffineFit> {
        places.with(&self.sums).fit().map(|fit| fit.moved([u, v, self.first]))
    }
}

impl PixelBox {
    fn include(&mut self, run: &LabelledRun) {
        self.u_min = self.u_min.min(run.u_first);
        self.u_max = self.u_max.max(run.u_last);
        self.v_min = self.v_min.min(run.v);
        self.v_max = self.v_max.max(run.v);
    }
}

/// The pixels at least `margin` away from the map's edge.
struct Margin {
    margin: u32,
    width: u32,
    height: u32,
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

impl Distances {
    #[inline(always)]
    fn add<T: Pixel>(
        &mut self,
        run: &LabelledRun,
        values: &[T],
        plane: &AffineFit,
        camera: Option<&Intrinsics>,
        depth_m: impl Fn(T) -> f64,
    ) {
        let (u, v) = (f64::from(run.u_first), f64::from(run.v));
        let (first, slope) = (plane.at(u, v), plane.abc[0]);
        let mut squares = [0.0; LANES];
        in_lanes(
            values,
            |k, value| 1.0 - depth_m(value) * (first + slope * k), // z (q - q of the plane)
            #[inline(always)]
            |_, relative| (0..LANES).for_each(|lane| squares[lane] += relative[lane] * relative[lane]),
        );
        (0..LANES).for_each(|lane| self.squares[lane] += squares[lane]);
        let is_behind = |z: f64| !(z > 0.0 && z < f64::INFINITY);
        if !T::IS_INTEGER || camera.is_some() {
            self.behind_infinity |= values.iter().fold(false, |any, &value| any | is_behind(depth_m(value)));
        }
        if let Some(camera) = camera {
            let mut sums = [[0.0; LANES]; 2];
            in_lanes(
                values,
                |_, value| depth_m(value),
                #[inline(always)]
                |k, depth| {
                    for lane in 0..LANES {
                        sums[0][lane] += depth[lane];
                        sums[1][lane] += k[lane] * depth[lane];
                    }
                },
            );
            let ([depth, by_k], ray) = (sums.map(|lanes| lanes.iter().sum::<f64>()), camera.ray(u, v));
            self.point[0] += ray[0] * depth + by_k / camera.fx;
            self.point[1] += ray[1] * depth;
            self.point[2] += depth;
        }
        self.add_area(run, plane);
    }

    /// Adds the area of the plane's part behind the squares of a run of pixels.
    ///
    /// With the rays r of a triangle's corners, `|det(r1, r2, r3)| / (6 q1 q2 q3)` is the volume of
    /// the pyramid from the camera over the triangle on the plane, a third of its area times the
    /// camera's distance; the determinant is twice the triangle's area on the picture over
    /// `|fx fy|`. A run's rectangle is two triangles that share two corners, and q is affine, so
    /// that they add up to `pixels q(middle) / (distance |fx fy| q1 q2 q3 q4)`.
    #[inline(always)]
    fn add_area(&mut self, run: &LabelledRun, plane: &AffineFit) {
        let (left, right) = (f64::from(run.u_first) - 0.5, f64::from(run.u_last) + 0.5);
        let (top, bottom) = (f64::from(run.v) - 0.5, f64::from(run.v) + 0.5);
        let corners = [plane.at(left, top), plane.at(right, top), plane.at(left, bottom), plane.at(right, bottom)];
        let middle = 0.25 * corners.iter().sum::<f64>();
        self.area += (right - left) * middle / corners.iter().product::<f64>();
        self.reaches_infinity |= corners.iter().any(|&q| q <= 0.0);
    }

    /// The metric plane: a point's distance from it is z |q - q of the plane| times the plane's
    /// distance from the camera, since n . P + d = d (1 - z m . r).
    fn metric(&self, tally: &Tally, seen: &Seen<'_>) -> Option<MetricPlane> {
        let camera = &seen.sensor.intrinsics?;
        let fit = tally.inverse_depth.filter(|_| !self.behind_infinity)?;
        let plane = fit::hessian(&fit, camera)?;
        let n = tally.pixel_count as f64;
        let (covariance, covariance_from) = match seen.noise.and_then(|noise| tally.covariance_by(noise, seen.sensor)) {
            Some(covariance) => (covariance, CovarianceSource::Noise),
            None => (fit.covariance(), CovarianceSource::Residuals),
        };
        let area = self.area / (plane.distance * (camera.fx * camera.fy).abs());
        Some(MetricPlane {
            plane,
            rms_m: (self.squares.iter().sum::<f64>() / n).sqrt() * plane.distance,
            centroid_m: self.point.map(|sum| sum / n),
            area_m2: Some(area).filter(|area| !self.reaches_infinity && area.is_finite()),
            covariance: fit::metric_covariance(fit.abc, &covariance, camera),
            covariance_from,
        })
    }
}
