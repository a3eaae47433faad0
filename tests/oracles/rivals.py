"""The oracles: cc3d's components, OpenCV's speckle filter, and label order written in numpy."""

import cc3d
import cv2
import numpy as np

MOST_PLANES = 65535


def without_missing(depth):
    """The map as an oracle needs it: NaN and the infinities are 0 as well."""
    if depth.dtype.kind == "f":
        return np.where(np.isfinite(depth), depth, np.float32(0))
    return depth


def components(depth, theta):
    """(component image, how many): 0 = missing, components 1, 2 ... in no order that we rely on.

    Integer maps take theta rounded down, as cc3d and depthplanes do; cc3d rounds a float theta to the
    nearest f32, as depthplanes does. One case is kept from cc3d: see `in_special_row`.
    """
    depth = without_missing(depth)
    if in_special_row(depth, theta):
        # At theta 0 only equality counts, so whole numbers may stand for the values.
        values, rank = np.unique(depth, return_inverse=True)
        rank = rank.reshape(depth.shape)
        depth = np.where(depth == 0, 0, rank + 1).astype(np.uint32)
    return cc3d.connected_components(np.ascontiguousarray(depth), connectivity=4, delta=theta, return_N=True)


def in_special_row(depth, theta):
    """Whether cc3d 4.1 would go wrong on a float map.

    At delta 0 a map whose data lie in one row of cc3d's memory order is labelled by a function of its
    own, `epl_special_row` (cc3d/fastcc3d.pyx). It keeps the last value in an int64: 5.5 is remembered as
    5, so equal neighbours 5.5 5.5 are not joined and 5.5 5.0 are. A map one column wide is such a row
    as well, since it counts as Fortran-ordered. `test_cc3d_goes_wrong_where_we_say` holds this down.
    """
    one_row = depth.shape[1] == 1 or np.count_nonzero(depth.any(axis=1)) <= 1
    return depth.dtype.kind == "f" and theta == 0 and one_row


def sizes_of(image, count):
    """Pixels of the components 1 to `count`."""
    return np.bincount(image.ravel(), minlength=count + 1)[1:]


def renumbered(image, count, least):
    """Components of more than `least` pixels by decreasing size, ties by first pixel in raster order."""
    flat = image.ravel()
    sizes = sizes_of(image, count)
    first = np.empty(count + 1, np.int64)
    first[flat[::-1]] = np.arange(flat.size - 1, -1, -1)  # of several writes to one place the last stays
    order = np.lexsort((first[1:], -sizes))
    order = order[sizes[order] > least]
    assert len(order) <= MOST_PLANES
    label = np.zeros(count + 1, np.uint16)
    label[order + 1] = np.arange(1, len(order) + 1)
    return label[image]


def least_for_16_bits(image, count, least):
    """`least`, or the next larger one at which 16 bits can name all planes."""
    sizes = sizes_of(image, count)
    while np.count_nonzero(sizes > least) > MOST_PLANES:
        least += 1
    return least


def takes_speckles(depth):
    """Whether cv2.filterSpeckles takes the map's values: 8 bit unsigned or 16 bit signed."""
    return depth.dtype == np.uint8 or (depth.dtype == np.uint16 and depth.max() < 32768)


def speckle_mask(depth, theta, least):
    """The pixels that cv2.filterSpeckles keeps: those of regions of more than `least` pixels."""
    filtered = depth.copy() if depth.dtype == np.uint8 else depth.astype(np.int16)
    cv2.filterSpeckles(filtered, 0, least, theta)
    return filtered != 0
