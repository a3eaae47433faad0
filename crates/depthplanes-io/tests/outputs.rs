//! Each output, read back by other means than those that wrote it.

mod support;

use depthplanes::detection::Curved;
use depthplanes::outline::{Outliner, Outlines};
use depthplanes::{Coplanar, Detection, Detector, Ngaf, Part, Sensor, ValueKind};
use depthplanes_io::outputs::{self, OUTPUTS, Output, OutputError, Report, Spread, Times};
use depthplanes_io::{Frame, Pixels};
use std::path::{Path, PathBuf};
use support::{HEIGHT, WIDTH, detection, frame, golden, png_samples, report};

fn output(name: &str) -> &'static Output {
    OUTPUTS.iter().find(|output| output.name == name).unwrap()
}

fn encode(name: &str, path: &str, report: &Report<'_>) -> Vec<u8> {
    (output(name).writer(Path::new(path)).unwrap().encode)(report).unwrap()
}

fn same_pixels(a: &[u8], b: &[u8]) -> bool {
    png_samples(a).1 == png_samples(b).1
}

/// An empty folder of this test's own.
fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).unwrap();
    folder
}

fn names_in(folder: &Path) -> Vec<String> {
    let mut names: Vec<String> =
        folder.read_dir().unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

#[test]
fn label_png_holds_the_labels_in_16_bits() {
    let (frame, detection) = (frame(), detection());
    let (about, samples) = png_samples(&encode("labels", "a.png", &report(&frame, &detection)));
    assert_eq!((about.width, about.height), (WIDTH as u32, HEIGHT as u32));
    assert_eq!((about.color_type, about.bit_depth), (png::ColorType::Grayscale, png::BitDepth::Sixteen));
    let read: Vec<u16> = samples.chunks_exact(2).map(|pair| u16::from_be_bytes([pair[0], pair[1]])).collect();
    assert_eq!(read, detection.labels);
}

#[test]
fn label_npy_has_the_numpy_layout() {
    let (frame, detection) = (frame(), detection());
    let bytes = encode("labels", "a.NPY", &report(&frame, &detection));
    assert_eq!(&bytes[..8], b"\x93NUMPY\x01\x00");
    let header_length = usize::from(u16::from_le_bytes([bytes[8], bytes[9]]));
    let (header, data) = bytes[10..].split_at(header_length);
    assert_eq!((10 + header_length) % 64, 0);
    let header = std::str::from_utf8(header).unwrap();
    assert!(header.starts_with("{'descr': '<u2', 'fortran_order': False, 'shape': (32, 48), }"), "{header}");
    assert!(header.ends_with('\n'));
    let read: Vec<u16> = data.chunks_exact(2).map(|pair| u16::from_le_bytes([pair[0], pair[1]])).collect();
    assert_eq!(read, detection.labels);
}

#[test]
fn overlay_looks_as_it_did() {
    let (frame, detection) = (frame(), detection());
    let plain = encode("overlay", "a.png", &report(&frame, &detection));
    golden("overlay.png", &plain, same_pixels);
    let legend = encode("overlay", "a.png", &Report { legend: true, ..report(&frame, &detection) });
    golden("overlay_legend.png", &legend, same_pixels);
}

#[test]
fn overlay_without_legend_has_the_size_of_the_map() {
    let (frame, detection) = (frame(), detection());
    let (about, _) = png_samples(&encode("overlay", "a.png", &report(&frame, &detection)));
    assert_eq!((about.width, about.height), (WIDTH as u32, HEIGHT as u32));
}

#[test]
fn near_is_brighter_than_far_and_missing_is_darkest() {
    let frame = frame();
    let mut none = detection();
    none.planes.clear();
    none.labels.fill(0);
    let (_, samples) = png_samples(&encode("overlay", "a.png", &report(&frame, &none)));
    let grey = |u: usize, v: usize| u32::from(samples[3 * (v * WIDTH + u)]);
    let (near, far, missing) = (grey(2, 20), grey(20, 2), grey(45, 1));
    assert!(near > far + 50 && far > missing + 20, "near {near}, far {far}, missing {missing}");
}

#[test]
fn overlays_of_disparity_and_of_empty_and_of_flat_maps_are_drawn() {
    let mut frame = frame();
    let detection = detection();
    frame.sensor = Sensor::default().value_kind(ValueKind::Disparity);
    encode("overlay", "a.png", &Report { legend: true, ..report(&frame, &detection) });
    for value in [0, 700] {
        frame.pixels = depthplanes_io::Pixels::U16(vec![value; WIDTH * HEIGHT]);
        encode("overlay", "a.png", &report(&frame, &detection));
    }
}

#[test]
fn planes_json_looks_as_it_did() {
    let (frame, detection) = (frame(), detection());
    let times =
        Times { total: Spread { median: 2.5, min: 2.0 }, stages: vec![("group", Spread { median: 1.5, min: 1.25 })] };
    let json = encode("planes", "a.json", &Report { times: Some(&times), ..report(&frame, &detection) });
    let stable = String::from_utf8(json).unwrap().replace(env!("CARGO_PKG_VERSION"), "VERSION");
    golden("planes.json", stable.as_bytes(), |a, b| a == b);
}

#[test]
fn planes_json_and_its_line_are_the_same_value() {
    let (frame, detection) = (frame(), detection());
    let document: serde_json::Value =
        serde_json::from_slice(&encode("planes", "a.json", &report(&frame, &detection))).unwrap();
    let line = outputs::json_line(&report(&frame, &detection));
    assert!(!line.contains('\n'));
    assert_eq!(document, serde_json::from_str::<serde_json::Value>(&line).unwrap());
    assert_eq!(document["schema"], outputs::SCHEMA);
    assert_eq!(document["parameters"], serde_json::json!({"theta": 1.5, "min-pixels": 32, "window": 0}));
    assert_eq!(document["planes"].as_array().unwrap().len(), 3);
    assert!(document["planes"][2]["fit"].is_null());
    assert!(document.get("time_ms").is_none());
}

#[test]
fn the_record_of_a_joined_plane_has_its_parts_as_they_were() {
    let (frame, mut detection) = (frame(), detection());
    let plain = outputs::json_line(&report(&frame, &detection));
    assert!(!plain.contains("parts") && !plain.contains("merge_coplanar"), "{plain}");
    detection.parts = [1, 2].map(|at| Part { of: 2, plane: detection.planes[at].clone() }).to_vec();
    let coplanar = Coplanar::new(4.0, 0.05).ok();
    let line = outputs::json_line(&Report { coplanar, ..report(&frame, &detection) });
    let (record, plain): (serde_json::Value, serde_json::Value) =
        (serde_json::from_str(&line).unwrap(), serde_json::from_str(&plain).unwrap());
    assert_eq!(record["merge_coplanar"], serde_json::json!({"angle_deg": 4.0, "distance_m": 0.05}));
    assert_eq!(record["planes"][1]["parts"], serde_json::json!([plain["planes"][1], plain["planes"][2]]));
    assert!(record["planes"][0].get("parts").is_none());
}

#[test]
fn planes_csv_looks_as_it_did() {
    let (frame, detection) = (frame(), detection());
    let csv = encode("planes", "a.csv", &report(&frame, &detection));
    golden("planes.csv", &csv, |a, b| a == b);
    for line in std::str::from_utf8(&csv).unwrap().lines().skip(1) {
        let after_source = line.strip_prefix("\"room, left.png\",").unwrap();
        assert_eq!(after_source.split(',').count(), outputs::CSV_COLUMNS.len() - 1);
    }
}

#[test]
fn cloud_holds_every_valid_pixel_in_metres() {
    let (frame, detection) = (frame(), detection());
    let bytes = encode("cloud", "a.ply", &report(&frame, &detection));
    let end = bytes.windows(11).position(|window| window == b"end_header\n").unwrap() + 11;
    let header = std::str::from_utf8(&bytes[..end]).unwrap();
    assert!(header.starts_with("ply\nformat binary_little_endian 1.0\n"));
    assert!(header.contains("element vertex 1508\n"), "{header}");
    let vertices: Vec<&[u8]> = bytes[end..].chunks_exact(17).collect();
    assert_eq!(vertices.len(), 1508);
    let float = |vertex: &[u8], i: usize| f32::from_le_bytes(vertex[4 * i..4 * i + 4].try_into().unwrap());
    let first = vertices[0];
    for (axis, expected) in [-23.5 / 40.0 * 3.0, -15.5 / 40.0 * 3.0, 3.0].into_iter().enumerate() {
        assert!((float(first, axis) - expected).abs() < 1e-5, "axis {axis}: {}", float(first, axis));
    }
    assert_eq!(first[12..15], outputs::colour(1));
    let labels: Vec<u16> = vertices.iter().map(|vertex| u16::from_le_bytes([vertex[15], vertex[16]])).collect();
    assert_eq!(labels.iter().filter(|&&label| label == 3).count(), detection.planes[2].pixel_count);
}

/// A synthetic room and its planes, many of them with holes.
fn room() -> (Frame, Detection) {
    let scene =
        "room:seed=2,sensor=tof_white,size=160x120".parse::<depthplanes::scene::Spec>().unwrap().frame().unwrap();
    let depthplanes::scene::ScenePixels::U16(pixels) = &scene.pixels else { panic!("millimetres") };
    let mut detector = Detector::new(Ngaf::default().theta(40.0).min_pixels(8)).unwrap().sensor(scene.sensor);
    let found = detector.detect(scene.view()).unwrap().clone();
    let (width, height) = (scene.width, scene.height);
    (Frame { width, height, pixels: Pixels::U16(pixels.clone()), sensor: scene.sensor, ..frame() }, found)
}

type Point = [f64; 3];

/// Vertices with their labels, and triangles, of a mesh as it is written.
fn read_mesh(bytes: &[u8]) -> (Vec<(Point, u16)>, Vec<[usize; 3]>) {
    let end = bytes.windows(11).position(|window| window == b"end_header\n").unwrap() + 11;
    let header = std::str::from_utf8(&bytes[..end]).unwrap();
    let count = |element: &str| {
        let line = header.lines().find_map(|line| line.strip_prefix(element)).unwrap();
        line.trim().parse::<usize>().unwrap()
    };
    let (vertices, faces) = bytes[end..].split_at(17 * count("element vertex"));
    assert_eq!(faces.len(), 13 * count("element face"));
    let float = |vertex: &[u8], i: usize| f64::from(f32::from_le_bytes(vertex[4 * i..4 * i + 4].try_into().unwrap()));
    let vertex = |v: &[u8]| ([0, 1, 2].map(|i| float(v, i)), u16::from_le_bytes([v[15], v[16]]));
    let corner = |face: &[u8], i: usize| u32::from_le_bytes(face[1 + 4 * i..5 + 4 * i].try_into().unwrap()) as usize;
    let face = |face: &[u8]| {
        assert_eq!(face[0], 3);
        [0, 1, 2].map(|i| corner(face, i))
    };
    (vertices.chunks_exact(17).map(vertex).collect(), faces.chunks_exact(13).map(face).collect())
}

/// The area of a triangle around a normal: below 0 if it turns the other way.
fn area_around(normal: Point, [a, b, c]: [Point; 3]) -> f64 {
    let (p, q) = ([0, 1, 2].map(|i| b[i] - a[i]), [0, 1, 2].map(|i| c[i] - a[i]));
    let cross = [p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]];
    (0..3).map(|i| normal[i] * cross[i]).sum::<f64>() / 2.0
}

#[test]
fn a_mesh_of_exact_outlines_covers_the_area_of_each_plane_and_faces_the_camera() {
    let (mut frame, mut detection) = room();
    for mirrored in [false, true] {
        if mirrored {
            // The same planes seen through a camera whose picture is upside down.
            let mut camera = frame.sensor.intrinsics.unwrap();
            camera.fy = -camera.fy;
            frame.sensor.intrinsics = Some(camera);
            let Pixels::U16(pixels) = &frame.pixels else { unreachable!() };
            let ngaf = Ngaf::default().theta(40.0).min_pixels(8);
            let mut detector = Detector::new(ngaf).unwrap().sensor(frame.sensor);
            let view = depthplanes::DepthView::new(pixels, frame.width, frame.height).unwrap();
            detection = detector.detect(view).unwrap().clone();
        }
        let mut outliner = Outliner::new(0.0).unwrap();
        let outlines = outliner.outline(&detection, frame.sensor.intrinsics.as_ref()).unwrap();
        let holes = |outlines: &Outlines| {
            outlines.iter().flat_map(|outline| outline.polygons()).map(|polygon| polygon.holes().len()).sum::<usize>()
        };
        assert!(holes(outlines) > 10, "{} holes", holes(outlines));
        let report = Report { outlines: Some(outlines), ..report(&frame, &detection) };
        let (vertices, triangles) = read_mesh(&encode("mesh", "a.ply", &report));
        let mut areas = vec![0.0; detection.planes.len()];
        for triangle in triangles {
            let label = usize::from(vertices[triangle[0]].1);
            let normal = detection.planes[label - 1].metric.unwrap().plane.normal;
            let area = area_around(normal, triangle.map(|corner| vertices[corner].0));
            assert!(area > -1e-6, "a triangle of plane {label} has area {area}");
            areas[label - 1] += area;
        }
        let mut metric = 0;
        for (plane, area) in detection.planes.iter().zip(areas) {
            let expected = plane.metric.and_then(|metric| metric.area_m2).unwrap_or(0.0);
            assert!((area - expected).abs() <= 1e-3 * expected + 1e-6, "plane {}: {area} {expected}", plane.label);
            metric += usize::from(expected > 0.0);
        }
        assert!(metric > 5, "{metric} metric planes");
    }
}

#[test]
fn a_mesh_without_a_camera_says_what_is_missing() {
    let (mut frame, detection) = (frame(), detection());
    frame.sensor.intrinsics = None;
    let error = (output("mesh").writers[0].encode)(&report(&frame, &detection)).unwrap_err();
    assert!(error.to_string().contains("--intrinsics"), "{error}");
}

#[test]
fn outlines_stand_in_the_record_and_on_the_picture() {
    let (frame, detection) = (frame(), detection());
    let mut outliner = Outliner::default();
    let outlines = outliner.outline(&detection, frame.sensor.intrinsics.as_ref()).unwrap();
    let report = Report { outlines: Some(outlines), ..report(&frame, &detection) };
    let json = String::from_utf8(encode("planes", "a.json", &report)).unwrap();
    golden("planes_outlines.json", json.replace(env!("CARGO_PKG_VERSION"), "VERSION").as_bytes(), |a, b| a == b);
    golden("overlay_outlines.png", &encode("overlay", "a.png", &report), same_pixels);
}

#[test]
fn cloud_without_a_camera_says_what_is_missing() {
    let (mut frame, detection) = (frame(), detection());
    frame.sensor.intrinsics = None;
    let error = (output("cloud").writers[0].encode)(&report(&frame, &detection)).unwrap_err();
    assert!(error.to_string().contains("--intrinsics"), "{error}");
    frame.sensor.value_kind = ValueKind::Disparity;
    let error = (output("cloud").writers[0].encode)(&report(&frame, &detection)).unwrap_err();
    assert!(error.to_string().contains("--baseline"), "{error}");
    assert!(error.is_usage());
}

#[test]
fn an_unknown_extension_names_the_known_ones() {
    for path in ["a.tif", "a", "png"] {
        let error = output("labels").writer(Path::new(path)).unwrap_err();
        assert!(error.to_string().contains(".png or .npy"), "{error}");
    }
}

#[test]
fn all_outputs_are_written_and_nothing_else() {
    let folder = folder("all_outputs");
    let (frame, mut detection) = (frame(), detection());
    let mut curved = Curved::default();
    curved.labels.resize(detection.labels.len(), 0);
    detection.curved = Some(curved);
    let wanted: Vec<(&Output, PathBuf)> = OUTPUTS.iter().map(|output| (output, folder.join(output.file))).collect();
    outputs::write_all(&report(&frame, &detection), &wanted).unwrap();
    assert_eq!(names_in(&folder), ["cloud.ply", "curved.png", "labels.png", "mesh.ply", "overlay.png", "planes.json"]);
}

#[test]
fn if_one_output_fails_none_is_written_and_old_files_stay() {
    let folder = folder("one_fails");
    let (mut frame, detection) = (frame(), detection());
    frame.sensor.intrinsics = None;
    std::fs::write(folder.join("labels.png"), "old").unwrap();
    let wanted: Vec<(&Output, PathBuf)> = OUTPUTS.iter().map(|output| (output, folder.join(output.file))).collect();
    assert!(outputs::write_all(&report(&frame, &detection), &wanted).is_err());
    assert_eq!(names_in(&folder), ["labels.png"]);
    assert_eq!(std::fs::read(folder.join("labels.png")).unwrap(), b"old");
    let nowhere = [(output("labels"), folder.join("labels.npy")), (output("planes"), folder.join("no/planes.json"))];
    assert!(matches!(outputs::write_all(&report(&frame, &detection), &nowhere), Err(OutputError::Write { .. })));
    assert_eq!(names_in(&folder), ["labels.png"]);
}

#[test]
fn an_output_may_not_be_an_input_or_another_output_however_it_is_spelled() {
    let folder = folder("same_path");
    let input = folder.join("in.png");
    std::fs::write(&input, "map").unwrap();
    let named = |path: &Path, name: &str| (path.to_path_buf(), name.to_string());
    let inputs = [named(&input, "the input")];
    let spelled = folder.join("../same_path/./in.png");
    let error = outputs::check_paths(&inputs, &[named(&spelled, "--labels")]).unwrap_err();
    assert!(error.to_string().contains("--labels would overwrite the input"), "{error}");
    let (a, b) = (folder.join("out.png"), folder.join("../same_path/out.png"));
    assert!(outputs::check_paths(&inputs, &[named(&a, "--labels"), named(&b, "--overlay")]).is_err());
    assert!(matches!(outputs::check_folder(&folder), Err(OutputError::IsFolder(_))));
    assert!(matches!(outputs::check_folder(&folder.join("no/a.png")), Err(OutputError::NoFolder { .. })));
    outputs::check_folder(&a).unwrap();
    outputs::check_paths(&inputs, &[named(&a, "--labels")]).unwrap();
}

#[cfg(unix)]
#[test]
fn a_link_to_an_input_is_that_input_and_a_link_as_output_stays_a_link() {
    let folder = folder("links");
    let (input, link) = (folder.join("in.png"), folder.join("link.png"));
    std::fs::write(&input, "map").unwrap();
    std::os::unix::fs::symlink(&input, &link).unwrap();
    let named = |path: &Path| (path.to_path_buf(), "it".to_string());
    assert!(outputs::check_paths(&[named(&input)], &[named(&link)]).is_err());
    outputs::write_file(&link, b"new").unwrap();
    assert!(link.symlink_metadata().unwrap().is_symlink());
    assert_eq!(std::fs::read(&input).unwrap(), b"new");
    outputs::write_file(Path::new("/dev/null"), b"gone").unwrap();
}

#[test]
fn the_schema_page_names_every_field_and_column() {
    let page =
        std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/planes-schema.md")).unwrap();
    assert!(page.contains(&outputs::CSV_COLUMNS.join(",")));
    let (frame, mut detection) = (frame(), detection());
    detection.parts = detection.planes[..2].iter().map(|plane| Part { of: 1, plane: plane.clone() }).collect();
    let coplanar = Some(Coplanar::default());
    let times = Times::default();
    let mut outliner = Outliner::default();
    let outlines = outliner.outline(&detection, frame.sensor.intrinsics.as_ref()).ok();
    let line = outputs::json_line(&Report { times: Some(&times), outlines, coplanar, ..report(&frame, &detection) });
    let record: serde_json::Value = serde_json::from_str(&line).unwrap();
    let plane = &record["planes"][0];
    let keys = |value: &serde_json::Value| value.as_object().unwrap().keys().cloned().collect::<Vec<_>>();
    let metric = keys(&plane["metric"]).into_iter().map(|key| format!("metric.{key}"));
    let outline = keys(&plane["outline"]).into_iter().map(|key| format!("outline.{key}"));
    for key in keys(&record).into_iter().chain(keys(plane)).chain(metric).chain(outline) {
        assert!(page.contains(&format!("`{key}`")), "{key}");
    }
}
