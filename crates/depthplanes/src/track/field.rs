//! Where in the picture each track was last seen, on a lattice of pixels, and what is there now.

use super::homography::Homography;
use crate::detection::{Detection, PixelBox};
use std::ops::Range;

/// Pixels from one point of a plane to the next along both axes, by the pixels of the plane: where a plane is takes about as
/// many points to say, however large it is.
fn step_of(pixels: usize) -> usize {
    match pixels {
        0..1024 => FINE,
        1024..16_384 => STEP,
        _ => 2 * STEP,
    }
}

/// The step of small planes, whose points are looked for in their boxes.
const FINE: usize = 2;
/// The step of the lattice on which all others are looked for together.
const STEP: usize = 4;

/// The points of a track: where they stand, and how many pixels each stands for.
#[derive(Clone, Debug, Default)]
struct Points {
    range: Range<usize>,
    pixels: u32,
}

/// Points of tracks, track by track.
#[derive(Clone, Debug, Default)]
pub(super) struct Field {
    /// (u, v), pixels; not a number where a point went behind the camera.
    points: Vec<[f32; 2]>,
    /// The points of each track.
    tracks: Vec<Points>,
    /// Memory for the next field.
    next: (Vec<[f32; 2]>, Vec<Points>),
    /// How many points of a track have each label; 0 beside those in `touched`.
    counts: Vec<u32>,
    touched: Vec<u16>,
    /// The step of each label's points; 0 of none.
    steps: Vec<usize>,
}

/// How many pixels of a track have a label now.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Overlap {
    pub(super) track: usize,
    pub(super) label: u16,
    pub(super) pixels: u32,
}

impl Field {
    /// Forgets where the tracks were: pictures of another size are not compared.
    pub(super) fn forget(&mut self) {
        self.points.clear();
        self.tracks.fill(Points::default());
    }

    /// How many pixels the points of a track stand for.
    pub(super) fn pixels_of(&self, track: usize) -> u32 {
        let Points { range, pixels } = &self.tracks[track];
        range.len() as u32 * pixels
    }

    /// Moves the points of a track.
    pub(super) fn shift(&mut self, track: usize, homography: &Homography) {
        for point in &mut self.points[self.tracks[track].range.clone()] {
            *point = homography.of(*point);
        }
    }

    /// Counts which labels the points have now; by track, then by label.
    pub(super) fn overlaps(&mut self, found: &Detection, overlaps: &mut Vec<Overlap>) {
        overlaps.clear();
        self.counts.resize(found.planes.len() + 1, 0);
        let (width, height) = (found.width as f32, found.height as f32);
        for (track, Points { range, pixels }) in self.tracks.iter().enumerate() {
            for &[u, v] in &self.points[range.clone()] {
                let [u, v] = [u + 0.5, v + 0.5]; // to the nearest pixel
                if !(u >= 0.0 && v >= 0.0 && u < width && v < height) {
                    continue;
                }
                let label = found.labels[v as usize * found.width + u as usize];
                let count = &mut self.counts[usize::from(label)];
                if *count == 0 {
                    self.touched.push(label);
                }
                *count += 1;
            }
            self.touched.sort_unstable();
            for label in self.touched.drain(..) {
                let points = std::mem::take(&mut self.counts[usize::from(label)]);
                if label != 0 {
                    overlaps.push(Overlap { track, label, pixels: points * pixels });
                }
            }
        }
    }

    /// The points of this frame's tracks: those of the plane that `label_of` gives, or, where it gives none, the points that
    /// the track had under its former number `old_of`. Every label is that of one track.
    pub(super) fn renew(
        &mut self,
        found: &Detection,
        tracks: usize,
        label_of: impl Fn(usize) -> Option<u16>,
        old_of: impl Fn(usize) -> Option<usize>,
    ) {
        let (points, tracks_next) = &mut self.next;
        points.clear();
        tracks_next.clear();
        let step_of =
            |label: u16| usize::from(label).checked_sub(1).map_or(0, |at| step_of(found.planes[at].pixel_count));
        self.steps.clear();
        self.steps.extend((0..=found.planes.len()).map(|label| step_of(label as u16)));
        let steps = &self.steps;
        let lattice = || {
            let rows = (STEP / 2..found.height).step_by(STEP);
            let points = rows.flat_map(|v| {
                let row = &found.labels[v * found.width..(v + 1) * found.width];
                (STEP / 2..found.width).step_by(STEP).map(move |u| (u, v, row[u]))
            });
            points.filter(|&(u, v, label)| match steps[usize::from(label)] {
                STEP => true,
                step => step > STEP && (u | v) & STEP == 0,
            })
        };
        // First how many points each large plane has, then where its next point goes.
        self.counts.resize(found.planes.len() + 1, 0);
        lattice().for_each(|(_, _, label)| self.counts[usize::from(label)] += 1);
        for track in 0..tracks {
            let start = points.len();
            let step = label_of(track).map_or(0, |label| self.steps[usize::from(label)]);
            let mut pixels = (step * step) as u32;
            match (label_of(track), old_of(track)) {
                (Some(label), _) if step == FINE => {
                    points.extend(points_of(found, label));
                }
                (Some(label), _) => {
                    let count = std::mem::replace(&mut self.counts[usize::from(label)], start as u32);
                    points.resize(start + count as usize, [f32::NAN; 2]);
                }
                (None, Some(old)) => {
                    let old = &self.tracks[old];
                    pixels = old.pixels;
                    points.extend_from_slice(&self.points[old.range.clone()]);
                }
                (None, None) => (),
            }
            tracks_next.push(Points { range: start..points.len(), pixels });
        }
        for (u, v, label) in lattice() {
            let place = &mut self.counts[usize::from(label)];
            points[*place as usize] = [u as f32, v as f32];
            *place += 1;
        }
        self.counts.fill(0);
        std::mem::swap(&mut self.points, &mut self.next.0);
        std::mem::swap(&mut self.tracks, &mut self.next.1);
    }
}

/// The points of a small plane.
fn points_of(found: &Detection, label: u16) -> impl Iterator<Item = [f32; 2]> {
    let PixelBox { u_min, v_min, u_max, v_max } = found.planes[usize::from(label) - 1].bounding_box;
    (v_min..=v_max).step_by(FINE).flat_map(move |v| {
        let row = &found.labels[v as usize * found.width..][..found.width];
        (u_min..=u_max).step_by(FINE).filter(move |&u| row[u as usize] == label).map(move |u| [u as f32, v as f32])
    })
}
