"""Our label images equal cc3d's components, renumbered, label for label."""

import cc3d
import numpy as np
import pytest

import maps
from rivals import components, in_special_row, least_for_16_bits, renumbered, sizes_of
from worker import Refused

MAPS_PER_TYPE = 5008  # a multiple of the sixteen patterns
LARGE_MAPS_PER_TYPE = 48
REAL_MAPS = 229
THETAS = [0, 1, 2, 4, 8, 16, 32, 64]
THREADS = 2


def check(worker, depth, theta, least, where):
    """Compares one map on all kernels and threads; returns (components of cc3d, images compared)."""
    image, count = components(depth, theta)
    expected = renumbered(image, count, least)
    ours = worker.labels(depth, theta, least, THREADS)
    assert ours.shape == (len(worker.kernels), THREADS, *depth.shape)
    for kernel, images in zip(worker.kernels, ours):
        for threads, labels in enumerate(images, 1):
            if not np.array_equal(labels, expected):
                v, u = np.argwhere(labels != expected)[0]
                pytest.fail(f"{where}: theta {theta}, min-pixels {least}, kernel {kernel}, {threads} thread(s): pixel "
                            f"({u}, {v}) has label {labels[v, u]}, cc3d's is {expected[v, u]}")
    return count, len(worker.kernels) * THREADS


@pytest.mark.parametrize("kind", ["u8", "u16", "f32"])
def test_random_maps_equal_cc3d(worker, tell, kind):
    maps_of_pattern = dict.fromkeys(maps.PATTERNS, 0)
    images, several, several_linked, missing = 0, 0, 0, 0
    for number in range(MAPS_PER_TYPE):
        pattern = maps.PATTERNS[number % len(maps.PATTERNS)]
        rng = np.random.default_rng([number, len(kind), ord(kind[-1])])
        depth, theta, least = maps.random_case(rng, kind, pattern)
        assert depth.dtype == {"u8": np.uint8, "u16": np.uint16, "f32": np.float32}[kind]
        count, compared = check(worker, depth, theta, least, f"{kind} map {number} ({pattern})")
        maps_of_pattern[pattern] += 1
        images += compared
        missing += count == 0
        several += count > 1
        several_linked += 1 < count < np.count_nonzero(depth)
    tell(f"{MAPS_PER_TYPE} random {kind} maps, {images} label images ({' '.join(worker.kernels)}; 1 and 2 threads); "
         f"{several} maps of several groups, {missing} of none:")
    assert sum(maps_of_pattern.values()) == MAPS_PER_TYPE >= 5000
    assert min(maps_of_pattern.values()) == MAPS_PER_TYPE / len(maps.PATTERNS)
    assert images == MAPS_PER_TYPE * len(worker.kernels) * THREADS
    # The maps are worth comparing: most have several groups that are more than single pixels.
    assert several > 0.6 * MAPS_PER_TYPE
    assert several_linked > 0.4 * MAPS_PER_TYPE


@pytest.mark.parametrize("kind", ["u8", "u16", "f32"])
def test_large_maps_of_several_strips_equal_cc3d(worker, tell, kind):
    """A map of up to 2^19 pixels is one strip of rows and one thread's; these have more."""
    compared, several = 0, 0
    for number in range(LARGE_MAPS_PER_TYPE):
        pattern, shape = maps.PATTERNS[number % 16], maps.LARGE_SHAPES[number % 5]
        rng = np.random.default_rng([number, len(kind), ord(kind[-1]), 1])
        depth, theta, least = maps.large_case(rng, kind, pattern, shape)
        least = least_for_16_bits(*components(depth, theta), least)
        count, _ = check(worker, depth, theta, least, f"large {kind} map {number} ({pattern}, {shape})")
        compared += 1
        several += count > 1
    tell(f"{compared} {kind} maps of several strips, {several} of them of several groups:")
    assert compared == LARGE_MAPS_PER_TYPE == 48
    assert several > 0.6 * LARGE_MAPS_PER_TYPE


def test_real_maps_equal_cc3d(worker, data, tell):
    seen, compared, raised = {}, 0, 0
    for path, depth in maps.real_maps(data):
        seen[path] = depth.dtype.name
        for theta in THETAS:
            least = least_for_16_bits(*components(depth, theta), 0)
            raised += least > 0
            check(worker, depth, theta, least, path)
            compared += 1
    kinds = {name: list(seen.values()).count(name) for name in sorted(set(seen.values()))}
    tell(f"{len(seen)} real maps ({kinds}) at {len(THETAS)} thetas; min-pixels above 0 was needed {raised} times:")
    assert len(seen) == REAL_MAPS
    assert compared == REAL_MAPS * len(THETAS)
    assert set(kinds) == {"uint8", "uint16", "float32"}


def test_more_planes_than_labels_are_refused_where_cc3d_counts_them(worker, tell):
    cases = 0
    for kind in ("u8", "u16", "f32"):
        v, u = np.indices((300, 450))
        board = ((u + v) % 2).astype({"u8": np.uint8, "u16": np.uint16, "f32": np.float32}[kind])
        board[296:] = 0
        for rows in (292, 291):  # 65,700 and 65,475 single pixels
            board[rows:] = 0
            image, count = components(board, 0)
            assert count == rows * 225
            assert (count > 65535) == (rows == 292)
            if count > 65535:
                with pytest.raises(Refused, match=f"{count}"):
                    worker.labels(board, 0, 0, THREADS)
            else:
                check(worker, board, 0, 0, f"{kind} board of {count} planes")
            cases += 1
    tell(f"{cases} boards at the limit of 65535 planes:")
    assert cases == 6


def test_renumbering_orders_by_size_then_by_first_pixel():
    image = np.array([[3, 3, 0, 1],
                      [0, 2, 2, 1],
                      [4, 5, 2, 0]])
    assert sizes_of(image, 5).tolist() == [2, 3, 2, 1, 1]
    assert renumbered(image, 5, 0).tolist() == [[2, 2, 0, 3], [0, 1, 1, 3], [4, 5, 1, 0]]
    assert renumbered(image, 5, 1).tolist() == [[2, 2, 0, 3], [0, 1, 1, 3], [0, 0, 1, 0]]
    assert renumbered(image, 5, 3).max() == 0


def test_cc3d_goes_wrong_where_we_say():
    """Should this fail, cc3d has been mended and `in_special_row` may go."""
    def theirs(rows):
        depth = np.array(rows, np.float32)
        assert in_special_row(depth, 0)
        return cc3d.connected_components(depth, connectivity=4, delta=0).tolist()

    assert theirs([[0, 0], [5.5, 5.5], [0, 0]]) == [[0, 0], [1, 2], [0, 0]]  # equal, not joined
    assert theirs([[0, 0], [5.5, 5.0], [0, 0]]) == [[0, 0], [1, 1], [0, 0]]  # different, joined
    assert theirs([[5.5], [5.5]]) == [[1], [2]]  # one column
    image, count = components(np.array([[0, 0, 0], [5.5, 5.5, 5.0], [0, np.nan, 0]], np.float32), 0)
    assert (image.tolist(), count) == ([[0, 0, 0], [1, 1, 2], [0, 0, 0]], 2)
