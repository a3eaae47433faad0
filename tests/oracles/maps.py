"""The maps that are compared: random ones of every kind of trouble, and the real ones."""

import csv

import cv2
import numpy as np

# The two dull ones once in 16, the others twice.
PATTERNS = ["missing", "constant"] + 2 * ["stripes", "checkerboard", "noise", "ramp", "holes", "patches", "maze"]
# Widths around the 64 pixels of a mask word and the vectors of the kernels.
CRITICAL_SIDES = [1, 2, 15, 16, 17, 31, 32, 33, 63, 64, 65, 127, 128, 129, 191, 192, 193, 199, 200]
# f32 maps: from denormals to values whose differences overflow.
FLOAT_SCALES = [1.0, 0.001, 1 / 3, 0.1, 1000.0, 1e30, 1e-40]


def random_case(rng, kind, pattern):
    """(map, theta, min_pixels): a map of the pixel type `kind` and parameters that suit it."""
    height, width = side(rng), side(rng)
    step = int(rng.choice([1, 2, 3, 8, 64]))
    units = PATTERN_MAKERS[pattern](rng, height, width, step)
    if rng.random() < 0.7:  # about the step between neighbours, where links hang in the balance
        theta = int(rng.choice([0, step - 1, step - 1, step, step // 2]))
    else:
        theta = int(rng.choice([0, 1, 2, 4, 8, 16, 32, 64, rng.integers(0, 65)]))
    least = 0 if rng.random() < 0.6 else int(rng.choice([1, 2, 7, 32, 64, 256, 5000]))
    if kind == "f32":
        depth, theta = as_float(rng, units, theta)
        return depth, theta, least
    if rng.random() < 0.1:
        theta += 0.5  # whole numbers are as far apart as with theta rounded down
    top = 255 if kind == "u8" else 65535
    base = int(rng.choice([0, 0, 0, top - 64, top // 2]))
    values = (units + base) % (top + 1) if rng.random() < 0.5 else np.clip(units + base, 0, top)
    return np.where(units == 0, 0, values).astype(np.uint8 if kind == "u8" else np.uint16), theta, least


def side(rng):
    return int(rng.choice(CRITICAL_SIDES)) if rng.random() < 0.3 else int(rng.integers(1, 201))


def as_float(rng, units, theta):
    """Whole numbers as f32 of some scale, with NaN and infinities for some of what is missing."""
    scale = float(rng.choice(FLOAT_SCALES))
    shift = float(rng.choice([0, 0, -20, 0.25]))  # negative values are valid
    with np.errstate(over="ignore", under="ignore"):
        depth = np.where(units == 0, 0, (units + shift) * scale).astype(np.float32)
        if rng.random() < 0.2:
            depth = np.where(depth == 0, 0, depth * (1 + rng.normal(0, 1e-3, depth.shape))).astype(np.float32)
    holes = (units == 0) & (rng.random(units.shape) < 0.7)
    depth[holes] = rng.choice(np.array([np.nan, np.inf, -np.inf, -0.0], np.float32), np.count_nonzero(holes))
    return depth, theta * scale


def missing(rng, height, width, step):
    return np.zeros((height, width), np.int64)


def constant(rng, height, width, step):
    return np.full((height, width), rng.integers(1, 256), np.int64)


def stripes(rng, height, width, step):
    v, u = np.indices((height, width))
    period = int(rng.integers(1, 12))
    across = [u, v, u + v, u - v + height][rng.integers(0, 4)] // period
    values = across % int(rng.integers(2, 5)) * step
    return values + (0 if rng.random() < 0.4 else 1)


def checkerboard(rng, height, width, step):
    v, u = np.indices((height, width))
    cell = int(rng.integers(1, 6))
    dark = (u // cell + v // cell) % 2
    return dark * step + (0 if rng.random() < 0.4 else 1)


def noise(rng, height, width, step):
    levels = int(rng.choice([2, 3, 5, 20, 256, 65536]))
    return rng.integers(0, levels, (height, width)) * (step if levels < 20 else 1)


def ramp(rng, height, width, step):
    v, u = np.indices((height, width))
    slope_u, slope_v = rng.uniform(-step, step, 2) * 1.5
    plane = slope_u * u + slope_v * v + rng.normal(0, rng.choice([0, 0.3, 2]), (height, width))
    return (plane - plane.min() + 1).astype(np.int64)


def holes(rng, height, width, step):
    values = ramp(rng, height, width, step) if rng.random() < 0.5 else constant(rng, height, width, step)
    if rng.random() < 0.5:
        return np.where(rng.random(values.shape) < rng.choice([0.01, 0.1, 0.41, 0.6, 0.95]), 0, values)
    v, u = np.indices(values.shape)
    for _ in range(int(rng.integers(1, 10))):
        centre_v, centre_u = rng.integers(0, height), rng.integers(0, width)
        values[(v - centre_v) ** 2 + (u - centre_u) ** 2 < rng.integers(1, 400)] = 0
    return values


def patches(rng, height, width, step):
    """Overlapping rectangles, a few grey levels apart."""
    values = np.ones((height, width), np.int64)
    for _ in range(int(rng.integers(1, 40))):
        (top, bottom), (left, right) = sorted(rng.integers(0, height + 1, 2)), sorted(rng.integers(0, width + 1, 2))
        values[top:bottom, left:right] = rng.integers(0, 6) * step
    return values


def maze(rng, height, width, step):
    """One long path (a serpentine or a comb), which makes many late unions."""
    values = np.zeros((height, width), np.int64)
    values[::2] = 1 + step
    gaps = np.arange(1, height, 2)
    ends = np.where(gaps // 2 % 2 == 0, width - 1, 0) if rng.random() < 0.7 else np.full(len(gaps), width - 1)
    values[gaps, ends] = 1 + int(rng.choice([step, 0]))
    flips = [values, values[::-1], values[:, ::-1], maze_of_columns(values)]
    return np.ascontiguousarray(flips[rng.integers(0, 4)])


def maze_of_columns(values):
    return values.T.reshape(values.shape) if values.shape[0] == values.shape[1] else values


PATTERN_MAKERS = {maker.__name__: maker for maker in
                  (missing, constant, stripes, checkerboard, noise, ramp, holes, patches, maze)}

# Maps that are too large for one strip of rows (2^19 pixels), which is where threads and the joining of
# strips come in.
LARGE_SHAPES = [(17, 65535), (1100, 1282), (8191, 130), (1024, 1024), (700, 1999)]


def large_case(rng, kind, pattern, shape):
    """As `random_case`, of a given shape: tiles of one random map, shifted row by row."""
    depth, theta, least = random_case(rng, kind, pattern)
    tiles = -(-shape[0] // depth.shape[0]), -(-shape[1] // depth.shape[1])
    depth = np.ascontiguousarray(np.tile(depth, tiles)[:shape[0], :shape[1]])
    breaks = rng.random(shape) < rng.choice([0, 1e-4, 1e-2])
    depth[breaks] = 0
    return depth, theta, least


def is_map(row):
    """Whether a row of the manifest is a depth or disparity map of one channel."""
    path = row["path"]
    one_channel = row["dtype"] in ("uint8", "uint16", "float32", "int32")
    readable = path.endswith((".png", ".pgm", ".bmp", ".tiff", ".pfm", ".npz"))
    other = any(word in path for word in ("labels", "_GT", "derived_planes", "/im"))  # labels and grey images
    return one_channel and readable and not other


def real_maps(data):
    """(path, map) of every map of the manifest that cv2 or numpy reads as one channel u8, u16 or f32."""
    with open(data / "MANIFEST.tsv", newline="", encoding="utf-8") as file:
        rows = [row for row in csv.DictReader(file, delimiter="\t") if is_map(row)]
    for row in rows:
        path = data / row["path"]
        if path.suffix == ".npz":
            with np.load(path) as archive:
                (name,) = archive.files
                depth = archive[name]
        else:
            depth = cv2.imread(str(path), cv2.IMREAD_UNCHANGED)
        assert depth is not None and depth.ndim == 2, f"{row['path']} is not a map of one channel"
        assert depth.dtype in (np.uint8, np.uint16, np.float32), f"{row['path']} is {depth.dtype}"
        yield row["path"], depth
