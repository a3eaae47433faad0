//! Labels of a sparse map's bins as labels of its pixels.
//!
//! In: the label of each bin. Out: for each measured pixel the label of the nearest plane of the bins around its own, if it
//! lies on that plane. Planes are those of the pixels that stand for the bins, at the places where these were
//! measured, so a bin in which two surfaces meet is divided between them.

use crate::map::{DepthView, Pixel};
use crate::noise::{NoiseModel, Space, Sparse};
use crate::statistics::least_squares::Moments;
use crate::util::memory::reserve_to;

/// The plane of a label.
#[derive(Clone, Copy, Debug, Default)]
struct LabelPlane {
    /// (u, v, q) that sums and plane stand about.
    origin: [f64; 3],
    sums: Moments,
    abc: [f64; 3],
    /// Its pixels' mean squared residual as a multiple of their variance, at least 1.
    excess: f64,
}

/// Gives labels of bins to pixels; reuses its memory.
#[derive(Debug, Default)]
pub(crate) struct Spreader {
    planes: Vec<LabelPlane>,
    /// Labels of a bin and of those around it.
    around: Vec<u16>,
}

impl Spreader {
    /// Makes room for maps of so many pixels.
    pub(crate) fn reserve(&mut self, area: usize) {
        reserve_to(&mut self.planes, area.min(u16::MAX.into()));
        reserve_to(&mut self.around, 9);
    }

    /// Writes the label of each pixel of the map into `image`, 0 for none. `inlier_threshold`: how far from a plane its
    /// pixels may lie, standard deviations.
    #[expect(clippy::too_many_arguments, reason = "a map, what its numbers mean and what was found")]
    pub(crate) fn spread<T: Pixel>(
        &mut self,
        map: &DepthView<'_, T>,
        space: Space,
        sparse: &Sparse<'_>,
        labels: &[u16],
        noise: &NoiseModel,
        inlier_threshold: f64,
        image: &mut Vec<u16>,
    ) {
        self.reserve(map.area());
        self.fit(map, space, sparse, labels, noise);
        reserve_to(image, map.area());
        image.resize(map.area(), 0);
        let ([columns, rows], validity) = (sparse.size, map.validity());
        let Spreader { planes, around } = self;
        for (row, column) in (0..rows).flat_map(|row| (0..columns).map(move |column| (row, column))) {
            around.clear();
            for near in row.saturating_sub(1)..(row + 2).min(rows) {
                let near = &labels[near * columns..][column.saturating_sub(1)..(column + 2).min(columns)];
                around.extend(near.iter().filter(|&&label| label > 0));
            }
            around.sort_unstable();
            around.dedup();
            for v in row * sparse.side[1]..((row + 1) * sparse.side[1]).min(map.height()) {
                for u in column * sparse.side[0]..((column + 1) * sparse.side[0]).min(map.width()) {
                    let value = map.row(v)[u];
                    if validity.holds(value) {
                        let q = space.q(value.into());
                        let squares = around.iter().map(|&label| {
                            (planes[usize::from(label) - 1].square_of([u as f64, v as f64, q], noise), label)
                        });
                        let nearest = squares.min_by(|a, b| a.0.total_cmp(&b.0));
                        let on = nearest.filter(|(square, _)| *square <= inlier_threshold * inlier_threshold);
                        image[v * map.width() + u] = on.map_or(0, |(_, label)| label);
                    }
                }
            }
        }
    }

    /// Fits the plane of each label to the pixels that stand for its bins.
    fn fit<T: Pixel>(
        &mut self,
        map: &DepthView<'_, T>,
        space: Space,
        sparse: &Sparse<'_>,
        labels: &[u16],
        noise: &NoiseModel,
    ) {
        let planes = &mut self.planes;
        planes.clear();
        planes.resize(labels.iter().copied().max().unwrap_or(0).into(), LabelPlane::default());
        for (&label, &pixel) in labels.iter().zip(sparse.pixels) {
            if label > 0 && pixel != Sparse::EMPTY {
                let [u, v] = [pixel as usize % map.width(), pixel as usize / map.width()];
                let q = space.q(map.row(v)[u].into());
                let plane = &mut planes[usize::from(label) - 1];
                let place = [u as f64, v as f64, q];
                if plane.sums.n == 0.0 {
                    plane.origin = place;
                }
                let [du, dv, dq] = [0, 1, 2].map(|axis| place[axis] - plane.origin[axis]);
                plane.sums.add(du, dv, dq);
            }
        }
        for plane in planes {
            let Some(fit) = plane.sums.fit() else { continue };
            plane.abc = fit.abc;
            let q = plane.origin[2] + plane.sums.q / plane.sums.n;
            plane.excess = (fit.rms * fit.rms / plane.variance(q, noise)).max(1.0);
        }
    }
}

impl LabelPlane {
    /// Variance that the noise gives to a pixel's distance from the plane.
    fn variance(&self, q: f64, noise: &NoiseModel) -> f64 {
        let [a, b, _] = self.abc;
        let ray = noise.ray() + noise.smooth_ray();
        noise.variance(q) + noise.smooth_sigma(q).powi(2) + ray * ray * (a * a + b * b)
    }

    /// Square of a pixel's distance from the plane in standard deviations; not a number for a plane that nothing determines.
    fn square_of(&self, [u, v, q]: [f64; 3], noise: &NoiseModel) -> f64 {
        let ([a, b, c], [u0, v0, q0]) = (self.abc, self.origin);
        let off = q - (a * (u - u0) + b * (v - v0) + c + q0);
        off * off / (self.excess * self.variance(q, noise))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::ValueKind;
    use crate::noise::{SensorNoise, SparseFinder};

    #[test]
    fn every_measured_pixel_has_the_nearest_plane_around_its_bin_and_what_lies_on_none_has_no_label() {
        // Two planes of disparity that meet at a slant, one pixel in nine, and a few far off.
        let [width, height] = [90, 60];
        let is_left = |u: usize, v: usize| 2 * u < 60 + v;
        let plane = |u: usize, v: usize| if is_left(u, v) { 60.0 + 0.2 * u as f32 } else { 20.0 - 0.1 * v as f32 };
        let is_off = |u: usize, v: usize| u % 30 == 10 && v % 30 == 10;
        let is_measured = |u: usize, v: usize| u % 3 == 1 && v % 3 == 1;
        let pixels: Vec<f32> = (0..width * height)
            .map(|at| [at % width, at / width])
            .map(|[u, v]| match (is_measured(u, v), is_off(u, v)) {
                (false, _) => f32::NAN,
                (true, true) => 45.0,
                (true, false) => plane(u, v),
            })
            .collect();
        let map = DepthView::new(&pixels, width, height).unwrap();
        let mut finder = SparseFinder::default();
        let sparse = finder.find(&map).unwrap();
        // The labels of bins are shifted by one bin, as those of whole tiles may be.
        let labels: Vec<u16> = (0..sparse.size[0] * sparse.size[1])
            .map(|at| [3 * (at % sparse.size[0]) + 1, 3 * (at / sparse.size[0]) + 1])
            .map(|[u, v]| {
                if is_off(u, v) {
                    0
                } else if is_left(u, v) {
                    1
                } else {
                    2
                }
            })
            .collect();
        let mut shifted = labels.clone();
        for row in shifted.chunks_mut(sparse.size[0]) {
            let border = row.iter().position(|&label| label == 2).unwrap();
            row[border] = 1;
        }
        let noise = NoiseModel::new(ValueKind::Disparity, SensorNoise::Value { sigma: 0.05 }, 0.0).unwrap();
        let mut image = vec![7; 3];
        for (labels, is_exact) in [(&labels, true), (&shifted, false)] {
            Spreader::default().spread(&map, Space::Value, &sparse, labels, &noise, 4.0, &mut image);
            for (at, &label) in image.iter().enumerate() {
                let [u, v] = [at % width, at / width];
                let expected = match (is_measured(u, v), is_off(u, v)) {
                    (true, false) => {
                        if is_left(u, v) {
                            1
                        } else {
                            2
                        }
                    }
                    _ => 0,
                };
                // A plane that was fitted to pixels of both is off.
                assert!(label == expected || !is_exact && label < 3, "{label} at {u}, {v}, not {expected}");
            }
            let right = image.iter().filter(|&&label| label > 0).count();
            assert!(right > width * height / 9 - 20, "{right}");
        }
    }
}
