"""What Python costs over Rust, and that threads of Python run at the same time. Figures are printed, bounds are loose."""

import hashlib
import os
import statistics
import threading
import time

import numpy as np
import pytest

import depthplanes

CALLS = 200
#: Most of a call over the Rust call inside it, microseconds and share, that a tenth of the calls must be below: the aim is 30 us
#: for the median. Other programs take the caches and the cores away, from the Rust call too.
OVERHEAD_US, SHARE = 100, 0.03
CAMERA = (525.0, 525.0, 319.5, 239.5)


@pytest.fixture(scope="module")
def frames(data):
    """Frames of a Kinect in memory, 640 x 480, 16-bit millimetres; 65535 was 0 in the camera."""
    paths = sorted((data / "video_7scenes").rglob("*depth.png"))[:8]
    frames = [depthplanes.read(path, sensor="7-scenes").depth for path in paths]
    assert len(frames) == 8 and all(frame.shape == (480, 640) for frame in frames)
    return [np.where(frame == 65535, np.uint16(0), frame) for frame in frames]


@pytest.mark.parametrize("unit, convert", [("mm", np.array), ("m", lambda depth: (depth / 1000).astype(np.float32))])
def test_a_call_costs_little_over_the_rust_call(frames, tell, unit, convert):
    frames = [convert(frame) for frame in frames]
    detector = depthplanes.Detector(camera=CAMERA, unit=unit)
    detector(frames[0])
    over, inside = [], []
    for call in range(CALLS):
        start = time.perf_counter()
        planes = detector(frames[call % len(frames)])
        taken = time.perf_counter() - start
        over.append(1e6 * (taken - planes.seconds))
        inside.append(1e3 * planes.seconds)
    tenth, median = statistics.quantiles(over, n=10)[0], statistics.median(over)
    what = f"{median:.1f} us over the Rust call of {statistics.median(inside):.2f} ms, medians of {CALLS}; a tenth less than {tenth:.1f} us"
    tell(f"640 x 480 {frames[0].dtype}: {what}:")
    assert tenth < max(OVERHEAD_US, 1e3 * SHARE * statistics.median(inside))


def test_four_threads_scale_as_the_cores_do(frames, tell):
    """Beside hashing, which needs no more than the cores that other programs leave, in turn."""
    detector = depthplanes.Detector(camera=CAMERA)
    detector(frames[0])
    calls, block = 80, bytes(10_000_000)

    def find(count):
        for call in range(count):
            detector(frames[call % len(frames)])

    def check_sums(count):
        for _ in range(count):
            hashlib.sha256(block)

    def seconds(work, count, threads):
        all_of = [threading.Thread(target=work, args=(count // threads,)) for _ in range(threads)]
        start = time.perf_counter()
        for thread in all_of:
            thread.start()
        for thread in all_of:
            thread.join()
        return time.perf_counter() - start

    gains = {find: [], check_sums: []}
    seconds(find, 8, 4)  # each thread makes its detector
    for _ in range(5):
        for work, count in ((find, calls), (check_sums, 20)):
            gains[work].append(seconds(work, count, 1) / seconds(work, count, 4))
    ours, others = (statistics.median(of) for of in gains.values())
    cores = len(os.sched_getaffinity(0))
    tell(f"4 threads find planes {ours:.2f} times as fast as 1, and hash {others:.2f} times as fast, on {cores} cores:")
    assert ours > 0.7 * others
