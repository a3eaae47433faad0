//! Corners of pixels.

/// A point where pixels meet: (x, y) is picture point (x - 1/2, y - 1/2).
pub(super) type Corner = [u16; 2];

/// `(b - a) x (c - a)`; below 0 where the way a, b, c turns counter-clockwise on the picture.
#[inline]
pub(super) fn turn(a: Corner, b: Corner, c: Corner) -> i64 {
    let [ax, ay, bx, by, cx, cy] = [a[0], a[1], b[0], b[1], c[0], c[1]].map(i64::from);
    (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
}

/// The picture point of a corner.
pub(super) fn point(corner: Corner) -> [f64; 2] {
    corner.map(|x| f64::from(x) - 0.5)
}
