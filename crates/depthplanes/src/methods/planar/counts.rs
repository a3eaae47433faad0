//! Depth in single precision that counts whole millimetres is worked on as that count.
//!
//! In: a map of floats. Out: the same numbers as `u16`, if each of them is a whole number of one of [`UNITS_M`], to
//! within single precision. 1.234 m as a float is off by a fifty-millionth; after ten stages with thresholds that is
//! enough to divide a region differently here and there. Read back as 1,234 mm, it gives what the map of millimetres
//! gives, to the last bit.

use super::pipeline::Runner;
use super::source::Source;
use crate::camera::ValueKind;
use crate::detection::{Detection, MapFit};
use crate::error::Result;
use crate::explanation::Explanation;
use crate::map::{DepthView, Pixel};
use crate::methods::method::{Job, MethodInfo};
use crate::sensor::Sensor;
use crate::util::memory::reserve_to;

/// Units that depth is stored in, metres, the coarsest first: whole millimetres, TUM's fifths, tenths.
const UNITS_M: [f64; 3] = [0.001, 0.0002, 0.0001];
/// How far off a whole number a value may be, units in the last place: one rounding when it was made, one here.
const PLACES: f64 = 2.0;

/// A map's values as counts; reuses its memory.
#[derive(Default)]
pub(super) struct Counts {
    pixels: Vec<u16>,
    source: Source,
}

/// What a map counts.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Counted {
    /// Counts of one map unit.
    per_unit: f64,
    /// The sensor of the counts.
    sensor: Sensor,
}

impl Counts {
    /// Finds planes in a map, of floats or not.
    ///
    /// # Errors
    /// As [`crate::Detector::detect`].
    pub(super) fn run<T: Pixel>(
        &mut self,
        runner: &mut Runner,
        map: &DepthView<'_, T>,
        job: &mut Job<'_>,
        out: &mut Detection,
    ) -> Result<()> {
        let Counts { pixels, source } = self;
        let Some((view, counted)) = counted(pixels, map, &job.sensor) else { return source.run(runner, map, job, out) };
        let result = counted.on(job, |job| source.run(runner, &view, job, out));
        counted.restore(out);
        result
    }

    /// Says why a pixel has a plane or none.
    ///
    /// # Errors
    /// As [`crate::Detector::explain`].
    pub(super) fn explain<T: Pixel>(
        &mut self,
        runner: &mut Runner,
        info: &'static MethodInfo,
        map: &DepthView<'_, T>,
        job: &mut Job<'_>,
        at: [usize; 2],
    ) -> Result<Explanation> {
        let Counts { pixels, source } = self;
        let Some((view, counted)) = counted(pixels, map, &job.sensor) else {
            return source.explain(runner, info, map, job, at);
        };
        let mut explanation = counted.on(job, |job| source.explain(runner, info, &view, job, at));
        explanation.iter_mut().for_each(|explanation| counted.restore_value(explanation));
        explanation
    }
}

/// The counts of a map of depth, 0 where nothing was measured; `None` for other maps, and where a value is no count.
fn counted<'a, T: Pixel>(
    pixels: &'a mut Vec<u16>,
    map: &DepthView<'_, T>,
    sensor: &Sensor,
) -> Option<(DepthView<'a, u16>, Counted)> {
    let ValueKind::Depth { metres } = sensor.value_kind else { return None };
    if T::IS_INTEGER {
        return None;
    }
    let unit_m = UNITS_M.into_iter().find(|unit_m| count(pixels, map, metres / unit_m))?;
    let counted = Counted {
        per_unit: metres / unit_m,
        sensor: Sensor { value_kind: ValueKind::Depth { metres: unit_m }, ..*sensor },
    };
    let view = DepthView::new(&pixels[..], map.width(), map.height()).ok()?;
    Some((view, counted))
}

/// Counts a map's values; whether all of them are counts.
fn count<T: Pixel>(pixels: &mut Vec<u16>, map: &DepthView<'_, T>, per_unit: f64) -> bool {
    reserve_to(pixels, map.area());
    let validity = map.validity();
    let is_count = |&value: &T, count: &mut u16| {
        let exact = per_unit * value.into();
        let whole = exact.round();
        let off = (exact - whole).abs();
        *count = if validity.holds(value) { whole as u16 } else { 0 };
        let fits = (1.0..=f64::from(u16::MAX)).contains(&whole);
        !validity.holds(value) | (fits & (off <= PLACES * f64::from(f32::EPSILON) * exact))
    };
    for v in 0..map.height() {
        let first = pixels.len();
        pixels.resize(first + map.width(), 0);
        let counts = &mut pixels[first..];
        if !map.row(v).iter().zip(counts).fold(true, |all, (value, count)| all & is_count(value, count)) {
            return false;
        }
    }
    true
}

impl Counted {
    /// Works on the counts.
    fn on<R>(&self, job: &mut Job<'_>, work: impl FnOnce(&mut Job<'_>) -> R) -> R {
        let sensor = std::mem::replace(&mut job.sensor, self.sensor);
        let result = work(job);
        job.sensor = sensor;
        result
    }

    /// Turns what was found in counts into the map's own units.
    fn restore(&self, out: &mut Detection) {
        let per_count = 1.0 / self.per_unit;
        let restore = |fit: &mut MapFit| {
            let MapFit { gradient: [a, b], offset, rms } = fit;
            [a, b, offset, rms].into_iter().for_each(|number| *number *= per_count);
        };
        let parts = out.parts.iter_mut().map(|part| &mut part.plane);
        out.planes.iter_mut().chain(parts).filter_map(|plane| plane.fit.as_mut()).for_each(restore);
    }

    /// The same of an explanation, which names the pixel's value.
    fn restore_value(&self, explanation: &mut Explanation) {
        let quantities = explanation.findings.iter_mut().flat_map(|finding| &mut finding.quantities);
        quantities.filter(|quantity| quantity.name == "value").for_each(|quantity| quantity.value /= self.per_unit);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::util::random::Random;

    const METRES: Sensor = Sensor {
        value_kind: ValueKind::Depth { metres: 1.0 },
        intrinsics: None,
        distortion: None,
        noise: None,
        smooth_noise: None,
    };

    /// The counts of a map of 50 columns, and how many a map unit has.
    fn counts_of<T: Pixel>(map: &[T], sensor: Sensor) -> Option<(Vec<u16>, f64)> {
        let mut pixels = vec![5; 7]; // of another map
        let view = DepthView::new(map, 50, map.len() / 50).unwrap();
        let (view, counted) = counted(&mut pixels, &view, &sensor)?;
        let ValueKind::Depth { metres } = counted.sensor.value_kind else { panic!("counts are of depth") };
        let ValueKind::Depth { metres: unit } = sensor.value_kind else { panic!("so are they") };
        assert!((metres * counted.per_unit / unit - 1.0).abs() < 1e-12);
        Some((view.rows().flatten().copied().collect(), counted.per_unit))
    }

    /// Counts in no order, of which some are missing.
    fn counts(seed: u64, most: usize) -> Vec<u16> {
        let mut random = Random::new(seed);
        (0..50 * 20).map(|_| if random.uniform() < 0.2 { 0 } else { random.whole(1, most) as u16 }).collect()
    }

    #[test]
    fn floats_that_count_whole_millimetres_fifths_and_tenths_are_found() {
        for (seed, per_metre) in (0..).zip([1000.0, 5000.0, 10_000.0]) {
            let counts = counts(seed, 65_535);
            // Made in single precision, in double precision, and in millimetres that are floats.
            let floats: [(f64, Vec<f32>); 3] = [
                (1.0, counts.iter().map(|&count| f32::from(count) / per_metre as f32).collect()),
                (1.0, counts.iter().map(|&count| (f64::from(count) / per_metre) as f32).collect()),
                (0.001, counts.iter().map(|&count| (f64::from(count) * 1000.0 / per_metre) as f32).collect()),
            ];
            for (metres, floats) in floats {
                let sensor = Sensor { value_kind: ValueKind::Depth { metres }, ..METRES };
                let (found, per_unit) = counts_of(&floats, sensor).unwrap();
                assert_eq!(found, counts);
                assert!((per_unit / (per_metre * metres) - 1.0).abs() < 1e-12, "{per_unit} a unit");
            }
        }
    }

    #[test]
    fn a_single_float_that_is_no_count_and_one_beyond_the_largest_are_enough_for_there_to_be_none() {
        let millimetres: Vec<f32> = counts(3, 9000).iter().map(|&count| f32::from(count) / 1000.0).collect();
        assert!(counts_of(&millimetres, METRES).is_some());
        for stray in [1.23456, 1.000_07, 1.000_01, 1.000_002, 66.0, 1e-5, -1.0] {
            let mut map = millimetres.clone();
            map[777] = stray;
            assert_eq!(counts_of(&map, METRES), None, "{stray}");
        }
        // What is not valid is no count and does no harm.
        for missing in [f32::NAN, f32::INFINITY, 0.0] {
            let mut map = millimetres.clone();
            map[777] = missing;
            assert_eq!(counts_of(&map, METRES).unwrap().0[777], 0);
        }
    }

    #[test]
    fn whole_numbers_and_what_is_no_depth_are_not_counted() {
        let counts = counts(4, 9000);
        let floats: Vec<f32> = counts.iter().map(|&count| f32::from(count)).collect();
        let millimetres = Sensor { value_kind: ValueKind::Depth { metres: 0.001 }, ..METRES };
        assert!(counts_of(&floats, millimetres).is_some());
        assert_eq!(counts_of(&counts, millimetres), None);
        assert_eq!(counts_of(&floats, Sensor { value_kind: ValueKind::Disparity, ..METRES }), None);
    }

    #[test]
    fn what_is_found_in_counts_is_told_in_the_units_of_the_map() {
        let counted = Counted { per_unit: 1000.0, sensor: METRES };
        let mut plane =
            crate::detection::Plane::new(1, 5, crate::detection::PixelBox { u_min: 0, v_min: 0, u_max: 1, v_max: 1 });
        plane.fit = Some(MapFit { gradient: [2.0, -3.0], offset: 1500.0, rms: 4.0 });
        let mut out = Detection { planes: vec![plane], ..Detection::default() };
        counted.restore(&mut out);
        let MapFit { gradient: [a, b], offset, rms } = out.planes[0].fit.unwrap();
        for (found, expected) in [(a, 0.002), (b, -0.003), (offset, 1.5), (rms, 0.004)] {
            assert!((found - expected).abs() < 1e-12, "{found}, not {expected}");
        }
        // The sensor of the counts is the job's while it works, and no longer.
        let mut job = Job { sensor: Sensor::default(), threads: 1, curved: false, joiner: None, observer: &mut |_| () };
        assert_eq!(counted.on(&mut job, |job| job.sensor), METRES);
        assert_eq!(job.sensor, Sensor::default());
    }
}
