//! The camera of the images, as the latest message has it.

use crate::messages::CameraInfo;
use depthplanes_io::camera_file::CameraFile;
use depthplanes_video::ros;

/// What is known of the camera.
#[derive(Default)]
pub(crate) struct Camera {
    message: Option<ros::CameraInfo>,
    known: Option<Result<CameraFile, String>>,
}

impl Camera {
    /// Takes in a message; most are the same as the one before.
    pub(crate) fn take(&mut self, message: &CameraInfo) {
        let message = numbers(message);
        if self.message.as_ref() != Some(&message) {
            self.known = Some(message.camera().map_err(|error| error.to_string()));
            self.message = Some(message);
        }
    }

    /// The camera, or why there is none; `None` before the first message.
    pub(crate) fn known(&self) -> Option<&Result<CameraFile, String>> {
        self.known.as_ref()
    }
}

fn numbers(message: &CameraInfo) -> ros::CameraInfo {
    let roi = message.roi;
    ros::CameraInfo {
        width: message.width,
        height: message.height,
        distortion_model: message.distortion_model.clone(),
        d: message.d.clone(),
        k: message.k.into(),
        r: message.r.into(),
        p: message.p.into(),
        binning: [message.binning_x, message.binning_y],
        region: [roi.x_offset, roi.y_offset, roi.width, roi.height],
    }
}
