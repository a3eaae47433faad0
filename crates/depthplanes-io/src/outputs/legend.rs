//! The legend: a column beside the picture, and small numbers on the planes it names.

use super::colour::colour;
use super::depth::depth_m;
use super::font;
use super::picture::Picture;
use depthplanes::{Detection, Plane, ValueKind};

const PAPER: [u8; 3] = [38, 38, 44];
const INK: [u8; 3] = [232, 232, 232];
const FAINT: [u8; 3] = [176, 176, 182];
/// Greys of the picture where there is no plane, and where nothing was measured.
const NO_PLANE: [u8; 3] = [128; 3];
const NO_DATA: [u8; 3] = [0; 3];
/// Rows that say so.
const GREYS: usize = 2;
/// Pictures at least this high get letters of twice the size.
const TALL: usize = 360;
/// Even a small picture names this many planes.
const FEWEST_ROWS: usize = 6;

/// The picture with the legend at its right.
pub(super) fn beside(picture: &Picture, detection: &Detection, value_kind: ValueKind) -> Picture {
    let layout = Layout::of(picture.height, detection, value_kind);
    let mut whole = Picture::filled(picture.width + layout.width, picture.height.max(layout.height), PAPER);
    whole.paste(picture, [0, 0]);
    layout.draw(&mut whole, picture.width);
    whole
}

/// The columns: label, pixels, depth at the middle and distance of the plane where these are known.
const HEADING: [&str; COLUMNS] = ["plane", "pixels", "depth", "distance"];
const COLUMNS: usize = 4;

/// What a row says of a plane; the first row is the heading.
struct Row {
    swatch: Option<[u8; 3]>,
    cells: [String; COLUMNS],
}

struct Layout {
    rows: Vec<Row>,
    columns: [usize; COLUMNS],
    scale: usize,
    width: usize,
    height: usize,
}

impl Layout {
    fn of(picture_height: usize, detection: &Detection, value_kind: ValueKind) -> Layout {
        let scale = letter_scale(picture_height);
        let rows = rows(planes_that_fit(picture_height, scale), detection, value_kind);
        let widest = |column: usize| rows.iter().map(|row| font::width(&row.cells[column], scale)).max().unwrap_or(0);
        let columns = std::array::from_fn(widest);
        let gap = |column: &usize| if *column == 0 { 0 } else { column + 2 * font::ADVANCE * scale };
        let width = margin(scale) + swatch_side(scale) + margin(scale) + columns.iter().map(gap).sum::<usize>();
        let height = 2 * margin(scale) + rows.len() * row_height(scale);
        Layout { rows, columns, scale, width, height }
    }

    fn draw(&self, whole: &mut Picture, left: usize) {
        let scale = self.scale;
        for (i, row) in self.rows.iter().enumerate() {
            let top = margin(scale) + i * row_height(scale);
            if let Some(swatch) = row.swatch {
                whole.fill([left + margin(scale), top], [swatch_side(scale); 2], swatch);
            }
            let mut u = left + margin(scale) + swatch_side(scale) + margin(scale);
            for (column, text) in row.cells.iter().enumerate().filter(|(column, _)| self.columns[*column] > 0) {
                let start = u + self.columns[column] - font::width(text, scale).min(self.columns[column]);
                let ink = if column == 0 && row.swatch.is_some() { INK } else { FAINT };
                font::write(whole, [start, top + scale], scale, ink, text);
                u += self.columns[column] + 2 * font::ADVANCE * scale;
            }
        }
    }
}

fn letter_scale(picture_height: usize) -> usize {
    if picture_height >= TALL { 1 + picture_height / TALL } else { 1 }
}

fn margin(scale: usize) -> usize {
    4 * scale
}

fn swatch_side(scale: usize) -> usize {
    (font::HEIGHT + 2) * scale
}

fn row_height(scale: usize) -> usize {
    (font::HEIGHT + 5) * scale
}

/// Rows below the heading.
fn planes_that_fit(picture_height: usize, scale: usize) -> usize {
    let rows = picture_height.saturating_sub(2 * margin(scale)) / row_height(scale);
    rows.saturating_sub(1 + GREYS).max(FEWEST_ROWS)
}

/// How many planes have a row; where not all fit, the last row counts the others.
fn planes_named(fitting: usize, detection: &Detection) -> usize {
    let planes = detection.planes.len();
    if planes > fitting { fitting - 1 } else { planes }
}

fn rows(fitting: usize, detection: &Detection, value_kind: ValueKind) -> Vec<Row> {
    let planes = &detection.planes;
    let named = planes_named(fitting, detection);
    let row_of = |swatch, text: String| Row { swatch, cells: [String::new(), text, String::new(), String::new()] };
    let told = |text| row_of(None, text);
    let is_missing = detection.valid_pixels < detection.labels.len();
    let is_left = detection.labelled_pixels() < detection.valid_pixels;
    let greys = [(is_left, NO_PLANE, "no plane"), (is_missing, NO_DATA, "no data")];
    let greys = greys.into_iter().filter(|(is_there, ..)| *is_there);
    let greys = greys.map(|(_, swatch, text)| row_of(Some(swatch), text.into()));
    if planes.is_empty() {
        return [told("no planes".into())].into_iter().chain(greys).collect();
    }
    let mut rows: Vec<Row> = planes[..named].iter().map(|plane| row(plane, value_kind)).collect();
    // A column of which nothing is known has no heading.
    let heads = |column: usize| column < 2 || rows.iter().any(|row| !row.cells[column].is_empty());
    let heading = std::array::from_fn(|column| if heads(column) { HEADING[column].into() } else { String::new() });
    rows.insert(0, Row { swatch: None, cells: heading });
    if named < planes.len() {
        rows.push(told(format!("+{} more", planes.len() - named)));
    }
    rows.extend(greys);
    rows
}

fn row(plane: &Plane, value_kind: ValueKind) -> Row {
    let metres = |length: Option<f64>| length.map(|metres| format!("{metres:.2} m")).unwrap_or_default();
    let distance = plane.metric.map(|metric| metric.plane.distance);
    let depth = metres(depth_m(plane, value_kind));
    Row {
        swatch: Some(colour(plane.label)),
        cells: [plane.label.to_string(), plane.pixel_count.to_string(), depth, metres(distance)],
    }
}

/// Writes the names of the planes that a legend lists onto them, where there is room.
pub(super) fn number_planes(picture: &mut Picture, detection: &Detection, name: impl Fn(u16) -> String) {
    let scale = letter_scale(picture.height);
    let named = planes_named(planes_that_fit(picture.height, scale), detection);
    let anchors = anchors(detection, named, scale);
    let mut written: Vec<Area> = Vec::new();
    for (plane, anchor) in detection.planes[..named].iter().zip(anchors) {
        let text = name(plane.label);
        let area = Area::around(anchor, &text, scale, picture);
        let small = plane.pixel_count < 3 * area.size[0] * area.size[1];
        if small || written.iter().any(|other| other.touches(&area)) {
            continue;
        }
        let corner = area.corner.map(|side| side + scale);
        halo(picture, corner, scale, &text);
        font::write(picture, corner, scale, [255; 3], &text);
        written.push(area);
    }
}

/// What a number and its halo cover.
struct Area {
    corner: [usize; 2],
    size: [usize; 2],
}

impl Area {
    /// The area of a text centred on a pixel, moved so that it lies within the picture.
    fn around(pixel: [usize; 2], text: &str, scale: usize, picture: &Picture) -> Area {
        let size = [font::width(text, scale) + 2 * scale, (font::HEIGHT + 2) * scale];
        let sides = [picture.width, picture.height];
        let start =
            |axis: usize| pixel[axis].saturating_sub(size[axis] / 2).min(sides[axis].saturating_sub(size[axis]));
        Area { corner: [start(0), start(1)], size }
    }

    fn touches(&self, other: &Area) -> bool {
        (0..2).all(|axis| {
            let (a, b) = (self.corner[axis], other.corner[axis]);
            a <= b + other.size[axis] && b <= a + self.size[axis]
        })
    }
}

/// The text's shape, one font pixel thicker on every side, in black.
fn halo(picture: &mut Picture, [u, v]: [usize; 2], scale: usize, text: &str) {
    for du in 0..3 {
        for dv in 0..3 {
            font::write(picture, [u + du * scale - scale, v + dv * scale - scale], scale, [0; 3], text);
        }
    }
}

/// For each of the first planes, its pixel nearest to its centroid where the number stands on the plane alone; if there is
/// none, its pixel nearest to the centroid.
fn anchors(detection: &Detection, named: usize, scale: usize) -> Vec<[usize; 2]> {
    let mut best = vec![(true, f64::INFINITY, [0, 0]); named];
    for (at, &label) in detection.labels.iter().enumerate() {
        if label == 0 || usize::from(label) > named {
            continue;
        }
        let best = &mut best[usize::from(label) - 1];
        let pixel = [at % detection.width, at / detection.width];
        let [u, v] = detection.planes[usize::from(label) - 1].centroid;
        let distance = (pixel[0] as f64 - u).powi(2) + (pixel[1] as f64 - v).powi(2);
        if (false, distance) >= (best.0, best.1) {
            continue;
        }
        let found = (!has_room(detection, pixel, label, scale), distance, pixel);
        if (found.0, found.1) < (best.0, best.1) {
            *best = found;
        }
    }
    best.into_iter().map(|(_, _, pixel)| pixel).collect()
}

/// Whether corners and sides of a number with that pixel in its middle lie on the plane.
fn has_room(detection: &Detection, [u, v]: [usize; 2], label: u16, scale: usize) -> bool {
    let half = [font::width(&label.to_string(), scale) / 2 + scale, (font::HEIGHT / 2 + 1) * scale];
    let holds = |u: Option<usize>, v: Option<usize>| {
        let inside = u.zip(v).filter(|&(u, v)| u < detection.width && v < detection.height);
        inside.is_some_and(|(u, v)| detection.labels[v * detection.width + u] == label)
    };
    let places = |at: usize, half: usize| [at.checked_sub(half), Some(at), Some(at + half)];
    places(u, half[0]).into_iter().all(|u| places(v, half[1]).into_iter().all(|v| holds(u, v)))
}
