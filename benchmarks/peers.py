"""Other people's plane finders on the maps of `depthplanes eval`, which asks and scores.

    depthplanes eval SET.. --report DIR --peers 'python benchmarks/peers.py [NAME..]'

Questions and answers are lines of JSON on standard input and output; docs/eval.md describes them. In: the folder of a
map, `values.npy` (its own numbers) and `depth.npy` (metres, or median depths where unit or camera is unknown), 0 = missing,
and a camera, assumed where it is unknown. Out: a label image in that folder, and how long it took from the array in memory
to the label image in memory. A package that is not there is said on standard error, and its methods are left out.

A peer is one function and one row of PEERS. Thresholds are not tuned to any set:

- Searches in space take what lies within 1 % of the diagonal of the box around all points, as `ransac` of depthplanes does
  (Schnabel et al. 2007), so that differences are those of the searches. They end at a plane of `MIN` points or fewer, which
  is what all methods of depthplanes have as default.
- Planes are as the package gives them: a plane of a search in space need not be connected in the map.
"""

import importlib
import importlib.metadata
import json
import os
import pathlib
import random
import statistics
import sys
import time

import numpy as np

MIN = 100  # a plane has more points than this
DRAWS = 1000  # Open3D's tutorial and the default of pyransac3d
NEIGHBOURS = 30  # of the normals, as in Open3D's tutorial
THETA, SMALLEST = 1, 32  # those of `ngaf`
SEED = 1
LONG_S = 1.0  # a run that takes longer needs no warm-up, and is the only one
MOST_PLANES = 65535


class Frame:
    """A map: `values` (h, w) as they are, `depth` (h, w) float32, camera (fx, fy, cx, cy)."""

    def __init__(self, values, depth, camera):
        self.values, self.depth, self.camera = values, depth, camera

    def points(self):
        """(n, 3) float64 points in space, and (n,) the pixels in raster order that they belong to."""
        fx, fy, cx, cy = self.camera
        pixels = np.flatnonzero(self.depth)
        v, u = np.divmod(pixels, self.depth.shape[1])
        z = self.depth.ravel()[pixels].astype(np.float64)
        return np.column_stack([(u - cx) / fx * z, (v - cy) / fy * z, z]), pixels

    def tolerance(self):
        """1 % of the diagonal of the box around all points but one in fifty on either side of each axis."""
        points, _ = self.points()
        if not len(points):
            return 0.0
        few = len(points) // 50
        ordered = np.sort(points, axis=0)
        return 0.01 * float(np.linalg.norm(ordered[-1 - few] - ordered[few]))

    def painted(self, pixels, planes):
        """The label image of planes, one array of point numbers each; the first that has a point keeps it."""
        labels = np.zeros(self.depth.size, np.uint16)
        for label, plane in reversed(list(enumerate(planes[:MOST_PLANES], 1))):
            labels[pixels[plane]] = label
        return labels.reshape(self.depth.shape)


def one_after_another(points, find):
    """Planes by a search for the largest, which is then taken out: arrays of point numbers.

    `find` gives the numbers of the points on the largest plane of those it is given.
    """
    planes, left = [], np.arange(len(points))
    while len(left) > MIN and len(planes) < MOST_PLANES:
        inside = np.asarray(find(points[left]), np.int64)
        if len(inside) <= MIN:
            break
        planes.append(left[inside])
        left = np.delete(left, inside)
    return planes


def open3d_segment_plane(open3d, frame, tolerance):
    open3d.utility.random.seed(SEED)

    def find(points):
        return open3d_cloud(open3d, points).segment_plane(tolerance, ransac_n=3, num_iterations=DRAWS)[1]

    points, pixels = frame.points()
    return frame.painted(pixels, one_after_another(points, find))


def open3d_planar_patches(open3d, frame, _tolerance):
    """The tutorial's call. Patches are boxes: a point within several belongs to the one whose plane is nearest."""
    open3d.utility.random.seed(SEED)
    points, pixels = frame.points()
    cloud = open3d_cloud(open3d, points)
    neighbours = open3d.geometry.KDTreeSearchParamKNN(knn=NEIGHBOURS)
    cloud.estimate_normals(neighbours)
    boxes = cloud.detect_planar_patches(
        normal_variance_threshold_deg=60, coplanarity_deg=75, outlier_ratio=0.75, min_plane_edge_length=0,
        min_num_points=0, search_param=neighbours)
    owner, nearest = np.full(len(points), -1), np.full(len(points), np.inf)
    for number, box in enumerate(boxes):
        inside = np.asarray(box.get_point_indices_within_bounding_box(cloud.points), np.int64)
        distance = np.abs((points[inside] - box.center) @ box.R[:, 2])
        closer = distance < nearest[inside]
        owner[inside[closer]], nearest[inside[closer]] = number, distance[closer]
    return frame.painted(pixels, [np.flatnonzero(owner == number) for number in range(len(boxes))])


def open3d_cloud(open3d, points):
    return open3d.geometry.PointCloud(open3d.utility.Vector3dVector(points))


def pyransac3d_plane(pyransac3d, frame, tolerance):
    random.seed(SEED)

    def find(points):
        return pyransac3d.Plane().fit(points, thresh=tolerance, maxIteration=DRAWS)[1]

    points, pixels = frame.points()
    return frame.painted(pixels, one_after_another(points, find))


def cc3d_components(cc3d, frame, _tolerance):
    """Group + select of `ngaf`: components of the map's own numbers, those of more than SMALLEST pixels."""
    labels, count = cc3d.connected_components(frame.values, connectivity=4, delta=THETA, return_N=True)
    keep = np.bincount(labels.ravel(), minlength=count + 1) > SMALLEST
    keep[0] = False
    if np.count_nonzero(keep) > MOST_PLANES:
        raise Refused(f"{np.count_nonzero(keep)} planes, but 16-bit labels can name {MOST_PLANES}")
    return np.where(keep, np.cumsum(keep), 0).astype(np.uint16)[labels]


class Refused(Exception):
    """Why a peer cannot do a map."""


SEARCH = f"tolerance 1 % of the diagonal, min-pixels {MIN}, draws {DRAWS}, seed {SEED}"
PATCHES = f"normal variance 60, coplanarity 75, outliers 0.75, edge 0, min-pixels 0, neighbours {NEIGHBOURS}, seed {SEED}"
# Name: its function, the module, the package it comes in, its parameters.
PEERS = {
    "open3d-segment-plane": (open3d_segment_plane, "open3d", "open3d", SEARCH),
    "open3d-planar-patches": (open3d_planar_patches, "open3d", "open3d", PATCHES),
    "pyransac3d-plane": (pyransac3d_plane, "pyransac3d", "pyransac3d", SEARCH),
    "cc3d-components": (cc3d_components, "cc3d", "connected-components-3d", f"theta {THETA}, min-pixels {SMALLEST}"),
}


def installed(names):
    """Those of the peers whose package can be loaded: name -> what the list of peers says of it, and its module."""
    found = {}
    for name in names:
        _, module, package, parameters = PEERS[name]
        try:
            loaded = importlib.import_module(module)
        except ImportError as error:
            print(f"note: {name} is left out: {error}; `make peers` installs {package}", file=sys.stderr)
            continue
        version = f"{package} {importlib.metadata.version(package)}"
        found[name] = {"name": name, "version": version, "parameters": parameters}, loaded
    return found


def timed(work):
    start = time.perf_counter()
    made = work()
    return made, time.perf_counter() - start


def measured(work, repeat):
    """What the work makes, and the times in ms of `repeat` runs after a warm-up."""
    made, seconds = timed(work)
    times = [seconds] if seconds > LONG_S else [timed(work)[1] for _ in range(repeat)]
    return made, [1000 * seconds for seconds in times]


def answer(question, peers):
    if question.get("list"):
        return {"peers": [listed for listed, _ in peers.values()]}
    name, folder = question["peer"], pathlib.Path(question["folder"])
    camera = [question["camera"][part] for part in ("fx", "fy", "cx", "cy")]
    frame = Frame(np.load(folder / "values.npy"), np.load(folder / "depth.npy"), camera)
    find, module = PEERS[name][0], peers[name][1]
    tolerance = frame.tolerance()
    try:
        labels, times = measured(lambda: find(module, frame, tolerance), question["repeat"])
    except Refused as why:
        return {"refused": str(why)}
    np.save(folder / "labels.npy", labels)
    return {"labels": "labels.npy", "median_ms": statistics.median(times), "least_ms": min(times)}


def keep_to_threads():
    """No more processors than OMP_NUM_THREADS says, before any package starts threads.

    Open3D's `segment_plane` has threads of its own, which no variable binds; on several of them the same seed gives
    different planes from run to run. Only Linux lets a process do this.
    """
    threads = int(os.environ.get("OMP_NUM_THREADS", 0))
    if threads and hasattr(os, "sched_setaffinity"):
        os.sched_setaffinity(0, sorted(os.sched_getaffinity(0))[-threads:])


def main():
    # Packages print to standard output; it belongs to the answers.
    answers = os.fdopen(os.dup(1), "w", buffering=1)
    os.dup2(2, 1)
    keep_to_threads()
    names = sys.argv[1:] or list(PEERS)
    for name in names:
        if name not in PEERS:
            sys.exit(f"error: there is no peer `{name}`; there are {', '.join(PEERS)}")
    peers = installed(names)
    for line in sys.stdin:
        answers.write(json.dumps(answer(json.loads(line), peers)) + "\n")


if __name__ == "__main__":
    main()
