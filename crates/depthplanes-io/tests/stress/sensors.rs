//! What is known of a map: sensible, odd, and at the limits of what is accepted.

use crate::case::{logarithmic, pick};
use depthplanes::noise::{NoiseTable, SensorNoise};
use depthplanes::scene::Random;
use depthplanes::{DepthView, Detector, Intrinsics, Ngaf, Sensor, ValueKind};

/// Any sensor; one in eight may be refused.
pub fn sensor(random: &mut Random) -> Sensor {
    let mut made = any_sensor(random);
    let may_be_refused = pick(random, 8) == 0;
    while !may_be_refused && is_refused(&made) {
        made = any_sensor(random);
    }
    made
}

fn is_refused(sensor: &Sensor) -> bool {
    let pixel = [1u8];
    let view = DepthView::new(&pixel, 1, 1).unwrap();
    Detector::new(Ngaf::default()).unwrap().sensor(*sensor).detect(view).is_err()
}

fn any_sensor(random: &mut Random) -> Sensor {
    let sensor = Sensor::default().value_kind(value_kind(random)).intrinsics(camera(random));
    match pick(random, 4) {
        0 => sensor.noise(noise(random)).smooth_noise(noise(random)),
        1 => sensor.noise(noise(random)),
        _ => sensor,
    }
}

/// Either sign.
fn signed(random: &mut Random, size: f64) -> f64 {
    if pick(random, 3) == 0 { -size } else { size }
}

fn value_kind(random: &mut Random) -> ValueKind {
    match pick(random, 8) {
        0 | 1 => ValueKind::Depth { metres: 0.001 },
        2 => ValueKind::Depth { metres: logarithmic(random, 1e-30, 1e30) },
        3 => ValueKind::Depth { metres: logarithmic(random, 1e-12, 1e12) },
        4 => ValueKind::InverseDepth { slope: 1.0 / 375.0, offset: 0.0 },
        5 => {
            let slope = logarithmic(random, 1e-30, 1e30);
            let offset = [0.0, 1.0, logarithmic(random, 1e-30, 1e30)][pick(random, 3)];
            ValueKind::InverseDepth { slope: signed(random, slope), offset: signed(random, offset) }
        }
        6 => {
            let slope = logarithmic(random, 1e-9, 1e3);
            let offset = logarithmic(random, 1e-6, 1e3);
            ValueKind::InverseDepth { slope: signed(random, slope), offset: signed(random, offset) }
        }
        _ => ValueKind::Disparity,
    }
}

fn camera(random: &mut Random) -> Option<Intrinsics> {
    let [near, fx, fy] = [(); 3].map(|()| logarithmic(random, 1e-9, 1e9));
    let focal = random.between(20.0, 700.0);
    let plain = Intrinsics { fx: focal, fy: focal, cx: random.between(0.0, 200.0), cy: random.between(0.0, 150.0) };
    match pick(random, 6) {
        0 => None,
        1 | 2 => Some(plain),
        3 => Some(Intrinsics { fy: -plain.fy, ..plain }),
        4 => Some(Intrinsics { fx: signed(random, fx), fy: signed(random, fy), ..plain }),
        _ => {
            let [cx, cy] = [(); 2].map(|()| logarithmic(random, 1.0, 1e9));
            Some(Intrinsics { fx: near, fy: near, cx: signed(random, cx), cy: signed(random, cy) })
        }
    }
}

fn noise(random: &mut Random) -> SensorNoise {
    let mut any = || [0.0, 1e-3, logarithmic(random, 1e-30, 1e30), logarithmic(random, 1e-6, 10.0)][pick(random, 4)];
    let (base, growth) = (any(), any());
    let mut rows: Vec<[f64; 2]> = (0..3).map(|_| [any() + f64::MIN_POSITIVE, any()]).collect();
    match pick(random, 3) {
        0 => SensorNoise::Depth { base, growth },
        1 => SensorNoise::Value { sigma: base },
        _ => {
            rows.sort_by(|one, other| one[0].total_cmp(&other[0]));
            rows.dedup_by_key(|row| row[0]);
            NoiseTable::new(&rows).map_or(SensorNoise::Value { sigma: growth }, SensorNoise::Table)
        }
    }
}
