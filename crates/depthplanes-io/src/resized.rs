//! The camera of a picture for a map of it that has other pixels: resized, turned, without some rows or columns.

use depthplanes::Intrinsics;

/// Columns and rows.
pub(crate) type Size = (usize, usize);

/// The camera of a picture for the same picture with other pixels, if the sides have the same ratio to within 3 %.
/// Pixel centres are at integers.
pub(crate) fn scaled(camera: &Intrinsics, from: Size, to: Size) -> Option<Intrinsics> {
    let [from, to] = [from, to].map(|(width, height)| [width, height].map(|side| side.max(1) as f64));
    let scale = [to[0] / from[0], to[1] / from[1]];
    // Networks resize to multiples of 14 or 32 pixels.
    let is_alike = (scale[0] / scale[1] - 1.0).abs() < 0.03;
    let centre = |c: f64, scale: f64| (c + 0.5) * scale - 0.5;
    is_alike.then(|| Intrinsics {
        fx: camera.fx * scale[0],
        fy: camera.fy * scale[1],
        cx: centre(camera.cx, scale[0]),
        cy: centre(camera.cy, scale[1]),
    })
}

/// What to do about the camera of a picture that the map is a crop of.
pub(crate) const OF_CROP: &str = "if the map is a crop of that picture, subtract the crop's left column from cx and its top row from cy in --intrinsics";

/// What is right of a crop whose picture is not known.
pub(crate) const OF_OTHER_CROP: &str =
    "it is right for a crop if the crop's left column was subtracted from the picture's cx, and its top row from cy";

/// The camera for maps of which every n-th row or column was kept; none if the sides are no such shares.
fn thinned(camera: &Intrinsics, from: Size, map: Size) -> Option<Intrinsics> {
    let every = |from: usize, to: usize| (1..=8).find(|n| to > 0 && from / n == to);
    let (x, y) = (every(from.0, map.0)?, every(from.1, map.1)?);
    let centre = |c: f64, n: usize| (c + 0.5) / n as f64 - 0.5;
    (x != y).then(|| Intrinsics {
        fx: camera.fx / x as f64,
        fy: camera.fy / y as f64,
        cx: centre(camera.cx, x),
        cy: centre(camera.cy, y),
    })
}

/// What to do about the camera of a picture of another shape.
pub(crate) fn of_other_shape(camera: &Intrinsics, from: Size, map: Size) -> String {
    match thinned(camera, from, map) {
        Some(thinned) => format!("if rows or columns were left out, give {}; {OF_CROP}", flag(&thinned)),
        None => OF_CROP.into(),
    }
}

/// The cameras of the picture turned clockwise and counter-clockwise, if the map has its size.
pub(crate) fn turned(camera: &Intrinsics, (width, height): Size, map: Size) -> Option<[Intrinsics; 2]> {
    let Intrinsics { fx, fy, cx, cy } = *camera;
    let (right, bottom) = (width as f64 - 1.0, height as f64 - 1.0);
    let clockwise = Intrinsics { fx: fy, fy: fx, cx: bottom - cy, cy: cx };
    let other = Intrinsics { fx: fy, fy: fx, cx: cy, cy: right - cx };
    Some([scaled(&clockwise, (height, width), map)?, scaled(&other, (height, width), map)?])
}

/// The flag for a camera, ready to paste.
pub(crate) fn flag(camera: &Intrinsics) -> String {
    let round = |x: f64| (x * 1e4).round() / 1e4;
    let [fx, fy, cx, cy] = [camera.fx, camera.fy, camera.cx, camera.cy].map(round);
    format!("--intrinsics={fx},{fy},{cx},{cy}")
}

/// Sizes of pictures, as shares of the map's, whose middle the principal point of the map's own camera may be: calibrated ones
/// are off the middle in both directions alike by less.
const ALMOST_OWN: std::ops::Range<f64> = 0.9..1.11;

/// The size of which the principal point is the middle, and the camera scaled to the map, if the map has that shape and
/// is clearly of another size.
pub(crate) fn whole_picture(camera: &Intrinsics, map: Size) -> Option<(Size, Intrinsics)> {
    let side = |c: f64| (c > 4.0 && c < 1e5).then(|| (2.0 * c + 1.0).round() as usize);
    let size = (side(camera.cx)?, side(camera.cy)?);
    let ratio = size.0 as f64 / map.0 as f64;
    // A calibrated principal point is off the middle by a hundredth.
    let is_alike = (ratio / (size.1 as f64 / map.1 as f64) - 1.0).abs() < 0.03;
    if !is_alike || ALMOST_OWN.contains(&ratio) {
        return None;
    }
    // The sizes of pictures are even.
    let even = |n: usize| n - n % 2;
    let nice = (even(size.0), even(size.1));
    let size = if scaled(camera, nice, map).is_some() { nice } else { size };
    let exact = (size.0, (size.0 as f64 * map.1 as f64 / map.0 as f64).round() as usize);
    scaled(camera, exact, map).map(|scaled| (exact, scaled))
}
