"""What depthplanes-rerun records is read by Rerun's own package, and is what `track` finds."""

import json
import os
import pathlib
import signal
import subprocess
import sys
import time

import cv2
import numpy as np
import pytest
from rerun.experimental import RrdReader

SCENE = "scene:boxes:sensor=kinect,size=320x240,frames=6"
CAMERA = "/world/camera"
FOCAL_PX = 290.0


def chunks(path):
    """Entity, whether it is for all times, and the columns of each message."""
    for chunk in RrdReader(str(path)).stream():
        if not chunk.entity_path.startswith("/__"):
            batch = chunk.to_record_batch()
            yield chunk.entity_path, chunk.is_static, dict(zip(batch.schema.names, batch.columns))


def rows(path, entity):
    """By frame: what an entity is, its components by name."""
    found = {}
    for name, is_static, columns in chunks(path):
        if name == entity and not is_static:
            for at, frame in enumerate(columns["frame"].to_pylist()):
                parts = {key.split(":")[1]: column[at].as_py() for key, column in columns.items() if ":" in key}
                found.setdefault(frame, {}).update(parts)
    return found


def image(row):
    """The pixels of an image of 8 or 16 bits or of floats."""
    (form,), (buffer,) = row["format"], row["buffer"]
    samples, pixels = bytes(buffer), form["width"] * form["height"]
    kind = {1: "u1", 2: "<u2", 4: "<f4"}[len(samples) // pixels]
    return np.frombuffer(samples, kind).reshape(form["height"], form["width"])


@pytest.fixture
def record(rerun_program, tmp_path):
    """Records a source; the file."""
    def record(source, *flags):
        out = tmp_path / "out.rrd"
        command = [rerun_program, source, "--out", out, *flags]
        done = subprocess.run(command, capture_output=True, text=True)
        assert done.returncode == 0, done.stderr
        return out
    return record


@pytest.fixture
def track(program, tmp_path):
    """What `track` finds in it: lines, label images."""
    def track(source, *flags):
        labels = tmp_path / "labels"
        command = [program, "track", source, "--out", "-", "--labels", labels, *flags]
        done = subprocess.run(command, capture_output=True, text=True, check=True)
        images = [cv2.imread(str(path), cv2.IMREAD_UNCHANGED) for path in sorted(labels.glob("*.png"))]
        return [json.loads(line) for line in done.stdout.splitlines()], images
    return track


def test_the_package_finds_no_fault(record, tmp_path):
    path = record(SCENE)
    # Without a home it counts nobody.
    environment = {**os.environ, "HOME": str(tmp_path)}
    viewer = pathlib.Path(sys.executable).with_name("rerun")  # of the environment, which need not be the shell's
    for words in (["verify"], ["print"], ["stats"]):
        done = subprocess.run([viewer, "rrd", *words, path], capture_output=True, text=True, env=environment)
        assert done.returncode == 0 and "error" not in done.stderr.lower().replace("without error", ""), done.stderr


def test_what_is_recorded_is_what_track_finds(record, track):
    path, (lines, labels) = record(SCENE), track(SCENE)
    outlines, normals = rows(path, f"{CAMERA}/planes/outlines"), rows(path, f"{CAMERA}/planes/normals")
    ids, poses = rows(path, f"{CAMERA}/image/ids"), rows(path, CAMERA)
    assert set(outlines) == set(normals) == set(ids) == set(poses) == set(range(6))
    for frame, (line, expected) in enumerate(zip(lines, labels)):
        assert np.array_equal(image(ids[frame]), expected)
        planes = {plane["id"]: plane for plane in line["planes"]}
        arrows = normals[frame]
        drawn = [int(label) for label in arrows["labels"]]
        assert len(drawn) == len(set(drawn)) >= 0.9 * len(planes) and set(drawn) <= set(planes)
        assert drawn == arrows["class_ids"]
        for id, origin, vector in zip(drawn, arrows["origins"], arrows["vectors"]):
            assert np.allclose(origin, planes[id]["centroid_m"], atol=1e-5)
            assert np.allclose(np.array(vector) / 0.2, planes[id]["normal"], atol=1e-5)
        rings = outlines[frame]
        assert set(rings["class_ids"]) == set(drawn) == {int(label) for label in rings["labels"]}
        for id, strip in zip(rings["class_ids"], rings["strips"]):
            points, plane = np.array(strip), planes[id]
            assert np.array_equal(points[0], points[-1]) and len(points) >= 4
            off = points @ np.array(plane["normal"])
            # On the plane of this frame, which the filtered one is near.
            off = np.minimum(np.abs(off + plane["distance_m"]), np.abs(off - plane["distance_m"]))
            assert off.max() < 0.05 * points[:, 2].max()
        assert np.allclose(poses[frame]["translation"][0], line["pose"]["translation_m"], atol=1e-5)
        x, y, z, w = poses[frame]["quaternion"][0]
        matrix = [[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                  [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                  [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]]
        assert np.allclose(matrix, line["pose"]["rotation"], atol=1e-5)


def test_a_recording_has_the_name_of_its_source(record):
    (chunk,) = (chunk for chunk in RrdReader(str(record(SCENE))).stream() if chunk.entity_path == "/__properties")
    batch = chunk.to_record_batch()
    assert batch.column(batch.schema.names.index("RecordingInfo:name")).to_pylist() == [[SCENE]]


def test_ids_have_the_colours_of_the_pictures(record):
    path = record(SCENE)
    contexts = [columns for name, is_static, columns in chunks(path) if name == CAMERA and is_static]
    named = {}
    for columns in contexts:
        for entry in columns["AnnotationContext:context"][0].as_py()[0]:
            named[entry["class_id"]] = entry["class_description"]["info"]
    for row in rows(path, f"{CAMERA}/planes/outlines").values():
        for id, colour in zip(row["class_ids"], row["colors"]):
            assert named[id]["label"] == str(id) and named[id]["color"] == colour
    assert len({info["color"] for info in list(named.values())[:20]}) == 20


def test_the_map_has_its_unit_and_its_camera(record, tmp_path):
    """Of 16 bits, of floats, and what is missing is 0."""
    random = np.random.default_rng(2)
    v, u = np.mgrid[0:60, 0:80]
    millimetres = np.round(1500 + 4 * v + 2 * u + random.normal(0, 1, u.shape)).astype(np.uint16)
    millimetres[10:20, 10:20] = 0
    for name, values, encoding, unit in [("16", millimetres, "millimetre", 1000), ("f", None, "metre", 1)]:
        folder = tmp_path / name
        folder.mkdir()
        if values is None:
            values = np.where(millimetres > 0, millimetres / np.float32(1000), np.nan).astype(np.float32)
            np.save(folder / "0.npy", values)
        else:
            cv2.imwrite(str(folder / "0.png"), values)
        path = record(folder, "--encoding", encoding, "--intrinsics", f"{FOCAL_PX},{FOCAL_PX},39.5,29.5")
        depth = rows(path, f"{CAMERA}/image/depth")[0]
        assert np.array_equal(image(depth), np.nan_to_num(values)) and depth["meter"] == [unit]
        camera = rows(path, f"{CAMERA}/image")[0]
        assert np.allclose(camera["image_from_camera"][0], [FOCAL_PX, 0, 0, 0, FOCAL_PX, 0, 39.5, 29.5, 1])
        assert camera["resolution"] == [[80, 60]]
        # Without a pose x is ahead and z is up.
        assert np.allclose(rows(path, CAMERA)[0]["quaternion"][0], [-0.5, 0.5, -0.5, 0.5])


def test_the_ground_is_that_of_track(record, track):
    source = "scene:corridor:sensor=kinect,size=320x240,frames=3"
    path, (lines, labels) = record(source, "--floor"), track(source, "--floor")
    ground, normals = rows(path, f"{CAMERA}/image/ground"), rows(path, f"{CAMERA}/planes/normals")
    for frame, (line, ids) in enumerate(zip(lines, labels)):
        by_label = {plane["label"]: plane["class"] for plane in line["ground"]["planes"]}
        classes = {plane["id"]: by_label[plane["label"]] for plane in line["planes"]}
        for label in normals[frame]["labels"]:
            id, *name = label.split(" ")
            assert (name or ["other"]) == [classes[int(id)]]
        floor = np.isin(ids, [id for id, name in classes.items() if name == "floor"])
        assert (image(ground[frame])[floor] == 1).mean() > 0.95 and floor.sum() > 1000


def test_what_is_killed_leaves_whole_messages(rerun_program, tmp_path):
    path = tmp_path / "out.rrd"
    source = "scene:boxes:sensor=kinect,size=160x120,frames=100000"
    with subprocess.Popen([rerun_program, source, "--out", path], stderr=subprocess.DEVNULL) as running:
        while not path.exists() or path.stat().st_size < 500_000:
            time.sleep(0.05)
            assert running.poll() is None
        running.send_signal(signal.SIGKILL)
    found = rows(path, f"{CAMERA}/image/ids")
    assert len(found) > 3 and set(found) == set(range(len(found)))


def test_what_is_interrupted_is_whole(rerun_program, tmp_path):
    path = tmp_path / "out.rrd"
    source = "scene:boxes:sensor=kinect,size=160x120,frames=100000"
    with subprocess.Popen([rerun_program, source, "--out", path], stderr=subprocess.PIPE, text=True) as running:
        while not path.exists() or path.stat().st_size < 200_000:
            time.sleep(0.05)
            assert running.poll() is None
        running.send_signal(signal.SIGINT)
        said = running.stderr.read()
    assert running.returncode == 130 and "0 failed" in said
    # Only a whole file has the table by which messages are found.
    assert len(RrdReader(str(path)).store()) > 10
    found = rows(path, f"{CAMERA}/planes/outlines")
    assert set(found) == set(range(len(found)))


def test_a_frame_that_cannot_be_read_is_logged(rerun_program, tmp_path):
    folder = tmp_path / "maps"
    folder.mkdir()
    cv2.imwrite(str(folder / "0.png"), np.full((48, 64), 1000, np.uint16))
    (folder / "1.png").write_bytes(b"\x89PNG\r\n\x1a\nbroken")
    path = tmp_path / "out.rrd"
    command = [rerun_program, folder, "--out", path, "--encoding", "millimetre"]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 2 and "1 frames, 1 failed" in done.stderr
    log = rows(path, "/log")[1]
    assert "1.png" in log["text"][0] and log["level"] == ["ERROR"]
    # No camera: labels alone.
    assert rows(path, f"{CAMERA}/planes/outlines")[0]["strips"] == []
    assert rows(path, f"{CAMERA}/image") == {}
