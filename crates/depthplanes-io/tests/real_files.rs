//! Real files of public data sets, wherever they are on this machine.

mod common;

use std::path::Path;

use depthplanes::with_view;
use depthplanes_io::camera_file::read_camera;
use depthplanes_io::formats::{DecodeOptions, FORMATS};
use depthplanes_io::{Frame, Pixels, ReadOptions, inspect, read};

fn named(encoding: &str) -> ReadOptions {
    ReadOptions { encoding: Some(encoding.into()), ..Default::default() }
}

fn median_m(frame: &Frame) -> f64 {
    inspect::summary(frame, 8).unwrap().range_m.expect("a metric map")[1]
}

#[test]
fn every_map_of_the_manifest_has_the_stated_size() {
    let Some(data) = common::data() else { return };
    let manifest = std::fs::read_to_string(data.join("MANIFEST.tsv")).unwrap();
    let (mut maps, mut colour) = (0, 0);
    for line in manifest.lines().skip(1) {
        let columns: Vec<&str> = line.split('\t').collect();
        let (path, what, width, height, kind) = (columns[0], columns[2], columns[3], columns[4], columns[5]);
        let extension = Path::new(path).extension().and_then(|e| e.to_str()).unwrap_or("");
        let headerless = extension == "raw";
        let known = FORMATS.iter().any(|format| format.extensions.contains(&extension));
        if !known || headerless || width == "-" || path.contains("_GT") {
            continue;
        }
        let result = read(data.join(path), &ReadOptions::default());
        if ["x3", "x4"].iter().any(|channels| kind.replace(' ', "").contains(channels)) {
            colour += usize::from(result.is_err());
            continue;
        }
        let frame = result.unwrap_or_else(|error| panic!("{what}: {error}"));
        assert_eq!((frame.width.to_string(), frame.height.to_string()), (width.into(), height.into()), "{path}");
        maps += 1;
    }
    println!("{maps} maps read, {colour} colour pictures refused");
    assert!(maps > 150 && colour > 20, "{maps} maps, {colour} colour pictures");
}

#[test]
fn raw_kinect_with_swapped_bytes_becomes_a_room() {
    let Some(data) = common::data() else { return };
    let path = data.join("open3d/NYU_depth.pgm");
    let guessed = read(&path, &ReadOptions::default()).unwrap();
    assert!(guessed.warnings.iter().any(|warning| warning.contains("--swap-bytes")), "{:?}", guessed.warnings);
    let frame = read(&path, &named("kinect-raw")).unwrap();
    assert!((1.0..6.0).contains(&median_m(&frame)), "{} m", median_m(&frame));
}

#[test]
fn foreign_units_are_suspected_and_millimetres_are_not() {
    let Some(data) = common::data() else { return };
    for (path, hint) in [
        ("open3d/SUN_depth.png", "sun-rgbd"),
        ("open3d/TUM_depth.png", "tum"),
        ("icl_nuim/evolin/depth/0000.png", "tum"),
        ("kinect_v1/cape_depth_0.png", ""),
        ("stairs_kinect_v2/0000_depth.png", ""),
        ("realsense_polylidar/depth/00000000_1580908150203.png", ""),
        ("video_tsdf_fusion/frame-000150.depth.png", ""),
    ] {
        let warnings = read(data.join(path), &ReadOptions::default()).unwrap().warnings;
        assert_eq!(warnings.is_empty(), hint.is_empty(), "{path}: {warnings:?}");
        assert!(hint.is_empty() || warnings[0].contains(hint), "{path}: {warnings:?}");
    }
}

#[test]
fn data_sets_with_their_own_units_become_rooms() {
    let Some(data) = common::data() else { return };
    for (path, encoding) in [
        ("open3d/SUN_depth.png", "sun-rgbd"),
        ("open3d/TUM_depth.png", "tum"),
        ("icl_nuim/evolin/depth/0000.png", "icl"),
        ("kinect_v1/cape_depth_0.png", "millimetre"),
        ("stairs_kinect_v2/0000_depth.png", "millimetre"),
        ("pcl_kinect/office1.pcd", "metre"),
        ("realsense_opf/rgbd_opc.npy", "metre"),
    ] {
        let frame = read(data.join(path), &named(encoding)).unwrap();
        assert!((0.3..10.0).contains(&median_m(&frame)), "{path}: {} m", median_m(&frame));
    }
}

#[test]
fn the_same_kinect_frame_as_pclzf_and_tiff() {
    let Some(data) = common::data() else { return };
    let frame = |extension: &str| data.join(format!("pcl_kinect/frame_20121214T142255.814212_depth.{extension}"));
    let packed = read(frame("pclzf"), &ReadOptions::default()).unwrap();
    assert_eq!((packed.width, packed.height, packed.format), (640, 480, "pclzf"));
    if cfg!(feature = "tiff") {
        let tiff = read(frame("tiff"), &ReadOptions::default()).unwrap();
        assert_eq!(tiff.pixels, packed.pixels);
    }
}

#[test]
fn headerless_realsense_frames_with_their_size() {
    let Some(data) = common::data() else { return };
    for (name, size) in [("001_small_depth.raw", (424, 240)), ("001_big_depth.raw", (848, 480))] {
        let decode = DecodeOptions { raw_size: Some(size), ..Default::default() };
        let options = ReadOptions { decode, preset: Some("realsense-d4xx".into()), ..Default::default() };
        let frame = read(data.join("realsense_opf").join(name), &options).unwrap();
        assert_eq!((frame.width, frame.height), size);
        assert!((0.2..10.0).contains(&median_m(&frame)), "{} m", median_m(&frame));
        assert!(read(data.join("realsense_opf").join(name), &ReadOptions::default()).is_err());
    }
}

#[test]
fn float_disparity_with_its_calibration_becomes_metres() {
    let Some(data) = common::data() else { return };
    for scene in ["terrace", "playground"] {
        let folder = data.join("pfm").join(scene);
        let camera = read_camera(folder.join("calib.txt")).unwrap();
        let frame = read(folder.join("disp0.pfm"), &ReadOptions::default().camera(&camera)).unwrap();
        assert_eq!((frame.encoding, camera.size), ("middlebury", Some((frame.width, frame.height))));
        assert!((0.3..20.0).contains(&median_m(&frame)), "{scene}: {} m", median_m(&frame));
        // The same in double precision by the formula of the data set.
        let rig = camera.stereo.unwrap();
        let value = 20.0;
        let z = rig.baseline_m * rig.focal_px / (value + rig.doffs_px);
        assert!((frame.sensor.value_kind.depth_m(value).unwrap() - z).abs() < 1e-12);
    }
}

#[test]
fn motorcycle_archive_has_unknown_pixels_at_infinity() {
    let Some(data) = common::data() else { return };
    let options = ReadOptions { disparity: true, ..Default::default() };
    let frame = read(data.join("middlebury2014_skimage/motorcycle_disp.npz"), &options).unwrap();
    let Pixels::F32(values) = &frame.pixels else { panic!("floats") };
    let finite = values.iter().filter(|value| value.is_finite()).count();
    let valid = with_view!(frame.view().unwrap(), view => view.valid_pixels());
    assert_eq!((finite, finite < values.len()), (valid, true));
}

#[test]
fn camera_files_of_the_data_sets() {
    let Some(data) = common::data() else { return };
    let icl = read_camera(data.join("icl_nuim/evolin/calibration_matrix.txt")).unwrap();
    assert_eq!((icl.intrinsics.fx, icl.intrinsics.fy, icl.intrinsics.cx), (481.2, -480.0, 319.5));
    let open3d = read_camera(data.join("realsense_polylidar/camera_intrinsic_rgb_424.json")).unwrap();
    assert_eq!((open3d.size, open3d.intrinsics.cy), (Some((424, 240)), 121.65782165527344));
    let azure = read_camera(data.join("azure_kinect/calibration.json")).unwrap();
    assert!((azure.intrinsics.fx - 504.6076).abs() < 1e-3 && azure.distortion.is_some());
    assert_eq!(azure.choices.len(), 10); // four modes of depth, six of colour
}

#[test]
fn a_missing_file_is_named() {
    let error = read("no/such/map.png", &ReadOptions::default()).unwrap_err().to_string();
    assert!(error.starts_with("no/such/map.png: "), "{error}");
}
