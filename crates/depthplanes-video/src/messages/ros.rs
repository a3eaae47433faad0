//! ROS 2: `sensor_msgs/msg/Image`, `CompressedImage` and `CameraInfo`, in CDR.

use super::cdr::Cdr;
use super::content::{CameraInfo, Content, Message, seconds};

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
