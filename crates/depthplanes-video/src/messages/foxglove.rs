//! Foxglove's messages in Protobuf (<https://docs.foxglove.dev/docs/sdk/schemas>).

use super::content::{CameraInfo, Content, Message, seconds};
use super::wire::{Wire, fields};

/// `google.protobuf.Timestamp`.
fn stamp(value: Wire<'_>) -> Result<Option<f64>, String> {
    let (mut whole, mut nanoseconds) = (0, 0);
    for field in fields(value.bytes()?) {
        match field? {
            (1, value) => whole = value.number()?.cast_signed(),
            (2, value) => nanoseconds = value.u32()?,
            _ => (),
        }
    }
    Ok(seconds(whole, nanoseconds))
}

pub(super) fn raw_image(bytes: &[u8]) -> Result<Message<'_>, String> {
    let (mut stamp_s, mut frame_id, mut encoding, mut data) = (None, String::new(), String::new(), &[][..]);
    let [mut width, mut height, mut step] = [0; 3];
    for field in fields(bytes) {
        match field? {
            (1, value) => stamp_s = stamp(value)?,
            (2, value) => width = value.u32()?,
            (3, value) => height = value.u32()?,
            (4, value) => encoding = value.text()?,
            (5, value) => step = value.u32()?,
            (6, value) => data = value.bytes()?,
            (7, value) => frame_id = value.text()?,
            _ => (),
        }
    }
    let content = Content::Raw { width, height, step, encoding, is_big_endian: false, data: data.into() };
    Ok(Message { stamp_s, frame_id, content })
}

pub(super) fn compressed_image(bytes: &[u8]) -> Result<Message<'_>, String> {
    let (mut stamp_s, mut frame_id, mut format, mut data) = (None, String::new(), String::new(), &[][..]);
    for field in fields(bytes) {
        match field? {
            (1, value) => stamp_s = stamp(value)?,
            (2, value) => data = value.bytes()?,
            (3, value) => format = value.text()?,
            (4, value) => frame_id = value.text()?,
            _ => (),
        }
    }
    Ok(Message { stamp_s, frame_id, content: Content::Packed { format, data: data.into() } })
}

pub(super) fn camera_calibration(bytes: &[u8]) -> Result<Message<'_>, String> {
    let (mut stamp_s, mut frame_id, mut camera) = (None, String::new(), CameraInfo::default());
    for field in fields(bytes) {
        match field? {
            (1, value) => stamp_s = stamp(value)?,
            (2, value) => camera.width = value.u32()?,
            (3, value) => camera.height = value.u32()?,
            (4, value) => camera.distortion_model = value.text()?,
            (5, value) => value.f64s(&mut camera.d)?,
            (6, value) => value.f64s(&mut camera.k)?,
            (7, value) => value.f64s(&mut camera.r)?,
            (8, value) => value.f64s(&mut camera.p)?,
            (9, value) => frame_id = value.text()?,
            _ => (),
        }
    }
    Ok(Message { stamp_s, frame_id, content: Content::Camera(camera.json()) })
}
