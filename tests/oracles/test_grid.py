"""The occupancy grid of `floor --grid`, read as ROS' map_server reads it and held against the points of the map."""

import json
import pathlib
import subprocess

import cv2
import numpy as np
import pytest

POLYLIDAR = ["--camera", "realsense_polylidar/camera_intrinsic_rgb_424.json", "--encoding", "millimetre"]
KINECT = ["--intrinsics", "585,585,320,240", "--missing", "65535", "--encoding", "millimetre"]
FRAMES = [
    ("realsense_polylidar/depth/00000001_1580908153638.png", POLYLIDAR),
    ("realsense_polylidar/depth/00000003_1580908154939.png", POLYLIDAR),
    ("realsense_polylidar/depth/00000005_1580908170414.png", POLYLIDAR),
    ("video_7scenes/frame-000000.depth.png", KINECT),
]
# Metres: a point that stands above any sensor's error here, and one that a robot of 40 cm still meets.
STANDS, MEETS = 0.15, 0.4


def map_server(path):
    """Cells as map_server's trinary mode reads them: 100 occupied, 0 free, -1 unknown; y grows upwards."""
    about = dict(line.split(": ", 1) for line in path.read_text().splitlines())
    assert about["mode"] == "trinary" and about["negate"] == "0"
    grey = cv2.imread(str(path.parent / about["image"].strip('"')), cv2.IMREAD_GRAYSCALE)
    shade = (255 - grey.astype(float)) / 255
    cells = np.full(grey.shape, -1)
    cells[shade > float(about["occupied_thresh"])] = 100
    cells[shade < float(about["free_thresh"])] = 0
    return cells[::-1], float(about["resolution"]), json.loads(about["origin"])


def camera(flags):
    if flags[0] == "--intrinsics":
        return [float(number) for number in flags[1].split(",")]
    matrix = json.loads(pathlib.Path(flags[1]).read_text())["intrinsic_matrix"]  # column by column
    return [matrix[0], matrix[4], matrix[6], matrix[7]]


def points(depth_m, intrinsics):
    fx, fy, cx, cy = intrinsics
    v, u = np.mgrid[0 : depth_m.shape[0], 0 : depth_m.shape[1]]
    all_of = np.stack([(u - cx) / fx * depth_m, (v - cy) / fy * depth_m, depth_m], axis=-1)
    return all_of[depth_m > 0]


def around(counts):
    """Sums over each cell and its eight neighbours."""
    padded = np.pad(counts, 1)
    rows, columns = counts.shape
    return sum(padded[i : i + rows, j : j + columns] for i in range(3) for j in range(3))


@pytest.mark.parametrize("name, flags", FRAMES)
def test_cells_are_what_the_points_show(program, data, tmp_path, tell, name, flags):
    flags = [str(data / flag) if flag.endswith(".json") else flag for flag in flags]
    grid = tmp_path / "grid.png"
    command = [program, "floor", data / name, *flags, "--grid", grid, "--json"]
    floor = json.loads(subprocess.run(command, check=True, capture_output=True).stdout)["floor"]
    cells, resolution, origin = map_server(grid.with_suffix(".yaml"))

    raw = cv2.imread(str(data / name), cv2.IMREAD_UNCHANGED).astype(float)
    raw[raw == 65535] = 0
    intrinsics = camera(flags)
    at = points(raw / 1000, intrinsics)
    up = np.array(floor["normal"])
    height = at @ up + floor["height_m"]
    ahead = np.array([0.0, 0.0, 1.0]) - up[2] * up
    ahead /= np.linalg.norm(ahead)
    left = np.cross(up, ahead)
    columns = np.floor((at @ ahead - origin[0]) / resolution).astype(int)
    rows = np.floor((at @ left - origin[1]) / resolution).astype(int)
    inside = (rows >= 0) & (rows < cells.shape[0]) & (columns >= 0) & (columns < cells.shape[1])

    def count(which):
        counts = np.zeros(cells.shape, int)
        np.add.at(counts, (rows[which & inside], columns[which & inside]), 1)
        return counts

    # As far off the floor as a sensor errs at that distance, and 2 cm.
    error = 0.02 + 0.02 * at[:, 2]
    on_floor, off_floor = count(abs(height) < error), count(abs(height) > 0.02)
    standing = count((height > STANDS) & (height < MEETS))

    free, occupied = cells == 0, cells == 100
    assert free.sum() > 50, "some floor is free"
    # A cell of 8 x 8 pixels of the map says what all the floor is that it shows, which far away is a long strip.
    to_floor = resolution * cv2.distanceTransform((on_floor == 0).astype(np.uint8), cv2.DIST_L2, cv2.DIST_MASK_PRECISE)
    ahead_of = origin[0] + resolution * (np.arange(cells.shape[1]) + 0.5)
    strip = 8 * (ahead_of**2 + floor["height_m"] ** 2) / (intrinsics[1] * floor["height_m"])
    near = to_floor < resolution + strip
    assert near[free].mean() > 0.97, "where it is free there is floor"
    assert (around(off_floor)[occupied] > 0).all(), "where it is occupied something is off the floor"
    full = standing >= 48
    assert full.sum() > 0
    found = around(occupied.astype(int))[full] > 0
    tell(f"{name}: {free.sum()} free, {occupied.sum()} occupied, {found.mean():.3f} of {full.sum()} full cells")
    assert found.mean() > 0.95, "what stands on the floor is occupied"
    assert not free[full].any() or free[full].mean() < 0.02, "nothing that stands on the floor is free"
