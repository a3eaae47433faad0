"""Arrays of every kind are the same map, read where they lie if they can be."""

import threading
import time
import warnings

import numpy as np
import pytest

import depthplanes

CAMERA = (525.0, 525.0, 319.5, 239.5)


@pytest.fixture(scope="module")
def kinect(data):
    """A frame of a Kinect, 16-bit millimetres."""
    return depthplanes.read(data / "gt_real" / "lpvo_hall_125.depth.png").depth


def labels(depth, **words):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", depthplanes.ReadingWarning)
        detector = depthplanes.Detector(**words)
        first = detector(depth).labels
        again = detector(depth).labels
    assert np.array_equal(first, again), "the first map of a detector is read otherwise than later ones"
    return first


def unaligned(depth, offset):
    """The same numbers, at an address that no number of theirs may have."""
    return np.frombuffer(bytes(offset) + depth.tobytes(), depth.dtype, offset=offset).reshape(depth.shape)


def field(depth):
    """The same numbers in a structure without gaps."""
    packed = np.zeros(depth.shape, np.dtype([("valid", np.uint8), ("z", depth.dtype)]))
    packed["z"] = depth
    return packed["z"]


class OnlyArray:
    """As tensors of PyTorch and DataArrays of xarray are taken."""

    def __init__(self, array):
        self.array = array

    def __array__(self, dtype=None, copy=None):
        return self.array


class OnlyDlpack:
    def __init__(self, array):
        self.array = array

    def __dlpack__(self, **words):
        return self.array.__dlpack__(**words)

    def __dlpack_device__(self):
        return self.array.__dlpack_device__()


@pytest.mark.parametrize(
    "change",
    [
        np.copy,
        np.asfortranarray,
        lambda depth: np.pad(depth, 7)[7:-7, 7:-7],
        lambda depth: np.repeat(depth, 2, axis=1)[:, ::2],
        lambda depth: depth[::-1].copy()[::-1],
        lambda depth: depth.astype(">u2"),
        lambda depth: depth.astype(np.int16),
        lambda depth: depth.astype(np.int32),
        lambda depth: depth.astype(np.int64),
        lambda depth: depth.astype(np.uint32),
        lambda depth: unaligned(depth, 1),
        lambda depth: unaligned(depth.astype(np.float32), 2),
        field,
        lambda depth: np.ma.masked_equal(depth, 0),
        lambda depth: depth.tolist(),
        OnlyArray,
        OnlyDlpack,
    ],
    ids=["copy", "fortran", "crop", "every second column", "upside down", "big-endian", "int16", "int32", "int64", "uint32",
         "unaligned", "unaligned floats", "field of a structure", "masked", "lists", "__array__", "DLPack"],
)  # fmt: skip
def test_arrays_of_the_same_numbers_have_the_same_labels(kinect, change):
    assert np.array_equal(labels(change(kinect), unit="mm"), labels(kinect))


def test_floats_are_metres_unless_told_otherwise(kinect):
    expected = labels(kinect, camera=CAMERA)
    for type_ in (np.float32, np.float64):
        assert np.array_equal(labels(kinect.astype(type_) / 1000, camera=CAMERA), expected)
        assert np.array_equal(labels(kinect.astype(type_), unit="mm", camera=CAMERA), expected)
    far = depthplanes.Detector(camera=CAMERA)
    with pytest.warns(depthplanes.ReadingWarning, match="millimetre"):
        planes = far(kinect.astype(np.float32))
    assert planes.distances[0] > 100, "floats that are no metres are metres all the same, and a warning says so"


def test_what_came_before_changes_nothing(kinect):
    other = np.where(kinect == 0, np.uint16(65535), kinect)
    alone = labels(other)
    assert np.array_equal(alone, labels(kinect)), "65535 is missing"
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", depthplanes.ReadingWarning)
        detector = depthplanes.Detector()
        for depth in (kinect, kinect[::2, ::2], kinect.astype(np.float32) / 1000, other):
            found = detector(depth)
    assert np.array_equal(found.labels, alone)


def test_xarray_and_pandas_go_in(kinect):
    xarray = pytest.importorskip("xarray")
    assert np.array_equal(labels(xarray.DataArray(kinect, dims=("v", "u"))), labels(kinect))
    pandas = pytest.importorskip("pandas")
    assert np.array_equal(labels(pandas.DataFrame(kinect)), labels(kinect))


def test_nothing_is_copied_that_need_not_be(kinect):
    detector = depthplanes.Detector(camera=CAMERA)
    planes = detector(kinect)
    assert not planes.labels.flags.owndata and not planes.labels.flags.writeable
    address = planes.labels.ctypes.data
    labels = planes.labels
    del planes
    assert labels.max() > 0, "an array outlives the planes that it came from"
    del labels
    # What is not needed any more is used again.
    addresses = {address}
    for _ in range(5):
        planes = detector(kinect)
        addresses.add(planes.labels.ctypes.data)
        del planes
    assert len(addresses) <= 2
    with pytest.raises(ValueError, match="read-only"):
        detector(kinect).labels[0, 0] = 1


def test_an_array_that_was_written_to_is_refused(kinect):
    depth = kinect.copy()
    detector = depthplanes.Detector(camera=CAMERA)
    detector(depth)
    planes = detector(depth)
    assert len(planes.points(0)) == planes.pixel_counts[0]
    planes = detector(depth)
    depth += 100  # the camera's next frame
    for reads_again in (lambda: planes.points(0), planes.draw, planes.to_dict, lambda: planes.explain(3, 4)):
        with pytest.raises(depthplanes.InputError, match=r"detector\(depth.copy\(\)\)"):
            reads_again()
    assert planes.areas[0] > 0 and planes.mask(0).sum() == planes.pixel_counts[0], "what was found stays"


@pytest.mark.parametrize("size", [(480, 640), (48, 64), (3000, 4000), (7, 5000), (5000, 7)])
def test_a_change_of_a_patch_is_noticed(size):
    depth = np.full(size, 2000, np.uint16)
    detector, random = depthplanes.Detector(), np.random.default_rng(1)
    detector(depth)
    # Of four times as many pixels as there are for each that is looked at; a square, unless the map is too narrow for it.
    side = 2 * int(np.ceil(np.sqrt(depth.size / 256)))
    height = min(side, size[0])
    width = min(side * side // height, size[1])
    height = min(side * side // width, size[0])
    for _ in range(40):
        planes = detector(depth)
        v, u = (random.integers(max(1, length - patch)) for length, patch in zip(size, (height, width), strict=True))
        before = depth[v : v + height, u : u + width].copy()
        depth[v : v + height, u : u + width] += 1
        with pytest.raises(depthplanes.InputError, match="written to"):
            planes.draw()
        depth[v : v + height, u : u + width] = before


def test_a_blank_first_map_settles_nothing(kinect):
    detector = depthplanes.Detector(camera=CAMERA)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", depthplanes.ReadingWarning)
        detector(np.zeros(kinect.shape, np.float32))
    millimetres = kinect.astype(np.float32)
    with pytest.warns(depthplanes.ReadingWarning, match="millimetre"):
        detector(millimetres)
    detector(millimetres)  # a second warning would be an error


def test_threads_share_a_detector_and_the_answer(kinect):
    detector = depthplanes.Detector(camera=CAMERA)
    expected = detector(kinect).labels
    wrong = []

    def work(crop):
        for _ in range(10):
            if not np.array_equal(detector(kinect).labels, expected) or len(detector(kinect[crop:])) == 0:
                wrong.append(crop)

    with warnings.catch_warnings():
        warnings.simplefilter("ignore", depthplanes.ReadingWarning)
        threads = [threading.Thread(target=work, args=(crop,)) for crop in (1, 2, 3, 4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
    assert not wrong


def test_other_threads_run_while_planes_are_looked_for(room):
    counted = 0
    done = threading.Event()

    def count():
        nonlocal counted
        while not done.is_set():
            counted += 1
            time.sleep(0.001)

    thread = threading.Thread(target=count)
    thread.start()
    depthplanes.detect(room, method="normals")
    for _ in range(20):
        depthplanes.Detector()(room)
    done.set()
    thread.join()
    assert counted > 10
