"""Outlines, hulls, rectangles and areas against Shapely and OpenCV; the mesh read by plyfile.

Maps are made of random label images: with theta 0 each connected group of equal values is a plane.
"""

import json
import subprocess

import cv2
import numpy as np
import pytest
import shapely
from plyfile import PlyData
from shapely.geometry import MultiPoint, Polygon


def label_image(random):
    """Blocks, specks and holes, of random size."""
    height, width = random.integers(2, 60, size=2)
    image = np.full((height, width), random.integers(1, 4))
    for _ in range(random.integers(0, 25)):
        v, u = random.integers(0, height), random.integers(0, width)
        h, w = random.integers(1, 20, size=2)
        image[v : v + h, u : u + w] = random.integers(0, 5)
    specks = random.random(image.shape) < random.choice([0, 0.02, 0.3])
    image[specks] = random.integers(0, 5, size=specks.sum())
    return image


def detect(program, folder, image, *flags):
    """The record and the label image of what is found in an image."""
    source, labels = folder / "map.pgm", folder / "labels.png"
    header = f"P5 {image.shape[1]} {image.shape[0]} 65535\n".encode()
    source.write_bytes(header + (1000 * image).astype(">u2").tobytes())
    command = [program, "detect", source, "--method", "ngaf", "--theta", "0", "--min-pixels", "0", "--labels", labels,
               "--json", *flags]
    done = subprocess.run(command, check=True, capture_output=True, text=True)
    return json.loads(done.stdout), cv2.imread(str(labels), cv2.IMREAD_UNCHANGED)


def polygons(outline):
    return [Polygon(part["outer"], part["holes"]) for part in outline["polygons_px"]]


def squares(labels, label):
    """The pixels of a plane as unit squares."""
    v, u = np.nonzero(labels == label)
    return shapely.union_all(shapely.box(u - 0.5, v - 0.5, u + 0.5, v + 0.5))


def corners(rectangle):
    (u, v), (a, b), (long, short) = (np.array(rectangle[name]) for name in ["centre", "axes", "sides"])
    return [(u, v) + s * long / 2 * a + t * short / 2 * b for s, t in [(-1, -1), (1, -1), (1, 1), (-1, 1)]]


def images(seed, count):
    random = np.random.default_rng(seed)
    return [label_image(random) for _ in range(count)]


def test_exact_polygons_are_the_union_of_the_pixels(program, tmp_path):
    planes = 0
    for image in images(1, 40):
        record, labels = detect(program, tmp_path, image, "--outlines=0")
        for plane in record["planes"]:
            (polygon,) = polygons(plane["outline"])
            assert polygon.is_valid, shapely.is_valid_reason(polygon)
            assert polygon.area == plane["pixel_count"]
            assert polygon.equals(squares(labels, plane["label"]))
            planes += 1
    assert planes > 1000


@pytest.mark.parametrize("tolerance", [0.8, 1.5, 4.0])
def test_simplified_polygons_are_valid_and_near(program, tmp_path, tolerance):
    for image in images(2, 25):
        record, labels = detect(program, tmp_path, image, f"--outlines={tolerance}")
        for plane in record["planes"]:
            (polygon,) = polygons(plane["outline"])
            assert polygon.is_valid, shapely.is_valid_reason(polygon)
            exact = squares(labels, plane["label"])
            assert len(polygon.interiors) == len(exact.interiors)
            assert polygon.boundary.hausdorff_distance(exact.boundary) <= tolerance + 1e-9


def test_hulls_and_rectangles_are_those_of_opencv_and_shapely(program, tmp_path):
    for image in images(3, 25):
        record, labels = detect(program, tmp_path, image, "--outlines")
        for plane in record["planes"]:
            outline = plane["outline"]
            ring = np.array(outline["hull_px"], dtype=np.float32)
            # All four corners of every pixel, by OpenCV.
            v, u = np.nonzero(labels == plane["label"])
            points = np.concatenate([np.stack([u + du, v + dv], axis=1) for du in (-0.5, 0.5) for dv in (-0.5, 0.5)])
            expected = cv2.convexHull(points.astype(np.float32))
            assert {tuple(point) for point in ring} == {tuple(point[0]) for point in expected}
            assert abs(cv2.contourArea(ring) - Polygon(ring).area) < 1e-3
            _, sides, _ = cv2.minAreaRect(ring)
            area = np.prod(outline["rectangle_px"]["sides"])
            assert area == pytest.approx(np.prod(sides), rel=1e-4)
            assert area == pytest.approx(shapely.minimum_rotated_rectangle(MultiPoint(ring)).area, rel=1e-6)
            assert Polygon(corners(outline["rectangle_px"])).buffer(1e-6).contains(Polygon(ring))


def test_outer_contours_are_those_of_opencv(program, tmp_path):
    """OpenCV follows pixels' centres: its contour's corners are half a pixel's diagonal from ours."""
    for image in images(4, 20):
        record, labels = detect(program, tmp_path, image, "--outlines=0")
        for plane in record["planes"]:
            mask = (labels == plane["label"]).astype(np.uint8)
            contours, _ = cv2.findContours(mask, cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_NONE)
            assert len(contours) == 1
            (polygon,) = polygons(plane["outline"])
            on_ring = shapely.points(contours[0][:, 0, :].astype(float))
            assert np.all(shapely.distance(Polygon(polygon.exterior), on_ring) == 0)
            assert np.all(shapely.distance(polygon.exterior, on_ring) <= 0.5)


def test_the_mesh_of_a_room_has_the_planes_areas(program, tmp_path, tell):
    mesh, room = tmp_path / "room.ply", "scene:room:seed=2,sensor=tof_white"
    command = [program, "detect", room, "--json", "--outlines=0", "--mesh", mesh]
    planes = json.loads(subprocess.run(command, check=True, capture_output=True, text=True).stdout)["planes"]
    ply = PlyData.read(mesh)
    vertices = np.stack([ply["vertex"][axis] for axis in "xyz"], axis=1).astype(float)
    triangles = np.stack(ply["face"]["vertex_indices"])
    a, b, c = (vertices[triangles[:, k]] for k in range(3))
    normals = np.cross(b - a, c - a) / 2
    labels = ply["vertex"]["label"][triangles[:, 0]]
    for plane in planes:
        mine = labels == plane["label"]
        if plane["metric"] is None or plane["metric"]["area_m2"] is None:
            assert not mine.any()
            continue
        around = normals[mine] @ np.array(plane["metric"]["normal"])
        assert around.min() > -1e-7
        assert around.sum() == pytest.approx(plane["metric"]["area_m2"], rel=1e-4)
    tell(f"mesh of a room: {len(planes)} planes, {len(vertices)} vertices, {len(triangles)} triangles")
