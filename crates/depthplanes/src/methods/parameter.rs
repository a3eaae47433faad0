//! A parameter of a method: name, default, range, unit and meaning.

use crate::error::{Error, Result};

/// A parameter of a method: the one place where its name, default, unit, range and meaning stand.
#[derive(Debug)]
#[non_exhaustive]
pub struct Param {
    /// Name of the flag and keyword.
    pub name: &'static str,
    /// Another name that is accepted wherever parameters are named, such as a paper's word for it. What is written has
    /// `name`.
    pub alias: Option<&'static str>,
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
#[non_exhaustive]
pub enum ParamKind {
    /// Any finite number.
    Real,
    /// Whole numbers.
    Whole,
    /// Odd whole numbers, and 0 for "off".
    OddOrOff,
}

impl Param {
    /// Whether this is its name or its alias.
    pub fn is_called(&self, name: &str) -> bool {
        self.name == name || self.alias == Some(name)
    }

    /// The values accepted, in words.
    pub fn accepted(&self) -> String {
        let (min, max) = (self.min, self.max);
        let top = match max {
            f64::MAX => "up".to_string(),
            // Zeros are not to be counted.
            1e9.. if self.kind == ParamKind::Real => format!("to {max:e}"),
            _ => format!("to {max}"),
        };
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

/// The default of each parameter, in order.
pub(crate) fn defaults(params: &[Param]) -> Vec<f64> {
    params.iter().map(|param| param.default).collect()
}

/// Where the parameter of that name, or of that alias, stands.
pub(crate) fn position(params: &[Param], name: &str) -> Option<usize> {
    params.iter().position(|param| param.is_called(name))
}

/// Checks one value for each parameter.
///
/// # Errors
/// [`Error::Parameter`] for the first that is not accepted.
pub(crate) fn check(params: &[Param], values: &[f64]) -> Result<()> {
    assert_eq!(values.len(), params.len(), "one value for each parameter");
    params.iter().zip(values).try_for_each(|(param, &value)| param.check(value))
}

/// Gives a struct of parameters a setter for each, named as the field.
macro_rules! setters {
    ($params:ident: $($name:ident: $kind:ty),+ $(,)?) => {
        impl $params {
            $(
                #[doc = concat!("The same with another [`", stringify!($params), "::", stringify!($name), "`](#structfield.", stringify!($name), ").")]
                #[must_use]
                pub fn $name(self, $name: $kind) -> Self {
                    $params { $name, ..self }
                }
            )+
        }
    };
}
pub(crate) use setters;
