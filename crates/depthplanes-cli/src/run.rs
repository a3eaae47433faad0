//! One map through the pipeline: which method with which parameters, and how long it takes.

use crate::failure::{Failure, Outcome};
use crate::pool;
use depthplanes::methods::{self, METHODS, MethodInfo};
use depthplanes::outline::{Outliner, Outlines};
use depthplanes::{Coplanar, Detection, Detector};
use depthplanes_io::outputs::{Spread, Times};
use depthplanes_io::{Frame, memory};
use std::collections::BTreeMap;
use std::time::Instant;

/// The stage that makes outlines, after the method's own.
const OUTLINE: &str = "outline";

/// A method with the value of each parameter, checked.
pub(crate) struct Recipe {
    pub(crate) method: &'static MethodInfo,
    pub(crate) values: Vec<f64>,
    threads: usize,
    /// Within what coplanar planes are joined, if that is wanted.
    pub(crate) coplanar: Option<Coplanar>,
    /// Tolerance of the planes' outlines, pixels, if they are wanted.
    outlines: Option<f64>,
    /// Pixels of the smallest hole that they keep.
    min_hole: usize,
    curved: bool,
}

/// What was found in a frame.
pub(crate) struct Found {
    pub(crate) detection: Detection,
    pub(crate) outlines: Option<Outlines>,
    pub(crate) times: Option<Times>,
}

impl Recipe {
    /// The method with some parameters given and the others at their defaults.
    ///
    /// # Errors
    /// A parameter that the method does not have, or a value out of range.
    pub(crate) fn new(method: &'static MethodInfo, given: &[(&'static str, f64)], threads: usize) -> Outcome<Self> {
        let mut values = method.defaults();
        for &(name, value) in given {
            let at = method.position(name);
            values[at.ok_or_else(|| lacks(method, name))?] = value;
        }
        drop(method.with(given)?); // they are checked
        let threads = pool::threads(threads);
        Ok(Recipe { method, values, threads, coplanar: None, outlines: None, min_hole: 0, curved: false })
    }

    /// The value of each parameter by its name.
    pub(crate) fn named_values(&self) -> BTreeMap<&'static str, f64> {
        self.method.params.iter().map(|param| param.name).zip(self.values.iter().copied()).collect()
    }

    /// Several methods by name, each with those of the parameters given that it has.
    ///
    /// # Errors
    /// An unknown method, a parameter that none of them has, a value out of range.
    pub(crate) fn several(names: &[String], given: &[(&'static str, f64)], threads: usize) -> Outcome<Vec<Self>> {
        let all = names.iter().map(|name| Ok(methods::find(name)?)).collect::<Outcome<Vec<_>>>()?;
        let has = |method: &MethodInfo, name: &str| method.position(name).is_some();
        if let Some((name, _)) = given.iter().find(|(name, _)| !all.iter().any(|method| has(method, name))) {
            return Err(Failure::request(format!("none of {} has a parameter `{name}`", names.join(", "))));
        }
        let recipe = |method: &'static MethodInfo| {
            let own: Vec<_> = given.iter().copied().filter(|(name, _)| has(method, name)).collect();
            Recipe::new(method, &own, threads)
        };
        all.into_iter().map(recipe).collect()
    }

    /// With the planes' outlines, simplified to within so many pixels and without smaller holes than that.
    ///
    /// # Errors
    /// A tolerance that is not a number of pixels.
    pub(crate) fn outlines(mut self, tolerance_px: Option<f64>, min_hole: usize) -> Outcome<Self> {
        (self.outlines, self.min_hole) = (tolerance_px, min_hole);
        self.outliner()?;
        Ok(self)
    }

    /// With surfaces that bend.
    ///
    /// # Errors
    /// A method that does not tell them.
    pub(crate) fn curved(mut self, yes: bool) -> Outcome<Self> {
        self.curved = yes;
        if yes && !self.method.tells_curved {
            let others: Vec<&str> =
                METHODS.iter().filter(|method| method.tells_curved).map(|method| method.name).collect();
            let message = format!(
                "method `{}` does not tell curved surfaces; --method {} does",
                self.method.name,
                others.join(", ")
            );
            return Err(Failure::request(message));
        }
        Ok(self)
    }

    /// With coplanar planes joined within an angle in degrees and a distance in metres.
    ///
    /// # Errors
    /// Limits out of range.
    pub(crate) fn merge_coplanar(mut self, limits: Option<[f64; 2]>) -> Outcome<Self> {
        self.coplanar = limits.map(|[angle_deg, distance_m]| Coplanar::new(angle_deg, distance_m)).transpose()?;
        Ok(self)
    }

    /// Every parameter with its value, for people and for records.
    pub(crate) fn written(&self) -> String {
        let all = self.method.params.iter().zip(&self.values);
        all.map(|(param, value)| format!("{} {value}", param.name)).collect::<Vec<_>>().join(", ")
    }

    /// Bytes that are used and reserved for a map.
    pub(crate) fn memory(&self, frame: &Frame) -> [u64; 2] {
        memory::of_detection(self.method, frame.width, frame.height)
    }

    fn outliner(&self) -> Outcome<Option<Outliner>> {
        let outliner = self.outlines.map(Outliner::new).transpose()?;
        Ok(outliner.map(|outliner| outliner.min_hole_px(self.min_hole)))
    }

    /// A detector of it.
    pub(crate) fn detector(&self) -> Detector {
        let method = self.method.of_values(&self.values).expect("the parameters were checked");
        let detector =
            Detector::new(method).expect("the parameters were checked").threads(self.threads).curved(self.curved);
        match self.coplanar {
            Some(within) => detector.merge_coplanar(within).expect("the limits were checked"),
            None => detector,
        }
    }
}

/// A parameter of another method: which has it, and what this one has.
fn lacks(method: &MethodInfo, name: &str) -> Failure {
    let owners = METHODS.iter().filter(|other| other.position(name).is_some());
    let owners: Vec<String> = owners.map(|other| format!("--method {}", other.name)).collect();
    let has: Vec<String> = method.params.iter().map(|param| format!("--{}", param.name.replace('_', "-"))).collect();
    Failure::request(format!(
        "method `{}` has no parameter `{name}`; {} has it; `{}` has: {}",
        method.name,
        owners.join(" or "),
        method.name,
        has.join(", ")
    ))
}

/// A detector, and what it has memory for.
pub(crate) struct Runner<'a> {
    recipe: &'a Recipe,
    detector: Detector,
    /// What the detector has memory for already.
    kept: [u64; 2],
    outliner: Option<Outliner>,
}

impl<'a> Runner<'a> {
    pub(crate) fn new(recipe: &'a Recipe) -> Self {
        let outliner = recipe.outliner().expect("the tolerance was checked");
        Runner { recipe, detector: recipe.detector(), kept: [0; 2], outliner }
    }

    /// Finds the planes of a frame; with `repeat` above 0 it also measures so many runs.
    ///
    /// # Errors
    /// Those of the library.
    pub(crate) fn detect(&mut self, frame: &Frame, repeat: usize) -> Outcome<Found> {
        let needed = self.recipe.memory(frame);
        if needed > self.kept {
            memory::check(needed[0], needed[1])?;
            self.keep(needed);
        }
        self.detector.set_sensor(frame.sensor);
        let detection = self.detector.detect(frame.view()?)?.clone();
        let outline = |outliner: &mut Outliner| outliner.outline_seen_by(&detection, &frame.sensor).cloned();
        let outlines = self.outliner.as_mut().map(outline).transpose()?;
        let times = (repeat > 0).then(|| self.measure(frame, repeat)).transpose()?;
        Ok(Found { detection, outlines, times })
    }

    /// Says that there is so much memory for it, bytes used and reserved ([`Recipe::memory`]).
    pub(crate) fn keep(&mut self, memory: [u64; 2]) {
        self.kept = self.kept.max(memory);
    }

    /// Whether it needs no more than it has had before.
    pub(crate) fn has_memory_for(&self, frame: &Frame) -> bool {
        self.recipe.memory(frame) <= self.kept
    }

    /// The method's stages, and that of outlines if they are wanted.
    fn stages(&self) -> impl Iterator<Item = &'static str> {
        self.recipe.method.stages.iter().copied().chain(self.outliner.is_some().then_some(OUTLINE))
    }

    /// Times so many runs over a map that the detector has seen before.
    fn measure(&mut self, frame: &Frame, repeat: usize) -> Outcome<Times> {
        let view = frame.view()?;
        let mut totals = Vec::with_capacity(repeat);
        let mut stages: Vec<(&'static str, Vec<f64>)> = self.stages().map(|stage| (stage, vec![0.0; repeat])).collect();
        for run in 0..repeat {
            let start = Instant::now();
            let mut stage_start = start;
            let mut observe = |name: &'static str| {
                let now = Instant::now();
                if let Some((_, times)) = stages.iter_mut().find(|(stage, _)| *stage == name) {
                    times[run] += milliseconds(now - stage_start);
                }
                stage_start = now;
            };
            let detection = self.detector.detect_observed(view, &mut observe)?;
            if let Some(outliner) = &mut self.outliner {
                outliner.outline_seen_by(detection, &frame.sensor)?;
                observe(OUTLINE);
            }
            totals.push(milliseconds(start.elapsed()));
        }
        let stages = stages.into_iter().map(|(name, times)| (name, spread(times))).collect();
        Ok(Times { total: spread(totals), stages })
    }
}

fn milliseconds(duration: std::time::Duration) -> f64 {
    duration.as_secs_f64() * 1e3
}

fn spread(mut times: Vec<f64>) -> Spread {
    times.sort_by(f64::total_cmp);
    let middle = times.len() / 2;
    let median = if times.len() % 2 == 1 { times[middle] } else { (times[middle - 1] + times[middle]) / 2.0 };
    Spread { median, min: times[0] }
}

#[cfg(test)]
mod tests {
    #[test]
    fn the_median_of_an_even_number_of_times_lies_between_the_middle_two() {
        let spread = super::spread(vec![4.0, 1.0, 3.0, 2.0]);
        assert_eq!((spread.median, spread.min), (2.5, 1.0));
        assert_eq!(super::spread(vec![7.0]).median, 7.0);
    }
}
