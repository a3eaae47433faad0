//! The picture that a pinhole camera in the lens's place would have made.
//!
//! In: size of a map, intrinsics, distortion. Out: a table, made once: where each pixel of the pinhole picture lies in
//! the map, and which pixel of the picture a pixel of the map is. Then maps one after the other.
//!
//! The picture keeps the focal lengths, so that its pixels are those of the map in the middle, and covers all rays of the map
//! within [`WIDEST`] of the axis. It has at most [`LARGEST`] times the map's pixels: where it would have more, its focal
//! lengths are smaller.

use super::distortion::Distortion;
use super::table::{Table, is_within};
use crate::camera::{Intrinsics, ValueKind};
use crate::error::Result;
use crate::limits::{MAX_PIXELS, MAX_SIDE};
use crate::map::{DepthView, Pixel, Validity};
use crate::noise::{Rounding, RoundingFinder, Space};

/// Tangent of the widest angle from the axis that the picture covers, 75 degrees: our choice, beyond it a pinhole picture of
/// bearable size has no pixels left for the middle.
const WIDEST: f64 = 3.732;

/// The most pixels of the picture, as a multiple of the map's: our choice.
const LARGEST: f64 = 4.0;

/// Largest difference of four neighbours' inverse depths, as a share of the smallest, between which there is no edge:
/// our choice. On a floor 1.2 m below a camera with a focal length of 250 pixels neighbours 4 m away differ by 1.3 %.
const SMOOTH: f64 = 0.05;

/// Fewest steps of the map's values by which four neighbours differ if a value between them is better than the nearest: our
/// choice. Nearest pixels keep the steps of coarse values, by which the noise is told; values between them keep slanted
/// planes smooth. (Rooms behind seven lenses: with nearest pixels alone a floor in millimetres falls apart, with values between
/// alone a room in eighths of a pixel has 18 planes for 3.)
const STEPS: f64 = 2.0;

/// How far beyond the centres of the map's outermost pixels a place may lie, pixels: what rounding makes of a place on them.
/// Farther out no four pixels surround it, and the nearest one alone would bend a slanted plane along the border of the map.
const BEYOND: f64 = 0.01;

/// No pixel.
pub(super) const NONE: u32 = u32::MAX;

/// The pixel nearest to a place, which is not below -0.5; the system's own rounding takes several times as long.
#[inline]
fn nearest(place: f32) -> usize {
    (place + 0.5) as usize
}

/// The table for maps of one size.
#[derive(Debug)]
pub(super) struct Rectifier {
    width: usize,
    height: usize,
    camera: Intrinsics,
    distortion: Distortion,
    /// The camera of the picture.
    pub(super) pinhole: Intrinsics,
    /// Columns and rows of the picture.
    pub(super) size: [usize; 2],
    /// For each pixel of the picture its place in the map; NaN outside of it.
    places: Vec<[f32; 2]>,
    /// For each pixel of the map the pixel of the picture that shows it, or [`NONE`].
    pub(super) back: Vec<u32>,
}

impl Rectifier {
    /// Whether it is for that map and camera.
    pub(super) fn is_for(&self, size: [usize; 2], camera: &Intrinsics, distortion: &Distortion) -> bool {
        size == [self.width, self.height] && self.camera == *camera && self.distortion == *distortion
    }

    pub(super) fn new([width, height]: [usize; 2], camera: &Intrinsics, distortion: &Distortion) -> Self {
        let rays = rays([width, height], camera, distortion);
        let bounds = bounds(&rays);
        let (pinhole, size) = picture(bounds, camera, width * height);
        let places = places(&pinhole, size, camera, distortion, [width, height]);
        let back = back(&rays, &pinhole, size, &places, width);
        Rectifier { width, height, camera: *camera, distortion: *distortion, pinhole, size, places, back }
    }

    /// The pinhole picture of a map, 0 where it shows nothing. A value is that of the nearest pixel, or, where the pixels around
    /// the place differ by more than [`STEPS`] but without an edge, between theirs by inverse depth, which is affine on
    /// planes. Beside missing pixels the plane of the pixel's other neighbours is carried on: the nearest value alone would bend
    /// a slanted plane along the gap.
    pub(super) fn resample<T: Pixel>(
        &self,
        map: &DepthView<'_, T>,
        value_kind: &ValueKind,
        finder: &mut RoundingFinder,
        out: &mut Vec<T>,
    ) {
        let space = Space::of(*value_kind);
        let values = Values { validity: map.validity(), rounding: finder.find(map, space), space };
        out.clear();
        out.reserve(self.places.len());
        out.extend(self.places.iter().map(|&place| values.at(map, place)));
    }

    /// An image of the map as the picture shows it, nearest pixels; 0 where it shows nothing.
    pub(super) fn nearest(&self, image: &DepthView<'_, u16>) -> Vec<u16> {
        let place = |&[u, v]: &[f32; 2]| {
            let near = |place: f32, side: usize| nearest(place).min(side - 1);
            if u.is_nan() { 0 } else { image.row(near(v, image.height()))[near(u, image.width())] }
        };
        self.places.iter().map(place).collect()
    }

    /// The view of a picture made by [`Rectifier::resample`].
    pub(super) fn view<'a, T: Pixel>(&self, map: &DepthView<'_, T>, pixels: &'a [T]) -> Result<DepthView<'a, T>> {
        let Validity { low, high, sentinel } = map.validity();
        let view = DepthView::new(pixels, self.size[0], self.size[1])?.missing_value(sentinel);
        if low < high { view.valid_range(low, high) } else { Ok(view) }
    }
}

/// What is known of a map's values.
struct Values<T> {
    validity: Validity<T>,
    rounding: Rounding,
    space: Space,
}

impl<T: Pixel> Values<T> {
    /// The value of a map at a place between its pixels.
    #[inline]
    fn at(&self, map: &DepthView<'_, T>, [u, v]: [f32; 2]) -> T {
        if u.is_nan() {
            return T::ZERO;
        }
        let (width, height) = (map.width(), map.height());
        let (column, row) = (nearest(u).min(width - 1), nearest(v).min(height - 1));
        let nearest = map.row(row)[column];
        if !self.validity.holds(nearest) {
            return T::ZERO;
        }
        let (du, dv) = (f64::from(u) - column as f64, f64::from(v) - row as f64);
        let q = self.turned(nearest.into());
        // The neighbour towards the place, or, where there is none, the one on the other side: the plane goes on.
        let side = |ahead: f64, neighbour: &dyn Fn(isize) -> Option<f64>| {
            let ahead = if ahead < 0.0 { -1 } else { 1 };
            neighbour(ahead).map(|q| (ahead, q)).or_else(|| neighbour(-ahead).map(|q| (-ahead, q)))
        };
        let value = |column: Option<usize>, row: Option<usize>| {
            let value = *map.row(row.filter(|&row| row < height)?).get(column?)?;
            self.validity.holds(value).then(|| self.turned(value.into()))
        };
        let along = side(du, &|step| value(column.checked_add_signed(step), Some(row)));
        let across = side(dv, &|step| value(Some(column), row.checked_add_signed(step)));
        let corner = along
            .zip(across)
            .and_then(|((du, _), (dv, _))| value(column.checked_add_signed(du), row.checked_add_signed(dv)));
        let known = [Some(q), along.map(|(_, q)| q), across.map(|(_, q)| q), corner];
        let (least, most) = known.into_iter().flatten().fold((f64::MAX, f64::MIN), |(a, b), q| (a.min(q), b.max(q)));
        let is_edge = most - least > SMOOTH * least.abs().min(most.abs());
        if is_edge || most - least <= STEPS * self.rounding.step(q) {
            return nearest;
        }
        let slope = |side: Option<(isize, f64)>| side.map_or(0.0, |(step, other)| (other - q) / step as f64);
        let (a, b) = (slope(along), slope(across));
        // Of four pixels, what the fourth adds to the plane of three.
        let twist = match (along, across, corner) {
            (Some((u, along)), Some((v, across)), Some(corner)) => (corner + q - along - across) / (u * v) as f64,
            _ => 0.0,
        };
        let value = T::from_f64(self.turned(q + a * du + b * dv + twist * du * dv));
        if self.validity.holds(value) { value } else { nearest }
    }

    /// q of a value, or the value of a q: both are the same formula.
    #[inline]
    fn turned(&self, value: f64) -> f64 {
        match self.space {
            Space::InverseDepth { metres } => 1.0 / (metres * value),
            Space::Value => value,
        }
    }
}

/// The undistorted normalised coordinates of each pixel of the map; NaN where the lens puts nothing, and beyond [`WIDEST`].
fn rays([width, height]: [usize; 2], camera: &Intrinsics, distortion: &Distortion) -> Vec<[f32; 2]> {
    let mut table = Table::of(distortion);
    let mut rays = Vec::with_capacity(width * height);
    for v in 0..height {
        let y = (v as f64 - camera.cy) / camera.fy;
        rays.extend((0..width).map(|u| {
            let straight =
                table.undistort([(u as f64 - camera.cx) / camera.fx, y]).filter(|&ray| is_within(ray, WIDEST));
            straight.map_or([f32::NAN; 2], |ray| ray.map(|side| side as f32))
        }));
    }
    rays
}

/// Smallest and largest x and y of the rays; the axis alone if there is none.
fn bounds(rays: &[[f32; 2]]) -> [[f64; 2]; 2] {
    let mut bounds = [[f64::MAX, f64::MIN]; 2];
    for ray in rays.iter().filter(|ray| !ray[0].is_nan()) {
        for (bound, side) in bounds.iter_mut().zip(ray.map(f64::from)) {
            *bound = [bound[0].min(side), bound[1].max(side)];
        }
    }
    if bounds[0][0] > bounds[0][1] { [[0.0; 2]; 2] } else { bounds }
}

/// The camera of the picture and its size.
fn picture([xs, ys]: [[f64; 2]; 2], camera: &Intrinsics, map_pixels: usize) -> (Intrinsics, [usize; 2]) {
    let Intrinsics { fx, fy, .. } = *camera;
    let spans = [(xs[1] - xs[0]) * fx.abs() + 1.0, (ys[1] - ys[0]) * fy.abs() + 1.0];
    let most = (LARGEST * map_pixels as f64).min(MAX_PIXELS as f64);
    let side = (MAX_SIDE - 1) as f64;
    let scale = (most / (spans[0] * spans[1])).sqrt().min(side / spans[0]).min(side / spans[1]).min(1.0);
    let axis = |f: f64, [low, high]: [f64; 2], span: f64| {
        let f = f * scale;
        let first = if f > 0.0 { low * f } else { high * f };
        (f, -first, (span * scale).ceil().max(1.0) as usize)
    };
    let ((fx, cx, width), (fy, cy, height)) = (axis(fx, xs, spans[0]), axis(fy, ys, spans[1]));
    (Intrinsics { fx, fy, cx, cy }, [width, height])
}

/// The places in the map of the picture's pixels.
fn places(
    pinhole: &Intrinsics,
    [columns, rows]: [usize; 2],
    camera: &Intrinsics,
    distortion: &Distortion,
    [width, height]: [usize; 2],
) -> Vec<[f32; 2]> {
    let is_inside = |place: f64, side: usize| place >= -BEYOND && place <= side as f64 - 1.0 + BEYOND;
    let mut table = Table::of(distortion);
    let mut places = Vec::with_capacity(columns * rows);
    for row in 0..rows {
        let y = (row as f64 - pinhole.cy) / pinhole.fy;
        places.extend((0..columns).map(|column| {
            // Beyond the fold of a formula other rays have the same pixels.
            let place = table.distort([(column as f64 - pinhole.cx) / pinhole.fx, y]);
            let place = place.map(|[x, y]| [camera.fx * x + camera.cx, camera.fy * y + camera.cy]);
            let inside = place.filter(|&[u, v]| is_inside(u, width) && is_inside(v, height));
            inside.map_or([f32::NAN; 2], |place| place.map(|side| side as f32))
        }));
    }
    places
}

/// For each pixel of the map the picture's pixel nearest to its ray; of those around it one that shows this very pixel, if
/// there is one.
fn back(
    rays: &[[f32; 2]],
    pinhole: &Intrinsics,
    [columns, rows]: [usize; 2],
    places: &[[f32; 2]],
    width: usize,
) -> Vec<u32> {
    let shows = |at: usize| {
        let [u, v] = places[at];
        (!u.is_nan()).then(|| nearest(v) * width + nearest(u))
    };
    let find = |(pixel, ray): (usize, &[f32; 2])| {
        if ray[0].is_nan() {
            return NONE;
        }
        let [u, v] = pinhole.project([f64::from(ray[0]), f64::from(ray[1]), 1.0]);
        let (column, row) = (nearest(u as f32).min(columns - 1), nearest(v as f32).min(rows - 1));
        let centre = row * columns + column;
        if shows(centre) == Some(pixel) {
            return centre as u32; // so it is for most
        }
        let around = [0, -1, 1].into_iter().flat_map(|dv| [0, -1, 1].map(|du| (du, dv)));
        let around = around.filter_map(|(du, dv): (isize, isize)| {
            let (u, v) = (column.checked_add_signed(du)?, row.checked_add_signed(dv)?);
            (u < columns && v < rows).then_some(v * columns + u)
        });
        let same = around.clone().find(|&at| shows(at) == Some(pixel));
        same.or_else(|| around.into_iter().find(|&at| shows(at).is_some())).map_or(NONE, |at| at as u32)
    };
    rays.iter().enumerate().map(find).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lens::distortion::DistortionModel::{BrownConrady, KannalaBrandt};

    fn rectifier(model: super::super::distortion::DistortionModel, coefficients: &[f64], focal: f64) -> Rectifier {
        let camera = Intrinsics { fx: focal, fy: focal, cx: 79.5, cy: 59.5 };
        Rectifier::new([160, 120], &camera, &Distortion::new(model, coefficients).unwrap())
    }

    #[test]
    fn every_pixel_of_the_map_has_one_of_the_picture() {
        for (coefficients, focal) in [(&[-0.2, 0.03][..], 126.0), (&[0.15], 126.0), (&[-0.05], 252.0)] {
            let made = rectifier(BrownConrady, coefficients, focal);
            assert!(made.back.iter().all(|&at| at != NONE), "{coefficients:?}");
            assert!(made.size[0] * made.size[1] <= 4 * 160 * 120 + 1000);
            let [u, v] = made.places[made.back[60 * 160 + 20] as usize];
            assert!((u - 20.0).abs() < 1.0 && (v - 60.0).abs() < 1.0, "{u} {v}");
        }
    }

    #[test]
    fn the_picture_of_a_fisheye_is_bounded() {
        let made = rectifier(KannalaBrandt, &[0.0; 4], 51.0);
        assert!(made.size[0] * made.size[1] <= 4 * 160 * 120 + 1000, "{:?}", made.size);
        assert!(made.back[60 * 160 + 80] != NONE && made.back[0] == NONE);
    }

    #[test]
    fn values_between_pixels_of_a_plane_are_on_it() {
        let made = rectifier(BrownConrady, &[-0.2], 126.0);
        let truth = |u: f64, v: f64| 1.0 / (0.25 + 0.00107 * u - 0.00043 * v);
        let pixels: Vec<f32> = (0..160 * 120).map(|at| truth((at % 160) as f64, (at / 160) as f64) as f32).collect();
        let map = DepthView::new(&pixels, 160, 120).unwrap();
        let mut out = Vec::new();
        made.resample(&map, &ValueKind::Depth { metres: 1.0 }, &mut RoundingFinder::default(), &mut out);
        for (&value, &[u, v]) in out.iter().zip(&made.places) {
            if u > 0.0 && v > 0.0 && u < 159.0 && v < 119.0 {
                assert!((f64::from(value) - truth(u.into(), v.into())).abs() < 1e-4);
            }
        }
    }
}
