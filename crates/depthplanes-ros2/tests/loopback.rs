//! The node in a process of its own, a camera and a listener in this one; they meet over loopback.

mod support;

use depthplanes::ground::GroundFinder;
use depthplanes::scene::{SceneFrame, ScenePixels, Spec};
use depthplanes::{Detection, Detector};
use depthplanes_ros2::messages::{Header, Image, Marker, MarkerArray, TransformStamped};
use serde_json::Value;
use std::time::Duration;
use support::{Domain, Frame, Peer, said_within};

/// A corridor, 1.45 m below a camera that looks down by 5 degrees.
const SCENE: &str = "corridor:sensor=clean_mm,size=320x240";
const HEIGHT_M: f64 = 1.45;
const TILT_DEG: f64 = 5.0;

fn scene() -> (SceneFrame, Vec<u16>) {
    let frame = SCENE.parse::<Spec>().unwrap().frame().unwrap();
    let ScenePixels::U16(pixels) = &frame.pixels else { panic!("millimetres have 16 bits") };
    let pixels = pixels.clone();
    (frame, pixels)
}

/// The same map in each encoding, by turns: both byte orders, rows with bytes between, metres.
fn image(pixels: &[u16], [width, height]: [usize; 2], turn: usize, header: Header) -> Image {
    let metres = |&value: &u16| 0.001 * f32::from(value);
    let (encoding, is_bigendian, bytes, gap): (_, _, Vec<u8>, _) = match turn % 4 {
        0 => ("16UC1", 0, pixels.iter().flat_map(|value| value.to_le_bytes()).collect(), 0),
        1 => ("16UC1", 1, pixels.iter().flat_map(|value| value.to_be_bytes()).collect(), 6),
        2 => ("32FC1", 0, pixels.iter().flat_map(|value| metres(value).to_le_bytes()).collect(), 0),
        _ => ("mono16", 0, pixels.iter().flat_map(|value| value.to_le_bytes()).collect(), 0),
    };
    let row = bytes.len() / height;
    let data = bytes.chunks(row).flat_map(|row| [row, &vec![0xff; gap][..]].concat()).collect();
    let (height, width, step) = (height as u32, width as u32, (row + gap) as u32);
    Image { header, height, width, encoding: encoding.into(), is_bigendian, step, data }
}

#[test]
fn a_listener_gets_what_the_library_finds() {
    let (frame, pixels) = scene();
    let size = [frame.width, frame.height];
    let domain = Domain::new();
    let mut node = domain.node(&[]);
    let mut peer = Peer::new(&domain);
    let sensor = frame.sensor;
    let frames =
        peer.frames(&mut node, sensor.intrinsics.unwrap(), size, 8, |turn, header| image(&pixels, size, turn, header));

    let mut detector = Detector::default().sensor(sensor);
    let expected = detector.detect(frame.view()).unwrap();
    let mut finder = GroundFinder::default();
    let ground = finder.find(frame.view(), expected, &sensor).unwrap();
    let mut floors = Vec::new();
    for Frame { labels, obstacles, planes, markers, transform } in &frames {
        let record: Value = serde_json::from_str(&planes.data).unwrap();
        check_record(&record, expected, &labels.header);
        check_labels(labels, expected, &record);
        assert_eq!((obstacles.encoding.as_str(), obstacles.step), ("mono8", 320));
        assert_eq!(obstacles.data, ground.marks);
        check_markers(markers, expected, &record);
        check_floor(transform);
        let floor = &record["ground"]["floor"]["label"];
        let plane = record["planes"].as_array().unwrap().iter().find(|plane| &plane["label"] == floor).unwrap();
        floors.push(plane["id"].as_u64().unwrap());
    }
    assert!(floors.iter().all(|id| *id == floors[0]), "the floor keeps its id: {floors:?}");

    // Colours are no depth: that is said, and the node goes on.
    let colours = Image {
        encoding: "rgb8".into(),
        step: 960,
        data: vec![0; 960 * 240],
        ..image(&pixels, size, 0, Header::default())
    };
    let failed = peer.failed(&mut node, &colours);
    assert!(failed["error"].as_str().unwrap().contains("a picture in `rgb8`; accepted: 16UC1"), "{failed}");
    let said = node.end();
    assert_eq!(said.matches("rgb8").count(), 1, "it is said once:\n{said}");
    assert!(said.contains("images were searched, "), "{said}");
}

fn check_record(record: &Value, expected: &Detection, header: &Header) {
    assert_eq!(record["schema"], "depthplanes.track/1");
    assert_eq!((&record["width"], &record["height"]), (&320.into(), &240.into()));
    let time_s = f64::from(header.stamp.sec) + 1e-9 * f64::from(header.stamp.nanosec);
    assert_eq!(record["time_s"].as_f64(), Some(time_s));
    let planes = record["planes"].as_array().unwrap();
    assert_eq!(planes.len(), expected.planes.len());
    for (plane, expected) in planes.iter().zip(&expected.planes) {
        assert_eq!(plane["label"], expected.label);
        assert_eq!(plane["pixel_count"], expected.pixel_count);
    }
    assert_eq!(record["ground"]["schema"], "depthplanes.floor/1");
}

/// Pixels have the id that the record gives to the label which the library gives to them.
fn check_labels(labels: &Image, expected: &Detection, record: &Value) {
    assert_eq!((labels.encoding.as_str(), labels.width, labels.height, labels.step), ("mono16", 320, 240, 640));
    let planes = record["planes"].as_array().unwrap();
    let id_of = |label: u16| planes.iter().find(|plane| plane["label"] == label).unwrap()["id"].as_u64().unwrap();
    let ids: Vec<u64> = (1..=planes.len() as u16).map(id_of).collect();
    let found = labels.data.chunks(2).map(|pair| u64::from(u16::from_le_bytes([pair[0], pair[1]])));
    let wanted = expected.labels.iter().map(|&label| usize::from(label).checked_sub(1).map_or(0, |at| ids[at]));
    assert!(found.eq(wanted));
}

/// One outline and one id for each plane, the outline on the plane.
fn check_markers(markers: &MarkerArray, expected: &Detection, record: &Value) {
    let (first, shown) = markers.markers.split_first().unwrap();
    assert_eq!(first.action, Marker::DELETE_ALL);
    let of = |ns: &'static str| shown.iter().filter(move |marker| marker.ns == ns).map(|marker| i64::from(marker.id));
    let planes = record["planes"].as_array().unwrap();
    let ids: Vec<i64> = planes.iter().map(|plane| plane["id"].as_i64().unwrap()).collect();
    assert!(of("outlines").eq(ids.iter().copied()) && of("ids").eq(ids.iter().copied()), "{ids:?}");
    assert_eq!(shown.len(), 2 * ids.len());
    for (marker, plane) in shown.iter().filter(|marker| marker.ns == "outlines").zip(&expected.planes) {
        let equation = plane.metric.unwrap().plane;
        assert!(marker.r#type == Marker::LINE_LIST && marker.points.len() % 2 == 0 && marker.points.len() >= 6);
        for point in &marker.points {
            let [x, y, z] = equation.normal;
            assert!((x * point.x + y * point.y + z * point.z + equation.distance).abs() < 1e-6);
        }
    }
}

/// The floor's frame is where the scene has its floor: its origin below the camera, z up, x ahead.
fn check_floor(stamped: &TransformStamped) {
    assert_eq!((stamped.header.frame_id.as_str(), stamped.child_frame_id.as_str()), ("depth_optical", "floor"));
    let (origin, q) = (stamped.transform.translation, stamped.transform.rotation);
    let height_m = (origin.x.powi(2) + origin.y.powi(2) + origin.z.powi(2)).sqrt();
    assert!((height_m - HEIGHT_M).abs() < 0.01, "{height_m}");
    // The third column of the rotation is up in the camera's coordinates, the first is ahead.
    let up = [2.0 * (q.x * q.z + q.y * q.w), 2.0 * (q.y * q.z - q.x * q.w), 1.0 - 2.0 * (q.x * q.x + q.y * q.y)];
    let ahead = [1.0 - 2.0 * (q.y * q.y + q.z * q.z), 2.0 * (q.x * q.y + q.z * q.w), 2.0 * (q.x * q.z - q.y * q.w)];
    let (sine, cosine) = TILT_DEG.to_radians().sin_cos();
    for (found, true_one) in [(up, [0.0, -cosine, -sine]), (ahead, [0.0, -sine, cosine])] {
        let product: f64 = (0..3).map(|i| found[i] * true_one[i]).sum();
        assert!(product > 0.3f64.to_radians().cos(), "{found:?} is more than 0.3 degrees from {true_one:?}");
    }
}

#[test]
fn a_camera_that_is_not_published_is_said_with_what_to_type() {
    let (frame, pixels) = scene();
    let size = [frame.width, frame.height];
    let domain = Domain::new();
    let mut node = domain.node(&[]);
    let peer = Peer::new(&domain);
    let waits = said_within(&mut node, Duration::from_secs(60), "--intrinsics FX,FY,CX,CY", || {
        peer.depth.publish(image(&pixels, size, 0, Header::default())).unwrap();
    });
    assert!(
        waits.contains(&format!("no camera that can be used on {}/camera_info for 5 s", domain.folder())),
        "{waits}"
    );
    drop(node.end());
}

#[test]
fn images_on_another_topic_are_named() {
    let (frame, pixels) = scene();
    let size = [frame.width, frame.height];
    let domain = Domain::new();
    let mut node = domain.node(&["--depth", "/nothing/image"]);
    let peer = Peer::new(&domain);
    let waits = said_within(&mut node, Duration::from_secs(60), "--depth TOPIC names another", || {
        peer.depth.publish(image(&pixels, size, 0, Header::default())).unwrap();
    });
    assert!(waits.contains("no image has come on /nothing/image for 5 s"), "{waits}");
    assert!(waits.contains(&format!("{}/image", domain.folder())), "{waits}");
    drop(node.end());
}
