//! Up in a camera's coordinates, by an inertial sensor whose axes `/tf_static` tells.

mod filter;
mod frames;

use crate::messages::Imu;
use filter::Filter;
use frames::Axes;
pub(crate) use frames::Frames;

/// An inertial sensor beside a camera.
#[derive(Debug)]
pub(crate) struct Gravity {
    /// Its topic.
    topic: String,
    /// Its axes in the camera's coordinates.
    axes: Axes,
    filter: Filter,
}

impl Gravity {
    /// The sensor of a topic with its frame of coordinates, beside a camera with its own.
    ///
    /// # Errors
    /// Why its readings cannot be turned into the camera's axes, and what to do.
    pub(crate) fn new(topic: &str, frame: &str, camera: &str, frames: &Frames) -> Result<Self, String> {
        let axes = frames.axes(frame, camera).ok_or_else(|| {
            format!(
                "up is not taken from {topic}: no chain of transforms on /tf_static leads from its frame_id `{frame}` to that of the \
                 maps, `{camera}`; record /tf_static as well, or state up"
            )
        })?;
        Ok(Gravity { topic: topic.into(), axes, filter: Filter::default() })
    }

    /// Takes a reading; seconds.
    pub(crate) fn add(&mut self, time_s: f64, reading: &Imu) {
        self.filter.add(time_s, reading);
    }

    /// Forgets the readings before.
    pub(crate) fn forget(&mut self) {
        self.filter = Filter::default();
    }

    /// Up at that time in camera coordinates, not of length 1; none where no reading is recent enough.
    pub(crate) fn up(&self, time_s: f64) -> Option<[f64; 3]> {
        let up = self.filter.up(time_s)?;
        Some(std::array::from_fn(|k| (0..3).map(|axis| up[axis] * self.axes[axis][k]).sum()))
    }

    /// What a person should know of it.
    pub(crate) fn note(&self) -> Option<String> {
        let length = self.filter.odd()?;
        Some(format!(
            "up is not taken from {}: its first reading is {length:.2} m/s2 long, and none is gravity's 9.81 within 0.5; accepted: \
             accelerations in m/s2 with gravity in them",
            self.topic
        ))
    }
}
