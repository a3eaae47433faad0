//! What every page knows beside the frames: whether it plays, where it is, the parameters, what went wrong.

use serde::Serialize;

/// Sent whenever it changes.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct State {
    #[serde(rename = "type")]
    kind: &'static str,
    pub(crate) is_playing: bool,
    /// The frame that is shown, or failed.
    pub(crate) index: Option<u64>,
    /// How many there are, if that is known.
    pub(crate) frames: Option<u64>,
    /// Whether any frame can be asked for.
    pub(crate) can_seek: bool,
    /// Whether the source has no more frames.
    pub(crate) has_ended: bool,
    /// The file that was dragged in and is shown instead of the source.
    pub(crate) file: Option<String>,
    /// A value for each parameter, in the order of the method's table.
    pub(crate) values: Vec<f64>,
    /// Why the newest frame, or what was asked for, failed.
    pub(crate) error: Option<String>,
}

impl State {
    pub(crate) fn new(values: &[f64]) -> Self {
        State {
            kind: "state",
            is_playing: true,
            index: None,
            frames: None,
            can_seek: false,
            has_ended: false,
            file: None,
            values: values.to_vec(),
            error: None,
        }
    }
}
