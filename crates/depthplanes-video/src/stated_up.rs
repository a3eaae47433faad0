//! What is stated of up for a whole video, and what it means in one of its frames.

use crate::error::{Error, Result};
use crate::frame::VideoFrame;
use depthplanes::ground::Up;

/// What is stated of up. It counts before what the source says of it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum StatedUp {
    /// Nothing: up is what the source says, or else it is estimated from the planes.
    #[default]
    Nothing,
    /// A direction in the camera's coordinates, of any length: the camera is always held like that.
    Camera([f64; 3]),
    /// A direction in the world of the source's poses, of any length.
    World([f64; 3]),
}

impl StatedUp {
    /// That it is a direction.
    pub(crate) fn check(self) -> depthplanes::Result<()> {
        match self {
            StatedUp::Nothing => Ok(()),
            StatedUp::Camera(up) | StatedUp::World(up) => Up::known(up).map(drop),
        }
    }

    /// What is left of it where nothing is known of the world.
    pub(crate) fn without_world(self) -> Self {
        match self {
            StatedUp::World(_) => StatedUp::Nothing,
            other => other,
        }
    }

    /// What is known of up in a frame.
    ///
    /// # Errors
    /// [`Error::Source`] for an up in the world of a frame without pose; the library's for a direction that is none.
    pub fn of(self, video: &VideoFrame) -> Result<Up> {
        let known = match (self, &video.pose) {
            (StatedUp::Camera(up), _) => Some(up),
            (StatedUp::World(up), Some(pose)) => Some(pose.to_camera(up)),
            (StatedUp::World(_), None) => {
                let accepted = "poses, or an up in the camera's coordinates (--up)";
                return Err(Error::source(&video.name, "an up in the world is stated and there is no pose", accepted));
            }
            (StatedUp::Nothing, _) => video.up,
        };
        Ok(known.map_or(Ok(Up::Estimated), Up::known)?)
    }
}

#[cfg(test)]
mod tests {
    use super::StatedUp;
    use crate::{SourceOptions, VideoFrame, open};
    use depthplanes::ground::Up;

    fn frame() -> VideoFrame {
        let mut source = open("scene:room:size=32x24,frames=1", &SourceOptions::default()).unwrap();
        source.next_frame().unwrap().unwrap()
    }

    #[test]
    fn what_is_stated_counts_before_what_the_source_says() {
        let up = |up| Up::known(up).unwrap();
        let said = VideoFrame { up: Some([0.0, -2.0, 0.0]), ..frame() };
        assert_eq!(StatedUp::Nothing.of(&said).unwrap(), up([0.0, -1.0, 0.0]));
        assert_eq!(StatedUp::Camera([1.0, 0.0, 0.0]).of(&said).unwrap(), up([1.0, 0.0, 0.0]));
        let world = StatedUp::World([0.0, 0.0, 1.0]).of(&said).unwrap();
        assert_eq!(world, up(said.pose.unwrap().to_camera([0.0, 0.0, 1.0])));
        assert_eq!(StatedUp::Nothing.of(&VideoFrame { up: None, ..said }).unwrap(), Up::Estimated);
    }

    #[test]
    fn an_up_in_the_world_needs_a_pose() {
        let error = StatedUp::World([0.0, 0.0, 1.0]).of(&VideoFrame { pose: None, ..frame() }).unwrap_err();
        assert!(error.to_string().contains("there is no pose; accepted: poses"), "{error}");
        assert!(StatedUp::Camera([0.0; 3]).of(&frame()).is_err());
    }
}
