//! Maps of every size, type and kind.

use crate::case::{logarithmic, pick};
use depthplanes::scene::Random;
use depthplanes::{DepthView, Pixel, Sensor, ValueKind};
use depthplanes_io::Pixels;

/// A map whose rows lie `stride` pixels apart.
pub struct Map {
    pub width: usize,
    pub height: usize,
    pub stride: usize,
    pub pixels: Pixels,
    pub missing: Option<f64>,
    pub valid_range: Option<(f64, f64)>,
    /// What it is, for people.
    pub about: String,
}

impl Map {
    /// Its view of one type.
    pub fn view<'a, T: Pixel>(&self, pixels: &'a [T]) -> DepthView<'a, T> {
        let mut view = DepthView::with_stride(pixels, self.width, self.height, self.stride).unwrap();
        if let Some(missing) = self.missing {
            view = view.missing_value(T::from_f64(missing));
        }
        if let Some((low, high)) = self.valid_range {
            view = view.valid_range(T::from_f64(low), T::from_f64(high)).unwrap();
        }
        view
    }

    /// Its pixels without what lies between rows.
    pub fn packed(&self) -> Pixels {
        fn rows<T: Copy>(pixels: &[T], map: &Map) -> Vec<T> {
            pixels.chunks(map.stride).flat_map(|row| &row[..map.width]).copied().collect()
        }
        match &self.pixels {
            Pixels::U8(pixels) => Pixels::U8(rows(pixels, self)),
            Pixels::U16(pixels) => Pixels::U16(rows(pixels, self)),
            Pixels::F32(pixels) => Pixels::F32(rows(pixels, self)),
        }
    }
}

pub fn map(random: &mut Random, sensor: &Sensor) -> Map {
    let (width, height) = size(random);
    let stride = if pick(random, 4) == 0 { width + pick(random, 9) } else { width };
    let kind = pick(random, 3);
    let level = level(random, sensor, kind);
    let (about, mut values) = surface(random, [width, height], level);
    let gaps = gaps(random, [width, height], &mut values, level, kind == 2);
    let padded = |_: &()| f64::from(u8::MAX);
    let strided: Vec<f64> = (0..height)
        .flat_map(|v| {
            let end = if v + 1 == height { width } else { stride };
            let row = values[v * width..][..width].to_vec();
            row.into_iter().chain(vec![(); end - width].into_iter().map(move |nothing| padded(&nothing)))
        })
        .collect();
    let pixels = match kind {
        0 => Pixels::U8(strided.iter().map(|&value| u8::from_f64(value)).collect()),
        1 => Pixels::U16(strided.iter().map(|&value| u16::from_f64(value)).collect()),
        _ => Pixels::F32(strided.iter().map(|&value| value as f32).collect()),
    };
    let missing = (pick(random, 4) == 0).then(|| values[pick(random, values.len())].round().clamp(-1e30, 1e30));
    let valid_range = (pick(random, 6) == 0).then_some((level * 0.5, level * 1.5)).filter(|&(low, high)| match kind {
        0 => u8::from_f64(low) < u8::from_f64(high),
        1 => u16::from_f64(low) < u16::from_f64(high),
        _ => (low as f32) < high as f32,
    });
    let kind = ["u8", "u16", "f32"][kind];
    let about =
        format!("{kind} stride {stride} {about}, {gaps}, level {level:e}, missing {missing:?}, valid {valid_range:?}");
    Map { width, height, stride, pixels, missing, valid_range, about }
}

/// Mostly small; around the sides of tiles and blocks; lines; now and then a large one.
fn size(random: &mut Random) -> (usize, usize) {
    let mut around = |sizes: &[usize]| sizes[pick(random, sizes.len())] - 1 + pick(random, 3);
    let near = [around(&[2, 4, 8, 16, 32, 64]), around(&[2, 4, 8, 16, 32, 64])];
    match pick(random, 400) {
        0 => (1, 1),
        1..10 => (1, 1 + pick(random, 300)),
        10..20 => (1 + pick(random, 300), 1),
        20 => (100 + pick(random, 100), 100 + pick(random, 50)),
        21 if pick(random, 50) == 0 => (1000, 700),
        22..150 => (near[0], near[1]),
        150..230 => (40 + pick(random, 60), 40 + pick(random, 40)),
        _ => (1 + pick(random, 48), 1 + pick(random, 36)),
    }
}

/// The values' magnitude.
fn level(random: &mut Random, sensor: &Sensor, kind: usize) -> f64 {
    match kind {
        0 => random.between(2.0, 255.0),
        1 => [random.between(500.0, 5000.0), logarithmic(random, 1.0, 65_535.0)][pick(random, 2)],
        _ => match pick(random, 6) {
            0 => logarithmic(random, 1e-45, 3.4e38),
            1 => logarithmic(random, 1e-6, 1e9),
            // What the sensor says is some metres away.
            2 | 3 => match sensor.value_kind {
                ValueKind::Disparity => random.between(2.0, 100.0),
                value_kind => value_kind.value(random.between(0.5, 8.0)).unwrap_or(1.0).clamp(-1e38, 1e38),
            },
            _ => random.between(0.5, 8.0),
        },
    }
}

/// Values of a surface, and its name.
fn surface(random: &mut Random, [width, height]: [usize; 2], level: f64) -> (&'static str, Vec<f64>) {
    let places = || (0..width * height).map(move |at| ((at % width) as f64, (at / width) as f64));
    let [steep, noise] =
        [[0.0, 1e-3, 0.3], [0.0, 1e-3, 0.1]].map(|sizes| level * sizes[pick(random, 3)] * random.uniform());
    let (a, b) = (steep * random.between(-0.1, 0.1), steep * random.between(-0.1, 0.1));
    let [cu, cv] = [random.uniform() * width as f64, random.uniform() * height as f64];
    let radius = random.between(2.0, 40.0);
    match [0, 1, 2, 3, 4, 5, 6, 6, 6, 7, 7, 8, 9, 10][pick(random, 14)] {
        0 => ("constant", vec![level; width * height]),
        1 => ("ramp", places().map(|(u, v)| level + a * u + b * v).collect()),
        2 => ("huge ramp", places().map(|(u, v)| level * (1.0 + 1e3 * (u - cu)) + 1e6 * b * v).collect()),
        3 => ("noise", (0..width * height).map(|_| level * random.uniform()).collect()),
        4 => ("all sizes", (0..width * height).map(|_| logarithmic(random, 1e-45, 3.4e38)).collect()),
        5 => {
            let side = 1 + pick(random, 8);
            let is_near = |u: f64, v: f64| (u as usize / side + v as usize / side).is_multiple_of(2);
            ("checkerboard", places().map(|(u, v)| if is_near(u, v) { level } else { 0.7 * level }).collect())
        }
        6 => {
            let ball = |u: f64, v: f64| 1.0 - ((u - cu).powi(2) + (v - cv).powi(2)) / (radius * radius);
            let value = |(u, v)| level * (1.0 - 0.2 * ball(u, v).max(0.0).sqrt()) + noise * random.gaussian() * 0.1;
            ("ball", places().map(value).collect())
        }
        7 => {
            let column = |u: f64| (1.0 - ((u - cu) / radius).powi(2)).max(0.0).sqrt();
            ("column", places().map(|(u, _)| level / (1.0 + 0.5 * column(u))).collect())
        }
        8 => ("inverse ramp", places().map(|(u, v)| level / (1.0 + 0.02 * (u - cu) + 0.01 * (v - cv))).collect()),
        9 => {
            let value = |(u, v)| {
                let step = if (u - cu) * 0.7 < v - cv { 1.0 } else { 1.3 };
                step * (level + a * u + b * v) + noise * random.gaussian()
            };
            ("steps", places().map(value).collect())
        }
        _ => {
            let value = |(u, v)| level + a * u + b * v + noise * random.gaussian();
            ("noisy plane", places().map(value).collect())
        }
    }
}

/// Makes gaps, and puts odd values into floats.
fn gaps(
    random: &mut Random,
    [width, height]: [usize; 2],
    values: &mut [f64],
    level: f64,
    is_float: bool,
) -> &'static str {
    let odd = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, -level, 1e-45, 3.4028234e38, -3.4e38, 1e-38];
    let gap = if is_float && pick(random, 2) == 0 { odd[pick(random, odd.len())] } else { 0.0 };
    let corner = [pick(random, width), pick(random, height)];
    let share = random.uniform();
    let one_in = 1 + pick(random, 7);
    let mut fill = |is_gap: &mut dyn FnMut(usize, usize) -> bool| {
        for (at, value) in values.iter_mut().enumerate() {
            if is_gap(at % width, at / width) {
                *value = gap;
            }
        }
    };
    match pick(random, 8) {
        0 => fill(&mut |u, v| u >= corner[0] && v >= corner[1]),
        1 => fill(&mut |_, _| random.uniform() < share),
        2 => fill(&mut |_, _| random.uniform() < 0.02),
        3 => fill(&mut |u, _| u % (1 + one_in) == 0),
        4 => fill(&mut |_, v| v % (1 + one_in) == 0),
        5 => fill(&mut |u, v| u == corner[0] || v == corner[1]),
        6 if pick(random, 4) == 0 => fill(&mut |_, _| true),
        6 if is_float => values.iter_mut().for_each(|value| {
            if random.uniform() < 0.05 {
                *value = odd[pick(random, odd.len())];
            }
        }),
        _ => return "no gaps",
    }
    "gaps"
}
