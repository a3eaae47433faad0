//! The floor as a frame of coordinates: its origin below the camera, x ahead, y to the left and z up (REP 103).

use crate::messages::{Header, TfMessage, Transform, TransformStamped};
use depthplanes::ground::Floor;
use depthplanes::track::CameraPose;

/// From the floor to the camera; none for axes that mirror, of a camera whose y points up.
pub(crate) fn transform(floor: &Floor, header: &Header, child: &str) -> Option<TfMessage> {
    let (ahead, left, up) = (floor.ahead, floor.right.map(|x| -x), floor.plane.normal);
    let rotation = std::array::from_fn(|row| [ahead[row], left[row], up[row]]);
    let pose = CameraPose::new(rotation, floor.point([0.0; 3])).ok()?;
    let transform = Transform { translation: pose.translation_m().into(), rotation: pose.quaternion().into() };
    let stamped = TransformStamped { header: header.clone(), child_frame_id: child.into(), transform };
    Some(TfMessage { transforms: vec![stamped] })
}
