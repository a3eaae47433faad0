"""The ROS 2 node and Eclipse Cyclone DDS, one of the middlewares that ROS runs on, understand each other."""

import json
import os
import random
import signal
import subprocess
import time

import numpy as np
import pytest

# Over 127.0.0.1 alone, without multicast; read when the package makes a domain.
os.environ["CYCLONEDDS_URI"] = """<CycloneDDS><Domain>
<General><Interfaces><NetworkInterface address="127.0.0.1" multicast="false"/></Interfaces>
<AllowMulticast>false</AllowMulticast></General>
<Discovery><ParticipantIndex>auto</ParticipantIndex><Peers><Peer address="127.0.0.1"/></Peers></Discovery>
</Domain></CycloneDDS>"""

from ros2_types import CameraInfo, Header, Image, RegionOfInterest, String, TFMessage, Time  # noqa: E402

from cyclonedds.core import Policy, Qos  # noqa: E402
from cyclonedds.domain import DomainParticipant  # noqa: E402
from cyclonedds.pub import DataWriter  # noqa: E402
from cyclonedds.sub import DataReader  # noqa: E402
from cyclonedds.topic import Topic  # noqa: E402
from cyclonedds.util import duration  # noqa: E402

WIDTH, HEIGHT, FOCAL, CAMERA_HEIGHT = 320, 240, 290.0, 0.8
CX, CY = (WIDTH - 1) / 2, (HEIGHT - 1) / 2
LIMIT_S = 60
SENSOR_DATA = Qos(Policy.Reliability.BestEffort, Policy.History.KeepLast(5))
DEFAULT = Qos(Policy.Reliability.Reliable(duration(seconds=1)), Policy.History.KeepLast(10))


def corridor():
    """A floor and walls to the left and right, millimetres."""
    v, u = np.mgrid[0:HEIGHT, 0:WIDTH]
    with np.errstate(divide="ignore", invalid="ignore"):
        floor = np.where(v > CY, CAMERA_HEIGHT * FOCAL / (v - CY), np.inf)
        walls = np.where(u != CX, 1.0 * FOCAL / np.abs(u - CX), np.inf)
    depth = np.minimum(floor, walls)
    return np.where(depth < 8, np.round(1000 * depth), 0).astype("<u2")


class Peer:
    def __init__(self, domain, folder, node):
        participant = DomainParticipant(domain)
        def topic(name, kind, qos):
            return participant, Topic(participant, f"rt{name}", kind, qos=qos)
        self.depth = DataWriter(*topic(f"{folder}/image", Image, SENSOR_DATA), qos=SENSOR_DATA)
        self.camera = DataWriter(*topic(f"{folder}/camera_info", CameraInfo, DEFAULT), qos=DEFAULT)
        self.labels = DataReader(*topic(f"{node}/labels", Image, SENSOR_DATA), qos=SENSOR_DATA)
        self.planes = DataReader(*topic(f"{node}/planes", String, DEFAULT), qos=DEFAULT)
        self.transforms = DataReader(*topic("/tf", TFMessage, DEFAULT), qos=DEFAULT)

    def publish(self, turn, pixels):
        header = Header(Time(1_700_000_000 + turn, 5), "optical")
        k = [FOCAL, 0, CX, 0, FOCAL, CY, 0, 0, 1]
        p = [FOCAL, 0, CX, 0, 0, FOCAL, CY, 0, 0, 0, 1, 0]
        eye = [1.0, 0, 0, 0, 1, 0, 0, 0, 1]
        region = RegionOfInterest(0, 0, 0, 0, False)
        self.camera.write(CameraInfo(header, HEIGHT, WIDTH, "plumb_bob", [0.0] * 5, k, eye, p, 0, 0, region))
        self.depth.write(Image(header, HEIGHT, WIDTH, "16UC1", 0, 2 * WIDTH, pixels.tobytes()))


@pytest.fixture
def meeting(ros2_program):
    domain, namespace = random.randint(1, 100), f"/test{random.getrandbits(32)}"
    flags = ["--localhost", "--domain-id", domain, "--namespace", namespace, "--depth", f"{namespace}/camera/image"]
    node = subprocess.Popen([ros2_program, *map(str, flags)], stderr=subprocess.PIPE, text=True)
    yield node, Peer(domain, f"{namespace}/camera", f"{namespace}/depthplanes")
    node.kill()
    node.wait()


def test_cyclone_dds_sends_images_and_gets_planes(meeting):
    node, peer = meeting
    labels, planes, transforms, start = {}, {}, {}, time.monotonic()
    pixels, turn = corridor(), 0
    while not (common := labels.keys() & planes.keys() & transforms.keys()):
        assert node.poll() is None, node.stderr.read()
        assert time.monotonic() - start < LIMIT_S, f"of {turn} images came {len(labels)} labels, {len(planes)} planes, {len(transforms)} /tf"
        peer.publish(turn, pixels)
        turn += 1
        time.sleep(0.1)
        labels |= {image.header.stamp.sec: image for image in peer.labels.take(20)}
        planes |= {int(json.loads(text.data)["time_s"]): json.loads(text.data) for text in peer.planes.take(20)}
        transforms |= {message.transforms[0].header.stamp.sec: message.transforms[0] for message in peer.transforms.take(20)}
    second = min(common)
    image, record, transform = labels[second], planes[second], transforms[second]
    assert (image.encoding, image.width, image.height, image.step) == ("mono16", WIDTH, HEIGHT, 2 * WIDTH)
    assert (image.header.frame_id, image.header.stamp.nanosec) == ("optical", 5)
    ids = np.frombuffer(bytes(image.data), "<u2").reshape(HEIGHT, WIDTH)
    assert {plane["id"]: plane["pixel_count"] for plane in record["planes"]} == {
        int(id): int(count) for id, count in zip(*np.unique(ids[ids > 0], return_counts=True))}
    assert len(record["planes"]) == 3
    assert abs(record["ground"]["floor"]["height_m"] - CAMERA_HEIGHT) < 0.005
    assert (transform.header.frame_id, transform.child_frame_id) == ("optical", "floor")
    place = transform.transform.translation
    assert np.allclose([place.x, place.y, place.z], [0, CAMERA_HEIGHT, 0], atol=0.005)
    node.send_signal(signal.SIGINT)
    assert node.wait(timeout=20) == 0
