"""Recordings that the packages mcap, mcap-ros2-support and mcap-protobuf-support write are read, and what `track` records
is read by them."""

import base64
import io
import json
import os
import pathlib
import subprocess

import cv2
import jsonschema
import numpy as np
import pytest
import shapely
from foxglove_schemas_protobuf.CameraCalibration_pb2 import CameraCalibration
from foxglove_schemas_protobuf.FrameTransform_pb2 import FrameTransform
from foxglove_schemas_protobuf.RawImage_pb2 import RawImage
from foxglove_schemas_protobuf.SceneUpdate_pb2 import SceneUpdate
from google.protobuf.descriptor_pb2 import FileDescriptorSet
from mcap.reader import NonSeekingReader, make_reader
from mcap.writer import Writer as PlainWriter
from mcap_protobuf.decoder import DecoderFactory
from mcap_protobuf.writer import Writer as ProtobufWriter
from mcap_ros2.reader import read_ros2_messages

import recordings
from recordings import camera_info, image, payload, quantised, write_ros2

WIDTH, HEIGHT, FOCAL = 160, 120, 145.0
CAMERA = (FOCAL, FOCAL, 79.5, 59.5)
STEP_NS = 33_333_333
START_NS = 1_700_000_000_000_000_000
DEPTH, CAMERA_TOPIC = "/camera/depth/image_raw", "/camera/depth/camera_info"
IMAGE, COMPRESSED, CAMERA_INFO = (f"sensor_msgs/msg/{name}" for name in ("Image", "CompressedImage", "CameraInfo"))


def frames(count=4):
    """A floor and two walls with noise, millimetres; some pixels are missing."""
    random = np.random.default_rng(5)
    v, u = np.mgrid[0:HEIGHT, 0:WIDTH]
    x, y = (u - CAMERA[2]) / FOCAL, (v - CAMERA[3]) / FOCAL
    for index in range(count):
        with np.errstate(divide="ignore", invalid="ignore"):
            floor = np.where(y > 0, 0.7 / y, np.inf)
            side = np.where(x > 0, 1.1 / x, np.inf)
        depth = np.minimum(np.minimum(floor, side), 3.0 + 0.01 * index)
        millimetres = np.round(1000 * depth + random.normal(0, 1.5, depth.shape)).astype(np.uint16)
        millimetres[random.random(depth.shape) < 0.01] = 0
        yield millimetres


def times(count=4):
    return [START_NS + index * STEP_NS for index in range(count)]


@pytest.fixture
def track(program, tmp_path):
    """Runs `track` on a source; the lines, the label images, and how it ended."""
    def track(source, *flags, check=True):
        labels = tmp_path / "labels"
        for old in labels.glob("*.png"):
            old.unlink()
        command = [program, "track", source, "--out", "-", "--labels", labels, *flags]
        done = subprocess.run(command, capture_output=True, text=True)
        assert done.returncode == 0 or not check, done.stderr
        assert "panicked" not in done.stderr
        images = [cv2.imread(str(path), cv2.IMREAD_UNCHANGED) for path in sorted(labels.glob("*.png"))]
        return [json.loads(line) for line in done.stdout.splitlines()], images, done
    return track


@pytest.fixture
def folder(tmp_path):
    """The same frames as a folder of PNGs."""
    folder = tmp_path / "png"
    folder.mkdir()
    for time, values in zip(times(), frames()):
        cv2.imwrite(str(folder / f"{time}.png"), values)
    return folder


FLAGS = ["--intrinsics", ",".join(map(str, CAMERA)), "--encoding", "millimetre"]


def assert_same(found, expected):
    """The same planes, labels and times."""
    (lines, labels, _), (expected_lines, expected_labels, _) = found, expected
    assert len(lines) == len(expected_lines) == len(labels) == len(expected_labels) > 0
    for line, expected_line in zip(lines, expected_lines):
        assert line["planes"] == expected_line["planes"] and len(line["planes"]) >= 3
        assert line["time_s"] == pytest.approx(expected_line["time_s"], abs=1e-3)
    for image, expected_image in zip(labels, expected_labels):
        assert np.array_equal(image, expected_image)


def with_camera(messages):
    return [(CAMERA_TOPIC, CAMERA_INFO, camera_info(WIDTH, HEIGHT, *CAMERA, START_NS), START_NS)] + messages


@pytest.mark.parametrize("compression", ["none", "lz4", "zstd"])
@pytest.mark.parametrize("form", ["16UC1", "mono16 big-endian padded", "png", "rvl"])
def test_millimetres_are_those_of_the_folder(track, tmp_path, folder, compression, form):
    path = tmp_path / "walk.mcap"
    messages = []
    for time, values in zip(times(), frames()):
        if form in ("png", "rvl"):
            message = {"header": recordings.stamp(time), "format": f"16UC1; compressedDepth {form}",
                       "data": payload(values, form)}
            messages.append((DEPTH + "/compressedDepth", COMPRESSED, message, time))
        else:
            odd = form != "16UC1"
            message = image(values, form.split()[0], time, big_endian=odd, padding=10 * odd)
            messages.append((DEPTH, IMAGE, message, time))
    write_ros2(path, with_camera(messages), compression, chunk_size=60_000)
    assert [message.ros_msg.header.stamp.sec for message in read_ros2_messages(str(path))][0] == START_NS // 10**9
    assert_same(track(path), track(folder, *FLAGS))


@pytest.mark.parametrize("form", ["32FC1", "32FC1 big-endian"])
def test_metres_are_those_of_a_folder_of_floats(track, tmp_path, form):
    path, folder = tmp_path / "walk.mcap", tmp_path / "npy"
    folder.mkdir()
    messages = []
    for time, values in zip(times(), frames()):
        metres = np.where(values > 0, values / np.float32(1000), np.nan).astype(np.float32)
        np.save(folder / f"{time}.npy", metres)
        messages.append((DEPTH, IMAGE, image(metres, "32FC1", time, big_endian="big" in form), time))
    write_ros2(path, with_camera(messages))
    assert_same(track(path), track(folder, *FLAGS[:2], "--encoding", "metre"))


@pytest.mark.parametrize("codec", ["png", "rvl"])
def test_quantised_metres_are_undone_by_a_and_b(track, tmp_path, codec):
    """Of the same numbers in a payload of their own, and within a step of the true planes."""
    path, folder = tmp_path / "walk.mcap", tmp_path / "payloads"
    folder.mkdir()
    messages = []
    for time, values in zip(times(), frames()):
        packed = payload(*[(x := quantised(values / 1000))[0], codec, x[1], x[2]])
        (folder / f"{time}.compressedDepth").write_bytes(packed)
        message = {"header": recordings.stamp(time), "format": f"32FC1; compressedDepth {codec}", "data": packed}
        messages.append((DEPTH + "/compressedDepth", COMPRESSED, message, time))
    write_ros2(path, with_camera(messages))
    found = track(path)
    assert_same(found, track(folder, *FLAGS[:2]))
    wall = max(found[0][0]["planes"], key=lambda plane: -plane["normal"][2])
    assert wall["distance_m"] == pytest.approx(3.0, abs=0.02)


def test_a_quantised_frame_with_nothing_in_it_is_no_error(track, tmp_path):
    path = tmp_path / "walk.mcap"
    _, a, b = quantised(np.ones((1, 1)))
    data = payload(np.zeros((HEIGHT, WIDTH), np.uint16), "png", a, b)
    message = {"header": recordings.stamp(START_NS), "format": "32FC1; compressedDepth png", "data": data}
    write_ros2(path, with_camera([(DEPTH + "/compressedDepth", COMPRESSED, message, START_NS)]))
    (line,), (labels,), _ = track(path)
    assert line["planes"] == [] and not labels.any()


def test_a_camera_is_that_beside_its_topic_with_binning_and_region(track, tmp_path, folder):
    """A camera of the whole sensor, of which the map is a binned region; another camera is in the file as well."""
    path = tmp_path / "walk.mcap"
    fx, fy, cx, cy = CAMERA
    info = camera_info(400, 300, 2 * fx, 2 * fy, 2 * cx + 40, 2 * cy + 20, START_NS, binning=2, roi=(40, 20, 320, 240))
    colour = camera_info(640, 480, 525.0, 525.0, 319.5, 239.5, START_NS)
    rgb = {"header": recordings.stamp(START_NS, "colour"), "height": 2, "width": 2, "encoding": "rgb8",
           "is_bigendian": 0, "step": 6, "data": bytes(12)}
    messages = [("/camera/color/camera_info", CAMERA_INFO, colour, START_NS),
                (CAMERA_TOPIC, CAMERA_INFO, info, START_NS), ("/camera/color/image_raw", IMAGE, rgb, START_NS)]
    messages += [(DEPTH, IMAGE, image(values, "16UC1", time), time) for time, values in zip(times(), frames())]
    write_ros2(path, messages)
    assert_same(track(path), track(folder, *FLAGS))


def test_a_camera_elsewhere_is_taken_by_its_frame_of_coordinates(track, tmp_path, folder):
    path = tmp_path / "walk.mcap"
    messages = [("/static/camera", CAMERA_INFO, camera_info(WIDTH, HEIGHT, *CAMERA, START_NS), START_NS)]
    messages += [(DEPTH, IMAGE, image(values, "16UC1", time), time) for time, values in zip(times(), frames())]
    write_ros2(path, messages)
    assert_same(track(path), track(folder, *FLAGS))


@pytest.mark.parametrize("compression", ["none", "lz4", "zstd"])
def test_a_file_that_is_cut_off_gives_its_whole_messages(track, tmp_path, compression):
    path = tmp_path / "walk.mcap"
    messages = [(DEPTH, IMAGE, image(values, "16UC1", time), time) for time, values in zip(times(8), frames(8))]
    write_ros2(path, with_camera(messages), compression, chunk_size=50_000)
    whole, _, _ = track(path)
    bytes_of_file, seen = path.read_bytes(), set()
    for share in (0.35, 0.55, 0.75, 0.95):
        path.write_bytes(bytes_of_file[:int(share * len(bytes_of_file))])
        lines, _, done = track(path, check=False)
        assert done.returncode == 2 and "error" in lines[-1] and "the file ends" in lines[-1]["error"], lines[-1]
        good = lines[:-1]
        assert [line["planes"] for line in good] == [line["planes"] for line in whole[:len(good)]]
        # A summary and what is not packed yet are small: frames are spread evenly over the file.
        assert len(good) >= int(8 * share) - 2
        seen.add(len(good))
    assert len(seen) >= 3


@pytest.mark.parametrize("encoding", ["protobuf", "json"])
def test_foxgloves_images_are_those_of_the_folder(track, tmp_path, folder, encoding):
    path = tmp_path / "walk.mcap"
    fx, fy, cx, cy = CAMERA
    k = [fx, 0.0, cx, 0.0, fy, cy, 0.0, 0.0, 1.0]
    with open(path, "wb") as file:
        if encoding == "protobuf":
            writer = ProtobufWriter(file)
            calibration = CameraCalibration(frame_id="depth", width=WIDTH, height=HEIGHT, K=k)
            writer.write_message("/depth/calibration", calibration, log_time=START_NS)
        else:
            writer = PlainWriter(file)
            writer.start()
            ids = []
            for topic, name in [("/depth/image", "foxglove.RawImage"),
                                ("/depth/calibration", "foxglove.CameraCalibration")]:
                schema = writer.register_schema(name, "jsonschema", b"{}")
                ids.append(writer.register_channel(topic, "json", schema))
            calibration = {"frame_id": "depth", "width": WIDTH, "height": HEIGHT, "K": k, "D": [], "R": [], "P": []}
            writer.add_message(ids[1], START_NS, json.dumps(calibration).encode(), START_NS)
        for time, values in zip(times(), frames()):
            if encoding == "protobuf":
                raw = RawImage(frame_id="depth", width=WIDTH, height=HEIGHT, encoding="16UC1", step=2 * WIDTH,
                               data=values.tobytes())
                raw.timestamp.FromNanoseconds(time)
                writer.write_message("/depth/image", raw, log_time=time)
            else:
                raw = {"timestamp": {"sec": time // 10**9, "nsec": time % 10**9}, "frame_id": "depth", "width": WIDTH,
                       "height": HEIGHT, "encoding": "16UC1", "step": 2 * WIDTH,
                       "data": base64.b64encode(values.tobytes()).decode()}
                writer.add_message(ids[0], time, json.dumps(raw).encode(), time)
        writer.finish()
    assert_same(track(path), track(folder, *FLAGS))


def test_messages_come_by_their_log_time(track, tmp_path, folder):
    """Written in another order, in chunks that overlap in time."""
    path = tmp_path / "walk.mcap"
    messages = [(DEPTH, IMAGE, image(values, "16UC1", time), time) for time, values in zip(times(), frames())]
    first, second, third, fourth = messages
    write_ros2(path, with_camera([second, fourth, first, third]), chunk_size=80_000)
    assert_same(track(path), track(folder, *FLAGS))


def test_a_bag_is_its_files_in_order_and_sqlite_is_refused(track, tmp_path, folder):
    bag = tmp_path / "bag"
    bag.mkdir()
    messages = [(DEPTH, IMAGE, image(values, "16UC1", time), time) for time, values in zip(times(), frames())]
    write_ros2(bag / "z.mcap", with_camera(messages[:2]))
    write_ros2(bag / "a.mcap", messages[2:])
    metadata = ("rosbag2_bagfile_information:\n  version: 9\n  storage_identifier: {}\n"
                "  relative_file_paths:\n{}  message_count: 5\n")
    (bag / "metadata.yaml").write_text(metadata.format("mcap", "    - z.mcap\n    - a.mcap\n"))
    expected = track(folder, *FLAGS)
    assert_same(track(bag), expected)
    assert_same(track(f"{bag}:{DEPTH}"), expected)
    (bag / "metadata.yaml").write_text(metadata.format("sqlite3", "    - bag_0.db3\n"))
    (bag / "bag_0.db3").write_bytes(b"SQLite format 3\0")
    _, _, done = track(bag, check=False)
    assert done.returncode == 2 and "ros2 bag convert -i" in done.stderr


def test_several_depth_topics_are_listed_ready_to_type(track, tmp_path, folder):
    path = tmp_path / "walk.mcap"
    messages = []
    for time, values in zip(times(), frames()):
        messages += [(DEPTH, IMAGE, image(values, "16UC1", time), time),
                     ("/other/depth", IMAGE, image(values // 2, "16UC1", time), time)]
    write_ros2(path, with_camera(messages))
    _, _, done = track(path, check=False)
    assert done.returncode == 2
    assert f"2 topics have depth; accepted: {path}:{DEPTH} (16UC1), {path}:/other/depth (16UC1)" in done.stderr
    assert_same(track(f"{path}:{DEPTH}"), track(folder, *FLAGS))
    _, _, done = track(f"{path}:/nowhere", check=False)
    assert done.returncode == 2 and "no pictures in a topic /nowhere" in done.stderr


SCENE = "scene:boxes:sensor=kinect,size=320x240,frames=6"


def messages_of(stream):
    """Topic, schema and decoded message, by the package's own readers."""
    factory = DecoderFactory()
    decoders = {}
    for schema, channel, message in NonSeekingReader(stream, validate_crcs=True).iter_messages(log_time_order=False):
        if schema.encoding == "jsonschema":
            yield channel.topic, schema, json.loads(message.data), message.log_time
        else:
            decode = decoders.setdefault(channel.id, factory.decoder_for(channel.message_encoding, schema))
            yield channel.topic, schema, decode(message.data), message.log_time


@pytest.fixture
def recorded(program, tmp_path):
    """What `track` records of a scene, and the same as lines and label images."""
    for out, more in [("out.mcap", []), ("out.jsonl", ["--labels", tmp_path / "labels"])]:
        subprocess.run([program, "track", SCENE, "--out", tmp_path / out, *more], check=True, capture_output=True)
    lines = [json.loads(line) for line in (tmp_path / "out.jsonl").read_text().splitlines()]
    labels = [cv2.imread(str(path), cv2.IMREAD_UNCHANGED) for path in sorted((tmp_path / "labels").glob("*.png"))]
    return tmp_path / "out.mcap", lines, labels


def test_what_is_recorded_is_what_was_found(recorded):
    path, lines, labels = recorded
    with open(path, "rb") as file:
        summary = make_reader(file).get_summary()
        assert summary.statistics.message_count == 5 * len(lines) and summary.statistics.chunk_count == len(lines)
        file.seek(0)
        by_topic = {}
        for topic, schema, message, time in messages_of(file):
            by_topic.setdefault(topic, []).append((message, schema, time))
    assert [message for message, _, _ in by_topic["/depthplanes/planes"]] == lines
    for message, schema, time in by_topic["/depthplanes/planes"]:
        jsonschema.Draft202012Validator.check_schema(json.loads(schema.data))
        jsonschema.validate(message, json.loads(schema.data))
        assert time == round(message["time_s"] * 1e9)
    for (message, schema, _), expected in zip(by_topic["/depthplanes/labels"], labels):
        assert schema.name == "foxglove.RawImage" and message.encoding == "mono16"
        assert np.array_equal(np.frombuffer(message.data, "<u2").reshape(message.height, message.width), expected)
    camera, _, _ = by_topic["/depthplanes/camera"][0]
    assert [camera.width, camera.height] == [320, 240] and camera.K[0] == camera.P[0] > 100
    for (message, _, _), line in zip(by_topic["/tf"], lines):
        assert (message.parent_frame_id, message.child_frame_id) == ("world", "camera")
        x, y, z, w = (getattr(message.rotation, axis) for axis in "xyzw")
        matrix = [[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                  [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                  [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]]
        assert np.allclose(matrix, line["pose"]["rotation"], atol=1e-9)
        assert np.allclose([getattr(message.translation, axis) for axis in "xyz"], line["pose"]["translation_m"])


def overlap(entity, camera, mask):
    """Intersection over union of a plane's outline, as the camera sees it, and its pixels."""
    fx, _, cx, _, fy, cy, *_ = camera.K
    shape = shapely.Polygon()
    for line in entity.lines:  # holes are taken out
        ring = [(fx * point.x / point.z + cx, fy * point.y / point.z + cy) for point in line.points]
        shape = shape.symmetric_difference(shapely.Polygon(ring).buffer(0))
    v, u = np.mgrid[0:mask.shape[0], 0:mask.shape[1]]
    inside = shapely.contains_xy(shape, u, v)
    return (inside & mask).sum() / (inside | mask).sum()


def test_the_scene_is_the_planes_outlines_and_what_is_gone_is_deleted(recorded):
    path, lines, labels = recorded
    shown, deleted = set(), 0
    with open(path, "rb") as file:
        messages = [(topic, message) for topic, _, message, _ in messages_of(file)]
    scenes = [message for topic, message in messages if topic == "/depthplanes/scene"]
    camera = next(message for topic, message in messages if topic == "/depthplanes/camera")
    for scene, line, image in zip(scenes, lines, labels):
        shown -= {deletion.id for deletion in scene.deletions}
        deleted += len(scene.deletions)
        shown |= {entity.id for entity in scene.entities}
        planes = {str(plane["id"]): plane for plane in line["planes"]}
        assert shown == {entity.id for entity in scene.entities} <= set(planes)
        assert len(shown) >= 0.9 * len(planes)
        for entity in scene.entities:
            plane = planes[entity.id]
            points = np.array([[point.x, point.y, point.z] for line in entity.lines for point in line.points])
            # Corners lie on the plane of this frame, which the filtered one is near.
            off = points @ np.array(plane["normal"]) + plane["distance_m"]
            assert min(np.abs(off).max(), np.abs(off - 2 * plane["distance_m"]).max()) < 0.05 * points[:, 2].max()
            if plane["pixel_count"] >= 1000:
                assert overlap(entity, camera, image == plane["id"]) > (0.85 if plane["pixel_count"] < 5000 else 0.95)
            assert entity.texts[0].text == entity.id and entity.frame_id == "camera"
            place = entity.texts[0].pose.position
            assert np.allclose([place.x, place.y, place.z], plane["centroid_m"])


CLASSES = [SceneUpdate, RawImage, CameraCalibration, FrameTransform]


def descriptions():
    """The files of all messages that are recorded, those that others need first."""
    described, known = FileDescriptorSet(), set()

    def add(file):
        if file.name not in known:
            known.add(file.name)
            for needed in file.dependencies:
                add(needed)
            file.CopyToProto(described.file.add())

    for cls in CLASSES:
        add(cls.DESCRIPTOR.file)
    return described


def test_the_descriptions_are_those_of_foxgloves_package(recorded):
    """DEPTHPLANES_GOLDEN=update writes them anew, for another version of the package."""
    path, _, _ = recorded
    if os.environ.get("DEPTHPLANES_GOLDEN") == "update":
        assets = pathlib.Path(__file__).resolve().parents[2] / "crates/depthplanes-cli/src/commands/track/assets"
        (assets / "foxglove.binpb").write_bytes(descriptions().SerializeToString(deterministic=True))
    with open(path, "rb") as file:
        schemas = make_reader(file).get_summary().schemas.values()
    seen = {schema.name: schema for schema in schemas if schema.encoding == "protobuf"}
    assert set(seen) == {cls.DESCRIPTOR.full_name for cls in CLASSES}
    assert all(FileDescriptorSet.FromString(schema.data) == descriptions() for schema in seen.values())


@pytest.mark.parametrize("share", [0.3, 0.6, 0.9])
def test_a_recording_that_was_cut_off_has_its_whole_chunks(recorded, share):
    path, lines, _ = recorded
    whole = path.read_bytes()
    cut = io.BytesIO(whole[:int(share * len(whole))])
    found = []
    try:
        for topic, _, message, _ in messages_of(cut):
            if topic == "/depthplanes/planes":
                found.append(message)
    except Exception as error:  # the package says that the end is missing
        assert "end of file" in str(error).lower() or "EndOfFile" in type(error).__name__
    assert found == lines[:len(found)] and len(found) >= int(share * len(lines)) - 1
