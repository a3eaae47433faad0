//! One frame of a video, with what is known of when and where it was taken.

use depthplanes::track::CameraPose;
use depthplanes_io::Frame;

/// One frame of a source.
#[derive(Clone, Debug, PartialEq)]
pub struct VideoFrame {
    /// Its place in the source, from 0; frames that cannot be read count as well.
    pub index: u64,
    /// What it is called there: the name of a file, or of a topic.
    pub name: String,
    /// When it was taken, seconds; since when is the source's affair. `None` if the source does not say.
    pub time_s: Option<f64>,
    /// Where the camera stood, camera to world; `None` if the source does not say.
    pub pose: Option<CameraPose>,
    /// The direction that is up, camera coordinates, as an accelerometer says; `None` if there is none.
    pub up: Option<[f64; 3]>,
    /// The map.
    pub frame: Frame,
}
