//! What each pixel is by its height above the floor: floor, obstacle or drop.
//!
//! A pixel of depth z on the ray r is `h = z (n . r) + d` above the floor `n . P + d = 0`. Along a row n . r is affine, so
//! a pixel takes one multiplication and addition for n . r, one for h, and comparisons with the margin, which holds for a
//! block of pixels. Planes say more than heights do: pixels of the floor's pieces are floor, and those of upright planes are
//! none, down to the crease between them.

use super::class::ClassifiedPlane;
use super::floor::Floor;
use super::space::height_variance;
use crate::camera::ValueKind;
use crate::detection::Detection;
use crate::map::{AnyView, DepthView, Pixel, with_view};
use crate::noise::{NoiseModel, SensorNoise};
use crate::sensor::Sensor;
use crate::util::simd::vectorised;
use crate::util::vec3::dot;

/// A pixel that has no value, or lies on a ray that the lens does not have.
pub const UNKNOWN: u8 = 0;
/// A pixel on the floor, within what the sensor and the floor's plane may err.
pub const FLOOR: u8 = 1;
/// A pixel above the floor, up to [`CLEARANCE_M`].
pub const OBSTACLE: u8 = 2;
/// A pixel below the floor: a hole, or stairs that lead down.
pub const DROP: u8 = 4;
/// A pixel higher above the floor than [`CLEARANCE_M`].
pub const OVERHEAD: u8 = 8;

/// Metres above the floor from where on nothing is in the way: higher than a person.
pub const CLEARANCE_M: f64 = 2.0;

/// Metres from the floor at which a pixel is off it at least, however exact the sensor: what small wheels roll over, and
/// what floors are uneven by.
const LEAST_M: f64 = 0.02;
/// Metres above the floor from where on a pixel is an obstacle however badly the floor is known: safe is better than sure.
const MOST_M: f64 = 0.1;
/// Standard deviations at which a pixel is off the floor: of a million pixels 60 are by chance.
const SIGNIFICANT: f64 = 4.0;
/// Metres of range at which the margin is taken at most; rays that meet the floor farther away are nearly level, and the
/// error of depth does not lift their pixels.
const FARTHEST_M: f64 = 20.0;
/// Columns and rows that share a margin; over them the range of the floor changes by a tenth.
const BLOCK: [usize; 2] = [64, 8];
/// Degrees between the floor and planes that stand on it, such as walls and sides of boxes: their pixels are none of the
/// floor's, however near to it. Ramps are less steep than the first, undersides more than the second.
const UPRIGHT_DEG: std::ops::RangeInclusive<f64> = 60.0..=120.0;
/// Pieces of the floor whose pixels are floor whatever their height: the largest.
const PIECES: usize = 4;

/// How far a pixel of the floor may seem off it.
pub(super) struct Margin<'a> {
    floor: &'a Floor,
    parts: [Option<NoiseModel>; 2],
}

impl<'a> Margin<'a> {
    /// By the floor's covariance and the noise that was expected of the map.
    pub(super) fn new(floor: &'a Floor, found: &Detection, sensor: &Sensor) -> Self {
        let model = |noise: SensorNoise| NoiseModel::new(sensor.value_kind, noise, 0.0);
        let white = found.noise.and_then(|noise| model(noise.white));
        let smooth = found.noise.and_then(|noise| model(noise.smooth?));
        Margin { floor, parts: [white, smooth] }
    }

    /// Metres, at the floor's point on a ray.
    fn on(&self, ray: [f64; 3]) -> f64 {
        let slope = dot(self.floor.plane.normal, ray);
        if slope >= 0.0 {
            return LEAST_M; // the ray does not meet the floor
        }
        let depth = (-self.floor.plane.distance / slope).min(FARTHEST_M);
        let of_floor = height_variance(&self.floor.covariance, ray.map(|r| r * depth));
        let sigma = |model: &NoiseModel| model.depth_sigma_m(depth).unwrap_or(0.0);
        let of_pixel = self.parts.iter().flatten().map(|model| (slope * sigma(model)).powi(2)).sum::<f64>();
        LEAST_M.max(SIGNIFICANT * (of_floor + of_pixel).sqrt())
    }
}

/// Marks the pixels of a map, row by row. `planes` are those of the detection, in its order.
pub(super) fn mark(
    map: AnyView<'_>,
    found: &Detection,
    sensor: &Sensor,
    floor: &Floor,
    planes: &[ClassifiedPlane],
    marks: &mut Vec<u8>,
) {
    marks.resize(found.labels.len(), UNKNOWN);
    let margin = Margin::new(floor, found, sensor);
    let mut pieces = [0; PIECES];
    pieces.iter_mut().zip(&floor.labels).for_each(|(piece, &label)| *piece = label);
    let rows = Rows { sensor, floor, margin, labels: &found.labels, planes, pieces };
    with_view!(map, view => vectorised(
        // Inlined by order: a closure of its own would be compiled without the vectors.
        #[inline(always)]
        || rows.mark(view, marks),
    ));
}

struct Rows<'a> {
    sensor: &'a Sensor,
    floor: &'a Floor,
    margin: Margin<'a>,
    labels: &'a [u16],
    planes: &'a [ClassifiedPlane],
    pieces: [u16; PIECES],
}

/// n . r along a block, the pixels' margins, and the camera's height.
#[derive(Clone, Copy)]
struct Line {
    start: f32,
    step: f32,
    /// Metres above and below the floor from where on a pixel is off it.
    above: f32,
    below: f32,
    height: f32,
}

impl Rows<'_> {
    #[inline(always)]
    fn mark<T: Pixel>(&self, view: DepthView<'_, T>, marks: &mut [u8]) {
        let (width, height) = (view.width(), view.height());
        for top in (0..height).step_by(BLOCK[1]) {
            let bottom = (top + BLOCK[1]).min(height);
            for first in (0..width).step_by(BLOCK[0]) {
                let last = (first + BLOCK[0]).min(width);
                let Some([above, below]) = self.lines([first, last], [top, bottom]) else {
                    (top..bottom).for_each(|v| marks[v * width + first..v * width + last].fill(UNKNOWN));
                    continue;
                };
                let rows = (bottom - top - 1).max(1) as f32;
                for v in top..bottom {
                    let share = (v - top) as f32 / rows;
                    let between = |above: f32, below: f32| above + share * (below - above);
                    let (start, step) = (between(above.start, below.start), between(above.step, below.step));
                    let line = Line { start, step, ..above };
                    let range = v * width + first..v * width + last;
                    let labels = &self.labels[range.clone()];
                    self.mark_block(view, &view.row(v)[first..last], labels, &mut marks[range], line);
                }
            }
        }
    }

    /// The lines of a block's first and last row; `None` where the lens has no rays.
    fn lines(&self, [first, last]: [usize; 2], [top, bottom]: [usize; 2]) -> Option<[Line; 2]> {
        let middle = self.sensor.ray((first + last) as f64 / 2.0, (top + bottom) as f64 / 2.0)?;
        let margin = self.margin.on(middle) as f32;
        let slope = |u: usize, v: usize| Some(dot(self.floor.plane.normal, self.sensor.ray(u as f64, v as f64)?));
        let line = |v: usize| {
            let (start, end) = (slope(first, v)?, slope(last - 1, v)?);
            let step = (end - start) / (last - first - 1).max(1) as f64;
            let [start, step, height] = [start, step, self.floor.plane.distance].map(|number| number as f32);
            Some(Line { start, step, above: margin.min(MOST_M as f32), below: margin, height })
        };
        Some([line(top)?, line(bottom - 1)?])
    }

    #[inline(always)]
    fn mark_block<T: Pixel>(&self, view: DepthView<'_, T>, values: &[T], labels: &[u16], marks: &mut [u8], line: Line) {
        match self.sensor.value_kind {
            ValueKind::Depth { metres } => {
                let metres = metres as f32;
                let height = |value: f32, slope: f32| value * metres * slope + line.height;
                self.mark_sized(view, values, labels, marks, line, height);
            }
            ValueKind::InverseDepth { slope: scale, offset } => {
                let (scale, offset) = (scale as f32, offset as f32);
                let height = |value: f32, slope: f32| {
                    let inverse = scale * value + offset;
                    if inverse > 0.0 { slope / inverse + line.height } else { f32::NAN }
                };
                self.mark_sized(view, values, labels, marks, line, height);
            }
            ValueKind::Disparity => marks.fill(UNKNOWN), // not metric, and so without a floor
        }
    }

    /// As `mark_by`, which is compiled for whole blocks by themselves: their vectors have no rest.
    #[inline(always)]
    fn mark_sized<T: Pixel>(
        &self,
        view: DepthView<'_, T>,
        values: &[T],
        labels: &[u16],
        marks: &mut [u8],
        line: Line,
        height: impl Fn(f32, f32) -> f32,
    ) {
        match values.first_chunk::<{ BLOCK[0] }>() {
            Some(values) => self.mark_by(view, values, labels, marks, line, height),
            None => self.mark_by(view, values, labels, marks, line, height),
        }
    }

    #[inline(always)]
    fn mark_by<T: Pixel>(
        &self,
        view: DepthView<'_, T>,
        values: &[T],
        labels: &[u16],
        marks: &mut [u8],
        line: Line,
        height: impl Fn(f32, f32) -> f32,
    ) {
        let (valid, [a, b, c, d]) = (view.validity(), self.pieces);
        let (labels, marks) = (&labels[..values.len()], &mut marks[..values.len()]);
        let mut is_doubtful = false;
        // By number, which the compiler makes vectors of.
        for at in 0..values.len() {
            let (value, label) = (values[at], labels[at]);
            let height = height(value.to_f32(), line.start + line.step * (at as i32 as f32));
            let is_piece = (label != 0) & ((label == a) | (label == b) | (label == c) | (label == d));
            let mut is = FLOOR;
            is = if height > line.above { OBSTACLE } else { is };
            is = if height < -line.below { DROP } else { is };
            is = if is_piece { FLOOR } else { is };
            is = if height > CLEARANCE_M as f32 { OVERHEAD } else { is };
            marks[at] = if valid.holds(value) & (height.abs() < f32::INFINITY) { is } else { UNKNOWN };
            is_doubtful |= (label != 0) & !is_piece & (marks[at] == FLOOR);
        }
        if is_doubtful {
            self.mark_upright(labels, marks);
        }
    }

    /// Pixels of upright planes are no floor, even where they are too low to tell by their height.
    fn mark_upright(&self, labels: &[u16], marks: &mut [u8]) {
        for (mark, &label) in marks.iter_mut().zip(labels).filter(|(mark, label)| **mark == FLOOR && **label != 0) {
            let ClassifiedPlane { slope_deg, height_m, .. } = self.planes[usize::from(label) - 1];
            if slope_deg.is_some_and(|slope| UPRIGHT_DEG.contains(&slope)) {
                // The sides of a hole are below the floor.
                *mark = if height_m.is_some_and(|height| height < 0.0) { DROP } else { OBSTACLE };
            }
        }
    }
}
