//! What an output is: the row that names it, the writers of its files, and the [`Report`] that they are given.
//!
//! Outputs take these types from here, and the table of outputs takes the outputs.

use super::destination::is_stream;
use super::error::OutputError;
use super::times::Times;
use crate::frame::Frame;
use depthplanes::methods::MethodInfo;
use depthplanes::outline::Outlines;
use depthplanes::{Coplanar, Detection, Sensor, ValueKind};
use std::path::Path;

/// One row of [`OUTPUTS`](super::OUTPUTS).
#[derive(Debug)]
pub struct Output {
    /// Name of the flag.
    pub name: &'static str,
    /// One sentence: what is in the file.
    pub about: &'static str,
    /// What follows the input's stem in a folder of results: `<stem>.<file>`.
    pub file: &'static str,
    /// Whether it needs a metric value kind and intrinsics.
    pub needs_camera: bool,
    /// Whether it needs curved regions, which are looked for on request alone.
    pub needs_curved: bool,
    /// One writer for each extension accepted; the first is the usual one.
    pub writers: &'static [Writer],
}

impl Output {
    /// The writer for the end of a path's name, of several the one with the longest; the usual one for `-` and for a stream
    /// without such a name, as `/dev/null`.
    ///
    /// # Errors
    /// [`OutputError::Extension`] with the extensions there are.
    pub fn writer(&self, path: &Path) -> Result<&'static Writer, OutputError> {
        let name = path.file_name().map(|name| name.to_string_lossy().to_lowercase()).unwrap_or_default();
        let ends = |writer: &&Writer| {
            let stem = name.strip_suffix(writer.extension).and_then(|name| name.strip_suffix('.'));
            stem.is_some_and(|stem| !stem.is_empty())
        };
        let found = self.writers.iter().filter(ends).max_by_key(|writer| writer.extension.len());
        let usual = || self.writers.first().filter(|_| path == Path::new("-") || is_stream(path));
        found.or_else(usual).ok_or_else(|| OutputError::Extension {
            output: self.name,
            path: path.to_path_buf(),
            accepted: self.extensions(),
        })
    }

    /// The extensions accepted, in words: `.png or .npy`, `.json, .csv or .geojson`.
    pub fn extensions(&self) -> String {
        let dotted: Vec<String> = self.writers.iter().map(|writer| format!(".{}", writer.extension)).collect();
        match &dotted[..] {
            [others @ .., last] if !others.is_empty() => format!("{} or {last}", others.join(", ")),
            _ => dotted.concat(),
        }
    }
}

/// Makes the bytes of a file with a certain extension.
#[derive(Debug)]
pub struct Writer {
    /// The extension, lower case, without the dot.
    pub extension: &'static str,
    /// The file's bytes.
    pub encode: fn(&Report<'_>) -> Result<Vec<u8>, OutputError>,
}

/// One frame and what was found in it: everything an output may need.
#[derive(Clone, Copy, Debug)]
pub struct Report<'a> {
    /// Where the frame came from, for people: usually the path as given.
    pub source: &'a str,
    /// The frame that was looked at.
    pub frame: &'a Frame,
    /// The method that looked.
    pub method: &'static MethodInfo,
    /// The value of each of the method's parameters, in the table's order.
    pub parameters: &'a [f64],
    /// What it found.
    pub detection: &'a Detection,
    /// Within what coplanar planes were joined, if they were.
    pub coplanar: Option<Coplanar>,
    /// The planes' outlines, if they are to be in the record and on the picture.
    pub outlines: Option<&'a Outlines>,
    /// How long it took, if that was measured.
    pub times: Option<&'a Times>,
    /// Whether pictures carry a legend.
    pub legend: bool,
    /// What a person should know of the result, beside the frame's warnings ([`crate::doubts`]).
    pub notes: &'a [String],
}

impl<'a> Report<'a> {
    /// A report of what a method found, without all that may be added to it.
    pub fn new(
        source: &'a str,
        frame: &'a Frame,
        method: &'static MethodInfo,
        parameters: &'a [f64],
        detection: &'a Detection,
    ) -> Self {
        Report {
            source,
            frame,
            method,
            parameters,
            detection,
            coplanar: None,
            outlines: None,
            times: None,
            legend: false,
            notes: &[],
        }
    }

    /// Whether an output has all that it needs.
    pub fn has_what_it_takes(&self, output: &Output) -> bool {
        let has_curved = self.detection.curved.is_some() || !output.needs_curved;
        has_curved && (self.is_metric() || !output.needs_camera)
    }

    /// Whether points and planes can be given in metres: the value kind is metric and the camera known.
    pub fn is_metric(&self) -> bool {
        self.metric_sensor().is_ok()
    }

    /// The sensor, for outputs in metres.
    ///
    /// # Errors
    /// [`OutputError::NeedsCamera`] unless the value kind is metric and the camera known.
    pub(super) fn metric_sensor(&self) -> Result<Sensor, OutputError> {
        let sensor = self.frame.sensor;
        if sensor.value_kind == ValueKind::Disparity {
            let missing = "to know what the disparities mean: give --focal and --baseline of the rig";
            return Err(OutputError::NeedsCamera { missing });
        }
        sensor.intrinsics.map(|_| sensor).ok_or(OutputError::NeedsCamera {
            missing: "the camera's intrinsics: give --intrinsics fx,fy,cx,cy, --camera FILE or --preset SENSOR",
        })
    }
}
