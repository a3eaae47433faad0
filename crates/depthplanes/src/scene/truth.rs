//! The exact answer for a frame: which plane each pixel shows, and where that plane is.

use super::cast::{Cast, plane_of};
use super::pose::Camera;
use super::surfaces::{Scene, Surface};
use crate::camera::HessianNormalForm;

/// What a camera sees of a scene, free of noise; row by row, `width * height` entries.
///
/// A plane is one flat surface of the scene: a table top that a ball cuts in two, or a wall on both
/// sides of a doorway, is one plane with one label. Methods that name connected regions are
/// measured against [`Truth::pieces`].
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Truth {
    /// Columns.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// 0 = nothing or a curved surface, 1.. = `planes[label - 1]`.
    pub labels: Vec<u16>,
    /// By decreasing pixel count, equal counts by first pixel in raster order, as in
    /// [`crate::Detection`]. Planes after the 65535th keep label 0 and are not listed.
    pub planes: Vec<TruthPlane>,
    /// Exact depth along the optical axis, metres; 0 where the ray meets nothing.
    pub depth_m: Vec<f64>,
    /// Number of the surface, flat or curved, as its place in the scene's list from 1; 0 where the
    /// ray meets nothing.
    pub surfaces: Vec<u32>,
    /// For surface number `s`, whether it is curved: `curved[s - 1]`.
    pub curved: Vec<bool>,
}

/// One plane of the scene.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct TruthPlane {
    /// Its value in the label image, 1..=65535.
    pub label: u16,
    /// Number of its surface in the scene, from 1.
    pub surface: u32,
    /// Where it is, camera coordinates, metres.
    pub plane: HessianNormalForm,
    /// Pixels that carry the label.
    pub pixel_count: usize,
}

impl Truth {
    pub(super) fn new(scene: &Scene, camera: &Camera, seen: Cast) -> Self {
        let eye = camera.extrinsics();
        let planes: Vec<_> = scene.surfaces.iter().map(|surface| plane_of(surface, &eye)).collect();
        let flat = |&surface: &u32| if surface > 0 && planes[surface as usize - 1].is_some() { surface } else { 0 };
        let regions: Vec<u32> = seen.surfaces.iter().map(flat).collect();
        let (labels, listed) = number(&regions, planes.len());
        let planes = (1..=u16::MAX).zip(listed).filter_map(|(label, (surface, pixel_count))| {
            let plane = planes[surface as usize - 1]?;
            Some(TruthPlane { label, surface, plane, pixel_count })
        });
        let round = |surface: &Surface| matches!(surface, Surface::Ball { .. } | Surface::Cylinder { .. });
        Truth {
            width: camera.width,
            height: camera.height,
            labels,
            planes: planes.collect(),
            depth_m: seen.depth_m,
            surfaces: seen.surfaces,
            curved: scene.surfaces.iter().map(round).collect(),
        }
    }

    /// The same truth with each 4-connected region of a plane as a plane of its own; regions of
    /// fewer than `least_pixels` get label 0.
    ///
    /// ```
    /// use depthplanes::scene::Spec;
    /// let truth = "room:size=160x120".parse::<Spec>()?.frame()?.truth;
    /// assert!(truth.pieces(1).planes.len() > truth.planes.len());
    /// # Ok::<(), depthplanes::Error>(())
    /// ```
    pub fn pieces(&self, least_pixels: usize) -> Truth {
        let (regions, sizes) = connected(&self.labels, self.width);
        let kept: Vec<u32> =
            regions.iter().map(|&r| if r > 0 && sizes[r as usize - 1] >= least_pixels { r } else { 0 }).collect();
        let (labels, listed) = number(&kept, sizes.len());
        let mut planes: Vec<_> = (1..=u16::MAX)
            .zip(listed)
            .map(|(label, (_, pixel_count))| TruthPlane { label, pixel_count, ..self.planes[0] })
            .collect();
        for (&piece, &whole) in labels.iter().zip(&self.labels) {
            if piece > 0 {
                let TruthPlane { surface, plane, .. } = self.planes[whole as usize - 1];
                let entry = &mut planes[piece as usize - 1];
                (entry.surface, entry.plane) = (surface, plane);
            }
        }
        Truth { labels, planes, ..self.clone() }
    }

    /// Pixels that show a curved surface.
    pub fn curved_pixels(&self) -> usize {
        self.surfaces.iter().filter(|&&surface| surface > 0 && self.curved[surface as usize - 1]).count()
    }
}

/// Labels for regions 1..=`count` (0 stays 0), by decreasing size, equal sizes by first pixel; and
/// for each label the region and its size.
fn number(regions: &[u32], count: usize) -> (Vec<u16>, Vec<(u32, usize)>) {
    let mut sizes = vec![0usize; count];
    let mut by_first_pixel = Vec::new();
    for &region in regions.iter().filter(|&&region| region > 0) {
        let size = &mut sizes[region as usize - 1];
        if *size == 0 {
            by_first_pixel.push(region);
        }
        *size += 1;
    }
    let mut order = by_first_pixel;
    order.sort_by_key(|&region| std::cmp::Reverse(sizes[region as usize - 1]));
    order.truncate(usize::from(u16::MAX));
    let mut label_of = vec![0u16; count + 1];
    for (label, &region) in (1..=u16::MAX).zip(&order) {
        label_of[region as usize] = label;
    }
    let labels = regions.iter().map(|&region| label_of[region as usize]).collect();
    (labels, order.into_iter().map(|region| (region, sizes[region as usize - 1])).collect())
}

/// 4-connected regions of equal label, numbered from 1 in raster order (label 0 gives 0), and the
/// size of each.
fn connected(labels: &[u16], width: usize) -> (Vec<u32>, Vec<usize>) {
    let mut regions = vec![0u32; labels.len()];
    let mut sizes = Vec::new();
    let mut stack = Vec::new();
    for start in 0..labels.len() {
        if labels[start] == 0 || regions[start] != 0 {
            continue;
        }
        let region = sizes.len() as u32 + 1;
        let mut size = 0;
        regions[start] = region;
        stack.push(start);
        while let Some(at) = stack.pop() {
            size += 1;
            let u = at % width;
            let beside = [
                (u > 0).then(|| at - 1),
                (u + 1 < width).then(|| at + 1),
                at.checked_sub(width),
                Some(at + width).filter(|&below| below < labels.len()),
            ];
            for next in beside.into_iter().flatten() {
                if regions[next] == 0 && labels[next] == labels[start] {
                    regions[next] = region;
                    stack.push(next);
                }
            }
        }
        sizes.push(size);
    }
    (regions, sizes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn regions_are_numbered_by_size_then_by_first_pixel() {
        let (labels, listed) = number(&[3, 1, 1, 0, 2, 2, 3, 3], 3);
        assert_eq!(labels, [1, 2, 2, 0, 3, 3, 1, 1]);
        assert_eq!(listed, [(3, 3), (1, 2), (2, 2)]);
    }

    #[test]
    fn diagonal_neighbours_are_not_connected() {
        let (regions, sizes) = connected(&[1, 0, 1, 1, 1, 0, 0, 0, 1], 3);
        assert_eq!(regions, [1, 0, 2, 1, 1, 0, 0, 0, 3]);
        assert_eq!(sizes, [3, 1, 1]);
    }
}
