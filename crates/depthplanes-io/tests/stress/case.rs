//! One run: a map, what is known of it, and what is asked of it.

use crate::maps::{self, Map};
use crate::sensors;
use depthplanes::methods::{METHODS, MethodInfo, Param, ParamKind};
use depthplanes::scene::Random;
use depthplanes::{Coplanar, Sensor};

pub struct Case {
    pub map: Map,
    pub sensor: Sensor,
    pub method: &'static MethodInfo,
    pub values: Vec<f64>,
    pub curved: bool,
    pub coplanar: Option<Coplanar>,
    pub outline_tolerance_px: f64,
    /// A pixel to explain; not in most runs.
    pub explained: Option<[usize; 2]>,
}

impl Case {
    pub fn new(seed: u64) -> Self {
        let mut random = Random::new(seed);
        let random = &mut random;
        let sensor = sensors::sensor(random);
        let map = maps::map(random, &sensor);
        let method = METHODS[pick(random, METHODS.len() + 2).saturating_sub(2)]; // planar three times as often
        // Defaults, one of them changed, or all of them.
        let changed = pick(random, 3);
        let one = pick(random, method.params.len());
        let value = |(at, param): (usize, &Param)| {
            if changed == 2 || (changed == 1 && at == one) { within(random, param) } else { param.default }
        };
        let mut values: Vec<f64> = method.params.iter().enumerate().map(value).collect();
        // Small maps have small planes.
        if changed == 0 || pick(random, 2) == 0 {
            values[method.position("min-pixels").unwrap()] = pick(random, 30) as f64;
        }
        let explained = (pick(random, 40) == 0 && map.width * map.height <= 2000)
            .then(|| [pick(random, map.width), pick(random, map.height)]);
        Case {
            map,
            sensor,
            method,
            values,
            curved: method.tells_curved && pick(random, 2) == 0,
            coplanar: (pick(random, 3) == 0).then(|| {
                let distance_m = if pick(random, 2) == 0 { 0.03 } else { logarithmic(random, 1e-12, 1e12) };
                Coplanar::new(random.between(0.0, 90.0), distance_m).unwrap()
            }),
            outline_tolerance_px: [0.0, 1.5, logarithmic(random, 1e-9, 1e9)][pick(random, 3)],
            explained,
        }
    }
}

impl std::fmt::Display for Case {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Case { map, sensor, method, values, .. } = self;
        write!(f, "{} x {} {}, {}", map.width, map.height, map.about, method.name)?;
        for (param, value) in method.params.iter().zip(values).filter(|(param, value)| param.default != **value) {
            write!(f, " --{} {value:?}", param.name)?;
        }
        let (curved, coplanar, tolerance) = (self.curved, self.coplanar, self.outline_tolerance_px);
        write!(
            f,
            "; curved {curved}, {coplanar:?}, outlines {tolerance:?}, explained {:?}\n  {sensor:?}",
            self.explained
        )
    }
}

/// A whole number below `count`.
pub fn pick(random: &mut Random, count: usize) -> usize {
    random.whole(0, count - 1)
}

/// A number between two positive ones whose logarithm is uniform.
pub fn logarithmic(random: &mut Random, low: f64, high: f64) -> f64 {
    (random.between(low.log2(), high.log2())).exp2().clamp(low, high)
}

/// Any value that a parameter accepts: its ends, its default, and what lies between.
fn within(random: &mut Random, param: &Param) -> f64 {
    let &Param { min, max, default, .. } = param;
    let near = |random: &mut Random| default * logarithmic(random, 1e-3, 1e3);
    let value = match pick(random, 8) {
        0 => min,
        1 => max,
        2 => default,
        3 | 4 => near(random),
        5 => logarithmic(random, 1e-9, 1e3),
        _ => logarithmic(random, min.max(1e-300), max.max(1e-299)),
    };
    let value = value.clamp(min, max);
    match param.kind {
        ParamKind::Whole => value.round(),
        ParamKind::OddOrOff if pick(random, 2) == 0 => 0.0,
        ParamKind::OddOrOff => ((value / 2.0).floor() * 2.0 + 1.0).clamp(min, max),
        _ => value,
    }
}
