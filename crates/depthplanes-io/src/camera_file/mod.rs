//! Cameras from the files that describe them.
//!
//! In: the text of a file of any of the [`FORMS`], told apart by content. Out: a [`CameraFile`]. What is ambiguous is refused with what was found.

mod assign;
mod azure;
mod camera;
mod colmap;
mod depthai;
mod form;
mod kitti;
mod lines;
mod matlab;
mod middlebury;
mod mvsnet;
mod names;
mod nerf;
mod once;
mod orbslam;
mod ost;
mod realsense;
mod scannet;
mod several;
mod text;
mod tree;
mod unit;
mod xml;
mod yaml;
mod zed;

use std::borrow::Cow;
use std::path::Path;

use depthplanes::Intrinsics;

use crate::error::{Error, Result};
use crate::file_bytes::read_bytes;
pub use camera::CameraFile;
use camera::unreadable;
pub use form::CameraForm;
use form::{Document, form};

/// All forms; those that are easily told apart come first.
pub const FORMS: &[CameraForm] = &[
    form(
        "colmap",
        "COLMAP's cameras.txt; its pixel centres are at 0.5. The camera of the map's size, else the first",
        "1 PINHOLE 640 480 525 525 320 240",
        colmap::recognise,
        colmap::parse,
    ),
    form(
        "kitti-raw",
        "KITTI's calib_cam_to_cam.txt; the rectified left colour camera, 02, and the rig of 02 and 03",
        "S_rect_02: 1242 375\nP_rect_02: 721.5 0 609.6 44.9 0 721.5 172.9 0.2 0 0 1 0.003",
        kitti::recognise_raw,
        kitti::parse_raw,
    ),
    form(
        "kitti",
        "KITTI's odometry and object calibration; P2, or P0 where there is no P2, and its rig",
        "P0: 718.9 0 607.2 0 0 718.9 185.2 0 0 0 1 0\nP1: 718.9 0 607.2 -386.1 0 718.9 185.2 0 0 0 1 0",
        kitti::recognise,
        kitti::parse,
    ),
    form(
        "middlebury",
        "Middlebury's and ETH3D's calib.txt, with the stereo rig",
        "cam0=[1000 0 300; 0 1000 200; 0 0 1]",
        middlebury::recognise,
        middlebury::parse,
    ),
    form(
        "mvsnet",
        "MVSNet's cam.txt",
        "extrinsic\n1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n\nintrinsic\n525 0 319.5\n0 525 239.5\n0 0 1\n\n425 2.5",
        mvsnet::recognise,
        mvsnet::parse,
    ),
    form(
        "scannet",
        "ScanNet's scene*.txt, and _info.txt of its reader of .sens; the depth camera",
        "depthWidth = 640\ndepthHeight = 480\nfx_depth = 577.6\nfy_depth = 578.7\nmx_depth = 318.9\nmy_depth = 242.7",
        scannet::recognise,
        scannet::parse,
    ),
    form(
        "ost",
        "camera_calibration's ost.txt; the first camera",
        "[image]\n\nwidth\n640\n\nheight\n480\n\n[narrow_stereo]\n\ncamera matrix\n525 0 319.5\n0 525 239.5\n0 0 1",
        ost::recognise,
        ost::parse,
    ),
    form(
        "matlab",
        "what Matlab shows of `cameraParameters` and `cameraIntrinsics`, and `IntrinsicMatrix`; its pixel centres begin at 1",
        "FocalLength: [525 525]\nPrincipalPoint: [320.5 240.5]\nImageSize: [480 640]",
        matlab::recognise,
        matlab::parse,
    ),
    form(
        "bouguet",
        "Calib_Results.m of Bouguet's toolbox",
        "fc = [ 525 ; 525 ];\ncc = [ 319.5 ; 239.5 ];\nkc = [ 0 ; 0 ; 0 ; 0 ; 0 ];\nnx = 640;\nny = 480;",
        matlab::recognise_bouguet,
        matlab::parse_bouguet,
    ),
    form(
        "realsense-python",
        "what Python prints of RealSense's intrinsics",
        "[ 640x480  p[319.5 239.5]  f[525 525]  Brown Conrady [0 0 0 0 0] ]",
        realsense::recognise_printed,
        realsense::parse_printed,
    ),
    form(
        "numbers",
        "`fx,fy,cx,cy`, or a 3 x 3, 3 x 4 or 4 x 4 matrix (ScanNet, ICL-NUIM, NumPy, Matlab); FoundationStereo's K.txt with the baseline in metres below; TUM's `fx fy cx cy` and coefficients; ARKitScenes' .pincam, `width height fx fy cx cy`",
        "525,525,319.5,239.5",
        text::recognise,
        text::parse,
    ),
    form(
        "zed",
        "ZED's SN*.conf; the left camera of the map's size, rectified",
        "[LEFT_CAM_HD]\nfx=700.5\nfy=700.1\ncx=639.2\ncy=361.8",
        zed::recognise,
        zed::parse,
    ),
    form(
        "azure-kinect-text",
        "what Azure Kinect's tools print; the first camera",
        "principal point x: 320.8\nprincipal point y: 334.8\nfocal length x: 504.3\nfocal length y: 504.4",
        azure::recognise_text,
        azure::parse_text,
    ),
    form(
        "azure-kinect",
        "Azure Kinect's calibration in JSON; the depth or the colour camera in the mode of the map's size",
        r#"{"CalibrationInformation": {"Cameras": [{"Location": "CALIBRATION_CameraLocationD0", "Intrinsics": {"ModelParameters": [0.5, 0.5, 0.49, 0.49, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0]}}]}}"#,
        azure::recognise,
        azure::parse,
    ),
    form(
        "depthai",
        "DepthAI's (OAK) calibration in JSON; the camera of the map's size, the right one first, rectified",
        r#"{"cameraData": [[2, {"width": 1280, "height": 800, "intrinsicMatrix": [[800, 0, 639.5], [0, 800, 399.5], [0, 0, 1]]}]]}"#,
        depthai::recognise,
        depthai::parse,
    ),
    form(
        "orb-slam",
        "settings of ORB-SLAM 2 and 3, with the depth map's factor",
        "Camera.fx: 525\nCamera.fy: 525\nCamera.cx: 319.5\nCamera.cy: 239.5",
        orbslam::recognise,
        orbslam::parse,
    ),
    form(
        "nerf-angle",
        "transforms.json of NeRF programs with `camera_angle_x` and `w`",
        r#"{"camera_angle_x": 1.0, "w": 640, "h": 480}"#,
        nerf::recognise,
        nerf::parse,
    ),
    form(
        "json-yaml",
        "JSON, YAML, XML, TOML and lines of `key = value`, of any nesting, and a table with a line of names: ROS CameraInfo and camera_calibration, OpenCV FileStorage, Open3D, BOP, RealSense, nerf (`fl_x`), Kalibr (cam0), Record3D, ARKit, and others that name `fx`, `K`, `camera_matrix` or `intrinsics`; matrices row by row or column by column. Of several that differ the one for depth, or the left one; a key that stands twice with different values is refused",
        r#"{"width": 640, "height": 480, "fx": 525, "fy": 525, "ppx": 319.5, "ppy": 239.5}"#,
        is_tree,
        parse_tree,
    ),
    form(
        "realsense-text",
        "the RealSense viewer's CSV, and what `rs-enumerate-devices -c` prints; the depth camera of the map's size",
        "Fx,383.4\nFy,383.4\nPPx,320.2\nPPy,239.1",
        realsense::recognise,
        realsense::parse,
    ),
];

/// A text of `key: value` lines that RealSense's tools print is YAML too, but its names say what it is.
fn is_tree(document: &Document<'_>) -> bool {
    document.tree().is_some_and(|tree| tree.is_object() || tree.is_array())
        && (document.is_json() || !realsense::recognise(document))
}

fn parse_tree(document: &Document<'_>) -> Result<CameraFile> {
    document.tree().map_or_else(|| Err(unreadable("it is no JSON and no YAML")), tree::parse)
}

/// The most bytes of a camera file.
const MAX_BYTES: usize = 1 << 24;

/// Reads a camera file.
///
/// # Errors
/// [`Error::Io`], [`Error::Limit`] above 16 MiB, and those of [`parse`].
pub fn read_camera(path: impl AsRef<Path>) -> Result<CameraFile> {
    let bytes = read_bytes(path.as_ref(), MAX_BYTES)?;
    let text = std::str::from_utf8(&bytes).map_err(|_| unreadable("it is not text"));
    text.and_then(parse).map_err(|error| error.in_file(&path.as_ref().display().to_string()))
}

/// `fx,fy,cx,cy` in pixels; a focal length may be negative.
///
/// # Errors
/// [`Error::Parameter`] unless these are four numbers; [`Error::Library`] for a focal length of 0.
pub fn parse_intrinsics(text: &str) -> Result<Intrinsics> {
    let numbers: Option<Vec<f64>> = text.split(',').map(|word| word.trim().parse().ok()).collect();
    match numbers.as_deref() {
        Some(&[fx, fy, cx, cy]) => Ok(Intrinsics::new(fx, fy, cx, cy)?),
        _ => Err(Error::parameter("--intrinsics", text, "fx,fy,cx,cy in pixels, such as 525,525,319.5,239.5")),
    }
}

/// Reads the text of a camera file.
///
/// # Errors
/// [`Error::Unreadable`] with what is missing; [`Error::Library`] for a camera that cannot be.
///
/// ```
/// let camera = depthplanes_io::camera_file::parse("525 0 319.5\n0 525 239.5\n0 0 1\n")?;
/// assert_eq!(camera.intrinsics.cx, 319.5);
/// # Ok::<(), depthplanes_io::Error>(())
/// ```
pub fn parse(text: &str) -> Result<CameraFile> {
    parse_as(text).map(|(camera, _)| camera)
}

/// As [`parse`]; the form beside the camera.
///
/// # Errors
/// As [`parse`].
pub fn parse_as(text: &str) -> Result<(CameraFile, &'static CameraForm)> {
    // Lines of old Macintosh programs end with CR alone.
    let lines = if text.contains('\n') { Cow::Borrowed(text) } else { Cow::Owned(text.replace('\r', "\n")) };
    let document = Document::new(&lines);
    if is_web_page(document.text) {
        return Err(unreadable("it is a web page: was a download page saved in place of the file?"));
    }
    match FORMS.iter().find(|form| (form.recognise)(&document)) {
        Some(form) => Ok(((form.parse)(&document)?, form)),
        None => Err(match document.read() {
            Err(wrong) if document.is_json() => unreadable(wrong.clone()),
            Err(wrong) if !document.text.is_empty() => {
                unreadable(looks_like(document.text).map_or_else(|| wrong.clone(), str::to_string))
            }
            _ => unreadable("it has no camera of a form known here"),
        }),
    }
}

fn is_web_page(text: &str) -> bool {
    let start = text.chars().take(20).collect::<String>().to_lowercase();
    start.starts_with("<!doctype html") || start.starts_with("<html")
}

/// What a text that is no camera file seems to be.
fn looks_like(text: &str) -> Option<&'static str> {
    let begins = |starts: &[&str]| starts.iter().any(|start| text.starts_with(start));
    let has = |parts: &[&str]| parts.iter().any(|part| text.contains(part));
    if begins(&["version https://git-lfs"]) {
        Some("it is a pointer of Git LFS: fetch the file itself with `git lfs pull`")
    } else if begins(&["ply\n", "ply\r", "# .PCD", "solid "]) {
        Some("it is a point cloud or a mesh")
    } else if has(&["#include", "int main(", "def ", "import numpy", "function ["]) {
        Some("it is the source of a program")
    } else if text.contains('\0') {
        Some("it is not text")
    } else if text.lines().any(|line| line.contains(": ") || line.contains('=')) {
        None
    } else {
        Some("it is text without names and values of a camera, such as `fx: 525`")
    }
}
