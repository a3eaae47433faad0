//! A plane's outline as it stands in JSON; docs/planes-schema.md describes each field.

use depthplanes::outline::{Outline, Polygon, Rectangle, Ring};
use serde::Serialize;

#[derive(Serialize)]
pub(super) struct OutlineRecord {
    polygons_px: Vec<PolygonRecord<2>>,
    hull_px: Points<2>,
    rectangle_px: RectangleRecord<2>,
    polygons_m: Option<Vec<PolygonRecord<3>>>,
    hull_m: Option<Points<3>>,
    rectangle_m: Option<RectangleRecord<3>>,
}

#[derive(Serialize)]
struct PolygonRecord<const N: usize> {
    outer: Points<N>,
    holes: Vec<Points<N>>,
}

#[derive(Serialize)]
struct RectangleRecord<const N: usize> {
    centre: Point<N>,
    axes: [Point<N>; 2],
    sides: Point<2>,
}

type Points<const N: usize> = Vec<Point<N>>;

/// A point or vector, which is written as a list of its numbers.
struct Point<const N: usize>([f64; N]);

impl<const N: usize> Serialize for Point<N> {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_seq(self.0)
    }
}

impl From<Outline<'_>> for OutlineRecord {
    fn from(outline: Outline<'_>) -> Self {
        OutlineRecord {
            polygons_px: outline.polygons().map(|polygon| polygon_of(&polygon, &points_px)).collect(),
            hull_px: points_px(&outline.hull()),
            rectangle_px: rectangle(outline.rectangle_px()),
            polygons_m: outline
                .is_metric()
                .then(|| outline.polygons().map(|polygon| polygon_of(&polygon, &points_m)).collect()),
            hull_m: outline.is_metric().then(|| points_m(&outline.hull())),
            rectangle_m: outline.rectangle_m().map(rectangle),
        }
    }
}

fn polygon_of<const N: usize>(polygon: &Polygon<'_>, points: &dyn Fn(&Ring<'_>) -> Points<N>) -> PolygonRecord<N> {
    PolygonRecord { outer: points(&polygon.outer()), holes: polygon.holes().map(|hole| points(&hole)).collect() }
}

fn points_px(ring: &Ring<'_>) -> Points<2> {
    ring.points_px().map(Point).collect()
}

fn points_m(ring: &Ring<'_>) -> Points<3> {
    ring.points_m().into_iter().flatten().map(rounded).collect()
}

fn rectangle<const N: usize>(found: Rectangle<N>) -> RectangleRecord<N> {
    RectangleRecord { centre: rounded(found.centre), axes: found.axes.map(Point), sides: rounded(found.sides) }
}

/// Pixels or metres rounded to a millionth, which halves the text.
fn rounded<const N: usize>(numbers: [f64; N]) -> Point<N> {
    Point(numbers.map(|x| (x * 1e6).round() / 1e6 + 0.0))
}
