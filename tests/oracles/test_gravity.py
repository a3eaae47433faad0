"""Up by an inertial sensor: bags that the package rosbags writes, of a camera at known tilts above a floor."""

import json
import subprocess

import numpy as np
import pytest
from rosbags.rosbag2 import StoragePlugin, Writer
from rosbags.typesys import Stores, get_typestore

WIDTH, HEIGHT, FOCAL = 160, 120, 145.0
START_NS, FRAME_NS, READING_NS = 1_700_000_000_000_000_000, 33_333_333, 5_000_000
HEIGHT_M, WALL_M, GRAVITY = 1.2, 2.5, 9.81
DEPTH, CAMERA, IMU = "/camera/depth/image_rect_raw", "/camera/depth/camera_info", "/imu/data"
OPTICAL, SENSOR = "camera_depth_optical_frame", "imu_link"
UNKNOWN = np.array([-1.0] + 8 * [0.0])


def matrix(quaternion):
    x, y, z, w = quaternion
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                     [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                     [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]])


def random_turns(seed):
    """Frames in their parents as quaternions: the camera and the sensor on a base, each turned as it likes, and the optical
    frame that REP 103 has in the camera's."""
    random = np.random.default_rng(seed)
    turns = [quaternion / np.linalg.norm(quaternion) for quaternion in random.normal(size=(2, 4))]
    return [("base_link", "camera_link", turns[0]), ("camera_link", OPTICAL, np.array([-0.5, 0.5, -0.5, 0.5])),
            ("base_link", SENSOR, turns[1])]


def camera_of_sensor(turns):
    """The rotation of the sensor's axes into the camera's."""
    camera, optical, sensor = (matrix(turn) for _, _, turn in turns)
    return (camera @ optical).T @ sensor


def up_of(tilt_deg, roll_deg=0.0):
    """Up of a camera that looks down by the tilt and has its right side lower by the roll, x right, y down, z ahead."""
    tilt, roll = np.radians([tilt_deg, roll_deg])
    return np.array([-np.cos(tilt) * np.sin(roll), -np.cos(tilt) * np.cos(roll), -np.sin(tilt)])


def depth_of(up, random):
    """A floor, and a wall ahead if the camera does not look straight down; millimetres with noise."""
    v, u = np.mgrid[0:HEIGHT, 0:WIDTH]
    rays = np.stack([(u - (WIDTH - 1) / 2) / FOCAL, (v - (HEIGHT - 1) / 2) / FOCAL, np.ones_like(u, float)], axis=-1)
    down = -(rays @ up)
    depth = np.where(down > 1e-6, HEIGHT_M / np.maximum(down, 1e-6), np.inf)
    ahead = np.array([0.0, 0.0, 1.0]) - up[2] * up
    if np.linalg.norm(ahead) > 0.1:
        facing = rays @ (ahead / np.linalg.norm(ahead))
        depth = np.minimum(depth, np.where(facing > 1e-6, WALL_M / np.maximum(facing, 1e-6), np.inf))
    return np.round(1000 * np.minimum(depth, 60) + random.normal(0, 1.5, depth.shape)).astype(np.uint16)


class Bag:
    """A bag that rosbags writes."""

    def __init__(self, path, release=Stores.ROS2_JAZZY):
        self.store = get_typestore(release)
        self.writer = Writer(path, version=9, storage_plugin=StoragePlugin.MCAP)
        self.writer.open()
        self.connections = {}

    def make(self, kind, **fields):
        package, name = kind.split("/")
        return self.store.types[f"{package}/msg/{name}"](**fields)

    def header(self, time_ns, frame_id):
        stamp = self.make("builtin_interfaces/Time", sec=time_ns // 10**9, nanosec=time_ns % 10**9)
        return self.make("std_msgs/Header", stamp=stamp, frame_id=frame_id)

    def vector(self, kind, values):
        return self.make(f"geometry_msgs/{kind}", **dict(zip("xyzw", map(float, values))))

    def write(self, topic, kind, time_ns, **fields):
        package, name = kind.split("/")
        kind = f"{package}/msg/{name}"
        if topic not in self.connections:
            self.connections[topic] = self.writer.add_connection(topic, kind, typestore=self.store)
        message = self.store.types[kind](**fields)
        self.writer.write(self.connections[topic], time_ns, self.store.serialize_cdr(message, kind))

    def transforms(self, turns, topic="/tf_static"):
        place = self.vector("Vector3", [0.1, 0.0, 0.2])
        made = [self.make("geometry_msgs/TransformStamped", header=self.header(START_NS, parent), child_frame_id=child,
                          transform=self.make("geometry_msgs/Transform", translation=place,
                                              rotation=self.vector("Quaternion", turn)))
                for parent, child, turn in turns]
        self.write(topic, "tf2_msgs/TFMessage", START_NS, transforms=made)

    def reading(self, time_ns, force, rate=None, topic=IMU, frame_id=SENSOR):
        self.write(topic, "sensor_msgs/Imu", time_ns, header=self.header(time_ns, frame_id),
                   orientation=self.vector("Quaternion", [0, 0, 0, 1]), orientation_covariance=UNKNOWN,
                   angular_velocity=self.vector("Vector3", [0, 0, 0] if rate is None else rate),
                   angular_velocity_covariance=UNKNOWN if rate is None else np.zeros(9),
                   linear_acceleration=self.vector("Vector3", force), linear_acceleration_covariance=np.zeros(9))

    def frame(self, time_ns, depth):
        k = np.array([FOCAL, 0, (WIDTH - 1) / 2, 0, FOCAL, (HEIGHT - 1) / 2, 0, 0, 1])
        region = self.make("sensor_msgs/RegionOfInterest", x_offset=0, y_offset=0, height=0, width=0, do_rectify=False)
        self.write(CAMERA, "sensor_msgs/CameraInfo", time_ns, header=self.header(time_ns, OPTICAL), height=HEIGHT,
                   width=WIDTH, distortion_model="plumb_bob", d=np.zeros(5), k=k, r=np.eye(3).ravel(),
                   p=np.insert(k, [3, 6, 9], 0.0), binning_x=0, binning_y=0, roi=region)
        self.write(DEPTH, "sensor_msgs/Image", time_ns, header=self.header(time_ns, OPTICAL), height=HEIGHT, width=WIDTH,
                   encoding="16UC1", is_bigendian=0, step=2 * WIDTH, data=depth.view(np.uint8).ravel())

    def close(self):
        self.writer.close()


def write(path, up_at, frames=4, turns=random_turns(1), says=True, has_gyroscope=True, release=Stores.ROS2_JAZZY,
          push=lambda time_s: np.zeros(3)):
    """A bag of a camera whose up is a function of the time; the sensor reads 200 times a second, with noise."""
    bag, random = Bag(path, release), np.random.default_rng(3)
    if says:
        bag.transforms(turns)
    sensor_of_camera = camera_of_sensor(turns).T
    step_s = READING_NS * 1e-9
    for time_ns in range(0, frames * FRAME_NS, READING_NS):
        up, before = up_at(time_ns * 1e-9), up_at(time_ns * 1e-9 - step_s)
        force = sensor_of_camera @ (GRAVITY * up + push(time_ns * 1e-9)) + random.normal(0, 0.05, 3)
        # What stays in the world turns the other way: up' = -rate x up, here without a turn about up.
        rate = sensor_of_camera @ np.cross(up, before) / step_s + random.normal(0, 0.005, 3)
        bag.reading(START_NS + time_ns, force, rate if has_gyroscope else None)
    for index in range(frames):
        # A depth image comes a moment after the reading of its time.
        time_ns = index * FRAME_NS
        bag.frame(START_NS + time_ns + 1, depth_of(up_at(time_ns * 1e-9), random))
    bag.close()


@pytest.fixture
def track(program, tmp_path):
    """The record of the ground of each frame, and what was said."""
    def track(source, *flags):
        command = [program, "track", source, "--floor", "--out", "-", *flags]
        done = subprocess.run(command, capture_output=True, text=True)
        assert done.returncode == 0, done.stderr
        return [json.loads(line)["ground"] for line in done.stdout.splitlines()], done.stderr
    return track


def degrees(a, b):
    return np.degrees(np.arccos(np.clip(np.dot(a, b) / np.linalg.norm(a) / np.linalg.norm(b), -1, 1)))


@pytest.mark.parametrize("release", [Stores.ROS2_HUMBLE, Stores.ROS2_JAZZY], ids=lambda release: release.value)
@pytest.mark.parametrize("tilt, roll", [(10, 0), (35, -20), (60, 10), (90, 0), (20, 90), (15, 180)])
def test_the_floor_is_found_at_any_tilt(track, tmp_path, tilt, roll, release):
    """Also of cameras that look straight down, lie on their side or hang upside down."""
    up = up_of(tilt, roll)
    write(tmp_path / "bag", lambda _: up, turns=random_turns(tilt), release=release)
    grounds, said = track(tmp_path / "bag")
    assert len(grounds) == 4 and "up is not taken" not in said
    for ground in grounds:
        assert ground["up_from"] == "stated" and degrees(ground["up"], up) < 1.0
        floor = ground["floor"]
        assert degrees(floor["normal"], up) < 1.0 and floor["height_m"] == pytest.approx(HEIGHT_M, abs=0.02)
        assert floor["tilt_deg"] == pytest.approx(tilt, abs=1.0)


def test_what_is_stated_counts_before_it(track, tmp_path):
    write(tmp_path / "bag", lambda _: up_of(20))
    (ground, *_), _ = track(tmp_path / "bag", "--up", "0,-1,0.1")
    assert degrees(ground["up"], [0, -1, 0.1]) < 1e-6


@pytest.mark.parametrize("has_gyroscope, most_deg", [(True, 1.0), (False, 6.0)], ids=["gyroscope", "alone"])
def test_it_is_known_while_the_camera_nods(track, tmp_path, has_gyroscope, most_deg):
    """By 15 degrees each way, 23 degrees a second at most."""
    up_at = lambda time_s: up_of(30 + 15 * np.sin(1.5 * time_s))
    write(tmp_path / "bag", up_at, frames=60, has_gyroscope=has_gyroscope)
    grounds, _ = track(tmp_path / "bag")
    off = [degrees(ground["up"], up_at(index * FRAME_NS * 1e-9)) for index, ground in enumerate(grounds)]
    assert max(off) < most_deg and all(ground["floor"] for ground in grounds), max(off)


def test_a_robot_that_speeds_up_keeps_its_floor(track, tmp_path):
    """Half a second at 3 m/s2: a single reading is off by 17 degrees, which is none of a floor."""
    push = lambda time_s: np.array([0, 0, 3.0]) if 2.0 <= time_s < 2.5 else np.zeros(3)
    write(tmp_path / "bag", lambda _: up_of(20), frames=80, push=push)
    grounds, _ = track(tmp_path / "bag")
    off = [degrees(ground["up"], up_of(20)) for ground in grounds]
    assert 2.0 < max(off) < 6.0 and all(ground["floor"] for ground in grounds), max(off)


def test_without_a_chain_it_is_said_and_estimated(track, tmp_path):
    write(tmp_path / "bag", lambda _: up_of(10), says=False)
    grounds, said = track(tmp_path / "bag")
    assert f"no chain of transforms on /tf_static leads from its frame_id `{SENSOR}`" in said
    assert all(ground["up_from"] == "estimated" and ground["floor"] for ground in grounds)
    # What moves is no chain.
    bag = Bag(tmp_path / "moving")
    bag.transforms(random_turns(1), topic="/tf")
    bag.reading(START_NS, [0, 0, GRAVITY])
    bag.frame(START_NS + 1, depth_of(up_of(10), np.random.default_rng(3)))
    bag.close()
    _, said = track(tmp_path / "moving")
    assert "no chain of transforms" in said


def test_maps_in_a_frame_that_is_no_optical_one_are_said(track, tmp_path):
    """As some simulators publish them: x ahead and z up, which the pixels are not in."""
    bag, level = Bag(tmp_path / "bag"), np.array([0.0, 0.0, 0.0, 1.0])
    bag.transforms([("base_link", OPTICAL, level), ("base_link", SENSOR, level)])
    bag.reading(START_NS, [0, 0, GRAVITY])
    bag.frame(START_NS + 1, depth_of(up_of(20), np.random.default_rng(3)))
    bag.close()
    (ground,), said = track(tmp_path / "bag")
    assert ground["floor"] is None and "no frame has a floor with the up that the source says" in said


def test_one_of_several_sensors_is_stated(track, tmp_path):
    """A gyroscope alone, as RealSense's has a topic of its own, is none of them."""
    up = up_of(25)
    bag = Bag(tmp_path / "bag")
    for index in range(10):
        time_ns = START_NS + index * READING_NS
        bag.reading(time_ns, GRAVITY * up, topic="/camera/accel/sample", frame_id=OPTICAL)
        bag.reading(time_ns, [0, 0, 0], [0.01, 0, 0], topic="/camera/gyro/sample", frame_id=OPTICAL)
    bag.frame(time_ns + 1, depth_of(up, np.random.default_rng(3)))
    bag.close()
    (ground,), _ = track(tmp_path / "bag")
    assert degrees(ground["up"], up) < 1e-3
    bag, turns = Bag(tmp_path / "more"), random_turns(7)
    bag.transforms(turns)
    for topic in ["/a/imu", "/b/imu"]:
        bag.reading(START_NS, camera_of_sensor(turns).T @ (GRAVITY * up), topic=topic)
    bag.frame(START_NS + 1, depth_of(up, np.random.default_rng(3)))
    bag.close()
    (ground,), said = track(tmp_path / "more")
    stated = f"{tmp_path / 'more' / 'more.mcap'}:{DEPTH}:/a/imu"
    assert f"/a/imu nor /b/imu, of which one is to be stated: {stated}" in said and ground["up_from"] == "estimated"
    (ground,), said = track(stated)
    assert degrees(ground["up"], up) < 1e-3 and "is to be stated" not in said
