"""benchmarks/peers.py as `depthplanes eval` runs it: cc3d's planes are those of `ngaf`, and every peer that is there
finds the walls of a synthetic corner."""

import importlib.util
import json
import subprocess
import sys

import cv2
import numpy as np
import pytest

from conftest import ROOT

PEERS = ROOT / "benchmarks" / "peers.py"


def evaluated(program, folder, words):
    """The rows of an evaluation, by map and label."""
    peers = f"{sys.executable} {PEERS}"
    subprocess.run([program, "eval", *words, "--peers", peers, "--repeat", "1", "--report", folder], check=True)
    rows = [json.loads(line) for line in (folder / "rows.jsonl").read_text().splitlines()]
    return {(row["map"], row["label"]): row for row in rows}


def test_cc3d_finds_what_ngaf_finds(program, tmp_path):
    words = ["scene:room:seed=1-3,size=320x240,sensor=disparity", "scene:room:seed=1-2,size=200x150,sensor=kinect_white"]
    rows = evaluated(program, tmp_path / "report", [*words, "--methods", "ngaf"])
    maps = {name for name, _ in rows}
    assert len(maps) == 5
    planes = 0
    for name in maps:
        ours, theirs = (rows[name, label]["outcome"]["found"] for label in ("ngaf", "cc3d-components"))
        images = [cv2.imread(str(tmp_path / "report" / found["labels"]), cv2.IMREAD_UNCHANGED) for found in (ours, theirs)]
        pairs = np.unique(np.stack([image.ravel() for image in images]), axis=1)
        assert pairs.shape[1] == len(set(pairs[0])) == len(set(pairs[1])), f"{name}: the labels differ by more than names"
        assert [0, 0] in pairs.T.tolist()
        assert ours["scores"] == pytest.approx(theirs["scores"])
        planes += ours["planes"]
    assert planes > 20
    version = rows[next(iter(maps)), "cc3d-components"]["version"]
    assert version.startswith("connected-components-3d 4.")


def test_searches_in_space_find_the_walls(program, tmp_path):
    rows = evaluated(program, tmp_path / "report", ["scene:planes3:seed=1,size=160x120", "--methods", "planar"])
    peers = [label for _, label in rows if label not in ("planar", "cc3d-components")]
    if not peers:
        pytest.skip("neither Open3D nor pyransac3d is installed; `make peers` runs them")
    for label in peers:
        found = next(row["outcome"]["found"] for (_, name), row in rows.items() if name == label)
        assert found["scores"]["segcomp.correct"] >= 2, (label, found)


def test_a_peer_that_is_not_installed_is_left_out_and_said():
    peers = load()
    peers.PEERS["nowhere"] = (None, "no_such_module", "no-such-package", "")
    assert peers.installed(["nowhere"]) == {}


def test_points_lie_where_the_camera_sees_them():
    peers = load()
    depth = np.array([[0, 2, 0], [1, 0, 4]], np.float32)
    points, pixels = peers.Frame(depth, depth, (2.0, 4.0, 1.0, 0.5)).points()
    assert pixels.tolist() == [1, 3, 5]
    assert points.tolist() == [[0, -0.25, 2], [-0.5, 0.125, 1], [2, 0.5, 4]]


def load():
    spec = importlib.util.spec_from_file_location("peers", PEERS)
    peers = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(peers)
    return peers
