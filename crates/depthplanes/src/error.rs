//! What can be wrong with a call: the map, a parameter, a camera, or the answer's size.
//!
//! Every message says what was given and what is accepted. A detection raises all of them before its work begins, but
//! for [`Error::TooManyPlanes`], the only one that can follow once a map, the parameters and the camera they need are
//! accepted.

use std::fmt;

/// The library's one error type.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Error {
    /// A side of the map is 0 or longer than [`crate::limits::MAX_SIDE`].
    Size {
        /// Columns given.
        width: usize,
        /// Rows given.
        height: usize,
    },
    /// The pixel slice does not hold the stated map.
    Length {
        /// Pixels given.
        given: usize,
        /// Fewest pixels that hold the map.
        least: usize,
        /// Most pixels that are accepted for it.
        most: usize,
    },
    /// Rows overlap: the stride is shorter than the width, or overflows.
    Stride {
        /// Pixels from one row's start to the next, as given.
        stride: usize,
        /// Columns given.
        width: usize,
    },
    /// A valid range whose low end is not below its high end.
    ValidRange {
        /// Low end given.
        low: f64,
        /// High end given.
        high: f64,
    },
    /// A parameter out of its range.
    Parameter {
        /// Its name in the method's table.
        name: &'static str,
        /// The value given.
        given: f64,
        /// What is accepted.
        accepted: String,
    },
    /// A name that no table knows.
    Unknown {
        /// What was looked for: `method`, `parameter`, `kernel` ...
        what: &'static str,
        /// The name given.
        given: String,
        /// The names there are.
        accepted: String,
    },
    /// A setting given as text that is not of its kind.
    Text {
        /// Name of the setting.
        name: &'static str,
        /// The text given.
        given: String,
        /// What is accepted.
        accepted: String,
    },
    /// A camera or a unit that describes no real one.
    Camera {
        /// The quantity at fault.
        name: &'static str,
        /// The value given.
        given: f64,
        /// What is accepted.
        accepted: &'static str,
    },
    /// Planes in metres are needed, and the camera or the rig is not known.
    NotMetric {
        /// Name of the parameter that needs them.
        wants: &'static str,
        /// Whether the rig is missing: the numbers are disparities of an unknown one.
        is_disparity: bool,
    },
    /// A table that is no table of a sensor's noise.
    NoiseTable {
        /// The row at fault, from 1; 0 for their number.
        row: usize,
        /// The value given.
        given: f64,
        /// What is accepted.
        accepted: &'static str,
    },
    /// Too little of a map is flat and valid to estimate the noise from.
    TooFewBlocks {
        /// Blocks of valid pixels found.
        found: usize,
        /// Fewest that are accepted.
        least: usize,
    },
    /// Maps of different value kinds where one noise is to be estimated from all.
    MixedValueKinds,
    /// More planes than 16-bit labels can name.
    TooManyPlanes {
        /// Planes found.
        found: usize,
        /// The method's parameters that leave fewer if they are raised, as a message has them: `` `min-pixels` or `theta` ``.
        raise: String,
    },
    /// Curved surfaces were asked of a method that does not tell them from planes.
    NoCurved {
        /// The method.
        method: &'static str,
        /// The methods that do.
        accepted: String,
    },
    /// A pixel outside of the map.
    Pixel {
        /// Column and row given.
        at: [usize; 2],
        /// Columns of the map.
        width: usize,
        /// Rows of the map.
        height: usize,
    },
    /// Not one label for each pixel of the map.
    Labels {
        /// Labels given.
        given: usize,
        /// Pixels of the map.
        pixels: usize,
    },
    /// A truth and a prediction with different numbers of pixels.
    LabelCounts {
        /// Labels of the truth.
        truth: usize,
        /// Labels of the prediction.
        prediction: usize,
    },
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Error::Size { width, height } => write!(
                f,
                "the map is {width} x {height} pixels; each side must be 1 to {} and the whole at most {} pixels",
                crate::limits::MAX_SIDE,
                crate::limits::MAX_PIXELS
            ),
            Error::Length { given, least, most } if least == most => {
                write!(
                    f,
                    "{given} pixels were given, the stated size needs {least}; check width, height and pixel type"
                )
            }
            Error::Length { given, least, most } => write!(
                f,
                "{given} pixels were given, the stated size and stride need {least} to {most}; check width, height and stride"
            ),
            Error::Stride { stride, width } => {
                write!(
                    f,
                    "the stride is {stride} pixels, it must be at least the width ({width}) and fit in memory; it counts pixels, not bytes"
                )
            }
            Error::ValidRange { low, high } => {
                write!(f, "the valid range {low} to {high} is empty; its low end must be below its high end")
            }
            Error::Parameter { name, given, accepted } => {
                write!(f, "parameter `{name}` is {given}; accepted: {accepted}")
            }
            Error::Unknown { what, given, accepted } => {
                write!(f, "there is no {what} `{given}`; there are: {accepted}")
            }
            Error::Text { name, given, accepted } => {
                write!(f, "`{name}` is `{given}`; accepted: {accepted}")
            }
            Error::Camera { name, given, accepted } => {
                write!(f, "the camera's {name} is {given}; accepted: {accepted}")
            }
            Error::NotMetric { wants, is_disparity } => {
                let missing =
                    if *is_disparity { "the rig's focal length and baseline" } else { "the camera's intrinsics" };
                write!(f, "`{wants}` needs planes in metres; state {missing}")
            }
            Error::NoiseTable { row: 0, given, accepted } => {
                write!(f, "the table of the noise has {given} rows; accepted: {accepted}")
            }
            Error::NoiseTable { row, given, accepted } => {
                write!(f, "row {row} of the table of the noise has {given}; accepted: {accepted}")
            }
            Error::TooFewBlocks { found, least } => write!(
                f,
                "the noise cannot be told from {found} blocks of 4 x 4 pixels that have their valid pixels and others beside them; at least {least} are needed"
            ),
            Error::MixedValueKinds => {
                write!(
                    f,
                    "the maps' numbers mean different things; one noise estimate needs maps of depth only, or disparity of one rig only"
                )
            }
            Error::TooManyPlanes { found, raise } => {
                write!(f, "{found} planes were found and labels have 16 bits (65535 at most); raise {raise}")
            }
            Error::NoCurved { method, accepted } => {
                write!(f, "method `{method}` does not tell curved surfaces from planes; accepted: {accepted}")
            }
            Error::Pixel { at: [u, v], width, height } => write!(
                f,
                "pixel {u},{v} is outside of the map; accepted: columns 0 to {}, rows 0 to {}",
                width.saturating_sub(1),
                height.saturating_sub(1)
            ),
            Error::Labels { given, pixels } => {
                write!(f, "{given} labels were given, the map has {pixels} pixels; give one label for each, row by row")
            }
            Error::LabelCounts { truth, prediction } => write!(
                f,
                "the truth has {truth} labels and the prediction {prediction}; both must be label images of one size"
            ),
        }
    }
}

impl std::error::Error for Error {}

/// `Result` with the library's [`Error`].
pub type Result<T> = std::result::Result<T, Error>;
