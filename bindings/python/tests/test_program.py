"""The package gives what the program gives, on every frame of the recorded data that the program reads."""

import json
import os
import subprocess
import sys
import warnings

import numpy as np
import pytest

import depthplanes

METHODS = [method["name"] for method in depthplanes.tables()["methods"]]
#: A few files of each format are searched by every method; the slow ones take seconds for a large map.
OF_EACH_FORMAT = 2
SMALL = 320 * 240


@pytest.fixture(scope="module")
def by_program(data, program, tmp_path_factory):
    """(path, label image, record) of every map below the data that the program finds planes in."""
    folder = tmp_path_factory.mktemp("found")
    program("detect", "--recursive", "--jobs", 2, "--table", folder / "planes.jsonl", data, check=False)
    found = []
    for line in (folder / "planes.jsonl").read_text().splitlines():
        record = json.loads(line)
        program("detect", record["source"], "--labels", folder / "labels.npy")
        found.append((record["source"], np.load(folder / "labels.npy"), record))
    return found


@pytest.mark.filterwarnings("ignore::depthplanes.ReadingWarning")
def test_labels_of_every_recorded_frame_are_the_programs(by_program, tell):
    detector = depthplanes.Detector()
    for path, labels, record in by_program:
        planes = detector(path)
        assert np.array_equal(planes.labels, labels), path
        assert len(planes) == len(record["planes"]), path
    tell(f"{len(by_program)} recorded frames have the program's labels, byte for byte:")
    assert len(by_program) > 100


@pytest.mark.filterwarnings("ignore::depthplanes.ReadingWarning")
def test_arrays_have_the_labels_of_their_files(by_program, tell):
    """The numbers of a file handed over as an array, with what the program said that they are."""
    shared = {}
    count = 0
    for path, labels, record in by_program:
        if record["encoding"] in ("compressed-depth", "scene") or record["format"] == "pcd":
            continue
        frame = depthplanes.read(path)
        key = (record["encoding"], frame.camera, frame.missing)
        words = {"unit": record["encoding"], "camera": frame.camera, "missing": frame.missing}
        detector = shared.setdefault(key, depthplanes.Detector(**words))
        assert np.array_equal(detector(frame.depth).labels, labels), path
        count += 1
    tell(f"{count} arrays have the labels of their files, {len(shared)} detectors for all of them:")
    assert count > 100


@pytest.mark.filterwarnings("ignore::depthplanes.ReadingWarning")
@pytest.mark.parametrize("method", METHODS)
def test_every_method_gives_the_programs_labels(by_program, program, tmp_path, method):
    of_format = {}
    for path, labels, record in by_program:
        of_format.setdefault(record["format"], []).append((labels.size, path))
    files = [path for all_of in of_format.values() for size, path in sorted(all_of)[:OF_EACH_FORMAT] if size <= SMALL * 4]
    assert len(files) >= len(of_format) - 1
    for path in files:
        program("detect", path, "--method", method, "--labels", tmp_path / "labels.npy")
        expected = np.load(tmp_path / "labels.npy")
        assert np.array_equal(depthplanes.detect(path, method=method).labels, expected), (path, method)


def test_documents_are_the_programs(data, program, tmp_path, planes):
    kinect = data / "gt_real" / "lpvo_hall_125.depth.png"
    camera = (525.0, 525.0, 319.5, 239.5)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", depthplanes.ReadingWarning)
        found = depthplanes.detect(kinect, camera=camera, unit="mm", merge_coplanar=(5, 0.05), min_pixels=300)
    words = ["--intrinsics", "525,525,319.5,239.5", "--encoding", "millimetre", "--merge-coplanar=5,0.05", "--min-pixels", 300]
    for ending in ("json", "csv", "geojson", "coco.json"):
        ours, theirs = tmp_path / f"ours.{ending}", tmp_path / f"theirs.{ending}"
        program("detect", kinect, *words, "--planes", theirs, "--outlines=1.5")
        found.write(planes=ours, outlines=1.5)
        assert ours.read_bytes() == theirs.read_bytes(), ending
    program("detect", kinect, *words, "--out-dir", tmp_path / "theirs")
    names = {"labels": "labels.png", "overlay": "overlay.png", "cloud": "cloud.ply", "mesh": "mesh.ply"}
    found.write(**{name: tmp_path / file for name, file in names.items()})
    for file in names.values():
        (theirs,) = (tmp_path / "theirs").glob(f"*.{file}")
        assert (tmp_path / file).read_bytes() == theirs.read_bytes(), file
    explained = json.loads(program("explain", kinect, "--at", "20,30", *words[:4], "--min-pixels", 300, "--json").stdout)
    assert found.explain(20, 30).to_dict() == explained


def test_tables_of_the_packages_program_are_parquet(engine, data, tmp_path):
    parquet, of_csv = engine("pyarrow.parquet"), engine("pyarrow.csv")
    for ending in ("parquet", "csv"):
        words = ["detect", data / "gt_real", "--table", tmp_path / f"planes.{ending}"]
        subprocess.run([sys.executable, "-m", "depthplanes", *words], capture_output=True)
    table, csv = parquet.read_table(tmp_path / "planes.parquet"), of_csv.read_csv(tmp_path / "planes.csv")
    assert table.num_rows > 300 and table.to_pylist() == csv.cast(table.schema).to_pylist()


def test_the_floor_and_the_noise_are_the_programs(data, program):
    stairs = next((data / "stairs_kinect_v2").glob("*_depth.png"))
    words = ["--preset", "kinect2", "--json"]
    ours = depthplanes.floor(str(stairs), sensor="kinect2", up=(0.0, -0.9, -0.4))
    assert ours.to_dict() == json.loads(program("floor", stairs, "--up=0,-0.9,-0.4", *words).stdout)
    frame = depthplanes.read(stairs, sensor="kinect2")
    theirs = json.loads(program("noise", stairs, *words).stdout)["frames"][0]
    theirs.pop("source")
    assert depthplanes.noise(frame) == theirs


def test_scores_are_the_programs(data, program, tmp_path, planes, room):
    np.save(tmp_path / "truth.npy", room.truth)
    np.save(tmp_path / "found.npy", planes.labels)
    theirs = json.loads(program("score", tmp_path / "truth.npy", tmp_path / "found.npy", "--json").stdout)
    ours = depthplanes.score(planes.labels, room.truth)
    assert ours and all(theirs["pairs"][0][family] == measures for family, measures in ours.items())


@pytest.mark.parametrize(
    "words, code",
    [
        (["--version"], 0),
        (["methods"], 0),
        (["detect", "scene:room:size=160x120", "--rows", "2"], 0),
        (["detect", "nothing-there.png"], 2),
        (["detect", "--frob"], 2),
        ([], 2),
    ],
)
def test_the_program_of_the_package_is_the_program(program, tmp_path, words, code):
    theirs = program(*words, check=False, cwd=tmp_path)
    ours = subprocess.run([sys.executable, "-m", "depthplanes", *words], capture_output=True, cwd=tmp_path)
    console = os.path.join(os.path.dirname(sys.executable), "depthplanes")
    script = subprocess.run([console, *words], capture_output=True, cwd=tmp_path)
    for ran in (ours, script):
        assert (ran.returncode, ran.stdout, ran.stderr) == (code, theirs.stdout, theirs.stderr)
    assert theirs.returncode == code


def test_the_demo_needs_no_data(tmp_path):
    subprocess.run([sys.executable, "-m", "depthplanes", "demo"], cwd=tmp_path, check=True, capture_output=True)
    assert len(depthplanes.detect(tmp_path / "depthplanes-demo" / "depth.png", unit="mm")) > 60
