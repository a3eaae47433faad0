//! Outlines of planes: polygons with holes, convex hulls and rectangles of least area.
//!
//! In: a [`crate::Detection`], and the camera if it is known. Out: [`Outlines`], in pixels, and in metres
//! where a plane is metric; those points lie on the fitted plane, whatever noise the map has.
//!
//! `labels -> trace -> simplify -> hull -> Outlines`. Rings run along the cracks between pixels, so
//! that their corners lie at half-integers, and are simplified by Douglas and Peucker ("Algorithms
//! for the reduction of the number of points ...", 1973). The cost grows with the planes' perimeter
//! and one look at each label.
//!
//! What holds for any label image: a ring never meets itself; rings of one plane share single
//! points at most; holes lie within their outer ring and beside each other; a ring deviates by at
//! most the tolerance from the pixels' cracks, and at tolerance 0 not at all.
//!
//! Outer rings run counter-clockwise seen from the camera, that is around the normal by the
//! right-hand rule; holes run clockwise. On the picture that looks the same, except where `fx fy` is
//! negative (ICL-NUIM): such a picture is mirrored, and there outer rings look clockwise on it.

mod chord;
mod conflicts;
mod corner;
mod holes;
mod hull;
mod outliner;
mod outlines;
mod rectangle;
mod simplify;
mod trace;

pub use outliner::{DEFAULT_TOLERANCE_PX, Outliner};
pub use outlines::{Outline, Outlines, Polygon, Ring};
pub use rectangle::Rectangle;
