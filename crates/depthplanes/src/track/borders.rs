//! Borders that do not flicker.
//!
//! In: a frame, its label image, and the label image that was shown for the frame before. Out: the label image in which planes
//! have back what was theirs in the frame before, as long as it still lies on them. What is measured decides: a hand before a
//! wall is none of the wall's, however long the wall was there.

use super::homography::Homography;
use super::pose::Motion;
use crate::camera::ValueKind;
use crate::detection::{Detection, Plane};
use crate::map::{AnyView, DepthView, Pixel, with_view};
use crate::sensor::Sensor;

/// A pixel lies on a plane up to so many times the root mean square that the plane's own pixels are off it: one of 400 of
/// these lies farther off.
const ON: f32 = 3.0;

/// Labels in a row that are looked at together: where all are one, there is no border.
const CHUNK: usize = 32;

/// Reuses its memory from frame to frame.
#[derive(Clone, Debug, Default)]
pub(super) struct Borders {
    /// The labels of the frame before, as they were shown, and their ids, label 1 first.
    former: Vec<u16>,
    former_ids: Vec<u32>,
    /// What each label may have back, label 1 first; none of planes that are new.
    claims: Vec<Option<Claim>>,
    /// Pixels (u, v) that a plane has got back, whose neighbours are to be looked at, and its label.
    open: Vec<([usize; 2], u16)>,
}

/// What a plane may have back.
#[derive(Clone, Copy, Debug)]
struct Claim {
    /// Its label in the frame before.
    former: u16,
    /// Where its pixels were then.
    back: Homography,
    surface: Surface,
}

/// Where the pixels of a plane lie. With `m = a u + b v + c`, metric ones are `depth m + d` metres off the plane, others
/// `m - value` units of the map.
#[derive(Clone, Copy, Debug)]
struct Surface {
    abc: [f32; 3],
    /// `None` where the plane is not metric.
    d: Option<f32>,
    /// How far off its pixels may be.
    most: f32,
}

impl Surface {
    /// None if no plane is determined. Behind a lens that distorts, pixels of a plane are not affine in 1/depth; there the fit in
    /// map units says where they lie, as it does without a camera.
    fn of(plane: &Plane, sensor: &Sensor) -> Option<Self> {
        let distorts = sensor.distortion.is_some_and(|distortion| !distortion.is_none());
        let metric = plane.metric.as_ref().zip(sensor.intrinsics).filter(|_| !distorts);
        let (abc, d, rms) = match (metric, &plane.fit) {
            (Some((metric, camera)), _) => {
                let [x, y, z] = metric.plane.normal;
                let [a, b] = [x / camera.fx, y / camera.fy];
                ([a, b, z - a * camera.cx - b * camera.cy], Some(metric.plane.distance as f32), metric.rms_m)
            }
            (None, Some(fit)) => ([fit.gradient[0], fit.gradient[1], fit.offset], None, fit.rms),
            (None, None) => return None,
        };
        Some(Surface { abc: abc.map(|number| number as f32), d, most: ON * rms as f32 })
    }

    fn holds(&self, [u, v]: [f32; 2], value: f32, kind: ValueKind) -> bool {
        let [a, b, c] = self.abc;
        let m = a * u + b * v + c;
        let off = match self.d {
            Some(d) => kind.depth_m(value.into()).map_or(f32::INFINITY, |depth| depth as f32 * m + d),
            None => m - value,
        };
        off.abs() <= self.most
    }
}

impl Borders {
    /// Forgets the frame before: it is not the one before the next.
    pub(super) fn forget(&mut self) {
        self.former.clear();
    }

    /// Makes the label image of a frame. `ids` are those of its labels, `motion` is the camera's since the frame before.
    pub(super) fn hold(
        &mut self,
        map: AnyView<'_>,
        found: &Detection,
        sensor: &Sensor,
        motion: &Motion,
        ids: &[u32],
        labels: &mut Vec<u16>,
    ) {
        labels.clone_from(&found.labels);
        if !self.former.is_empty() {
            self.claim(found, sensor, motion, ids);
            let Borders { former, claims, open, .. } = self;
            with_view!(map, view => Regrowth { view, found, kind: sensor.value_kind, former, claims, open, labels }.run());
        }
        self.former.clone_from(labels);
        self.former_ids.clear();
        self.former_ids.extend_from_slice(ids);
    }

    fn claim(&mut self, found: &Detection, sensor: &Sensor, motion: &Motion, ids: &[u32]) {
        let back = motion.inverse();
        let claims = found.planes.iter().zip(ids).map(|(plane, id)| {
            let former = self.former_ids.iter().position(|former| former == id)?;
            let moved = plane.metric.as_ref().zip(sensor.intrinsics).filter(|_| *motion != Motion::NONE);
            let back = moved.map(|(metric, camera)| Homography::new(&back, &metric.plane, &camera));
            let surface = Surface::of(plane, sensor)?;
            Some(Claim { former: former as u16 + 1, back: back.unwrap_or(Homography::NONE), surface })
        });
        self.claims.clear();
        self.claims.extend(claims);
    }
}

/// Planes grow from their borders over what was theirs.
struct Regrowth<'a, T> {
    view: DepthView<'a, T>,
    found: &'a Detection,
    kind: ValueKind,
    former: &'a [u16],
    claims: &'a [Option<Claim>],
    open: &'a mut Vec<([usize; 2], u16)>,
    labels: &'a mut [u16],
}

impl<T: Pixel> Regrowth<'_, T> {
    fn run(mut self) {
        let Detection { width, height, ref labels, .. } = *self.found;
        for v in 0..height {
            let row = &labels[v * width..][..width];
            let below = labels.get((v + 1) * width..(v + 2) * width).unwrap_or(row);
            for start in (0..width).step_by(CHUNK) {
                let end = (start + CHUNK).min(width);
                let next = end.min(width - 1);
                if row[start..next] == row[start + 1..=next] && row[start..end] == below[start..end] {
                    continue;
                }
                for u in start..end {
                    if u + 1 < width && row[u] != row[u + 1] {
                        self.meet([u, v], [u + 1, v]);
                    }
                    if row[u] != below[u] {
                        self.meet([u, v], [u, v + 1]);
                    }
                }
            }
        }
    }

    /// Where two planes meet, each may have the pixel of the other, and more behind it.
    fn meet(&mut self, a: [usize; 2], b: [usize; 2]) {
        for (place, [u, v]) in [(a, b), (b, a)] {
            self.offer(place, self.labels[v * self.found.width + u]);
            while let Some(([u, v], label)) = self.open.pop() {
                // Wrapped around, a place to the left of the first is out of the picture too.
                for place in [[u.wrapping_sub(1), v], [u + 1, v], [u, v.wrapping_sub(1)], [u, v + 1]] {
                    if place[0] < self.found.width && place[1] < self.found.height {
                        self.offer(place, label);
                    }
                }
            }
        }
    }

    /// Gives a pixel to a plane that it was of and that it lies on. No pixel is given twice.
    fn offer(&mut self, [u, v]: [usize; 2], label: u16) {
        let at = v * self.found.width + u;
        if label == 0 || self.labels[at] == label || self.labels[at] != self.found.labels[at] {
            return;
        }
        let Some(claim) = &self.claims[usize::from(label) - 1] else { return };
        let (pixel, value) = ([u as f32, v as f32], self.view.row(v)[u]);
        let is_on = self.view.validity().holds(value) && claim.surface.holds(pixel, value.to_f32(), self.kind);
        if is_on && self.was_of(claim, pixel) {
            self.labels[at] = label;
            self.open.push(([u, v], label));
        }
    }

    fn was_of(&self, claim: &Claim, pixel: [f32; 2]) -> bool {
        let Detection { width, height, .. } = *self.found;
        let [u, v] = claim.back.of(pixel).map(|x| x + 0.5); // to the nearest pixel
        let is_seen = u >= 0.0 && v >= 0.0 && u < width as f32 && v < height as f32;
        is_seen && self.former[v as usize * width + u as usize] == claim.former
    }
}
