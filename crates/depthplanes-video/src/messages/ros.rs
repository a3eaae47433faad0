//! ROS 2: `sensor_msgs/msg/Image`, `CompressedImage`, `CameraInfo` and `Imu`, and `tf2_msgs/msg/TFMessage`, in CDR.

use super::cdr::Cdr;
use super::content::{CameraInfo, Content, Imu, Message, Transform, seconds};
use crate::pose_text::quaternion;

fn header(cdr: &mut Cdr<'_>) -> Result<(Option<f64>, String), String> {
    let stamp_s = seconds((cdr.u32()? as i32).into(), cdr.u32()?);
    Ok((stamp_s, cdr.text()?))
}

pub(super) fn image(bytes: &[u8]) -> Result<Message<'_>, String> {
    let mut cdr = Cdr::new(bytes)?;
    let (stamp_s, frame_id) = header(&mut cdr)?;
    let (height, width, encoding) = (cdr.u32()?, cdr.u32()?, cdr.text()?);
    let (is_big_endian, step, data) = (cdr.u8()? != 0, cdr.u32()?, cdr.bytes()?.into());
    let content = Content::Raw { width, height, step, encoding, is_big_endian, data };
    Ok(Message { stamp_s, frame_id, content })
}

pub(super) fn compressed_image(bytes: &[u8]) -> Result<Message<'_>, String> {
    let mut cdr = Cdr::new(bytes)?;
    let (stamp_s, frame_id) = header(&mut cdr)?;
    let content = Content::Packed { format: cdr.text()?, data: cdr.bytes()?.into() };
    Ok(Message { stamp_s, frame_id, content })
}

pub(super) fn camera_info(bytes: &[u8]) -> Result<Message<'_>, String> {
    /// Coefficients of a lens: more than any model has.
    const MOST: usize = 64;
    let mut cdr = Cdr::new(bytes)?;
    let (stamp_s, frame_id) = header(&mut cdr)?;
    let (height, width, distortion_model) = (cdr.u32()?, cdr.u32()?, cdr.text()?);
    let count = cdr.u32()? as usize;
    if count > MOST {
        return Err(format!("{count} coefficients of a lens"));
    }
    let d = cdr.f64s(count)?;
    let (k, r, p) = (cdr.f64s(9)?, cdr.f64s(9)?, cdr.f64s(12)?);
    let binning = [cdr.u32()?, cdr.u32()?];
    let [x, y, rows, columns] = [cdr.u32()?, cdr.u32()?, cdr.u32()?, cdr.u32()?];
    let region = [x, y, columns, rows];
    let camera = CameraInfo { width, height, distortion_model, d, k, r, p, binning, region };
    Ok(Message { stamp_s, frame_id, content: Content::Camera(camera.json()) })
}

pub(super) fn imu(bytes: &[u8]) -> Result<Message<'_>, String> {
    let mut cdr = Cdr::new(bytes)?;
    let (stamp_s, frame_id) = header(&mut cdr)?;
    cdr.f64s(4 + 9)?; // the orientation, whose world is that of another program
    let [turn_rate, acceleration] = [measured(&mut cdr)?, measured(&mut cdr)?];
    Ok(Message { stamp_s, frame_id, content: Content::Imu(Imu { acceleration, turn_rate }) })
}

/// Three numbers and their covariance; none where they were not measured: its first entry is -1 (the message's definition), or
/// all three are exactly 0, as drivers leave what they do not fill in.
fn measured(cdr: &mut Cdr<'_>) -> Result<Option<[f64; 3]>, String> {
    let vector = cdr.vector()?;
    let covariance = cdr.f64s(9)?;
    let is_measured = covariance[0] != -1.0 && vector != [0.0; 3] && vector.iter().all(|x| x.is_finite());
    Ok(is_measured.then_some(vector))
}

pub(super) fn transforms(bytes: &[u8]) -> Result<Message<'_>, String> {
    let mut cdr = Cdr::new(bytes)?;
    let mut transforms = Vec::new();
    for _ in 0..cdr.u32()? {
        let ((_, parent), child) = (header(&mut cdr)?, cdr.text()?);
        let [x, y, z] = cdr.vector()?;
        let numbers = [x, y, z, cdr.f64()?, cdr.f64()?, cdr.f64()?, cdr.f64()?];
        let pose = quaternion(numbers).map_err(|error| format!("{child} in {parent}: {error}"))?;
        transforms.push(Transform { parent, child, pose });
    }
    Ok(Message { stamp_s: None, frame_id: String::new(), content: Content::Transforms(transforms) })
}
