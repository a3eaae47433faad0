//! Foxglove's messages in JSON, bytes in base64.

use super::content::{CameraInfo, Content, Message, seconds};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use serde_json::Value;

fn head(bytes: &[u8]) -> Result<(Value, Option<f64>, String), String> {
    let value: Value = serde_json::from_slice(bytes).map_err(|error| error.to_string())?;
    let of_stamp = |name: &str| value["timestamp"][name].as_i64().unwrap_or(0);
    let stamp_s = seconds(of_stamp("sec"), u32::try_from(of_stamp("nsec")).unwrap_or(0));
    let frame_id = value["frame_id"].as_str().unwrap_or_default().to_string();
    Ok((value, stamp_s, frame_id))
}

fn whole(value: &Value, name: &str) -> Result<u32, String> {
    let number = value[name].as_u64().and_then(|number| u32::try_from(number).ok());
    number.ok_or_else(|| format!("`{name}` is {}, not a number of 32 bits", value[name]))
}

fn text(value: &Value, name: &str) -> Result<String, String> {
    value[name].as_str().map(str::to_string).ok_or_else(|| format!("`{name}` is no text"))
}

fn data(value: &Value) -> Result<Vec<u8>, String> {
    let text = value["data"].as_str().ok_or("`data` is no text")?;
    STANDARD.decode(text).map_err(|error| format!("`data` is no base64: {error}"))
}

pub(super) fn raw_image(bytes: &[u8]) -> Result<Message<'_>, String> {
    let (value, stamp_s, frame_id) = head(bytes)?;
    let content = Content::Raw {
        width: whole(&value, "width")?,
        height: whole(&value, "height")?,
        step: whole(&value, "step")?,
        encoding: text(&value, "encoding")?,
        is_big_endian: false,
        data: data(&value)?.into(),
    };
    Ok(Message { stamp_s, frame_id, content })
}

pub(super) fn compressed_image(bytes: &[u8]) -> Result<Message<'_>, String> {
    let (value, stamp_s, frame_id) = head(bytes)?;
    let content = Content::Packed { format: text(&value, "format")?, data: data(&value)?.into() };
    Ok(Message { stamp_s, frame_id, content })
}

pub(super) fn camera_calibration(bytes: &[u8]) -> Result<Message<'_>, String> {
    let (value, stamp_s, frame_id) = head(bytes)?;
    let numbers = |name: &str| -> Vec<f64> {
        value[name].as_array().into_iter().flatten().map(|number| number.as_f64().unwrap_or(f64::NAN)).collect()
    };
    let camera = CameraInfo {
        width: whole(&value, "width")?,
        height: whole(&value, "height")?,
        distortion_model: value["distortion_model"].as_str().unwrap_or_default().to_string(),
        d: numbers("D"),
        k: numbers("K"),
        r: numbers("R"),
        p: numbers("P"),
        ..CameraInfo::default()
    };
    Ok(Message { stamp_s, frame_id, content: Content::Camera(camera.json()) })
}
