//! A map as Rerun shows it: depth along the optical axis with its unit.

use depthplanes::{AnyView, DepthView, Pixel, ValueKind};
use depthplanes_io::Frame;
use re_sdk_types::archetypes::DepthImage;
use re_sdk_types::datatypes::ChannelDatatype;

/// The depth of a frame; missing pixels are 0, which Rerun leaves out. As it is where the map has depth, in metres where it has
/// disparity of a known rig; `None` where nobody knows the depth.
///
/// # Errors
/// Those of [`Frame::view`].
pub(crate) fn depth_image(frame: &Frame) -> depthplanes::Result<Option<DepthImage>> {
    let (view, kind) = (frame.view()?, frame.sensor.value_kind);
    let (bytes, samples, metres) = match (kind, view) {
        (ValueKind::Disparity, _) => return Ok(None),
        (ValueKind::Depth { metres }, AnyView::U8(view)) => (bytes(view, u8::to_le_bytes), ChannelDatatype::U8, metres),
        (ValueKind::Depth { metres }, AnyView::U16(view)) => {
            (bytes(view, u16::to_le_bytes), ChannelDatatype::U16, metres)
        }
        (ValueKind::Depth { metres }, AnyView::F32(view)) => {
            (bytes(view, f32::to_le_bytes), ChannelDatatype::F32, metres)
        }
        (_, view) => {
            let depth_m = |value: f64| kind.depth_m(value).unwrap_or(0.0) as f32;
            let metres =
                depthplanes::with_view!(view, view => bytes(view, |value| depth_m(f64::from(value)).to_le_bytes()));
            (metres, ChannelDatatype::F32, 1.0)
        }
    };
    let size = [frame.width as u32, frame.height as u32];
    let image = DepthImage::from_data_type_and_bytes(bytes, size, samples);
    Ok(Some(image.with_meter(metres.recip() as f32)))
}

/// The bytes of all pixels, row by row; 0 where they are missing.
fn bytes<T: Pixel, const N: usize>(view: DepthView<'_, T>, to_bytes: impl Fn(T) -> [u8; N]) -> Vec<u8> {
    let valid = view.validity();
    let pixel = |&value: &T| if valid.holds(value) { to_bytes(value) } else { [0; N] };
    view.rows().flatten().flat_map(pixel).collect()
}
