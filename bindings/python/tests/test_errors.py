"""What is wrong is said as the program says it, in Python's words, with exceptions that Python's own are above."""

import io
import pickle
import subprocess
import sys

import numpy as np
import pytest

import depthplanes
from depthplanes._words import in_python

DEPTH = np.full((48, 64), 2000, np.uint16)


def said(program, *words):
    """What the program says is wrong."""
    return program(*words, check=False).stderr.decode().removeprefix("error: ").strip()


@pytest.mark.parametrize(
    "words, options",
    [
        (["--encoding", "kinect-raw", "--scale", "3"], {"unit": "kinect-raw", "scale": 3}),
        (["--depth-scale", "-1"], {"depth_scale": -1}),
        (["--missing", "70000"], {"missing": 70000}),
        (["--valid-range", "5,2"], {"valid_range": (5, 2)}),
        (["--intrinsics", "0,1,2,3"], {"camera": (0, 1, 2, 3)}),
        (["--intrinsics", "500,500,9000,3"], {"camera": (500, 500, 9000, 3)}),
        (["--baseline", "0.1"], {"baseline": 0.1}),
        (["--min-pixels", "-1"], {"min_pixels": -1}),
        (["--inlier-threshold", "nan"], {"inlier_threshold": float("nan")}),
        (["--merge-coplanar=91,1"], {"merge_coplanar": (91, 1)}),
    ],
)
def test_values_are_refused_as_the_program_refuses_them(program, tmp_path, words, options):
    path = tmp_path / "map.npy"
    np.save(path, DEPTH)
    theirs = said(program, "detect", path, *words)
    with pytest.raises(ValueError) as raised:
        depthplanes.detect(path, **options)
    assert isinstance(raised.value, depthplanes.InputError)
    assert str(raised.value).removeprefix(f"{path}: ") == in_python(theirs.removeprefix(f"{path}: "))


@pytest.mark.parametrize(
    "text, expected",
    [
        ("--preset is `realsense`; accepted: kinect1", "sensor is `realsense`; accepted: kinect1"),
        ("parameter `min-pixels` is -1", "parameter `min_pixels` is -1"),
        ("read as `inverse-depth`", "read as `inverse-depth`"),
        ("state --encoding or --scale if it is not, --encoding millimetre if it is", 'state unit or scale if it is not, unit="millimetre" if it is'),
        ("try --scale 16 or 256, or --missing -1.", "try scale=16 or 256, or missing=-1."),
        ("give --intrinsics fx,fy,cx,cy, --camera FILE or --preset SENSOR", "give camera=(fx, fy, cx, cy), camera=FILE or sensor=SENSOR"),
        ("check --intrinsics and --camera", "check camera"),
        ("--intrinsics=58,58.5,31.5,23; --camera-size 640x480", "camera=(58, 58.5, 31.5, 23); camera_size=(640, 480)"),
        ("the size with --raw-size WIDTHxHEIGHT", "the size with raw_size=(WIDTH, HEIGHT)"),
        ("undone; --rectified if the map is; --rectified=no undoes it", "undone; rectified=True if the map is; rectified=False undoes it"),
        ("try --preset kinect1-raw, or --encoding kinect-raw", 'try sensor="kinect1-raw", or unit="kinect-raw"'),
        ("try --swap-bytes", "try swap_bytes=True"),
        ("a curved surface; see `detect --curved`.", "a curved surface; see `curved=True`."),
    ],
)  # fmt: skip
def test_flags_are_keywords(text, expected):
    assert in_python(text) == expected


def test_names_are_listed_where_one_is_unknown():
    for options, name in [({"sensor": "kinect9"}, "kinect1"), ({"unit": "inch"}, "millimetre"), ({"method": "magic"}, "ransac")]:
        with pytest.raises(depthplanes.InputError, match=name):
            depthplanes.Detector(**options)
    with pytest.raises(TypeError, match="there is no keyword frob; there are: ") as raised:
        depthplanes.Detector(frob=1)
    assert isinstance(raised.value, depthplanes.InputTypeError)
    with pytest.raises(TypeError):
        depthplanes.Detector(scale="many")
    with pytest.raises(depthplanes.InputError, match="theta"):
        depthplanes.Detector(method="ngaf", theta=-1)


def test_what_is_no_map_is_refused():
    detector = depthplanes.Detector()
    for shape in [(3,), (2, 3, 4), (0, 5), (5, 0)]:
        with pytest.raises(ValueError):
            detector(np.zeros(shape, np.uint16))
    with pytest.raises(depthplanes.InputError, match=r"the shape \(100,\); accepted: .*\(height, width\)"):
        detector(np.zeros(100, np.uint16))
    with pytest.raises(TypeError, match="accepted: uint8, uint16, float32"):
        detector(np.zeros((4, 4), complex))
    with pytest.raises(TypeError, match="array of bool"):
        detector(np.zeros((4, 4), bool))
    with pytest.raises(TypeError):
        detector(None)
    for camera in [(1, 2, 3), np.eye(4), [[500, 1, 320], [0, 500, 240], [0, 0, 1]]]:
        with pytest.raises(ValueError, match="camera"):
            depthplanes.Detector(camera=camera)


def test_a_matrix_and_a_file_are_cameras(data):
    matrix = np.array([[58.0, 0, 31.5], [0, 58.0, 23.5], [0, 0, 1]])
    assert depthplanes.detect(DEPTH, camera=matrix).distances == depthplanes.detect(DEPTH, camera=(58, 58, 31.5, 23.5)).distances
    folder = data / "realsense_polylidar"
    frame = depthplanes.read(folder / "depth" / "00000000_1580908150203.png", camera=folder / "camera_intrinsic_rgb_424.json")
    assert frame.camera[0] > 100


def test_files_that_are_not_there_are_missing_files(program, tmp_path):
    path = tmp_path / "nothing.png"
    with pytest.raises(FileNotFoundError) as raised:
        depthplanes.read(path)
    assert isinstance(raised.value, depthplanes.FileError) and isinstance(raised.value, depthplanes.Error)
    assert str(raised.value) == said(program, "detect", path)
    with pytest.raises(depthplanes.FileError):
        depthplanes.read(tmp_path)
    (tmp_path / "text.png").write_text("no map")
    with pytest.raises(depthplanes.InputError) as raised:
        depthplanes.read(tmp_path / "text.png")
    assert str(raised.value) == in_python(said(program, "detect", tmp_path / "text.png"))


def test_bytes_are_read_as_their_file_is(data, tmp_path):
    for path in (data / "gt_real").glob("*.depth.png"):
        file, memory = depthplanes.read(path, unit="mm"), depthplanes.read(path.read_bytes(), name=str(path), unit="mm")
        assert np.array_equal(file.depth, memory.depth) and (file.notes, file.source) == (memory.notes, memory.source)
    assert depthplanes.read(path.read_bytes()).source == "bytes"
    (tmp_path / "broken.png").write_bytes(path.read_bytes()[:200])
    said = []
    for broken in (tmp_path / "broken.png", path.read_bytes()[:200]):
        with pytest.raises(depthplanes.InputError) as raised:
            depthplanes.read(broken)
        said.append(str(raised.value))
    assert said[0].removeprefix(f"{tmp_path}/broken.png: ") == said[1].removeprefix("bytes: ")
    for file, name in [(open(path, "rb"), str(path)), (io.BytesIO(path.read_bytes()), "bytes")]:
        with file:
            frame = depthplanes.read(file, unit="mm")
        assert np.array_equal(frame.depth, memory.depth) and frame.source == name
    assert np.array_equal(depthplanes.read(bytearray(path.read_bytes()), unit="mm").depth, memory.depth)
    with open(path, encoding="latin-1") as file, pytest.raises(depthplanes.InputTypeError, match='open\\(path, "rb"\\)'):
        depthplanes.read(file)
    with pytest.raises(depthplanes.InputError, match="name='a' is for bytes"):
        depthplanes.read(path, name="a")
    with pytest.raises(depthplanes.InputError):
        depthplanes.read(b"")


def test_nothing_is_written_if_one_name_is_wrong(planes, tmp_path):
    with pytest.raises(depthplanes.InputError, match=r"\.png or \.npy"):
        planes.write(planes=tmp_path / "planes.json", labels=tmp_path / "labels.gif")
    with pytest.raises(FileNotFoundError, match="does not exist"):
        planes.write(planes=tmp_path / "planes.json", labels=tmp_path / "no" / "labels.png")
    with pytest.raises(depthplanes.InputError, match="overwrite"):
        planes.write(planes=tmp_path / "one.json", cloud=tmp_path / "one.ply", mesh=tmp_path / "one.ply")
    with pytest.raises(depthplanes.InputError, match="there is no file to write; accepted: any of labels, overlay, planes"):
        planes.write()
    assert list(tmp_path.iterdir()) == []
    depthplanes.write(planes, labels=tmp_path / "labels.png")
    assert np.array_equal(depthplanes.read(tmp_path / "labels.png", unit="grey").depth, planes.labels)


@pytest.mark.filterwarnings("ignore::depthplanes.ReadingWarning")
def test_what_a_frame_lacks_the_detector_states(tmp_path):
    camera, path = (58, 58, 31.5, 23.5), tmp_path / "map.npy"
    depth = 2000 + np.arange(64, dtype=np.uint16) + np.zeros((48, 64), np.uint16)
    np.save(path, depth)
    frame = depthplanes.read(path)
    assert frame.camera is None
    for words in [{"camera": camera}, {"camera": camera, "unit": "tum"}, {"camera": camera, "scale": 500}, {"camera": camera, "sensor": "tum-fr1"},
                  {"unit": "disparity", "baseline": 0.1, "camera": camera}, {"camera": camera, "missing": 2000}]:  # fmt: skip
        expected = depthplanes.detect(depth, **words)
        for found in (depthplanes.detect(frame, **words), depthplanes.Detector(**words)(frame)):
            assert np.array_equal(found.labels, expected.labels) and np.array_equal(found.normals, expected.normals), words
            assert np.array_equal(found.points(0), expected.points(0)) and not np.isnan(found.distances).any(), words
    stated = depthplanes.read(path, unit="tum", camera=camera)
    expected = depthplanes.detect(path, unit="tum", camera=camera)
    for words in [{"unit": "tum"}, {"camera": camera}, {"depth_scale": 0.0002}, {"unit": "tum", "camera": camera}]:
        assert np.array_equal(depthplanes.detect(stated, **words).distances, expected.distances), words
    np.save(tmp_path / "small.npy", (depth // 100).astype(np.uint8))
    small = depthplanes.read(tmp_path / "small.npy", unit="mm", scale=10)
    found = depthplanes.detect(small, camera=camera, noise_table=[(1, 0.01), (4, 0.02)])
    assert found.distances[0] == pytest.approx(2, abs=0.1)
    with pytest.raises(depthplanes.InputError, match="unit is .* by the detector, and .* by the frame"):
        depthplanes.detect(small, camera=camera, scale=100)
    disparity = depthplanes.detect(depthplanes.read(path, unit="disparity"), baseline=0.1, camera=camera)
    assert np.array_equal(disparity.distances, depthplanes.detect(depth, unit="disparity", baseline=0.1, camera=camera).distances)
    assert depthplanes.detect(frame, camera=(58, 58, 63, 23.5)).notes, "an odd camera is told of"


def test_what_a_frame_and_a_detector_both_state_has_to_agree(room):
    assert len(depthplanes.detect(room, unit="mm", camera=room.camera)) == len(depthplanes.detect(room))
    with pytest.raises(depthplanes.InputError, match=r'unit is "tum" \(0.0002 m\) by the detector, and "scene" \(0.001 m\) by the frame'):
        depthplanes.detect(room, unit="tum")
    with pytest.raises(depthplanes.InputError, match=r"camera is \(500, 500, 320, 240\) by the detector, and \(580, 580, 319.5, 239.5\) by"):
        depthplanes.detect(room, camera=(500, 500, 320, 240))
    with pytest.raises(depthplanes.InputError, match=r"ray_distance is True.*depthplanes.read\(.., ray_distance=True\)"):
        depthplanes.detect(room, ray_distance=True)
    assert len(depthplanes.detect(room, min_pixels=5000)) < 20


def test_odd_maps_are_warned_of_once(data):
    detector = depthplanes.Detector(camera=(58, 58, 31.5, 23.5))
    odd = np.full((48, 64), 20, np.float32) + np.arange(64, dtype=np.float32) / 10
    with pytest.warns(depthplanes.ReadingWarning):
        first = detector(odd * 1000)
    detector(odd * 1000)  # a second warning would be an error
    assert first.notes


def test_errors_can_be_handed_to_other_processes():
    for error in (depthplanes.InputError("text"), depthplanes.MissingFileError("text")):
        again = pickle.loads(pickle.dumps(error))
        assert type(again) is type(error) and str(again) == "text"


@pytest.mark.parametrize(
    "call, package",
    [("plot()", "matplotlib"), ("to_dataframe()", "pandas"), ("to_open3d()", "open3d"), ("to_supervision()", "supervision"),
     ("to_rerun()", "rerun-sdk"), ("to_ros()", "rosbags")],
)  # fmt: skip
def test_a_package_that_is_not_there_is_named(call, package):
    """Each conversion in a Python that has NumPy alone."""
    code = f"""
import sys, importlib.abc
class Alone(importlib.abc.MetaPathFinder):
    def find_spec(self, name, path, target=None):
        if name.split(".")[0] in {{"matplotlib", "pandas", "open3d", "supervision", "rerun", "rosbags", "shape_msgs"}}:
            raise ModuleNotFoundError("No module named " + repr(name))
sys.meta_path.insert(0, Alone())
import depthplanes
planes = depthplanes.detect(depthplanes.scene("planes3:size=64x48"))
try:
    planes.{call}
except ImportError as error:
    assert isinstance(error, depthplanes.MissingPackageError)
    print(error)
"""
    ran = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert f"pip install {package}" in ran.stdout and call in ran.stdout, ran.stdout


def test_a_package_that_lacks_a_library_says_which(planes, monkeypatch):
    import importlib

    def lacking(name):
        raise ImportError("libX11.so.6: cannot open shared object file")

    monkeypatch.setattr(importlib, "import_module", lacking)
    with pytest.raises(depthplanes.MissingPackageError, match="`open3d`, which is installed, but cannot be imported: libX11.so.6") as raised:
        planes.to_open3d()
    assert "pip install" not in str(raised.value)
