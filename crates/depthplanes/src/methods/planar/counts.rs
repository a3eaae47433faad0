//! Depth in single precision that counts whole millimetres is worked on as that count.
//!
//! In: a map of floats. Out: the same numbers as `u16`, if each of them is a whole number of one of [`UNITS_M`], to within
//! single precision. 1.234 m as a float is off by a fifty-millionth; through ten stages with limits that is enough to part
//! another region here and there. Read back as 1,234 mm it gives what the map of millimetres gives, to the last bit.

use super::Runner;
use crate::camera::{Measure, Sensor};
use crate::detection::{Detection, MapFit};
use crate::error::Result;
use crate::explanation::Explanation;
use crate::group::reserve_to;
use crate::map::{DepthView, Pixel};
use crate::methods::Job;

/// Units that depth is stored in, metres, the coarsest first: whole millimetres, TUM's fifths, tenths.
const UNITS_M: [f64; 3] = [0.001, 0.0002, 0.0001];
/// How far off a whole number a value may be, units in the last place: one rounding when it was made, one here.
const PLACES: f64 = 2.0;

impl Runner {
    /// Finds planes in a map, of floats or not.
    ///
    /// # Errors
    /// As [`crate::methods::Method::run`].
    pub(super) fn planar_of_counts<T: Pixel>(
        &mut self,
        map: &DepthView<'_, T>,
        job: &mut Job<'_>,
        out: &mut Detection,
    ) -> Result<()> {
        let mut counts = std::mem::take(&mut self.counts);
        let result = match counts.of(map, &job.sensor) {
            Some((view, counted)) => {
                let result = counted.on(job, |job| self.planar_of_source(&view, job, out));
                counted.restore(out);
                result
            }
            None => self.planar_of_source(map, job, out),
        };
        self.counts = counts;
        result
    }

    /// Says why a pixel has a plane or none.
    ///
    /// # Errors
    /// As [`crate::methods::Method::explain`].
    pub(super) fn explain_of_counts<T: Pixel>(
        &mut self,
        map: &DepthView<'_, T>,
        job: &mut Job<'_>,
        at: [usize; 2],
    ) -> Result<Explanation> {
        let mut counts = std::mem::take(&mut self.counts);
        let result = match counts.of(map, &job.sensor) {
            Some((view, counted)) => {
                let mut explanation = counted.on(job, |job| self.explain_of_source(&view, job, at));
                explanation.iter_mut().for_each(|explanation| counted.restore_value(explanation));
                explanation
            }
            None => self.explain_of_source(map, job, at),
        };
        self.counts = counts;
        result
    }
}

/// A map's values as counts; reuses its memory.
#[derive(Debug, Default)]
pub(super) struct Counts {
    pixels: Vec<u16>,
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
    /// The counts of a map of depth, 0 where nothing was measured; `None` for other maps, and where a value is no count.
    fn of<T: Pixel>(&mut self, map: &DepthView<'_, T>, sensor: &Sensor) -> Option<(DepthView<'_, u16>, Counted)> {
        let Measure::Depth { metres } = sensor.measure else { return None };
        if T::IS_INTEGER {
            return None;
        }
        let unit_m = UNITS_M.into_iter().find(|unit_m| self.count(map, metres / unit_m))?;
        let counted = Counted {
            per_unit: metres / unit_m,
            sensor: Sensor { measure: Measure::Depth { metres: unit_m }, ..*sensor },
        };
        let view = DepthView::new(&self.pixels[..], map.width(), map.height()).ok()?;
        Some((view, counted))
    }

    /// Counts a map's values; whether all of them are counts.
    fn count<T: Pixel>(&mut self, map: &DepthView<'_, T>, per_unit: f64) -> bool {
        reserve_to(&mut self.pixels, map.area());
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
            let first = self.pixels.len();
            self.pixels.resize(first + map.width(), 0);
            let counts = &mut self.pixels[first..];
            if !map.row(v).iter().zip(counts).fold(true, |all, (value, count)| all & is_count(value, count)) {
                return false;
            }
        }
        true
    }
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
