//! Why a pixel belongs to a plane or to none.
//!
//! In: what a method's stages saw at one pixel ([`Finding`]). Out: an [`Explanation`]: these findings in order, the
//! result ([`Verdict`]) and what to change ([`Suggestion`]). [`crate::Detector::explain`] makes one; a detection
//! itself keeps none of it.

use std::fmt;

/// What each stage of a method saw at one pixel, and the result.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[non_exhaustive]
pub struct Explanation {
    /// The pixel: column u, row v.
    pub at: [usize; 2],
    /// Name of the method.
    pub method: &'static str,
    /// In the order of the stages.
    pub findings: Vec<Finding>,
    /// The result.
    pub verdict: Verdict,
    /// Changes of parameters that give the pixel a plane; each was tried by running the method again.
    pub suggestions: Vec<Suggestion>,
}

/// What one stage saw of one thing.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[non_exhaustive]
pub struct Finding {
    /// Name of the stage, or what comes before the first.
    pub stage: &'static str,
    /// What was looked at, in words.
    pub subject: String,
    /// What was measured of it.
    pub quantities: Vec<Quantity>,
    /// What came of it, in words; may be empty.
    pub outcome: String,
    /// Whether the pixel, or what it was part of, was refused here.
    pub refuses: bool,
}

impl Finding {
    /// A finding that refuses nothing, without numbers.
    pub(crate) fn new(stage: &'static str, subject: impl Into<String>, outcome: impl Into<String>) -> Self {
        Finding { stage, subject: subject.into(), quantities: Vec::new(), outcome: outcome.into(), refuses: false }
    }

    pub(crate) fn with(mut self, name: &'static str, value: f64, unit: &'static str) -> Self {
        self.quantities.push(Quantity { name, value, unit, limit: None });
        self
    }

    /// Adds a limit to the last quantity.
    pub(crate) fn limit(mut self, limit: Limit) -> Self {
        if let Some(quantity) = self.quantities.last_mut() {
            quantity.limit = Some(limit);
        }
        self
    }

    pub(crate) fn refusing(mut self, refuses: bool) -> Self {
        self.refuses = refuses;
        self
    }
}

/// A number of a [`Finding`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[non_exhaustive]
pub struct Quantity {
    /// What it is.
    pub name: &'static str,
    /// Its value; not finite where nothing was measured.
    pub value: f64,
    /// Its unit; empty for a bare number.
    pub unit: &'static str,
    /// What it was compared with.
    pub limit: Option<Limit>,
}

/// The bound a number was compared with, in its unit.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[non_exhaustive]
pub enum Limit {
    /// It has to be this or less.
    AtMost(f64),
    /// It has to be this or more.
    AtLeast(f64),
    /// It has to be more than this.
    MoreThan(f64),
}

impl Limit {
    /// In words, `at most`, and the bound.
    pub fn words(self) -> (&'static str, f64) {
        match self {
            Limit::AtMost(most) => ("at most", most),
            Limit::AtLeast(least) => ("at least", least),
            Limit::MoreThan(bound) => ("more than", bound),
        }
    }

    /// Whether a value keeps to it.
    pub fn holds(self, value: f64) -> bool {
        match self {
            Limit::AtMost(most) => value <= most,
            Limit::AtLeast(least) => value >= least,
            Limit::MoreThan(bound) => value > bound,
        }
    }
}

/// The result of an explanation. Its text is one sentence for people.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[non_exhaustive]
pub enum Verdict {
    /// The pixel belongs to a plane.
    Plane {
        /// The plane's label.
        label: u16,
        /// Its pixels.
        pixels: usize,
        /// How far off the plane it lies, standard deviations, if the method measures that.
        off: Option<f64>,
    },
    /// The map holds no measurement here.
    NotMeasured,
    /// Too few of the pixels around it hold one.
    Sparse {
        /// Pixels of the smallest cell that do.
        pixels: usize,
        /// Fewest that are needed to start a region.
        least: usize,
    },
    /// A surface of too few pixels.
    Small {
        /// Its pixels.
        pixels: usize,
        /// The parameter `min-pixels`.
        min_pixels: u32,
        /// Whether it was dropped early, before its pixels were looked at one by one; then half of `min-pixels` is asked for.
        early: bool,
    },
    /// Part of a curved surface.
    Curved,
    /// Part of a surface that is seen edge-on, or of pixels between two surfaces.
    EdgeOn,
    /// The surface is not flat around the pixel: an edge, a crease, a curve or clutter.
    Uneven {
        /// Roughness as a multiple of what noise makes of a flat cell.
        roughness: f64,
    },
    /// Too far from every plane around it.
    Off {
        /// Distance from the nearest, standard deviations.
        off: f64,
        /// Most that is accepted.
        most: f64,
        /// Label of the nearest plane; 0 if it has none.
        label: u16,
    },
    /// No flat region lies near it.
    Alone,
    /// A surface that is dropped by a condition of this method alone.
    Dropped {
        /// Name of the parameter.
        parameter: &'static str,
        /// What was measured.
        value: f64,
        /// What is accepted.
        limit: Limit,
    },
    /// The method cannot explain itself.
    Unexplained {
        /// The pixel's label, 0 for none.
        label: u16,
    },
}

impl Verdict {
    /// Its name in records.
    pub fn kind(&self) -> &'static str {
        match self {
            Verdict::Plane { .. } => "plane",
            Verdict::NotMeasured => "not_measured",
            Verdict::Sparse { .. } => "sparse",
            Verdict::Small { .. } => "small",
            Verdict::Curved => "curved",
            Verdict::EdgeOn => "edge_on",
            Verdict::Uneven { .. } => "uneven",
            Verdict::Off { .. } => "off",
            Verdict::Alone => "alone",
            Verdict::Dropped { .. } => "dropped",
            Verdict::Unexplained { .. } => "unexplained",
        }
    }
}

impl fmt::Display for Verdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Verdict::Plane { label, pixels, off: Some(off) } => {
                write!(f, "It belongs to plane {label} of {}, {off:.1} standard deviations off.", counted(*pixels))
            }
            Verdict::Plane { label, pixels, off: None } => {
                write!(f, "It belongs to plane {label} of {}.", counted(*pixels))
            }
            Verdict::NotMeasured => write!(f, "No plane here: nothing was measured at this pixel."),
            Verdict::Sparse { pixels, least } => write!(
                f,
                "No plane here: of its tile's pixels {pixels} were measured, and a region starts from {least}."
            ),
            Verdict::Small { pixels, min_pixels, early: false } => {
                write!(
                    f,
                    "No plane here: its surface has {}, and min-pixels = {min_pixels} asks for more.",
                    counted(*pixels)
                )
            }
            Verdict::Small { pixels, min_pixels, early: true } => write!(
                f,
                "No plane here: its region of {} is smaller than half of min-pixels = {min_pixels}, and is not looked at further.",
                counted(*pixels)
            ),
            Verdict::Curved => write!(f, "No plane here: it is part of a curved surface; see `detect --curved`."),
            Verdict::EdgeOn => write!(
                f,
                "No plane here: the surface is seen at less than 1.2 degrees. It may be what a sensor sees between two surfaces, or pixels of both."
            ),
            Verdict::Uneven { roughness } => write!(
                f,
                "No plane here: the surface is {roughness:.1} times as rough as noise makes a flat one. An edge, a crease or clutter, or more noise than expected."
            ),
            Verdict::Off { off, most, label } => {
                write!(f, "No plane here: the pixel is {off:.1} standard deviations off the nearest plane")?;
                if *label > 0 {
                    write!(f, " ({label})")?;
                }
                write!(f, ", and {most} are accepted.")
            }
            Verdict::Alone => write!(f, "No plane here: no flat region lies near the pixel."),
            Verdict::Dropped { parameter, value, limit } => {
                let limit = match limit {
                    Limit::AtMost(most) => format!("at most {most}"),
                    Limit::AtLeast(least) => format!("at least {least}"),
                    Limit::MoreThan(bound) => format!("more than {bound}"),
                };
                write!(f, "No plane here: `{parameter}` drops its surface, {value:.4} where {limit} is accepted.")
            }
            Verdict::Unexplained { label: 0 } => write!(f, "No plane here; the method does not say why."),
            Verdict::Unexplained { label } => write!(f, "It belongs to plane {label}; the method does not say why."),
        }
    }
}

/// So many pixels, in words.
fn counted(pixels: usize) -> String {
    if pixels == 1 { "1 pixel".into() } else { format!("{pixels} pixels") }
}

/// A change of parameters after which the pixel belongs to a plane.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[non_exhaustive]
pub struct Suggestion {
    /// The parameters to give, with their values; the others stay.
    pub parameters: Vec<(&'static str, f64)>,
    /// Pixels of the plane that the pixel then belongs to.
    pub plane_pixels: usize,
    /// Planes of the whole map with the parameters as they are.
    pub planes_before: usize,
    /// Planes of the whole map after the change.
    pub planes_after: usize,
}
