//! The legend: a column beside the picture, and small numbers on the planes it names.

use super::colour::colour;
use super::font;
use super::picture::Picture;
use depthplanes::{Detection, Plane};

const PAPER: [u8; 3] = [38, 38, 44];
const INK: [u8; 3] = [232, 232, 232];
const FAINT: [u8; 3] = [176, 176, 182];
/// Pictures at least this high get letters of twice the size.
const TALL: usize = 360;
/// Even a small picture names this many planes.
const FEWEST_ROWS: usize = 6;

/// The picture with the legend at its right.
pub(super) fn beside(picture: &Picture, detection: &Detection) -> Picture {
    let layout = Layout::of(picture.height, detection);
    let mut whole = Picture::filled(picture.width + layout.width, picture.height.max(layout.height), PAPER);
    whole.paste(picture, [0, 0]);
    layout.draw(&mut whole, picture.width, detection);
    whole
}

/// What a row says of a plane: its label, its pixels, and its distance where that is known.
struct Row {
    swatch: Option<[u8; 3]>,
    cells: [String; 3],
}

struct Layout {
    rows: Vec<Row>,
    columns: [usize; 3],
    scale: usize,
    width: usize,
    height: usize,
}

impl Layout {
    fn of(picture_height: usize, detection: &Detection) -> Layout {
        let scale = letter_scale(picture_height);
        let rows = rows(rows_that_fit(picture_height, scale), detection);
        let widest = |column: usize| rows.iter().map(|row| font::width(&row.cells[column], scale)).max().unwrap_or(0);
        let columns = [widest(0), widest(1), widest(2)];
        let gap = |column: &usize| if *column == 0 { 0 } else { column + 2 * font::ADVANCE * scale };
        let width = margin(scale) + swatch_side(scale) + margin(scale) + columns.iter().map(gap).sum::<usize>();
        let height = 2 * margin(scale) + rows.len() * row_height(scale);
        Layout { rows, columns, scale, width, height }
    }

    fn draw(&self, whole: &mut Picture, left: usize, detection: &Detection) {
        let scale = self.scale;
        for (i, row) in self.rows.iter().enumerate() {
            let top = margin(scale) + i * row_height(scale);
            if let Some(swatch) = row.swatch {
                whole.fill([left + margin(scale), top], [swatch_side(scale); 2], swatch);
            }
            let mut u = left + margin(scale) + swatch_side(scale) + margin(scale);
            for (column, text) in row.cells.iter().enumerate() {
                let start = u + self.columns[column] - font::width(text, scale).min(self.columns[column]);
                let ink = if column == 0 && i < detection.planes.len() { INK } else { FAINT };
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

fn rows_that_fit(picture_height: usize, scale: usize) -> usize {
    (picture_height.saturating_sub(2 * margin(scale)) / row_height(scale)).max(FEWEST_ROWS)
}

/// How many planes have a row; where not all fit, the last row counts the others.
fn planes_named(fitting: usize, detection: &Detection) -> usize {
    let planes = detection.planes.len();
    if planes > fitting { fitting - 1 } else { planes }
}

fn rows(fitting: usize, detection: &Detection) -> Vec<Row> {
    let planes = &detection.planes;
    let named = planes_named(fitting, detection);
    let mut rows: Vec<Row> = planes[..named].iter().map(row).collect();
    if named < planes.len() {
        let more = format!("+{} more", planes.len() - named);
        rows.push(Row { swatch: None, cells: [String::new(), more, String::new()] });
    }
    if planes.is_empty() {
        rows.push(Row { swatch: None, cells: [String::new(), "no planes".into(), String::new()] });
    }
    rows
}

fn row(plane: &Plane) -> Row {
    let distance = plane.metric.as_ref().map(|metric| format!("{:.2} m", metric.plane.distance)).unwrap_or_default();
    let cells = [plane.label.to_string(), format!("{} px", plane.pixel_count), distance];
    Row { swatch: Some(colour(plane.label)), cells }
}

/// Writes the labels that the legend names onto their planes, where there is room.
pub(super) fn number_planes(picture: &mut Picture, detection: &Detection) {
    let scale = letter_scale(picture.height);
    let named = planes_named(rows_that_fit(picture.height, scale), detection);
    let anchors = anchors(detection, named);
    let mut written: Vec<Area> = Vec::new();
    for (plane, anchor) in detection.planes[..named].iter().zip(anchors) {
        let text = plane.label.to_string();
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

/// For each of the first planes, its pixel nearest to its centroid.
fn anchors(detection: &Detection, named: usize) -> Vec<[usize; 2]> {
    let mut best = vec![(f64::INFINITY, [0, 0]); named];
    for (at, &label) in detection.labels.iter().enumerate() {
        if label == 0 || usize::from(label) > named {
            continue;
        }
        let plane = usize::from(label) - 1;
        let pixel = [at % detection.width, at / detection.width];
        let [u, v] = detection.planes[plane].centroid;
        let distance = (pixel[0] as f64 - u).powi(2) + (pixel[1] as f64 - v).powi(2);
        if distance < best[plane].0 {
            best[plane] = (distance, pixel);
        }
    }
    best.into_iter().map(|(_, pixel)| pixel).collect()
}
