"""Messages of the ROS 2 node lie in bytes as the package rosbags writes them, in each release of ROS that is in use."""

import numpy as np
import pytest
from rosbags.typesys import Stores, get_typestore

from conftest import ROOT

GOLDEN = ROOT / "crates" / "depthplanes-ros2" / "tests" / "golden"
RELEASES = [Stores.ROS2_HUMBLE, Stores.ROS2_JAZZY, Stores.ROS2_KILTED]


@pytest.fixture(params=RELEASES, ids=lambda release: release.value)
def store(request):
    return get_typestore(request.param)


@pytest.fixture
def make(store):
    """Makes a message of a type by its fields."""
    def make(kind, **fields):
        package, name = kind.split("/")
        return store.types[f"{package}/msg/{name}"](**fields)
    return make


@pytest.fixture
def header(make):
    stamp = make("builtin_interfaces/Time", sec=1_700_000_000, nanosec=123_456_789)
    return make("std_msgs/Header", stamp=stamp, frame_id="camera_depth_optical_frame")


def check(store, kind, message):
    package, name = kind.split("/")
    written = bytes(store.serialize_cdr(message, f"{package}/msg/{name}"))
    ours = (GOLDEN / f"{name}.cdr").read_bytes()
    # rosbags fills the last word up; what stands behind the last field says nothing.
    assert written.rstrip(b"\0") == ours.rstrip(b"\0") and abs(len(written) - len(ours)) < 4
    assert store.serialize_cdr(store.deserialize_cdr(ours, f"{package}/msg/{name}"), f"{package}/msg/{name}") == written


def vector(make, x, y, z, kind="Vector3"):
    return make(f"geometry_msgs/{kind}", x=x, y=y, z=z)


def quaternion(make, x, y, z, w):
    return make("geometry_msgs/Quaternion", x=x, y=y, z=z, w=w)


def test_image(store, make, header):
    data = np.array([1, 2, 3, 4, 5, 6, 0, 0, 7, 8, 9, 10, 11, 12, 0, 0], np.uint8)
    image = make("sensor_msgs/Image", header=header, height=2, width=3, encoding="16UC1", is_bigendian=1, step=8, data=data)
    check(store, "sensor_msgs/Image", image)


def test_camera_info(store, make, header):
    roi = make("sensor_msgs/RegionOfInterest", x_offset=4, y_offset=5, height=6, width=7, do_rectify=True)
    camera = make(
        "sensor_msgs/CameraInfo", header=header, height=480, width=640, distortion_model="plumb_bob",
        d=np.array([0.1, -0.2, 0.001, 0.002, 0.3]), k=np.array([580.0, 0, 319.5, 0, 581, 239.5, 0, 0, 1]),
        r=np.eye(3).ravel(), p=np.array([580.0, 0, 319.5, -40, 0, 581, 239.5, 0, 0, 0, 1, 0]),
        binning_x=2, binning_y=3, roi=roi)
    check(store, "sensor_msgs/CameraInfo", camera)


def test_string(store, make):
    check(store, "std_msgs/String", make("std_msgs/String", data='{"planes": 3}'))


def test_transforms(store, make, header):
    transform = make("geometry_msgs/Transform", translation=vector(make, 0.1, 1.2, -0.3),
                     rotation=quaternion(make, 0.5, -0.5, 0.5, -0.5))
    transforms = [make("geometry_msgs/TransformStamped", header=header, child_frame_id=child, transform=transform)
                  for child in ("floor", "ceiling")]
    check(store, "tf2_msgs/TFMessage", make("tf2_msgs/TFMessage", transforms=transforms))


def test_markers(store, make, header):
    def marker(**fields):
        none = make("std_msgs/Header", stamp=make("builtin_interfaces/Time", sec=0, nanosec=0), frame_id="")
        texture = make("sensor_msgs/CompressedImage", header=none, format="", data=np.array([], np.uint8))
        pose = make("geometry_msgs/Pose", position=vector(make, 0.0, 0.0, 0.0, "Point"),
                    orientation=quaternion(make, 0.0, 0.0, 0.0, 1.0))
        defaults = dict(
            header=none, ns="", id=0, type=0, action=0, pose=pose, scale=vector(make, 0.0, 0.0, 0.0),
            color=make("std_msgs/ColorRGBA", r=0.0, g=0.0, b=0.0, a=0.0),
            lifetime=make("builtin_interfaces/Duration", sec=0, nanosec=0), frame_locked=False, points=[], colors=[],
            texture_resource="", texture=texture, uv_coordinates=[], text="", mesh_resource="",
            mesh_file=make("visualization_msgs/MeshFile", filename="", data=np.array([], np.uint8)),
            mesh_use_embedded_materials=False)
        return make("visualization_msgs/Marker", **(defaults | fields))

    def colour(red):
        return make("std_msgs/ColorRGBA", r=red, g=0.25, b=0.5, a=1.0)

    types = store.types["visualization_msgs/msg/Marker"]
    pose = make("geometry_msgs/Pose", position=vector(make, 1.0, 2.0, 3.0, "Point"),
                orientation=quaternion(make, 0.0, 0.6, 0.0, 0.8))
    everything = marker(
        header=header, ns="outlines", id=7, type=types.LINE_LIST, action=types.ADD, pose=pose,
        scale=vector(make, 0.01, 0.02, 0.03), color=colour(0.75),
        lifetime=make("builtin_interfaces/Duration", sec=2, nanosec=3), frame_locked=True,
        points=[vector(make, 0.5, 1.5, 2.5, "Point"), vector(make, 3.5, 4.5, 5.5, "Point")],
        colors=[colour(0.0), colour(1.0), colour(0.125)], texture_resource="texture",
        texture=make("sensor_msgs/CompressedImage", header=header, format="png", data=np.array([1, 2, 3], np.uint8)),
        uv_coordinates=[make("visualization_msgs/UVCoordinate", u=0.5, v=0.25)], text="12", mesh_resource="mesh",
        mesh_file=make("visualization_msgs/MeshFile", filename="file", data=np.array([9], np.uint8)),
        mesh_use_embedded_materials=True)
    gone = marker(action=types.DELETEALL)
    check(store, "visualization_msgs/MarkerArray", make("visualization_msgs/MarkerArray", markers=[gone, everything]))
