"""What is wrong is said in the program's words, with exceptions that Python's own are above."""

import pickle
import subprocess
import sys

import numpy as np
import pytest

import depthplanes

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
def test_values_are_refused_in_the_programs_words(program, tmp_path, words, options):
    path = tmp_path / "map.npy"
    np.save(path, DEPTH)
    theirs = said(program, "detect", path, *words)
    with pytest.raises(ValueError) as raised:
        depthplanes.detect(path, **options)
    assert isinstance(raised.value, depthplanes.InputError)
    assert str(raised.value).removeprefix(f"{path}: ") == theirs.removeprefix(f"{path}: ")


def test_names_are_listed_where_one_is_unknown():
    for options, name in [({"sensor": "kinect9"}, "kinect1"), ({"unit": "inch"}, "millimetre"), ({"method": "magic"}, "ransac")]:
        with pytest.raises(depthplanes.InputError, match=name):
            depthplanes.Detector(**options)
    with pytest.raises(TypeError, match="there is no parameter `frob`; there are: ") as raised:
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
    with pytest.raises(TypeError, match="accepted: uint8, uint16, float32"):
        detector(np.zeros((4, 4), complex))
    with pytest.raises(TypeError, match="type bool"):
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
    assert str(raised.value) == said(program, "detect", tmp_path / "text.png")


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
    assert list(tmp_path.iterdir()) == []
    depthplanes.write(planes, labels=tmp_path / "labels.png")
    assert np.array_equal(depthplanes.read(tmp_path / "labels.png", unit="grey").depth, planes.labels)


def test_a_frame_brings_its_own_words(room):
    with pytest.raises(depthplanes.InputError, match="knows its sensor, camera and unit"):
        depthplanes.detect(room, unit="mm")
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
