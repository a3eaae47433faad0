//! The detectors, one file each, and the table that names them.
//!
//! A row of [`METHODS`] gives a method its flag, its keyword, its help and its contract tests.

mod a_contrario;
mod affine;
mod cloud;
mod finish;
mod fpdidm;
mod gradient;
mod hough;
mod mdl;
mod ngaf;
mod noise;
mod normals;
mod pieces;
mod planar;
mod ppdfdm;
mod ransac;
mod rays;
mod records;
mod regions;
mod tries;

use crate::camera::Sensor;
use crate::coplanar::Joiner;
use crate::detection::Detection;
use crate::error::{Error, Result};
use crate::explanation::{Explanation, Verdict};
use crate::map::AnyView;

pub use ngaf::Ngaf;
pub use planar::Planar;

/// All methods. The first is the default.
pub static METHODS: &[&MethodInfo] = &[
    &planar::INFO,
    &ngaf::INFO,
    &ransac::INFO,
    &ppdfdm::INFO,
    &fpdidm::INFO,
    &hough::INFO,
    &normals::INFO,
    &mdl::INFO,
    &gradient::INFO,
];

/// One row of [`METHODS`].
#[derive(Debug)]
pub struct MethodInfo {
    /// The name on the command line and in `method=`.
    pub name: &'static str,
    /// One sentence: what it finds, and whose it is.
    pub about: &'static str,
    /// Its stages in order, as told to the observer of [`crate::Detector::detect_observed`].
    pub stages: &'static [&'static str],
    /// Whether it tells surfaces that bend from planes and can report them.
    pub tells_curved: bool,
    /// Its parameters, in the order of `build`'s values.
    pub params: &'static [Param],
    /// Makes the method from one value for each parameter, in order; [`Error::Parameter`] for one
    /// that is not accepted. Panics unless there is a value for each.
    pub build: fn(&[f64]) -> Result<Box<dyn Method>>,
}

/// A parameter of a method: the one place where its name, default, unit, range and meaning stand.
#[derive(Debug)]
pub struct Param {
    /// Name of the flag and keyword.
    pub name: &'static str,
    /// Default value.
    pub default: f64,
    /// Smallest value accepted.
    pub min: f64,
    /// Largest value accepted.
    pub max: f64,
    /// Which values between `min` and `max` are accepted.
    pub kind: ParamKind,
    /// Unit of the value.
    pub unit: &'static str,
    /// One sentence: what it does.
    pub meaning: &'static str,
    /// The section of the method's paper it comes from; `None` marks an addition of our own.
    pub source: Option<&'static str>,
}

/// Which values a parameter takes within its range.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ParamKind {
    /// Any finite number.
    Real,
    /// Whole numbers.
    Whole,
    /// Odd whole numbers, and 0 for "off".
    OddOrOff,
}

impl Param {
    /// The values accepted, in words.
    pub fn accepted(&self) -> String {
        let (min, max) = (self.min, self.max);
        let top = if max == f64::MAX { "up".to_string() } else { format!("to {max}") };
        match self.kind {
            ParamKind::Real => format!("a number from {min} {top}"),
            ParamKind::Whole => format!("a whole number from {min} {top}"),
            ParamKind::OddOrOff => format!("an odd whole number from {min} {top}, or 0 for off"),
        }
    }

    fn check(&self, given: f64) -> Result<()> {
        let within = (self.min..=self.max).contains(&given);
        let right = match self.kind {
            ParamKind::Real => within,
            ParamKind::Whole => within && given.fract() == 0.0,
            ParamKind::OddOrOff => given == 0.0 || (within && given % 2.0 == 1.0),
        };
        if right { Ok(()) } else { Err(Error::Parameter { name: self.name, given, accepted: self.accepted() }) }
    }
}

/// A detector with its parameters and its memory.
pub trait Method: Send {
    /// Its row in [`METHODS`].
    fn info(&self) -> &'static MethodInfo;

    /// Finds planes. `job.done(stage)` is called as each stage ends.
    ///
    /// # Errors
    /// [`Error::TooManyPlanes`]; [`Error::NotMetric`] for a parameter in metres without a camera.
    fn run(&mut self, map: AnyView<'_>, job: &mut Job<'_>, out: &mut Detection) -> Result<()>;

    /// Says what its stages see at a pixel of the map, and what would give it a plane. A method that does not
    /// know says only what it found.
    ///
    /// # Errors
    /// As [`Method::run`].
    fn explain(&mut self, map: AnyView<'_>, job: &mut Job<'_>, at: [usize; 2]) -> Result<Explanation> {
        let mut out = Detection::default();
        self.run(map, job, &mut out)?;
        let verdict = Verdict::Unexplained { label: out.labels[at[1] * out.width + at[0]] };
        Ok(Explanation { at, method: self.info().name, findings: Vec::new(), verdict, suggestions: Vec::new() })
    }
}

/// What a method needs beside the map.
pub struct Job<'a> {
    /// What the map's numbers mean, and the camera.
    pub sensor: Sensor,
    /// Threads to use, 1 and up; the answer does not depend on it.
    pub threads: usize,
    /// Whether surfaces that bend are wanted as well, of methods that tell them.
    pub curved: bool,
    /// Joins coplanar planes, if that is wanted.
    pub joiner: Option<&'a mut Joiner>,
    /// Told the name of each stage as it ends.
    pub observer: &'a mut (dyn FnMut(&'static str) + Send),
}

impl Job<'_> {
    /// Tells the observer that a stage has ended.
    pub fn done(&mut self, stage: &'static str) {
        (self.observer)(stage);
    }
}

/// The method of that name.
///
/// # Errors
/// [`Error::Unknown`] with the names there are.
pub fn find(name: &str) -> Result<&'static MethodInfo> {
    METHODS.iter().copied().find(|method| method.name == name).ok_or_else(|| Error::Unknown {
        what: "method",
        given: name.to_string(),
        accepted: names(METHODS.iter().map(|method| method.name)),
    })
}

/// The method to take where none is named: the first of [`METHODS`].
pub fn default() -> &'static MethodInfo {
    METHODS[0]
}

impl MethodInfo {
    /// The default of each parameter, in order.
    pub fn defaults(&self) -> Vec<f64> {
        self.params.iter().map(|param| param.default).collect()
    }

    /// The method with some parameters given by name and the others at their defaults.
    ///
    /// # Errors
    /// [`Error::Unknown`] for a name that is not in its table, [`Error::Parameter`] for a value out
    /// of range.
    ///
    /// ```
    /// let ngaf = depthplanes::methods::find("ngaf")?.with(&[("theta", 2.0), ("min", 64.0)])?;
    /// assert_eq!(ngaf.info().name, "ngaf");
    /// # Ok::<(), depthplanes::Error>(())
    /// ```
    pub fn with(&self, given: &[(&str, f64)]) -> Result<Box<dyn Method>> {
        let mut values = self.defaults();
        for &(name, value) in given {
            let at = self.params.iter().position(|param| param.name == name).ok_or_else(|| Error::Unknown {
                what: "parameter",
                given: name.to_string(),
                accepted: names(self.params.iter().map(|param| param.name)),
            })?;
            values[at] = value;
        }
        (self.build)(&values)
    }

    /// Checks one value for each parameter.
    fn check(&self, values: &[f64]) -> Result<()> {
        assert_eq!(values.len(), self.params.len(), "{} takes one value for each of its parameters", self.name);
        self.params.iter().zip(values).try_for_each(|(param, &value)| param.check(value))
    }
}

fn names<'a>(all: impl Iterator<Item = &'a str>) -> String {
    all.collect::<Vec<_>>().join(", ")
}
