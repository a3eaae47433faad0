//! Camera files of every form, as programs write them, and cameras held against the size of a map.

mod common;

use depthplanes::{DistortionModel, Intrinsics};
use depthplanes_io::camera_file::{FORMS, parse, parse_as, read_camera};
use depthplanes_io::{Frame, ReadOptions, decode, read};

/// Columns and rows of a plain 16-bit map of a room, millimetres.
fn map(width: usize, height: usize) -> Vec<u8> {
    let values: Vec<u8> = (0..width * height)
        .flat_map(|at| (2000 + ((at % width * 3 + at / width * 7) % 1013) as u16).to_be_bytes())
        .collect();
    [format!("P5\n{width} {height}\n65535\n").into_bytes(), values].concat()
}

fn framed(
    text: &str,
    (width, height): (usize, usize),
    change: impl FnOnce(&mut ReadOptions),
) -> depthplanes_io::Result<Frame> {
    let mut options = ReadOptions::default().camera(&parse(text).unwrap());
    change(&mut options);
    decode(&map(width, height), "map", &options)
}

fn close(given: Intrinsics, right: [f64; 4]) -> bool {
    let given = [given.fx, given.fy, given.cx, given.cy];
    given.iter().zip(right).all(|(a, b)| (a - b).abs() < 1e-3)
}

const VGA: [f64; 4] = [525.0, 526.0, 319.5, 239.5];

/// The form, the text, the camera, and the size that it is for.
type Specimen = (&'static str, &'static str, [f64; 4], Option<(usize, usize)>);

/// Files of the camera [`VGA`], or of the one beside them, with their sizes.
const SPECIMENS: &[Specimen] = &[
    ("numbers", "525, 526, 319.5, 239.5\n", VGA, None),
    ("numbers", "525 526 319.5 239.5", VGA, None),
    ("numbers", "# fx fy cx cy\n525\n526\n319.5\n239.5\n", VGA, None),
    ("numbers", "525.0 0 319.5\n0 526.0 239.5\n0 0 1\n", VGA, None),
    ("numbers", "[[525.   0.  319.5]\n [  0.  526.  239.5]\n [  0.    0.    1. ]]", VGA, None),
    ("numbers", "K = [525 0 319.5; 0 526 239.5; 0 0 1];", VGA, None),
    ("matlab", "IntrinsicMatrix = [525 0 0; 0 526 0; 320.5 240.5 1]", VGA, None),
    (
        "matlab",
        "cameraParams.IntrinsicMatrix\n\nans =\n\n  525.0  0  0\n  0  526.0  0\n  320.5  240.5  1.0\n",
        VGA,
        None,
    ),
    (
        "matlab",
        "cameraIntrinsics with properties:\n\n             FocalLength: [525 526]\n          PrincipalPoint: [320.5 240.5]\n               ImageSize: [480 640]\n        RadialDistortion: [0 0]\n    TangentialDistortion: [0 0]\n                    Skew: 0\n                       K: [3x3 double]\n",
        VGA,
        Some((640, 480)),
    ),
    (
        "bouguet",
        "% Intrinsic and Extrinsic Camera Parameters\n%-- Focal length:\nfc = [ 525.0 ; 526.0 ];\n\n%-- Principal point:\ncc = [ 319.5 ; 239.5 ];\nalpha_c = 0.0;\nkc = [ 0 ; 0 ; 0 ; 0 ; 0 ];\n%-- Image size:\nnx = 640;\nny = 480;\n",
        VGA,
        Some((640, 480)),
    ),
    (
        "scannet",
        "axisAlignment = 0.9 0.1 0 0 -0.1 0.9 0 0 0 0 1 0 0 0 0 1 \ncolorHeight = 968\ncolorWidth = 1296\ndepthHeight = 480\ndepthWidth = 640\nfx_color = 1170.2\nfx_depth = 525\nfy_color = 1170.2\nfy_depth = 526\nmx_color = 647.75\nmx_depth = 319.5\nmy_color = 483.75\nmy_depth = 239.5\nsceneType = Office\n",
        VGA,
        Some((640, 480)),
    ),
    (
        "scannet",
        "m_versionNumber = 4\nm_sensorName = StructureSensor\nm_colorWidth = 1296\nm_colorHeight = 968\nm_depthWidth = 640\nm_depthHeight = 480\nm_depthShift = 1000\nm_calibrationColorIntrinsic = 1170.19 0 647.75 0 0 1170.19 483.75 0 0 0 1 0 0 0 0 1 \nm_calibrationDepthIntrinsic = 525 0 319.5 0 0 526 239.5 0 0 0 1 0 0 0 0 1 \nm_frames.size = 100\n",
        VGA,
        Some((640, 480)),
    ),
    (
        "ost",
        "# oST version 5.0 parameters\n\n\n[image]\n\nwidth\n640\n\nheight\n480\n\n[narrow_stereo]\n\ncamera matrix\n525 0 319.5\n0 526 239.5\n0 0 1\n\ndistortion\n-0.12 0.04 0.001 -0.002 0\n\nrectification\n1 0 0\n0 1 0\n0 0 1\n\nprojection\n525 0 319.5 0\n0 526 239.5 0\n0 0 1 0\n",
        VGA,
        Some((640, 480)),
    ),
    ("realsense-python", "[ 640x480  p[319.5 239.5]  f[525 526]  Brown Conrady [0 0 0 0 0] ]", VGA, Some((640, 480))),
    (
        "json-yaml",
        "width: 640, height: 480, ppx: 319.5, ppy: 239.5, fx: 525, fy: 526, model: Brown Conrady, coeffs: [0, 0, 0, 0, 0]",
        VGA,
        Some((640, 480)),
    ),
    ("json-yaml", "{'fx': 525.0, 'fy': 526.0, 'cx': 319.5, 'cy': 239.5}", VGA, None),
    ("json-yaml", "fx=525\nfy=526\ncx=319.5\ncy=239.5\n", VGA, None),
    ("json-yaml", "fx, fy, cx, cy = 525, 526, 319.5, 239.5\nscale = 1000.0  # per metre", VGA, None),
    ("json-yaml", "fx = 525, fy = 526, cx = 319.5, cy = 239.5", VGA, None),
    (
        "json-yaml",
        "# the rig\n[camera]\nname = \"a\"\nfx = 525.0\nfy = 526.0\ncx = 319.5\ncy = 239.5\nwidth = 640\nheight = 480\n",
        VGA,
        Some((640, 480)),
    ),
    (
        "json-yaml",
        "name = \"a\"\nresolution = [640, 480]\nK = [\n  [525, 0, 319.5],\n  [0, 526, 239.5],\n  [0, 0, 1],\n]\n",
        VGA,
        Some((640, 480)),
    ),
    ("json-yaml", "fx,fy,cx,cy\n525,526,319.5,239.5\n", VGA, None),
    (
        "json-yaml",
        "width height fx fy cx cy\n640 480 525 526 319.5 239.5\n640 480 525 526 319.5 239.5\n",
        VGA,
        Some((640, 480)),
    ),
    ("numbers", "640 480 525 526 319.5 239.5\n", VGA, Some((640, 480))),
    ("numbers", "array([[525., 0., 319.5], [0., 526., 239.5], [0., 0., 1.]])", VGA, None),
    ("numbers", "525 0 319.5 0\n0 526 239.5 0\n0 0 1 0\n", VGA, None),
    (
        "numbers",
        "525.000000 0.000000 319.500000 0.000000 \n0.000000 526.000000 239.500000 0.000000 \n0.000000 0.000000 1.000000 0.000000 \n0.000000 0.000000 0.000000 1.000000 \n",
        VGA,
        None,
    ),
    ("numbers", "525.0 0.0 319.5 0.0 526.0 239.5 0.0 0.0 1.0\n0.063\n", VGA, None),
    (
        "colmap",
        "# Camera list with one line of data per camera:\n#   CAMERA_ID, MODEL, WIDTH, HEIGHT, PARAMS[]\n# Number of cameras: 1\n1 PINHOLE 640 480 525 526 320 240\n",
        VGA,
        Some((640, 480)),
    ),
    ("colmap", "1 SIMPLE_PINHOLE 640 480 525 320 240\n", [525.0, 525.0, 319.5, 239.5], Some((640, 480))),
    ("colmap", "3 OPENCV 640 480 525 526 320 240 0 0 0 0\n", VGA, Some((640, 480))),
    (
        "kitti",
        "P0: 7.188560000000e+02 0.000000000000e+00 6.071928000000e+02 0.000000000000e+00 0.000000000000e+00 7.188560000000e+02 1.852157000000e+02 0.000000000000e+00 0.000000000000e+00 0.000000000000e+00 1.000000000000e+00 0.000000000000e+00\nP1: 7.188560000000e+02 0.000000000000e+00 6.071928000000e+02 -3.861448000000e+02 0.000000000000e+00 7.188560000000e+02 1.852157000000e+02 0.000000000000e+00 0.000000000000e+00 0.000000000000e+00 1.000000000000e+00 0.000000000000e+00\n",
        [718.856, 718.856, 607.1928, 185.2157],
        None,
    ),
    (
        "kitti",
        "P0: 721.5377 0 609.5593 0 0 721.5377 172.854 0 0 0 1 0\nP1: 721.5377 0 609.5593 -387.5744 0 721.5377 172.854 0 0 0 1 0\nP2: 721.5377 0 609.5593 44.85728 0 721.5377 172.854 0.2163791 0 0 1 0.002745884\nP3: 721.5377 0 609.5593 -339.5242 0 721.5377 172.854 2.199936 0 0 1 0.002729905\nR0_rect: 1 0 0 0 1 0 0 0 1\nTr_velo_to_cam: 1 0 0 0 0 1 0 0 0 0 1 0\nTr_imu_to_velo: 1 0 0 0 0 1 0 0 0 0 1 0\n",
        [721.5377, 721.5377, 609.5593, 172.854],
        None,
    ),
    (
        "kitti-raw",
        "calib_time: 09-Jan-2012 13:57:47\ncorner_dist: 9.950000e-02\nS_02: 1.392000e+03 5.120000e+02\nK_02: 9.597910e+02 0.000000e+00 6.960217e+02 0.000000e+00 9.569251e+02 2.241806e+02 0.000000e+00 0.000000e+00 1.000000e+00\nD_02: -3.691481e-01 1.968681e-01 1.353473e-03 5.677587e-04 -6.770705e-02\nS_rect_02: 1.242000e+03 3.750000e+02\nP_rect_02: 7.215377e+02 0.000000e+00 6.095593e+02 4.485728e+01 0.000000e+00 7.215377e+02 1.728540e+02 2.163791e-01 0.000000e+00 0.000000e+00 1.000000e+00 2.745884e-03\nP_rect_03: 7.215377e+02 0.000000e+00 6.095593e+02 -3.395242e+02 0.000000e+00 7.215377e+02 1.728540e+02 2.199936e+00 0.000000e+00 0.000000e+00 1.000000e+00 2.729905e-03\n",
        [721.5377, 721.5377, 609.5593, 172.854],
        Some((1242, 375)),
    ),
    (
        "middlebury",
        "cam0=[525 0 319.5; 0 526 239.5; 0 0 1]\ncam1=[525 0 330.5; 0 526 239.5; 0 0 1]\ndoffs=11\nbaseline=193.001\nwidth=640\nheight=480\nndisp=290\nisint=0\n",
        VGA,
        Some((640, 480)),
    ),
    (
        "middlebury",
        "left: cam0=[525 0 319.5; 0 526 239.5; 0 0 1] cam1=[525 0 319.5; 0 526 239.5; 0 0 1] doffs=0 baseline=59.9 width=640 height=480 ndisp=64",
        VGA,
        Some((640, 480)),
    ),
    (
        "mvsnet",
        "extrinsic\n0.97 0.01 0.2 -191.0\n-0.01 0.99 0.03 3.2\n-0.2 -0.03 0.9 22.5\n0.0 0.0 0.0 1.0\n\nintrinsic\n525 0 319.5\n0 526 239.5\n0 0 1\n\n425.0 2.5\n",
        VGA,
        None,
    ),
    (
        "zed",
        "[LEFT_CAM_2K]\nfx=1400.8\nfy=1400.8\ncx=1104.5\ncy=633.7\nk1=-0.17\nk2=0.02\n\n[LEFT_CAM_HD]\nfx=700.4\nfy=700.4\ncx=639.2\ncy=361.8\nk1=-0.17\nk2=0.02\n\n[RIGHT_CAM_HD]\nfx=701\nfy=701\ncx=641\ncy=360\n[STEREO]\nBaseline=119.87\nCV_HD=0.002\n",
        [1400.8, 1400.8, 1104.5, 633.7],
        Some((2208, 1242)),
    ),
    (
        "azure-kinect-text",
        "===== Device 0: 000573600112 =====\nresolution width: 640\nresolution height: 576\nprincipal point x: 320.803894\nprincipal point y: 334.772949\nfocal length x: 504.344574\nfocal length y: 504.414703\nradial distortion coefficients:\nk1: 6.084146\nk2: 4.375491\nk3: 0.236186\nk4: 6.408733\nk5: 6.418296\nk6: 1.220292\ncenter of distortion in Z=1 plane, x: 0.000000\ncenter of distortion in Z=1 plane, y: 0.000000\ntangential distortion coefficient x: -0.000055\ntangential distortion coefficient y: 0.000065\nmetric radius: 0.000000\n",
        [504.3446, 504.4147, 320.8039, 334.7729],
        Some((640, 576)),
    ),
    (
        "azure-kinect",
        r#"{"CalibrationInformation":{"Cameras":[{"Intrinsics":{"ModelParameterCount":14,"ModelParameters":[0.50127333,0.50319624,0.49252397,0.49259248,6.084146,4.375491,0.236186,6.408733,6.418296,1.220292,0,0,0.000065,-0.000055],"ModelType":"CALIBRATION_LensDistortionModelBrownConrady"},"Location":"CALIBRATION_CameraLocationD0","Purpose":"CALIBRATION_CameraPurposeDepth","SensorHeight":1024,"SensorWidth":1024},{"Intrinsics":{"ModelParameters":[0.5,0.5,0.47,0.63,0,0,0,0,0,0,0,0,0,0]},"Location":"CALIBRATION_CameraLocationPV0","SensorHeight":3072,"SensorWidth":4096}]}}"#,
        [504.3445, 504.4147, 320.8039, 334.7729],
        Some((640, 576)),
    ),
    (
        "depthai",
        r#"{"batchName":"","boardName":"BW1098OBC","cameraData":[[0,{"cameraType":0,"distortionCoeff":[0.1,-0.2,0,0,0.1,0,0,0,0,0,0,0,0,0],"height":1080,"intrinsicMatrix":[[1500,0,960],[0,1500,540],[0,0,1]],"width":1920}],[1,{"cameraType":0,"height":800,"intrinsicMatrix":[[790,0,640],[0,790,400],[0,0,1]],"width":1280}],[2,{"cameraType":0,"distortionCoeff":[-5.2,11.3,0.001,0.002,-3.0,-5.3,11.9,-4.0,0,0,0,0,0,0],"extrinsics":{"translation":{"x":7.5,"y":0,"z":0}},"height":800,"intrinsicMatrix":[[800.5,0,641.25],[0,800.5,400.5],[0,0,1]],"width":1280}]]}"#,
        [800.5, 800.5, 641.25, 400.5],
        Some((1280, 800)),
    ),
    (
        "orb-slam",
        "%YAML:1.0\n\n#-----\n# Camera Parameters.\n#-----\n\n# Camera calibration and distortion parameters (OpenCV) \nCamera.fx: 525.0\nCamera.fy: 526.0\nCamera.cx: 319.5\nCamera.cy: 239.5\n\nCamera.k1: 0.0\nCamera.k2: 0.0\nCamera.p1: 0.0\nCamera.p2: 0.0\n\nCamera.width: 640\nCamera.height: 480\nCamera.fps: 30.0\n\n# IR projector baseline times fx (aprox.)\nCamera.bf: 40.0\nCamera.RGB: 1\nThDepth: 40.0\nDepthMapFactor: 5000.0\nViewer.KeyFrameSize: 0.05\n",
        VGA,
        Some((640, 480)),
    ),
    (
        "nerf-angle",
        r#"{"camera_angle_x": 0.6911112, "w": 800, "h": 800, "frames": []}"#,
        [1111.1110, 1111.1110, 399.5, 399.5],
        Some((800, 800)),
    ),
    (
        "json-yaml",
        r#"{"fl_x": 525, "fl_y": 526, "cx": 319.5, "cy": 239.5, "w": 640, "h": 480, "camera_model": "OPENCV", "k1": 0, "frames": [{"transform_matrix": [[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]]}]}"#,
        VGA,
        Some((640, 480)),
    ),
    (
        "json-yaml",
        "cam0:\n  cam_overlaps: [1]\n  camera_model: pinhole\n  distortion_coeffs: [0, 0, 0, 0]\n  distortion_model: radtan\n  intrinsics: [525, 526, 319.5, 239.5]\n  resolution: [640, 480]\n  rostopic: /cam0/image_raw\ncam1:\n  T_cn_cnm1:\n  - [0.99, 0.0, 0.0, -0.11]\n  - [0.0, 0.99, 0.0, 0.0]\n  - [0.0, 0.0, 0.99, 0.0]\n  - [0.0, 0.0, 0.0, 1.0]\n  camera_model: pinhole\n  distortion_coeffs: [0, 0, 0, 0]\n  distortion_model: radtan\n  intrinsics: [530, 531, 320, 240]\n  resolution: [640, 480]\n",
        VGA,
        Some((640, 480)),
    ),
    (
        "json-yaml",
        r#"{"intrinsics": {"depth": {"width": 640, "height": 480, "ppx": 319.5, "ppy": 239.5, "fx": 525, "fy": 526, "model": 4, "coeffs": [0,0,0,0,0]}, "color": {"width": 1280, "height": 720, "ppx": 640, "ppy": 360, "fx": 900, "fy": 900}}}"#,
        VGA,
        Some((640, 480)),
    ),
    (
        "json-yaml",
        r#"{"K":[525,0,0,0,526,0,319.5,239.5,1],"fps":60,"h":480,"w":640,"poses":[[0,0,0,1,0,0,0]]}"#,
        VGA,
        Some((640, 480)),
    ),
    (
        "json-yaml",
        r#"{"cameraPoseARFrame":[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1],"intrinsics":[[525,0,0],[0,526,0],[319.5,239.5,1]],"imageResolution":[640,480]}"#,
        VGA,
        Some((640, 480)),
    ),
    (
        "json-yaml",
        r#"{"1": {"cam_K": [525,0,319.5,0,526,239.5,0,0,1], "depth_scale": 0.1}, "2": {"cam_K": [525,0,319.5,0,526,239.5,0,0,1], "depth_scale": 0.1}}"#,
        VGA,
        None,
    ),
    (
        "json-yaml",
        r#"{"width":640,"height":480,"intrinsic_matrix":[525,0,0,0,526,0,319.5,239.5,1]}"#,
        VGA,
        Some((640, 480)),
    ),
    (
        "json-yaml",
        r#"{"class_name":"PinholeCameraParameters","extrinsic":[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1],"intrinsic":{"height":480,"intrinsic_matrix":[525,0,0,0,526,0,319.5,239.5,1],"width":640},"version_major":1}"#,
        VGA,
        Some((640, 480)),
    ),
    (
        "json-yaml",
        "header: \n  seq: 17\n  stamp: \n    secs: 1\n    nsecs: 2\n  frame_id: \"camera_depth_optical_frame\"\nheight: 480\nwidth: 640\ndistortion_model: \"plumb_bob\"\nD: [0.0, 0.0, 0.0, 0.0, 0.0]\nK: [525.0, 0.0, 319.5, 0.0, 526.0, 239.5, 0.0, 0.0, 1.0]\nR: [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0]\nP: [525.0, 0.0, 319.5, 0.0, 0.0, 526.0, 239.5, 0.0, 0.0, 0.0, 1.0, 0.0]\nbinning_x: 0\nbinning_y: 0\nroi: \n  x_offset: 0\n  y_offset: 0\n  height: 0\n  width: 0\n  do_rectify: False\n---\n",
        VGA,
        Some((640, 480)),
    ),
    (
        "json-yaml",
        "k:\n- 525.0\n- 0.0\n- 319.5\n- 0.0\n- 526.0\n- 239.5\n- 0.0\n- 0.0\n- 1.0\nr:\n- 1.0\nheight: 480\nwidth: 640\n",
        VGA,
        Some((640, 480)),
    ),
    (
        "json-yaml",
        "image_width: 640\nimage_height: 480\ncamera_name: narrow_stereo\ncamera_matrix:\n  rows: 3\n  cols: 3\n  data: [525, 0, 319.5,\n    0, 526, 239.5, 0, 0, 1]\ndistortion_model: plumb_bob\ndistortion_coefficients:\n  rows: 1\n  cols: 5\n  data: [0, 0, 0, 0, 0]\n",
        VGA,
        Some((640, 480)),
    ),
    (
        "json-yaml",
        "%YAML:1.0\n---\ncalibration_time: \"Mon 03 Aug 2020\"\nimage_width: 640\nimage_height: 480\nflags: 0\ncamera_matrix: !!opencv-matrix\n   rows: 3\n   cols: 3\n   dt: d\n   data: [ 5.2500000000000000e+02, 0., 3.1950000000000000e+02, 0.,\n       5.2600000000000000e+02, 2.3950000000000000e+02, 0., 0., 1. ]\ndistortion_coefficients: !!opencv-matrix\n   rows: 5\n   cols: 1\n   dt: d\n   data: [ 0., 0., 0., 0., 0. ]\n",
        VGA,
        Some((640, 480)),
    ),
    ("json-yaml", "camera:\n  K: [525 0 319.5; 0 526 239.5; 0 0 1]\n", VGA, None),
    (
        "json-yaml",
        r#"{"calib": {"rgb": {"camera_matrix": {"fx": 525, "fy": 526, "cx": 319.5, "cy": 239.5}, "image_size": {"width": 640, "height": 480}}}}"#,
        VGA,
        Some((640, 480)),
    ),
    (
        "realsense-text",
        "Frame Info:\nType,Depth\nFormat,Z16\nFrame Number,240\nTimestamp (ms),1540000000.1\nResolution x,640\nResolution y,480\nBytes per pixel,2\n\nIntrinsic:,\nFx,525.000000\nFy,526.000000\nPPx,319.500000\nPPy,239.500000\nDistorsion,Brown Conrady\n",
        VGA,
        Some((640, 480)),
    ),
    (
        "realsense-text",
        "Device info: \n    Name : Intel RealSense D435\n\nIntrinsic Parameters:\n\n Intrinsic of \"Depth\" / 640x480 / {Z16}\n  Width:      \t640\n  Height:     \t480\n  PPX:        \t319.5\n  PPY:        \t239.5\n  Fx:         \t525\n  Fy:         \t526\n  Distortion: \tBrown Conrady\n  Coeffs:     \t0  \t0  \t0  \t0  \t0  \n  FOV (deg):  \t62.7 x 49.1\n\n Intrinsic of \"Color\" / 640x480 / {RGB8}\n  Width:      \t640\n  Height:     \t480\n  PPX:        \t320\n  PPY:        \t241\n  Fx:         \t600\n  Fy:         \t600\n  Distortion: \tInverse Brown Conrady\n  Coeffs:     \t0  \t0  \t0  \t0  \t0  \n",
        VGA,
        Some((640, 480)),
    ),
];

#[test]
fn lenses_of_opencv_files_are_those_of_their_cameras() {
    let xml = |names: [&str; 4]| {
        let [a, da, b, db] = names;
        let matrix = |name: &str, data: &str| {
            format!(
                "<{name} type_id=\"opencv-matrix\">\n<rows>3</rows><cols>3</cols><dt>d</dt>\n<data>\n{data}</data></{name}>\n"
            )
        };
        let all = [matrix(a, "525. 0. 319.5 0. 526. 239.5 0. 0. 1."), matrix(da, "0.1 -0.2 0. 0. 0.05")];
        let others = [matrix(b, "530. 0. 320.5 0. 530. 240.5 0. 0. 1."), matrix(db, "0.3 -0.4 0. 0. 0.07")];
        let others = if b.is_empty() { String::new() } else { others.concat() };
        format!("<?xml version=\"1.0\"?>\n<opencv_storage>\n{}{others}</opencv_storage>\n", all.concat())
    };
    let one = parse(&xml(["Camera_Matrix", "Distortion_Coefficients", "", ""])).unwrap();
    assert!(close(one.intrinsics, VGA));
    assert_eq!(one.distortion.unwrap().coefficients()[4], 0.05);
    let left = parse(&xml(["M1", "D1", "M2", "D2"])).unwrap();
    assert!(close(left.intrinsics, VGA) && left.notes.iter().any(|note| note.contains("M1")));
    assert_eq!(left.distortion.unwrap().coefficients()[0], 0.1);
    let depth = parse(&xml(["depth_intrinsics", "depth_distortion", "rgb_intrinsics", "rgb_distortion"])).unwrap();
    assert_eq!(depth.distortion.unwrap().coefficients()[0], 0.1);
    // Depth may be of the infrared camera, or turned into the colour camera's picture.
    assert!(parse(&xml(["RGB_intrinsic_params", "RGB_dist", "IR_intrinsic_params", "IR_dist"])).is_err());
    for wrong in ["<a>", "<a></b>", "</a>", "<a", "<?xml?>", "<!--"] {
        assert!(parse(wrong).is_err(), "{wrong}");
    }
}

#[test]
fn every_form_gives_its_camera() {
    for (form, text, right, size) in SPECIMENS {
        let (camera, found) = parse_as(text).unwrap_or_else(|error| panic!("{form}: {error}\n{text}"));
        assert!(close(camera.intrinsics, *right), "{form}: {:?}\n{text}", camera.intrinsics);
        assert_eq!((found.name, camera.size), (*form, *size), "{text}");
    }
    for form in FORMS {
        assert_eq!(parse_as(form.sample).unwrap().1.name, form.name);
        assert!(SPECIMENS.iter().any(|(name, ..)| *name == form.name), "{}", form.name);
    }
}

/// Whatever of a file is lost or changed, there is no panic and no camera with numbers that are none.
#[test]
fn files_that_were_cut_or_changed_give_a_finite_camera_or_none() {
    let mut seed = 1u64;
    let mut random = move |below: usize| {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (seed >> 33) as usize % below
    };
    let looked_at = |text: &str| {
        let Ok(camera) = parse(text) else { return };
        for camera in camera.choices.iter().chain([&camera]) {
            let own = camera.intrinsics;
            assert!([own.fx, own.fy, own.cx, own.cy].iter().all(|x| x.is_finite()), "{text}");
        }
        for size in [(640, 480), (1, 1), (1280, 720)] {
            for camera_size in [None, Some((1, 65_535))] {
                let options = ReadOptions { camera_size, ..ReadOptions::default().camera(&camera) };
                let _ = decode(&map(size.0.min(64), size.1.min(48)), "map", &options);
            }
        }
    };
    const PIECES: [&str; 16] =
        ["[", "]", "{", "}", ":", ",", "-", "nan", "inf", "1e308", "0", "\n", " ", "\"", "é", "<a>"];
    for (_, text, ..) in SPECIMENS {
        let chars: Vec<char> = text.chars().collect();
        for _ in 0..60 {
            looked_at(&chars[..random(chars.len())].iter().collect::<String>());
            let mut changed = chars.clone();
            for _ in 0..1 + random(4) {
                let at = random(changed.len());
                let end = (at + random(6)).min(changed.len());
                changed.splice(at..end, PIECES[random(PIECES.len())].chars());
            }
            looked_at(&changed.iter().collect::<String>());
        }
    }
}

#[test]
fn the_small_files_after_reports_give_their_camera() {
    let Some(data) = common::data() else { return };
    let mut count = 0;
    for file in std::fs::read_dir(data.join("reports/cameras")).unwrap() {
        let path = file.unwrap().path();
        let camera = read_camera(&path).unwrap();
        assert!(close(camera.intrinsics, [288.0, 288.0, 159.5, 119.5]), "{}: {camera:?}", path.display());
        let frame = decode(&map(320, 240), "map", &ReadOptions::default().camera(&camera)).unwrap();
        assert_eq!(frame.encoding != "millimetre", path.ends_with("eth3d_calib.txt"), "{}", path.display());
        count += 1;
    }
    assert!(count >= 11);
}

#[test]
fn rigs_units_and_lenses_are_read() {
    let of = |name: &str, nth: usize| {
        parse(SPECIMENS.iter().filter(|(form, ..)| *form == name).nth(nth).unwrap().1).unwrap()
    };
    let baseline = |name, nth| of(name, nth).stereo.unwrap().baseline_m;
    assert!((baseline("numbers", 10) - 0.063).abs() < 1e-12);
    assert!((baseline("kitti", 0) - 0.53717).abs() < 1e-4);
    assert!((baseline("kitti", 1) - 0.53272).abs() < 1e-4);
    assert!((baseline("kitti-raw", 0) - 0.53272).abs() < 1e-4);
    assert!((baseline("zed", 0) - 0.11987).abs() < 1e-9);
    assert!((baseline("depthai", 0) - 0.075).abs() < 1e-9);
    assert_eq!(of("orb-slam", 0).unit_m, Some(1.0 / 5000.0));
    assert_eq!(of("orb-slam", 0).stereo, None);
    assert!((of("json-yaml", 14).unit_m.unwrap() - 1e-4).abs() < 1e-12);
    let azure = of("azure-kinect", 0);
    let lens = azure.distortion.unwrap();
    assert_eq!(lens.model(), DistortionModel::BrownConrady);
    assert_eq!(
        lens.coefficients()[..8],
        [6.084146, 4.375491, -0.000055, 0.000065, 0.236186, 6.408733, 6.418296, 1.220292]
    );
    assert_eq!(of("azure-kinect-text", 0).distortion.unwrap().coefficients()[..8], lens.coefficients()[..8]);
    let lens = |text: &str| parse(text).unwrap().distortion.map(|lens| (lens.model(), lens.coefficients().to_vec()));
    let (model, k) = lens("525 525 319.5 239.5 0.2312 -0.7849 -0.0033 -0.0001 0.9172").unwrap();
    assert_eq!((model, k[4]), (DistortionModel::BrownConrady, 0.9172));
    let (model, k) = lens("2 OPENCV_FISHEYE 640 480 300 300 320 240 0.1 0.2 0.3 0.4").unwrap();
    assert_eq!((model, k), (DistortionModel::KannalaBrandt, vec![0.1, 0.2, 0.3, 0.4]));
    let (model, _) = lens("cam0:\n  camera_model: pinhole\n  distortion_model: equidistant\n  distortion_coeffs: [0.1, 0.2, 0.3, 0.4]\n  intrinsics: [300, 300, 320, 240]\n  resolution: [640, 480]\n").unwrap();
    assert_eq!(model, DistortionModel::KannalaBrandt);
    let text = r#"{"width":640,"height":480,"ppx":320,"ppy":240,"fx":600,"fy":600,"model":"distortion.inverse_brown_conrady","coeffs":[0.1,0,0,0,0]}"#;
    assert_eq!(lens(text).unwrap().0, DistortionModel::InverseBrownConrady);
    let text = "File.version: \"1.0\"\nCamera.type: \"KannalaBrandt8\"\nCamera1.fx: 190\nCamera1.fy: 190\nCamera1.cx: 254\nCamera1.cy: 256\nCamera1.k1: 0.0034\nCamera1.k2: 0.0007\nCamera1.k3: -0.002\nCamera1.k4: 0.0002\n";
    assert_eq!(lens(text).unwrap(), (DistortionModel::KannalaBrandt, vec![0.0034, 0.0007, -0.002, 0.0002]));
    let unknown = parse(r#"{"width":640,"height":480,"ppx":320,"ppy":240,"fx":600,"fy":600,"model":"distortion.ftheta","coeffs":[0.9,0,0,0,0]}"#).unwrap();
    assert!(unknown.distortion.is_none() && unknown.notes[0].contains("ignored"));
}

#[test]
fn what_is_ambiguous_or_no_camera_is_refused() {
    let wrong = [
        "",
        "hello",
        "1,2,3",
        "0,1,2,3",
        "nan,1,2,3",
        "{",
        "{}",
        "[1,2]",
        "K: [1, 2]",
        "K:",
        "cam0=",
        "cam0=[1 2]",
        "1 2 3 4 5 6 7 8 9",
        r#"{"intrinsic_matrix":[1,2,3]}"#,
        r#"{"cam_K":"x"}"#,
        "camera_matrix:\n  data:",
        "500 40 300 0 500 200 0 0 1",
        "P: [1,0,0,0,0,0,0,0,0,0,1,0]",
        "1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1",
        "0.5357 0.6696 0.4932 0.5004",
        r#"{"a": {"fx": 500, "fy": 500, "cx": 320, "cy": 240}, "b": {"fx": 600, "fy": 600, "cx": 320, "cy": 240}, "c": {"fx": 700, "fy": 600, "cx": 320, "cy": 240}}"#,
        r#"{"1": {"cam_K": [525,0,319.5,0,526,239.5,0,0,1]}, "2": {"cam_K": [500,0,319.5,0,526,239.5,0,0,1]}, "3": {"cam_K": [501,0,319.5,0,526,239.5,0,0,1]}}"#,
        "1 THIN_PRISM_FISHEYE 640 480 300 300 320 240 0 0 0 0 0 0 0 0",
        "1 PINHOLE 640 480 525 526 320",
        r#"{"camera_angle_x": 0.69, "frames": []}"#,
        "cam0:\n  camera_model: omni\n  intrinsics: [1.5, 800, 800, 320, 240]\n",
    ];
    for text in wrong {
        assert!(parse(text).is_err(), "{text}: {:?}", parse(text));
    }
    let error = parse(wrong[20]).unwrap_err().to_string();
    assert!(error.contains("`a` 500") && error.contains("`b` 600"), "{error}");
}

#[test]
fn a_camera_of_another_size_is_refused_with_the_scaled_one_and_scaled_on_demand() {
    let phone = "1590,1590,959.5,719.5";
    let error = framed(phone, (256, 192), |_| ()).unwrap_err().to_string();
    assert!(error.contains("--intrinsics=212,212,127.5") && error.contains("--camera-size 1920x1440"), "{error}");
    let frame = framed(phone, (256, 192), |options| options.camera_size = Some((1920, 1440))).unwrap();
    assert!(close(frame.sensor.intrinsics.unwrap(), [212.0, 212.0, 127.5, 95.5]));
    assert!(frame.warnings.is_empty(), "{:?}", frame.warnings);
    let sized = r#"{"width": 1280, "height": 720, "fx": 900, "fy": 900, "ppx": 640, "ppy": 360}"#;
    let error = framed(sized, (640, 360), |_| ()).unwrap_err().to_string();
    assert!(
        error.contains("--intrinsics=450,450,319.75,179.75") && error.contains("--camera-size 1280x720"),
        "{error}"
    );
    assert!(framed(sized, (640, 360), |options| options.camera_size = Some((1280, 720))).is_ok());
    let error = framed(sized, (640, 480), |_| ()).unwrap_err().to_string();
    assert!(error.contains("another shape"), "{error}");
    assert!(framed(sized, (640, 480), |options| options.camera_size = Some((1280, 720))).is_err());
}

#[test]
fn cameras_that_cannot_be_the_maps_are_refused_and_unlikely_ones_noted() {
    let plain = |numbers: &str, size| framed(numbers, size, |_| ());
    let error = plain("319.5,239.5,525,525", (640, 480)).unwrap_err().to_string();
    assert!(error.contains("--intrinsics=525,525,319.5,239.5"), "{error}");
    let error = plain("319.5,239.5,525,525", (320, 240)).unwrap_err().to_string();
    assert!(error.contains("--intrinsics=262.5,262.5,159.5,119.5"), "{error}");
    let error = plain("525,525,700,239.5", (640, 480)).unwrap_err().to_string();
    assert!(error.contains("--camera-size") && error.contains("subtract the crop's left column from cx"), "{error}");
    let noted = |numbers: &str, size| plain(numbers, size).unwrap().warnings.join("; ");
    assert!(noted("525,525,159.5,119.5", (640, 480)).contains("--camera-size 320x240"));
    assert!(noted("525,525,80,239.5", (640, 480)).contains("far from the middle"));
    assert!(noted("40,40,319.5,239.5", (640, 480)).contains("field of view"));
    assert!(noted("9000,9000,319.5,239.5", (640, 480)).contains("field of view"));
    for good in ["525,525,319.5,239.5", "481.2,-480,319.5,239.5", "594.21,591.04,339.31,242.74", "380,380,330,200"] {
        assert_eq!(noted(good, (640, 480)), "", "{good}");
    }
    // A size that is stated says that the map is a part of a larger picture, whose principal point may lie outside. That of the
    // picture itself is noted for a crop of any size.
    let cropped = |numbers: &str, size| {
        framed(numbers, size, |options| options.camera_size = Some(size)).unwrap().warnings.join("; ")
    };
    let own = cropped("525,525,700,239.5", (640, 480));
    assert!(own.contains("right for a crop if the crop's left column was subtracted"), "{own}");
    let of_picture = cropped("525,525,319.5,239.5", (260, 260));
    assert!(of_picture.contains("the middle of 640 x 480") && of_picture.contains("subtract"), "{of_picture}");
}

#[test]
fn cameras_of_several_sizes_are_chosen_by_the_maps() {
    let zed = SPECIMENS.iter().find(|(form, ..)| *form == "zed").unwrap().1;
    let frame = framed(zed, (1280, 720), |_| ()).unwrap();
    assert!(close(frame.sensor.intrinsics.unwrap(), [700.4, 700.4, 639.2, 361.8]));
    assert!(frame.sensor.distortion.is_none() && frame.warnings.iter().any(|note| note.contains("LEFT_CAM_HD")));
    let error = framed(zed, (640, 360), |_| ()).unwrap_err().to_string();
    assert!(error.contains("LEFT_CAM_2K") && error.contains("LEFT_CAM_HD"), "{error}");
    let frame = framed(zed, (640, 360), |options| options.camera_size = Some((1280, 720))).unwrap();
    assert!((frame.sensor.intrinsics.unwrap().fx - 350.2).abs() < 1e-9);
    let azure = SPECIMENS.iter().find(|(form, ..)| *form == "azure-kinect").unwrap().1;
    let frame = framed(azure, (512, 512), |_| ()).unwrap();
    assert!((frame.sensor.intrinsics.unwrap().fx - 252.172).abs() < 1e-2);
    assert!((framed(azure, (1280, 720), |_| ()).unwrap().sensor.intrinsics.unwrap().cy - 359.5).abs() < 1e-9);
}

fn ros(d: &str, p: &str, rest: &str) -> String {
    format!(
        "height: 480\nwidth: 640\ndistortion_model: plumb_bob\nD: [{d}]\nK: [525, 0, 319.5, 0, 526, 239.5, 0, 0, 1]\nP: [{p}]\n{rest}"
    )
}

#[test]
fn raw_and_rectified_cameras_of_ros_and_what_changes_them() {
    let same = "525, 0, 319.5, 0, 0, 526, 239.5, 0, 0, 0, 1, 0";
    let other = "500, 0, 310, -40, 0, 500, 230, 0, 0, 0, 1, 0";
    let bent = "-0.05, 0, 0, 0, 0";
    let size = (640, 480);
    let frame = |text: &str, rectified| framed(text, size, |options| options.rectified = rectified).unwrap();
    let has = |frame: &Frame, word: &str| frame.warnings.iter().any(|note| note.contains(word));
    let raw = frame(&ros(bent, same, ""), None);
    assert!(raw.sensor.distortion.is_some() && has(&raw, "--rectified"));
    let flat = frame(&ros(bent, same, ""), Some(true));
    assert!(flat.sensor.distortion.is_none() && flat.warnings.is_empty());
    let straight = frame(&ros(bent, other, ""), None);
    assert!(
        straight.sensor.distortion.is_none()
            && close(straight.sensor.intrinsics.unwrap(), [500.0, 500.0, 310.0, 230.0])
    );
    assert!(has(&straight, "--rectified=no"));
    let raw = frame(&ros(bent, other, ""), Some(false));
    assert!(raw.sensor.distortion.is_some() && close(raw.sensor.intrinsics.unwrap(), VGA));
    assert!(frame(&ros("0, 0, 0, 0, 0", same, ""), None).warnings.is_empty());
    assert_eq!(parse(&ros("0", other, "")).unwrap().stereo.unwrap().baseline_m, 0.08);
}

#[test]
fn binning_and_region_of_interest_are_applied() {
    let same = "525, 0, 319.5, 0, 0, 526, 239.5, 0, 0, 0, 1, 0";
    let rest = "binning_x: 2\nbinning_y: 2\nroi:\n  x_offset: 0\n  y_offset: 40\n  height: 400\n  width: 640\n  do_rectify: true\n";
    let camera = parse(&ros("0", same, rest)).unwrap();
    assert_eq!(camera.size, Some((320, 200)));
    assert!(close(camera.intrinsics, [262.5, 263.0, 159.75, 99.75]));
    let frame = framed(&ros("0", same, rest), (320, 200), |_| ()).unwrap();
    assert!(frame.warnings.iter().any(|note| note.contains("binning")));
}

#[test]
fn the_unit_of_a_camera_file_is_that_of_a_map_whose_unit_is_a_guess() {
    let orb = SPECIMENS.iter().find(|(form, ..)| *form == "orb-slam").unwrap().1;
    let frame = framed(orb, (640, 480), |_| ()).unwrap();
    assert_eq!(frame.sensor.value_kind.depth_m(5000.0), Some(1.0));
    assert!(frame.warnings.iter().any(|note| note.contains("--scale")));
    let frame = framed(orb, (640, 480), |options| options.encoding = Some("millimetre".into())).unwrap();
    assert_eq!(frame.sensor.value_kind.depth_m(5000.0), Some(5.0));
}

/// The camera [`VGA`] in JSON, with more beside it.
fn json(more: &str) -> String {
    format!(r#"{{"fx": 525, "fy": 526, "cx": 319.5, "cy": 239.5, "width": 640, "height": 480, {more}}}"#)
}

#[test]
fn the_unit_is_read_under_every_name_whose_meaning_is_sure_and_noted_under_others() {
    for (more, right) in [
        (r#""depth_scale": 0.1"#, 1e-4),
        (r#""depth_scale": 1.0"#, 1e-3),
        (r#""depth_scale": 0.001"#, 1e-3),
        (r#""depth_scale": 0.00025"#, 2.5e-4),
        (r#""depth_scale": 1000"#, 1e-3),
        (r#""scale": 6553.5"#, 1.0 / 6553.5),
        (r#""png_depth_scale": 6553.5"#, 1.0 / 6553.5),
        (r#""depth_unit_scale_factor": 0.0002"#, 2e-4),
        (r#""scaling_factor": 5000"#, 2e-4),
        (r#""depth_scaling_factor": 4000.0"#, 2.5e-4),
        (r#""units_per_meter": 8000"#, 1.25e-4),
        (r#""DepthMapFactor": 5000"#, 2e-4),
    ] {
        let camera = parse(&json(more)).unwrap();
        let unit_m = camera.unit_m.unwrap_or_else(|| panic!("{more}"));
        assert!((unit_m - right).abs() < 1e-12 && camera.notes.is_empty(), "{more}: {unit_m} {:?}", camera.notes);
    }
    let bop = r#"{"0": {"cam_K": [525, 0, 319.5, 0, 526, 239.5, 0, 0, 1], "depth_scale": 0.1}}"#;
    assert!((parse(bop).unwrap().unit_m.unwrap() - 1e-4).abs() < 1e-12);
    for (more, name) in
        [(r#""depth_scaling_factor": 0.3"#, "depth_scaling_factor"), (r#""depth_units": 1"#, "depth_units")]
    {
        let camera = parse(&json(more)).unwrap();
        assert!(camera.unit_m.is_none() && camera.notes.iter().any(|note| note.contains(name)), "{:?}", camera.notes);
    }
    assert!(parse(&json(r#""scale": 1"#)).unwrap().notes.is_empty());
}

#[test]
fn models_that_are_no_pinhole_are_refused_by_name_and_fisheyes_are_fisheyes() {
    for (key, model) in [
        ("camera_type", "ds"),
        ("camera_type", "eucm"),
        ("model", "ucm"),
        ("camera_model", "omni"),
        ("model_type", "MEI"),
        ("projection_model", "equirectangular"),
    ] {
        let text = json(&format!(r#""distortion_model": "radtan", "{key}": "{model}", "xi": -0.2"#));
        let error = parse(&text).unwrap_err().to_string();
        assert!(error.contains(&format!("`{model}`")), "{error}");
    }
    let basalt = |model: &str, rest: &str| {
        format!(
            r#"{{"value0": {{"intrinsics": [{{"camera_type": "{model}", "intrinsics": {{"fx": 525, "fy": 526, "cx": 319.5, "cy": 239.5, {rest}}}}}], "resolution": [[640, 480]]}}}}"#
        )
    };
    let error = parse(&basalt("ds", r#""xi": -0.2, "alpha": 0.6"#)).unwrap_err().to_string();
    assert!(error.contains("`ds`"), "{error}");
    let kalibr = "cam0:\n  camera_model: omni\n  distortion_model: radtan\n  distortion_coeffs: [0.1, 0, 0, 0]\n  intrinsics: [1.2, 525, 526, 319.5, 239.5]\n";
    let error = parse(kalibr).unwrap_err().to_string();
    assert!(error.contains("`omni`"), "{error}");
    let opencv = "%YAML:1.0\n---\nimage_width: 640\nimage_height: 480\nfisheye_model: 1\ncamera_matrix: !!opencv-matrix\n   rows: 3\n   cols: 3\n   dt: d\n   data: [ 525., 0., 319.5, 0., 526., 239.5, 0., 0., 1. ]\ndistortion_coefficients: !!opencv-matrix\n   rows: 4\n   cols: 1\n   dt: d\n   data: [ 0.05, -0.01, 0.004, -0.001 ]\n";
    let vins = "%YAML:1.0\n---\nmodel_type: KANNALA_BRANDT\nimage_width: 640\nimage_height: 480\nprojection_parameters:\n   k2: 0.05\n   k3: -0.01\n   k4: 0.004\n   k5: -0.001\n   mu: 525\n   mv: 526\n   u0: 319.5\n   v0: 239.5\n";
    let lens = r#""k1": 0.05, "k2": -0.01, "k3": 0.004, "k4": -0.001"#;
    let ngp = json(&format!(r#""is_fisheye": true, "camera_model": "OPENCV", {lens}"#));
    for text in [opencv, vins, &ngp, &basalt("kb4", lens)] {
        let camera = parse(text).unwrap();
        assert!(close(camera.intrinsics, VGA) && camera.size == Some((640, 480)), "{text}");
        let distortion = camera.distortion.unwrap();
        assert_eq!(distortion.model(), DistortionModel::KannalaBrandt, "{text}");
        assert_eq!(distortion.coefficients()[..4], [0.05, -0.01, 0.004, -0.001], "{text}");
    }
    let off = parse(&json(&format!(r#""is_fisheye": false, {lens}"#))).unwrap();
    assert_eq!(off.distortion.unwrap().model(), DistortionModel::BrownConrady);
}

#[test]
fn the_note_on_several_cameras_names_the_others() {
    let of = |name: &str, fx: f64| format!(r#""{name}": {{"fx": {fx}, "fy": {fx}, "cx": 319.5, "cy": 239.5}}"#);
    for text in [
        format!("{{{}, {}}}", of("color", 600.0), of("depth", 525.0)),
        format!("{{{}, {}}}", of("depth", 525.0), of("color", 600.0)),
    ] {
        let camera = parse(&text).unwrap();
        assert_eq!(camera.intrinsics.fx, 525.0);
        assert!(camera.notes.iter().any(|note| note.ends_with("`depth` is taken, not `color`")), "{:?}", camera.notes);
    }
}

#[test]
fn the_camera_of_record3d_is_scaled_to_its_depth_maps() {
    let text = r#"{"w": 960, "h": 720, "dw": 256, "dh": 192, "fps": 60, "K": [720, 0, 0, 0, 720, 0, 479.5, 359.5, 1]}"#;
    let frame = framed(text, (256, 192), |_| ()).unwrap();
    assert!(close(frame.sensor.intrinsics.unwrap(), [192.0, 192.0, 127.5, 95.5]));
    assert!(
        frame.warnings.iter().any(|note| note.contains("960 x 720") && note.contains("dw")),
        "{:?}",
        frame.warnings
    );
    let frame = framed(text, (960, 720), |_| ()).unwrap();
    assert!(close(frame.sensor.intrinsics.unwrap(), [720.0, 720.0, 479.5, 359.5]));
    let mut options = ReadOptions::default().camera(&parse(text).unwrap());
    options.encoding = None;
    assert!(decode(&map(640, 480), "map", &options).is_err());
}

#[test]
fn what_is_no_camera_file_is_called_what_it_looks_like() {
    for (text, what) in [
        ("<!DOCTYPE html>\n<html><body>Not found</body></html>", "web page"),
        ("version https://git-lfs.github.com/spec/v1\noid sha256:ab\nsize 12\n", "Git LFS"),
        ("ply\nformat ascii 1.0\nelement vertex 3\n", "point cloud"),
        ("The camera was lent to a friend.\nAsk there.\n", "text without names"),
        ("1.0 0.1 0.2 0.3 0 0 0 1\n2.0 0.1 0.2 0.3 0 0 0 1\n3.0 0.1 0.2 0.3 0 0 0 1\n", "3 lines of 8 numbers"),
    ] {
        let error = parse(text).unwrap_err().to_string();
        assert!(error.contains(what) && !error.contains("no YAML"), "{error}");
    }
}

#[test]
fn cameras_of_recorded_maps_have_no_note() {
    let Some(data) = common::data() else { return };
    let mut count = 0;
    for (folder, camera, map) in [
        ("icl_nuim/evolin", "calibration_matrix.txt", "depth/0000.png"),
        ("pfm/terrace", "calib.txt", "disp0.pfm"),
        ("pfm/playground", "calib.txt", "disp0.pfm"),
    ] {
        let camera = read_camera(data.join(folder).join(camera)).unwrap();
        let with = read(data.join(folder).join(map), &ReadOptions::default().camera(&camera)).unwrap();
        let without = read(data.join(folder).join(map), &ReadOptions::default()).unwrap();
        assert_eq!(with.warnings.len(), without.warnings.len(), "{folder}: {:?}", with.warnings);
        count += 1;
    }
    assert_eq!(count, 3);
}

#[test]
fn the_page_of_cameras_lists_every_form() {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/cameras.md");
    let page = std::fs::read_to_string(&path).unwrap();
    let (start, end) = ("<!-- forms -->\n", "<!-- end of forms -->");
    let (before, rest) = page.split_once(start).unwrap();
    let (_, after) = rest.split_once(end).unwrap();
    let row = |form: &depthplanes_io::camera_file::CameraForm| {
        format!("### `{}`\n\n{}.\n\n```text\n{}\n```\n\n", form.name, form.about, form.sample)
    };
    let made = format!("{before}{start}\n{}{end}{after}", FORMS.iter().map(row).collect::<String>());
    if std::env::var("DEPTHPLANES_GOLDEN").as_deref() == Ok("update") {
        std::fs::write(&path, &made).unwrap();
    }
    assert!(std::fs::read_to_string(&path).unwrap() == made, "docs/cameras.md is not that of the table: make golden");
}

#[test]
fn a_key_that_stands_twice_is_refused_and_the_same_twice_is_not() {
    for text in [
        "fx: 525\nfy: 526\ncx: 319.5\ncy: 239.5\nfx: 600\n",
        "camera:\n  fx: 525\n  fy: 526\n  cx: 319.5\n  cy: 239.5\n  cx: 300\n",
        "camera: {fx: 525, fy: 526, cx: 319.5, cy: 239.5, cy: 200}",
        r#"{"fx": 525, "fy": 526, "cx": 319.5, "cy": 239.5, "fx": 600}"#,
        r#"{"a": [{"fx": 525, "fx": 600, "fy": 526, "cx": 319.5, "cy": 239.5}]}"#,
        "fx = 525\nfy = 526\ncx = 319.5\ncy = 239.5\nfx = 600\n",
    ] {
        let error = parse(text).unwrap_err().to_string();
        assert!(error.contains("stands twice"), "{text}: {error}");
    }
    for text in [
        "fx: 525\nfy: 526\ncx: 319.5\ncy: 239.5\nfx: 525.0\n",
        r#"{"fx": 525, "fy": 526, "cx": 319.5, "cy": 239.5, "fx": 525}"#,
        "fx = 525\nfx = 525\nfy = 526\ncx = 319.5\ncy = 239.5\n",
    ] {
        assert!(close(parse(text).unwrap().intrinsics, VGA), "{text}");
    }
}

#[test]
fn lines_may_end_with_cr_alone() {
    let mut count = 0;
    for (form, text, right, _) in SPECIMENS {
        if text.contains('\r') {
            continue;
        }
        let camera = parse(&text.replace('\n', "\r")).unwrap_or_else(|error| panic!("{form}: {error}\n{text}"));
        assert!(close(camera.intrinsics, *right), "{form}: {camera:?}\n{text}");
        count += 1;
    }
    assert!(count > 40, "{count}");
}

#[test]
fn of_several_cameras_the_one_of_the_depth_map_is_taken() {
    let of = |name: &str, fx: f64| format!(r#""{name}": {{"fx": {fx}, "fy": {fx}, "cx": 319.5, "cy": 239.5}}"#);
    for (names, right) in [
        (["color", "depth", "depth_to_color"], 501.0),
        (["aligned_depth_to_color", "depth", "infra1"], 501.0),
        (["rgb", "color_to_depth", "depth_camera"], 502.0),
    ] {
        let cameras: Vec<String> = (0..).zip(names).map(|(at, name)| of(name, 500.0 + f64::from(at))).collect();
        let camera = parse(&format!("{{{}}}", cameras.join(", "))).unwrap();
        assert_eq!(camera.intrinsics.fx, right, "{names:?}");
        assert!(camera.notes.iter().any(|note| note.contains("is taken, not")), "{:?}", camera.notes);
    }
    for names in [["color", "depth_to_color", "ir"], ["color", "ir", "depth2color"], ["rgb", "infra1", "depthToRgb"]] {
        let cameras: Vec<String> = (0..).zip(names).map(|(at, name)| of(name, 500.0 + f64::from(at))).collect();
        let error = parse(&format!("{{{}}}", cameras.join(", "))).unwrap_err().to_string();
        assert!(error.contains("several cameras that differ") && error.contains("--intrinsics"), "{error}");
    }
}

#[test]
fn a_camera_of_another_size_whose_shape_is_close_is_noted() {
    for (camera, size) in [
        ("617.1,617.3,421.9,238.1", (640, 360)),
        ("366.1,366.2,257.9,206.4", (640, 512)),
        ("504.3,504.4,318.0,292.1", (512, 464)),
        ("600.1,600.2,322.0,242.9", (544, 408)),
    ] {
        let frame = framed(camera, size, |_| ()).unwrap();
        let is_noted =
            frame.warnings.iter().any(|note| note.contains("is the middle of") && note.contains("--camera-size"));
        assert!(is_noted, "{camera}: {:?}", frame.warnings);
    }
    // Calibrated cameras of their own maps.
    for (camera, size) in [
        ("575.9,576.4,315.2,230.6", (640, 480)),
        ("504.3,504.4,321.0,334.9", (640, 576)),
        ("994.9,994.9,311.2,254.9", (741, 500)),
        ("366.1,366.1,258.2,204.2", (512, 424)),
    ] {
        assert_eq!(framed(camera, size, |_| ()).unwrap().warnings, [""; 0], "{camera}");
    }
}
