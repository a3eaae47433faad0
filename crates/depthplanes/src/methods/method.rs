//! What a method is: its row of the table, what it is run with, and how it is asked for.

use super::parameter::{Param, check, defaults, position};
use crate::coplanar::Joiner;
use crate::detection::Detection;
use crate::error::{Error, Result};
use crate::explanation::{Explanation, Verdict};
use crate::map::AnyView;
use crate::sensor::Sensor;

/// One row of [`super::METHODS`].
#[derive(Debug)]
#[non_exhaustive]
pub struct MethodInfo {
    /// The name on the command line and in `method=`.
    pub name: &'static str,
    /// One sentence: what it finds, and whose it is.
    pub about: &'static str,
    /// Its stages in order, as told to the observer of [`crate::Detector::detect_observed`].
    pub stages: &'static [&'static str],
    /// Whether it tells curved surfaces from planes and can report them.
    pub tells_curved: bool,
    /// Bytes that it uses for a pixel of a map, and bytes that it reserves for the worst map of that size, as measured on maps
    /// of 3 and 12 million pixels.
    pub bytes_per_pixel: [u64; 2],
    /// Its parameters, in the order of [`MethodInfo::of_values`].
    pub params: &'static [Param],
    /// Makes the method from one accepted value for each parameter, in order.
    pub(crate) build: fn(&[f64]) -> Box<dyn Method>,
}

/// A method with its parameters, as [`crate::Detector::new`] takes it: made of [`crate::Planar`] or [`crate::Ngaf`], or of
/// any method by name ([`MethodInfo::with`]).
#[must_use]
pub struct Configured(pub(crate) Box<dyn Method>);

impl Configured {
    /// Its row in [`super::METHODS`].
    pub fn info(&self) -> &'static MethodInfo {
        self.0.info()
    }
}

impl std::fmt::Debug for Configured {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_tuple("Configured").field(&self.info().name).finish()
    }
}

/// What [`crate::Detector::new`] takes: the parameters of a method. The trait is sealed.
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not the parameters of a method",
    note = "take `Planar::default()`, `Ngaf::default()`, or any method by name: `methods::find(name)?.with(&[..])?`"
)]
pub trait Parameters: sealed::Sealed {
    /// The method with these parameters.
    ///
    /// # Errors
    /// [`Error::Parameter`] if one of them is out of range.
    fn configured(self) -> Result<Configured>;
}

pub(crate) mod sealed {
    /// Nobody else's types are a method's parameters.
    pub trait Sealed {}
}

impl sealed::Sealed for Configured {}

impl sealed::Sealed for &MethodInfo {}

/// A row of the table stands for the method at its defaults.
impl Parameters for &MethodInfo {
    fn configured(self) -> Result<Configured> {
        self.with(&[])
    }
}

impl Parameters for Configured {
    fn configured(self) -> Result<Configured> {
        Ok(self)
    }
}

/// A method with its parameters and its memory.
pub(crate) trait Method: Send {
    /// Its row in [`super::METHODS`].
    fn info(&self) -> &'static MethodInfo;

    /// Finds planes. `job.done(stage)` is called as each stage ends.
    ///
    /// # Errors
    /// [`Error::TooManyPlanes`]; [`Error::NotMetric`] for a parameter in metres without a camera.
    fn run(&mut self, map: AnyView<'_>, job: &mut Job<'_>, out: &mut Detection) -> Result<()>;

    /// Says what its stages see at a pixel of the map, and what would give it a plane. A method that cannot tell says
    /// only what it found.
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
pub(crate) struct Job<'a> {
    /// What the map's numbers mean, and the camera.
    pub sensor: Sensor,
    /// Threads to use, 1 and up; the answer does not depend on it.
    pub threads: usize,
    /// Whether curved surfaces are wanted as well, from methods that tell them apart.
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

impl MethodInfo {
    /// The default of each parameter, in order.
    pub fn defaults(&self) -> Vec<f64> {
        defaults(self.params)
    }

    /// Where the parameter of that name, or of that alias, stands in [`MethodInfo::params`].
    pub fn position(&self, name: &str) -> Option<usize> {
        position(self.params, name)
    }

    /// The method with one value for each parameter, in order.
    ///
    /// # Errors
    /// [`Error::Parameter`] for a value out of range.
    ///
    /// # Panics
    /// Unless there is a value for each parameter.
    pub fn of_values(&self, values: &[f64]) -> Result<Configured> {
        check(self.params, values)?; // before any of them becomes a whole number
        Ok(Configured((self.build)(values)))
    }

    /// The method with some parameters given by name or alias and the others at their defaults.
    ///
    /// # Errors
    /// [`Error::Unknown`] for a name that is not in its table, [`Error::Parameter`] for a value out
    /// of range.
    ///
    /// ```
    /// let ngaf = depthplanes::methods::find("ngaf")?.with(&[("theta", 2.0), ("min-pixels", 64.0)])?;
    /// assert_eq!(ngaf.info().name, "ngaf");
    /// # Ok::<(), depthplanes::Error>(())
    /// ```
    pub fn with(&self, given: &[(&str, f64)]) -> Result<Configured> {
        let mut values = self.defaults();
        for &(name, value) in given {
            let at = self.position(name).ok_or_else(|| Error::Unknown {
                what: "parameter",
                given: name.to_string(),
                accepted: names(self.params.iter().map(|param| param.name)),
            })?;
            values[at] = value;
        }
        self.of_values(&values)
    }
}

/// A list of names, for a message.
pub(crate) fn names<'a>(all: impl Iterator<Item = &'a str>) -> String {
    all.collect::<Vec<_>>().join(", ")
}
