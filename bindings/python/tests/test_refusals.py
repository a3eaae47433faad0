"""Every public function refuses wrong types and wrong values with an error of the package that names the argument."""

import copy
import io
import pickle
import re

import numpy as np
import pytest

import depthplanes
from depthplanes import batch

FRAME = depthplanes.scene("planes3:size=64x48")
PLANES = depthplanes.detect(FRAME)
GROUND = depthplanes.floor(FRAME)
DETECTOR = depthplanes.Detector()
ODD = object()
MIRROR = np.diag([-1.0, 1, 1, 1])

#: What is called, the argument that is wrong, and values of it.
CALLS = [
    *(
        (function, name, values)
        for function in (depthplanes.Detector, lambda **words: depthplanes.detect(FRAME.depth, **words), lambda **words: batch.process("a.png", **words))
        for name, values in {
            "sensor": [3, "kinect9", ODD],
            "camera": [{"fx": 1}, (1, 2, 3), "nothing.yaml", ODD, ["a", "b", "c", "d"], [[1, 2], [3]], (-1, 0, 1, 2)],
            "unit": [3, "inch"],
            "method": [3, "magic", None],
            "scale": ["many", (1, 2)],
            "depth_scale": ["many"],
            "ray_distance": [1, "yes"],
            "disparity": [1],
            "focal": ["long"],
            "baseline": [ODD],
            "doffs": ["a"],
            "missing": ["a", [0, 1]],
            "valid_range": [3, (1, 2, 3), ("a", "b")],
            "camera_size": [3, (1.5, 2), (0, 4), (2**70, 4), "4x3", (640, 480)],
            "rectified": ["no"],
            "swap_bytes": [1],
            "noise_table": [3, [(1, 2, 3)], ODD],
            "threads": ["two", 0, -1, 1.5, 2**70],
            "curved": [1],
            "merge_coplanar": [3, (1, 2, 3), (91, 1)],
            "min_pixels": ["few", -1, None, (1, 2)],
            "noise": ["loud"],
        }.items()
    ),
    *((lambda depth, function=function: function(depth), "depth", [None, ODD, {"a": 1}, b"abc", np.zeros(100), np.zeros((4, 4), complex), [[1, 2], [3]], 7])
      for function in (DETECTOR, depthplanes.detect, depthplanes.floor)),
    *((lambda name=name, **words: depthplanes.detect(FRAME.depth, **words), name, [-1]) for name in ("scale", "depth_scale")),
    (lambda path: depthplanes.read(path), "path", [None, 3, io.StringIO("text")]),
    (lambda **words: depthplanes.read(b"P2 1 1 9 5", **words), "name", [3]),
    (lambda **words: depthplanes.read(b"P2 1 1 9 5", **words), "member", [ODD, -1]),
    (lambda **words: depthplanes.read(b"P2 1 1 9 5", **words), "raw_size", [(3,), "3x4"]),
    (lambda **words: depthplanes.read(b"abcdef", raw_size=(3, 1), **words), "raw_type", [3, "word"]),
    (depthplanes.scene, "spec", [3, None]),
    (depthplanes.video, "source", [3, None]),
    (lambda **words: depthplanes.floor(PLANES, **words), "up", [[0, -1], "up", 3, (0, 0, 0)]),
    (lambda **words: depthplanes.floor(PLANES, **words), "camera_height", ["tall", -1]),
    (GROUND.grid, "resolution", ["fine", -1]),
    (depthplanes.noise, "frames", [3, [3], "depth.png", np.zeros((4, 4))]),
    (lambda **words: depthplanes.score(**({"prediction": PLANES.labels, "truth": PLANES.labels} | words)), "prediction", [ODD, "a", np.zeros(3), [[1], [2, 3]], np.full((2, 2), -1)]),
    (lambda **words: depthplanes.score(**({"prediction": PLANES.labels, "truth": PLANES.labels} | words)), "truth", [None, np.zeros((2, 2, 2), int), np.zeros((2, 2), int)]),
    (lambda **words: depthplanes.score(PLANES.labels, PLANES.labels, **words), "tolerance", ["a", 3]),
    (lambda **words: depthplanes.score(PLANES.labels, PLANES.labels, **words), "truth_from", ["a", -1, 70000]),
    (depthplanes.Tracker, "kept_frames", ["a", -1, 1.5]),
    (lambda planes: depthplanes.Tracker()(planes), "planes", [FRAME, None, PLANES[:2]]),
    (lambda pose: depthplanes.Tracker()(PLANES, pose), "pose", [3, "a", np.eye(3), 2 * np.eye(4), MIRROR, np.ones((4, 4)), (np.eye(3), [1, 2]), (np.eye(4), [0, 0, 0]), np.full((4, 4), np.nan)]),
    *((getattr(PLANES, name), "k", [99, -99, "a", 1.5]) for name in ("mask", "points", "plane_model", "polygons", "hull", "rectangle")),
    (lambda index: PLANES[index], "index", [99, "a", 1.5, [99], [0.5], None]),
    (lambda **words: PLANES.polygons(0, **words), "metric", [1]),
    (lambda **words: PLANES.polygons(0, **words), "tolerance", ["a", -1]),
    (lambda **words: PLANES.polygons(0, **words), "min_hole", ["a", -1, 1.5, 2**70]),
    (lambda **words: PLANES.hull(0, **words), "metric", [1]),
    (lambda **words: PLANES.rectangle(0, **words), "metric", ["yes"]),
    (lambda u: PLANES.explain(u, 0), "u", ["a", -1, 64, 1.5]),
    (lambda v: PLANES.explain(0, v), "v", [None, -1, 48]),
    (PLANES.draw, "image", [3, "a", np.zeros((48, 64, 3)), np.zeros((10, 64, 3), np.uint8), np.zeros((48, 64, 4), np.uint8), np.zeros((64, 48), np.uint8)]),
    (PLANES.plot, "ax", [3]),
    (PLANES.to_dict, "source", [3]),
    (PLANES.to_dict, "outlines", ["a", -1]),
    (PLANES.to_coco, "source", [3]),
    (PLANES.to_geojson, "outlines", ["a", -1]),
    (PLANES.to_rerun, "path", [3]),
    (PLANES.to_ros, "frame_id", [3]),
    (PLANES.to_ros, "stamp", [3, (1, 2, 3), "now"]),
    (PLANES.to_ros, "types", [3]),
    *((PLANES.write, name, [3, ODD]) for name in ("labels", "overlay", "planes", "cloud", "mesh", "curved")),
    *((lambda name=name, **words: PLANES.write(planes="never.json", **words), name, values)
      for name, values in {"outlines": ["a", -1], "legend": [1], "source": [3]}.items()),
    (lambda result: depthplanes.write(result, labels="never.png"), "result", [FRAME]),
    (batch.process, "path", [3, None]),
    (lambda **words: batch.process("a.png", **words), "labels", [3]),
    (lambda paths: batch.run(paths, "never"), "paths", [3, [3], None]),
    (lambda **words: batch.run(**({"paths": "a.png", "out": "never"} | words)), "out", [3, None]),
    *((lambda name=name, **words: batch.run("a.png", "never", **words), name, values)
      for name, values in {"engine": [3, "spark"], "workers": ["a", 0, 1.5], "part": ["a", 0, None], "labels": [3], "client": [3], "retry_failed": [1]}.items()),
    (batch.read_rows, "out", [3, None]),
]  # fmt: skip


@pytest.mark.filterwarnings("ignore::depthplanes.ReadingWarning")
def test_what_is_wrong_is_refused_with_the_name_of_the_argument(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    tried, wrong = 0, []
    for call, name, values in CALLS:
        for value in values:
            tried += 1
            try:
                call(**{name: value})
            except depthplanes.Error as error:
                said = str(error)
                if not re.search(rf"\b{name}\b", said) and not (isinstance(value, str) and value in said):
                    wrong.append((name, value, said))
            except Exception as error:
                wrong.append((name, value, error))
            else:
                wrong.append((name, value, "is accepted"))
    assert not wrong, "\n".join(map(str, wrong))
    assert tried > 300
    assert list(tmp_path.iterdir()) == []


def test_a_keyword_that_there_is_not_is_told_the_one_that_was_meant():
    for call in (depthplanes.Detector, lambda **words: depthplanes.detect(FRAME, **words), lambda **words: batch.process("a.png", **words)):
        for wrong, right in {"cam": "camera", "senzor": "sensor", "minpixels": "min_pixels", "encoding": "unit", "intrinsics": "camera"}.items():
            with pytest.raises(depthplanes.InputTypeError, match=f"there is no keyword {wrong}; did you mean {right}\\? There are: ") as raised:
                call(**{wrong: 1})
            for name in ("sensor", "camera", "unit", "method", "scale", "threads", "min_pixels", "inlier_threshold"):
                assert f" {name}" in str(raised.value)
            assert "min-pixels" not in str(raised.value) and "theta" not in str(raised.value)
    for call in (depthplanes.read, depthplanes.video):
        with pytest.raises(depthplanes.InputTypeError, match="there is no keyword senzor; did you mean sensor") as raised:
            call("depth.png", senzor="kinect1")
        assert "raw_size" in str(raised.value) and "min_pixels" not in str(raised.value)
    with pytest.raises(depthplanes.InputTypeError, match='there is no keyword theta of the method "planar", but of "ngaf"'):
        depthplanes.Detector(theta=3)
    assert depthplanes.Detector(method="ngaf", theta=3).parameters["theta"] == 3


def test_a_detector_can_be_handed_to_other_processes():
    detector = depthplanes.Detector(unit="mm", camera=np.array([[58.0, 0, 31.5], [0, 58, 23.5], [0, 0, 1]]), min_pixels=50, threads=2)
    again = pickle.loads(pickle.dumps(detector))
    depth = np.full((48, 64), 2000, np.uint16)
    assert np.array_equal(again(depth).distances, detector(depth).distances) and again(depth).distances == [2]
    assert repr(again) == repr(detector) and again.parameters == detector.parameters
    assert repr(detector).startswith("Detector(method='planar', camera=(58.0, 58.0, 31.5, 23.5), unit='mm', threads=2, min_pixels=50, ")
    assert len(copy.deepcopy(detector)(depth)) == 1


def test_what_cannot_be_pickled_says_what_can():
    for thing, instead in [(PLANES, "to_dict"), (PLANES[0], "to_dict"), (FRAME, "frame.depth"), (GROUND, "to_dict"), (depthplanes.Tracker(), "Tracks")]:
        with pytest.raises(depthplanes.InputTypeError, match=f"cannot be pickled.*accepted: .*{instead}"):
            pickle.dumps(thing)
    same = copy.deepcopy({"planes": PLANES[1:]})["planes"]
    assert np.array_equal(same.labels, PLANES[1:].labels) and same.indices.tolist() == [1, 2]
    same.normals[:] = 0
    assert PLANES[1:].normals.any()
    assert len(depthplanes.detect(copy.deepcopy(FRAME))) == len(PLANES)
    assert np.array_equal(pickle.loads(pickle.dumps(PLANES.labels)), PLANES.labels)
