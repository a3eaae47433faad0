//! The definitions, written as plainly as can be. They share no code with the library.
#![allow(dead_code)] // each test file uses its own part

/// Whether a value is a measurement.
pub fn valid(value: f64, sentinel: f64, low: f64, high: f64) -> bool {
    value.is_finite() && value != 0.0 && value != sentinel && value >= low && value <= high
}

/// Groups by flood fill: for each pixel the raster index of its group's first pixel, or `None`.
pub fn flood(map: &[f64], width: usize, ok: impl Fn(f64) -> bool, theta: f64, single: bool) -> Vec<Option<usize>> {
    let mut group = vec![None; map.len()];
    let close = |a: f64, b: f64| {
        if single { (a as f32 - b as f32).abs() <= theta as f32 } else { (a - b).abs() <= theta }
    };
    for seed in 0..map.len() {
        if group[seed].is_some() || !ok(map[seed]) {
            continue;
        }
        let mut stack = vec![seed];
        group[seed] = Some(seed);
        while let Some(at) = stack.pop() {
            let (u, v) = (at % width, at / width);
            let mut visit = |to: usize| {
                if group[to].is_none() && ok(map[to]) && close(map[at], map[to]) {
                    group[to] = Some(seed);
                    stack.push(to);
                }
            };
            if u > 0 {
                visit(at - 1);
            }
            if u + 1 < width {
                visit(at + 1);
            }
            if v > 0 {
                visit(at - width);
            }
            if at + width < map.len() {
                visit(at + width);
            }
        }
    }
    group
}

/// Labels of the groups with more than `min-pixels` pixels: by decreasing size, then by first pixel.
pub fn select(group: &[Option<usize>], min: usize) -> Vec<u16> {
    let mut size = vec![0; group.len()];
    group.iter().flatten().for_each(|&first| size[first] += 1);
    let mut order: Vec<usize> = (0..size.len()).filter(|&first| size[first] > min).collect();
    order.sort_by_key(|&first| (usize::MAX - size[first], first));
    let mut label = vec![0; group.len()];
    for (index, &first) in order.iter().enumerate() {
        label[first] = u16::try_from(index + 1).expect("few planes");
    }
    group.iter().map(|first| first.map_or(0, |first| label[first])).collect()
}

/// Enhancing, section 3b: window by window. The filled map, and how many pixels were filled.
pub fn enhance(
    map: &[f64],
    width: usize,
    ok: impl Fn(f64) -> bool,
    window: usize,
    mean: impl Fn(&[f64]) -> f64,
) -> (Vec<f64>, usize) {
    let height = map.len() / width;
    let reach = window / 2;
    let mut out = map.to_vec();
    let mut filled = 0;
    for v in 0..height {
        for u in 0..width {
            if ok(map[v * width + u]) {
                continue;
            }
            let (mut area, mut values) = (0, Vec::new());
            for y in v.saturating_sub(reach)..(v + reach + 1).min(height) {
                for x in u.saturating_sub(reach)..(u + reach + 1).min(width) {
                    area += 1;
                    if ok(map[y * width + x]) {
                        values.push(map[y * width + x]);
                    }
                }
            }
            if !values.is_empty() && 2 * (area - values.len()) <= area && ok(mean(&values)) {
                out[v * width + u] = mean(&values);
                filled += 1;
            }
        }
    }
    (out, filled)
}

/// The mean of whole numbers, rounded half up, in whole numbers.
pub fn whole_mean(values: &[f64]) -> f64 {
    let (sum, count) = (values.iter().map(|&value| value as u64).sum::<u64>(), values.len() as u64);
    ((2 * sum + count) / (2 * count)) as f64
}

/// The mean as the nearest single-precision number.
pub fn single_mean(values: &[f64]) -> f64 {
    f64::from((values.iter().sum::<f64>() / values.len() as f64) as f32)
}

/// A plane's record, recomputed from its pixels.
#[derive(Debug)]
pub struct Record {
    pub pixel_count: usize,
    /// `[u_min, v_min, u_max, v_max]`
    pub bounding_box: [usize; 4],
    pub centroid: [f64; 2],
    pub fit: Option<Fit>,
    /// Raster index of the first pixel.
    pub first: usize,
}

/// `q = a u + b v + c`, and the root mean square of what is left.
#[derive(Clone, Copy, Debug)]
pub struct Fit {
    pub abc: [f64; 3],
    pub rms: f64,
    /// Standard deviation of q, the scale that rounding errors go by.
    pub spread: f64,
}

/// Least squares in two passes: means, then everything about the means. `None` for points on a line.
pub fn fit(points: &[[f64; 3]]) -> Option<Fit> {
    let n = points.len() as f64;
    let mean: [f64; 3] = std::array::from_fn(|k| points.iter().map(|p| p[k]).sum::<f64>() / n);
    let sum = |i: usize, j: usize| -> f64 { points.iter().map(|p| (p[i] - mean[i]) * (p[j] - mean[j])).sum() };
    let (uu, uv, vv, uq, vq) = (sum(0, 0), sum(0, 1), sum(1, 1), sum(0, 2), sum(1, 2));
    let det = uu * vv - uv * uv;
    if det <= 1e-9 * uu * vv {
        return None;
    }
    let (a, b) = ((uq * vv - vq * uv) / det, (vq * uu - uq * uv) / det);
    let c = mean[2] - a * mean[0] - b * mean[1];
    // About the means, where no digits are lost.
    let left = |p: &[f64; 3]| p[2] - mean[2] - a * (p[0] - mean[0]) - b * (p[1] - mean[1]);
    let squares: f64 = points.iter().map(|p| left(p) * left(p)).sum();
    Some(Fit { abc: [a, b, c], rms: (squares / n).sqrt(), spread: (sum(2, 2) / n).sqrt() })
}

/// The record of each label 1, 2, .. of a label image.
pub fn records(labels: &[u16], map: &[f64], width: usize) -> Vec<Record> {
    let most = usize::from(labels.iter().copied().max().unwrap_or(0));
    let mut pixels = vec![Vec::new(); most + 1];
    for (at, &label) in labels.iter().enumerate() {
        pixels[usize::from(label)].push(at);
    }
    pixels[1..].iter().map(|pixels| record(pixels, map, width)).collect()
}

fn record(pixels: &[usize], map: &[f64], width: usize) -> Record {
    assert!(!pixels.is_empty(), "a label that no pixel carries");
    let columns = || pixels.iter().map(|at| at % width);
    let rows = || pixels.iter().map(|at| at / width);
    let n = pixels.len() as f64;
    let mean = |sum: usize| sum as f64 / n;
    let points: Vec<_> = pixels.iter().map(|&at| [(at % width) as f64, (at / width) as f64, map[at]]).collect();
    let end = |side: Option<usize>| side.expect("some pixel");
    Record {
        pixel_count: pixels.len(),
        bounding_box: [end(columns().min()), end(rows().min()), end(columns().max()), end(rows().max())],
        centroid: [mean(columns().sum()), mean(rows().sum())],
        fit: fit(&points),
        first: pixels[0],
    }
}

/// Deterministic pseudo-random numbers (Steele, Lea, Flood 2014, SplitMix64).
pub struct Random(pub u64);

impl Random {
    pub fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    /// A whole number in 0..end.
    pub fn below(&mut self, end: u64) -> u64 {
        self.next() % end
    }

    /// A number in low..high.
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * (self.next() >> 11) as f64 / (1u64 << 53) as f64
    }

    /// A draw of mean 0 and deviation 1 (Box and Muller 1958).
    pub fn gaussian(&mut self) -> f64 {
        let (radius, angle) = (1.0 - self.between(0.0, 1.0), self.between(0.0, std::f64::consts::TAU));
        (-2.0 * radius.ln()).sqrt() * angle.cos()
    }
}

/// Maps of every awkward kind, as whole numbers 0..=255: noise of several widths, all missing,
/// constant, stripes, checkerboards, ramps, holes.
pub fn awkward_map(random: &mut Random, width: usize, height: usize) -> Vec<u8> {
    let kind = random.below(10);
    let spread = 1 + random.below(12);
    let holes = random.below(4) * 15;
    let base = 40 + random.below(100);
    let mut map = Vec::with_capacity(width * height);
    for v in 0..height as u64 {
        for u in 0..width as u64 {
            let value = match kind {
                0 => 0,
                1 => base,
                2 => base + (u / 3 % 2) * spread,
                3 => base + (v / 2 % 2) * spread,
                4 => base + ((u + v) % 2) * spread,
                5 => (base + u / 4 + v / 5) % 256,
                6 => random.below(256),
                7 => ((u ^ v) & 255).max(1),
                _ => base + random.below(spread + 1),
            };
            map.push(if random.below(100) < holes { 0 } else { value as u8 });
        }
    }
    map
}
