//! A frame in one line of text: `room`, `room:seed=7,sensor=tof_white,size=320x240`.

use std::fmt;
use std::str::FromStr;

use super::catalogue::{SceneInfo, find};
use super::frame::SceneFrame;
use super::pose::Camera;
use super::render::render;
use super::sensors::SensorModel;
use crate::error::{Error, Result};
use crate::limits::MAX_SIDE;

/// Most pixels of a frame that a [`Spec`] may ask for; a frame takes about 30 bytes each.
pub const MAX_FRAME_PIXELS: usize = 1 << 25;

const KEYS: &str = "seed, sensor, size";

/// Which frame to make: a scene of [`super::SCENES`] and how it is seen.
///
/// As text: the scene's name, then any of `seed=`, `sensor=` (a name of [`super::SENSORS`]) and
/// `size=WIDTHxHEIGHT` after a colon, separated by commas. Left out they are 1, `kinect_white` and
/// 640x480. [`fmt::Display`] writes all three, and the text reads back as the same spec.
///
/// ```
/// use depthplanes::scene::Spec;
/// let spec: Spec = "stairs:sensor=tof_white".parse()?;
/// assert_eq!(spec.to_string(), "stairs:seed=1,sensor=tof_white,size=640x480");
/// let error = "stairs:sensor=sonar".parse::<Spec>().unwrap_err();
/// assert_eq!(error.to_string(), "there is no sensor `sonar`; there are: clean, clean_mm, kinect, kinect2, azure, realsense, stereo, kinect_white, tof_white, disparity");
/// # Ok::<(), depthplanes::Error>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Spec {
    /// The scene.
    pub scene: &'static SceneInfo,
    /// Drives the scene's own variation and the sensor's noise.
    pub seed: u64,
    /// How the depth is measured.
    pub sensor: SensorModel,
    /// Columns.
    pub width: usize,
    /// Rows.
    pub height: usize,
}

impl PartialEq for Spec {
    fn eq(&self, other: &Self) -> bool {
        let key = |spec: &Spec| (spec.scene.name, spec.seed, spec.sensor, spec.width, spec.height);
        key(self) == key(other)
    }
}

impl Spec {
    /// The scene of that name, seed 1, `kinect_white`, 640 x 480.
    ///
    /// # Errors
    /// [`Error::Unknown`] with the names there are.
    pub fn new(scene: &str) -> Result<Self> {
        Ok(Spec { scene: find(scene)?, seed: 1, sensor: SensorModel::KinectV1White, width: 640, height: 480 })
    }

    /// The frame of a first look: `room`, as a Kinect sees it.
    ///
    /// ```
    /// use depthplanes::scene::Spec;
    /// assert_eq!(Spec::demo().to_string(), "room:seed=1,sensor=kinect_white,size=640x480");
    /// ```
    pub fn demo() -> Self {
        Spec::new("room").expect("the room is a row of the table")
    }

    /// Makes the frame.
    ///
    /// # Errors
    /// [`Error::Size`] for a width or height that no map can have.
    pub fn frame(&self) -> Result<SceneFrame> {
        let staged = (self.scene.build)(self.seed);
        let camera = Camera::kinect(self.width, self.height, staged.pose)?;
        render(&staged.scene, &camera, self.sensor, self.seed)
    }

    fn set(&mut self, key: &str, value: &str) -> Result<()> {
        match key {
            "seed" => {
                self.seed = value.parse().map_err(|_| wrong("seed", value, "a whole number from 0 to 2^64 - 1"))?
            }
            "sensor" => self.sensor = SensorModel::find(value)?,
            "size" => {
                (self.width, self.height) = size(value).ok_or_else(|| {
                    let accepted = format!(
                        "WIDTHxHEIGHT in pixels, such as 320x240, each 1 to {MAX_SIDE} and at most {MAX_FRAME_PIXELS} in all"
                    );
                    wrong("size", value, &accepted)
                })?;
            }
            _ => {
                return Err(Error::Unknown {
                    what: "key of a scene",
                    given: key.to_string(),
                    accepted: KEYS.to_string(),
                });
            }
        }
        Ok(())
    }
}

fn size(text: &str) -> Option<(usize, usize)> {
    let (width, height) = text.split_once('x')?;
    let side = |text: &str| text.parse::<usize>().ok().filter(|side| (1..=MAX_SIDE).contains(side));
    let (width, height) = (side(width)?, side(height)?);
    (width * height <= MAX_FRAME_PIXELS).then_some((width, height))
}

fn wrong(name: &'static str, given: &str, accepted: &str) -> Error {
    Error::Text { name, given: given.to_string(), accepted: accepted.to_string() }
}

impl FromStr for Spec {
    type Err = Error;

    fn from_str(text: &str) -> Result<Self> {
        let (name, settings) = text.split_once(':').unwrap_or((text, ""));
        let mut spec = Spec::new(name)?;
        for setting in settings.split(',').filter(|setting| !setting.is_empty()) {
            let (key, value) = setting.split_once('=').unwrap_or((setting, ""));
            spec.set(key, value)?;
        }
        Ok(spec)
    }
}

impl fmt::Display for Spec {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (scene, sensor) = (self.scene.name, self.sensor.info().name);
        write!(f, "{scene}:seed={},sensor={sensor},size={}x{}", self.seed, self.width, self.height)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_spec_reads_back_as_written() {
        for text in ["room", "curved:", "stairs:seed=18446744073709551615,size=1x65535", "random:sensor=disparity"] {
            let spec: Spec = text.parse().unwrap();
            assert_eq!(spec.to_string().parse::<Spec>().unwrap(), spec, "{text}");
        }
        assert_eq!("room".parse::<Spec>().unwrap(), Spec::demo());
    }

    #[test]
    fn what_is_wrong_is_named() {
        let message = |text: &str| text.parse::<Spec>().unwrap_err().to_string();
        assert!(message("hall").starts_with("there is no scene `hall`; there are: room,"));
        assert_eq!(message("room:zoom=2"), "there is no key of a scene `zoom`; there are: seed, sensor, size");
        assert_eq!(message("room:seed=-1"), "`seed` is `-1`; accepted: a whole number from 0 to 2^64 - 1");
        for size in ["", "320", "0x240", "320x", "axb", "65536x1", "65535x65535", "320x240x2"] {
            let message = message(&format!("room:size={size}"));
            assert!(message.starts_with(&format!("`size` is `{size}`; accepted: WIDTHxHEIGHT")), "{message}");
        }
    }
}
