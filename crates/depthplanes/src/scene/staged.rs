//! A scene as a camera finds it.

use super::pose::Pose;
use super::surfaces::Scene;

/// A scene and the place of the camera in it.
#[derive(Clone, Debug, PartialEq)]
pub struct Staged {
    /// The surfaces.
    pub scene: Scene,
    /// The camera's place.
    pub pose: Pose,
}
