//! Messages lie in bytes as in the golden files, which `tests/oracles/test_ros2.py` holds to the Python package rosbags.

use byteorder::{BigEndian, LittleEndian};
use depthplanes_ros2::messages::*;
use ros2_client::dds::rustdds::cdr_encoding::{from_bytes, to_vec};
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::fmt::Debug;
use std::path::PathBuf;

/// What stands before a message: plain CDR, the lowest byte first.
const LITTLE_ENDIAN: [u8; 4] = [0, 1, 0, 0];

fn header() -> Header {
    Header { stamp: Time { sec: 1_700_000_000, nanosec: 123_456_789 }, frame_id: "camera_depth_optical_frame".into() }
}

/// `lengths` of texts and sequences are odd, so that what follows is aligned anew.
fn compare<M: Serialize + DeserializeOwned + PartialEq + Debug>(name: &str, message: &M) {
    let path: PathBuf = [env!("CARGO_MANIFEST_DIR"), "tests", "golden", name].iter().collect();
    let bytes = [&LITTLE_ENDIAN[..], &to_vec::<M, LittleEndian>(message).unwrap()].concat();
    if std::env::var_os("DEPTHPLANES_GOLDEN").is_some_and(|value| value == "update") {
        std::fs::write(&path, &bytes).unwrap();
    }
    let golden = std::fs::read(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    assert_eq!(bytes, golden, "{name}: if the change is meant, run `make golden`");
    let (read, count) = from_bytes::<M, LittleEndian>(&golden[4..]).unwrap();
    assert_eq!((&read, count), (message, golden.len() - 4), "{name}");
    let turned = to_vec::<M, BigEndian>(message).unwrap();
    assert_eq!(&from_bytes::<M, BigEndian>(&turned).unwrap().0, message, "{name}");
}

#[test]
fn messages_of_cameras_lie_as_in_ros() {
    let data = vec![1, 2, 3, 4, 5, 6, 0, 0, 7, 8, 9, 10, 11, 12, 0, 0];
    let (encoding, is_bigendian) = ("16UC1".into(), 1);
    compare("Image.cdr", &Image { header: header(), height: 2, width: 3, encoding, is_bigendian, step: 8, data });
    let camera = CameraInfo {
        header: header(),
        height: 480,
        width: 640,
        distortion_model: "plumb_bob".into(),
        d: vec![0.1, -0.2, 0.001, 0.002, 0.3],
        k: [580.0, 0.0, 319.5, 0.0, 581.0, 239.5, 0.0, 0.0, 1.0],
        r: [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0],
        p: [580.0, 0.0, 319.5, -40.0, 0.0, 581.0, 239.5, 0.0, 0.0, 0.0, 1.0, 0.0],
        binning_x: 2,
        binning_y: 3,
        roi: RegionOfInterest { x_offset: 4, y_offset: 5, height: 6, width: 7, do_rectify: true },
    };
    compare("CameraInfo.cdr", &camera);
}

#[test]
fn messages_of_planes_lie_as_in_ros() {
    compare("String.cdr", &Text { data: "{\"planes\": 3}".into() });
    let transform = Transform { translation: [0.1, 1.2, -0.3].into(), rotation: [0.5, -0.5, 0.5, -0.5].into() };
    let stamped = TransformStamped { header: header(), child_frame_id: "floor".into(), transform };
    let other = TransformStamped { child_frame_id: "ceiling".into(), ..stamped.clone() };
    compare("TFMessage.cdr", &TfMessage { transforms: vec![stamped, other] });
}

#[test]
fn markers_lie_as_in_ros() {
    let colour = |part: f32| Colour { r: part, g: 0.25, b: 0.5, a: 1.0 };
    let all = Marker {
        header: header(),
        ns: "outlines".into(),
        id: 7,
        r#type: Marker::LINE_LIST,
        action: Marker::ADD,
        pose: Pose { position: [1.0, 2.0, 3.0].into(), orientation: [0.0, 0.6, 0.0, 0.8].into() },
        scale: [0.01, 0.02, 0.03].into(),
        color: colour(0.75),
        lifetime: Time { sec: 2, nanosec: 3 },
        frame_locked: true,
        points: vec![[0.5, 1.5, 2.5].into(), [3.5, 4.5, 5.5].into()],
        colors: vec![colour(0.0), colour(1.0), colour(0.125)],
        texture_resource: "texture".into(),
        texture: CompressedImage { header: header(), format: "png".into(), data: vec![1, 2, 3] },
        uv_coordinates: vec![UvCoordinate { u: 0.5, v: 0.25 }],
        text: "12".into(),
        mesh_resource: "mesh".into(),
        mesh_file: MeshFile { filename: "file".into(), data: vec![9] },
        mesh_use_embedded_materials: true,
    };
    let gone = Marker { action: Marker::DELETE_ALL, ..Marker::default() };
    compare("MarkerArray.cdr", &MarkerArray { markers: vec![gone, all] });
}
