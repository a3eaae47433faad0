//! Depth in single precision that counts whole millimetres is worked on as that count.
//!
//! In: a map of floats. Out: the same numbers as `u16`, if each of them is a whole number of one of [`UNITS_M`], to
//! within single precision. 1.234 m as a float is off by a fifty-millionth; after ten stages with thresholds that is
//! enough to divide a region differently here and there. Read back as 1,234 mm, it gives what the map of millimetres
//! gives, to the last bit.

use super::enlarged::Source;
use super::pipeline::Runner;
use crate::camera::Measure;
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
    let Measure::Depth { metres } = sensor.measure else { return None };
    if T::IS_INTEGER {
        return None;
    }
    let unit_m = UNITS_M.into_iter().find(|unit_m| count(pixels, map, metres / unit_m))?;
    let counted =
        Counted { per_unit: metres / unit_m, sensor: Sensor { measure: Measure::Depth { metres: unit_m }, ..*sensor } };
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
