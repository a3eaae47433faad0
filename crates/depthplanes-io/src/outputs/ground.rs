//! The picture of the ground: the floor green, obstacles red, drops blue, a white line where the free floor ends, and
//! heights in metres.

use super::error::OutputError;
use super::font;
use super::picture::{Picture, blend};
use super::shade;
use depthplanes::ground::{Floor, Ground, PlaneClass, Sector, marks};
use depthplanes::{AnyView, Detection, Sensor};

/// The colour of each mark, and its share in the picture; others are left grey.
const COLOURS: [(u8, [u8; 3], f32); 3] =
    [(marks::FLOOR, [40, 190, 90], 0.5), (marks::OBSTACLE, [225, 50, 45], 0.55), (marks::DROP, [40, 100, 245], 0.65)];

/// The colour in which the picture shows what a pixel of the ground is ([`marks`]); `None` where it leaves it grey.
pub fn mark_colour(mark: u8) -> Option<[u8; 3]> {
    COLOURS.iter().find(|(of, ..)| *of == mark).map(|(_, colour, _)| *colour)
}
/// Share of the colour of floor that is not free, which lies behind something.
const BEHIND_SHARE: f32 = 0.2;
const LINE: [u8; 3] = [255; 3];
/// Pictures at least this high get letters of twice the size.
const TALL: usize = 360;
/// Heights that are written at most, of obstacles and of planes.
const MOST: usize = 12;

/// The picture of the ground of a map as the bytes of a PNG file; the map in grey where there is no floor.
///
/// # Errors
/// [`OutputError::Size`] unless the detection is one of a map of that size.
pub fn ground_png<'m>(
    map: impl Into<AnyView<'m>>,
    sensor: &Sensor,
    found: &Detection,
    ground: &Ground,
) -> Result<Vec<u8>, OutputError> {
    let map = map.into();
    let size @ [width, height] = [map.width(), map.height()];
    if size != [found.width, found.height] {
        return Err(OutputError::Size { map: size, found: [found.width, found.height] });
    }
    let mut picture = Picture { width, height, pixels: shade::greys(map, sensor.value_kind) };
    if let Some(floor) = &ground.floor {
        tint(&mut picture, ground, floor, sensor);
        write_heights(&mut picture, found, ground);
    }
    Ok(picture.png())
}

/// Colours each pixel, and draws where the free floor ends.
fn tint(picture: &mut Picture, ground: &Ground, floor: &Floor, sensor: &Sensor) {
    let (width, height) = (picture.width, picture.height);
    let thick = height.div_ceil(240);
    for u in 0..width {
        // From below, which is from near to far.
        let mut was_free = false;
        for v in (0..height).rev() {
            let at = v * width + u;
            let mark = ground.marks[at];
            let Some(&(_, colour, share)) = COLOURS.iter().find(|(of, ..)| *of == mark) else { continue };
            let is_free = mark == marks::FLOOR && is_free(ground, floor, sensor, [u, v]);
            let share = if mark == marks::FLOOR && !is_free { BEHIND_SHARE } else { share };
            picture.pixels[at] = blend(picture.pixels[at], colour, share);
            was_free |= is_free;
        }
        if !was_free {
            continue;
        }
        let Some(end) = (0..height).find(|&v| is_free(ground, floor, sensor, [u, v])) else { continue };
        picture.fill([u, end.saturating_sub(thick / 2)], [1, thick], LINE);
    }
}

/// Whether the floor behind a pixel is nearer than what ends it in its direction.
fn is_free(ground: &Ground, floor: &Floor, sensor: &Sensor, [u, v]: [usize; 2]) -> bool {
    let Some([right, ahead]) = sensor.ray(u as f64, v as f64).and_then(|ray| floor.place(ray)) else { return false };
    let bearing = right.atan2(ahead).to_degrees();
    let is_in = |sector: &&Sector| bearing <= sector.to_deg;
    let sector = ground.sectors.iter().find(is_in).or(ground.sectors.last());
    sector.is_some_and(|sector| right.hypot(ahead) <= sector.free_m)
}

/// Heights in metres, on obstacles in white and on level planes in yellow.
fn write_heights(picture: &mut Picture, found: &Detection, ground: &Ground) {
    let scale = if picture.height >= TALL { 2 } else { 1 };
    let small = |pixels: usize| pixels < 4 * (font::HEIGHT * scale).pow(2);
    let level = ground.planes.iter().filter(|of| matches!(of.class, PlaneClass::Table | PlaneClass::Step));
    let planes = level.filter_map(|of| Some((found.plane(of.label)?, of.height_m?)));
    let planes = planes.filter(|(plane, _)| !small(plane.pixel_count)).take(MOST);
    let mut taken: Vec<[usize; 4]> = Vec::new();
    for (plane, height) in planes {
        write(picture, &mut taken, plane.centroid, scale, [255, 235, 60], height);
    }
    let obstacles = ground.obstacles.iter().filter(|of| !small(of.bounding_box.area())).take(MOST);
    for obstacle in obstacles {
        let pixels = obstacle.bounding_box;
        let middle = (f64::from(pixels.u_min) + f64::from(pixels.u_max)) / 2.0;
        // Near its foot, where the next thing behind it does not write.
        let foot = f64::from(pixels.v_max).mul_add(0.7, 0.3 * f64::from(pixels.v_min));
        write(picture, &mut taken, [middle, foot], scale, [255; 3], obstacle.height_m);
    }
}

/// A number with a dark box around it, unless another is there.
fn write(
    picture: &mut Picture,
    taken: &mut Vec<[usize; 4]>,
    [u, v]: [f64; 2],
    scale: usize,
    ink: [u8; 3],
    metres: f64,
) {
    let text = format!("{metres:.2}");
    let [width, height] = [font::width(&text, scale) + 2 * scale, (font::HEIGHT + 2) * scale];
    let start =
        |at: f64, size: usize, side: usize| ((at - size as f64 / 2.0).max(0.0) as usize).min(side.saturating_sub(size));
    let corner @ [left, top] = [start(u, width, picture.width), start(v, height, picture.height)];
    let touches = |&[l, t, w, h]: &[usize; 4]| left <= l + w && l <= left + width && top <= t + h && t <= top + height;
    if taken.iter().any(touches) {
        return;
    }
    taken.push([left, top, width, height]);
    picture.fill(corner, [width, height], [0; 3]);
    font::write(picture, [left + scale, top + scale], scale, ink, &text);
}
