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

/// Labels of the groups with more than `min` pixels: by decreasing size, then by first pixel.
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

/// Enhancing, section 3b: window by window.
pub fn enhance(map: &[f64], width: usize, ok: impl Fn(f64) -> bool, window: usize, whole: bool) -> Vec<f64> {
    let height = map.len() / width;
    let reach = window / 2;
    let mut out = map.to_vec();
    for v in 0..height {
        for u in 0..width {
            if ok(map[v * width + u]) {
                continue;
            }
            let (mut area, mut count, mut sum) = (0, 0, 0.0);
            for y in v.saturating_sub(reach)..(v + reach + 1).min(height) {
                for x in u.saturating_sub(reach)..(u + reach + 1).min(width) {
                    area += 1;
                    if ok(map[y * width + x]) {
                        count += 1;
                        sum += map[y * width + x];
                    }
                }
            }
            if count > 0 && 2 * (area - count) <= area {
                let mean = sum / count as f64;
                out[v * width + u] = if whole { (mean + 0.5).floor() } else { f64::from(mean as f32) };
            }
        }
    }
    out
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
