"""The pixels that we keep are those that cv2.filterSpeckles keeps, where it takes the map's values."""

import numpy as np
import pytest

import maps
from rivals import components, least_for_16_bits, speckle_mask, takes_speckles

RANDOM_MAPS_PER_TYPE = 2000
REAL_MAPS = 218
SIZES = [0, 1, 7, 32, 256]
REAL_CASES = [(1, 32), (2, 256), (16, 64)]  # theta, min-pixels


def check(worker, depth, theta, least, where):
    expected = speckle_mask(depth, theta, least)
    for kernel, images in zip(worker.kernels, worker.labels(depth, theta, least, 2)):
        for labels in images:
            assert np.array_equal(labels != 0, expected), f"{where}: theta {theta}, min-pixels {least}, kernel {kernel}"
    return expected


@pytest.mark.parametrize("kind", ["u8", "u16"])
def test_random_maps_keep_what_opencv_keeps(worker, tell, kind):
    compared, partly = 0, 0
    for number in range(RANDOM_MAPS_PER_TYPE):
        rng = np.random.default_rng([number, len(kind), 2])
        depth, theta, _ = maps.random_case(rng, kind, maps.PATTERNS[number % len(maps.PATTERNS)])
        if kind == "u16":
            depth &= 0x7FFF
        theta, least = int(theta), SIZES[number % len(SIZES)]
        assert takes_speckles(depth)
        kept = check(worker, depth, theta, least, f"{kind} map {number}")
        compared += 1
        partly += 0 < np.count_nonzero(kept) < np.count_nonzero(depth)
    tell(f"{compared} random {kind} maps against filterSpeckles, {partly} of them lost some pixels and kept some:")
    assert compared == RANDOM_MAPS_PER_TYPE >= 2000
    assert partly > 0.15 * RANDOM_MAPS_PER_TYPE


def test_real_maps_keep_what_opencv_keeps(worker, data, tell):
    seen, compared = set(), 0
    for path, depth in maps.real_maps(data):
        if not takes_speckles(depth):
            continue
        seen.add(path)
        for theta, least in REAL_CASES:
            check(worker, depth, theta, least_for_16_bits(*components(depth, theta), least), path)
            compared += 1
    tell(f"{len(seen)} real maps against filterSpeckles at {len(REAL_CASES)} pairs of theta and min-pixels:")
    assert len(seen) == REAL_MAPS
    assert compared == REAL_MAPS * len(REAL_CASES)
