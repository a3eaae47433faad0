"""Clouds and equations of planes, held against Open3D's own."""

import sys

import numpy as np
import pytest

import depthplanes

pytestmark = pytest.mark.filterwarnings("ignore:Open3D was built with CUDA support:ImportWarning")

CAMERA = (525.0, 525.0, 319.5, 239.5)
#: Unit normals and distances of a floor and two walls, camera coordinates, metres.
CORNER = [((0.1, -0.95, -0.2), 1.1), ((0.7, -0.05, -0.7), 2.0), ((-0.8, 0.02, -0.6), 2.3)]


@pytest.fixture
def open3d(engine):
    if sys.version_info >= (3, 13):
        pytest.skip("the Open3D of the tests has no wheel for this Python")
    return engine("open3d")


def corner():
    """The map of a clean corner in metres, and its planes (a, b, c, d)."""
    fx, fy, cx, cy = CAMERA
    v, u = np.mgrid[:480, :640]
    rays = np.stack([(u - cx) / fx, (v - cy) / fy, np.ones(u.shape)], axis=-1)
    models = [np.array([*(np.array(normal) / np.linalg.norm(normal)), distance]) for normal, distance in CORNER]
    depths = [-model[3] / (rays @ model[:3]) for model in models]
    depths = np.where(np.array(depths) > 0, depths, np.inf)
    return depths.min(axis=0).astype(np.float32), models


def test_clouds_have_all_points_of_their_planes(open3d, planes):
    some = planes[:20]
    clouds = some.to_open3d()
    assert [len(cloud.points) for cloud in clouds] == some.pixel_counts.tolist()
    for k, cloud in enumerate(clouds[:5]):
        assert np.allclose(np.asarray(cloud.normals)[0], some.normals[k])
        open3d.utility.random.seed(1)
        model, inliers = cloud.segment_plane(0.01, 3, 200)
        model = np.array(model) * np.sign(model[3] * some.distances[k])
        assert np.degrees(np.arccos(min(1, model[:3] @ some.normals[k]))) < 1 and abs(model[3] - some.distances[k]) < 0.03
        assert len(inliers) > 0.99 * some.pixel_counts[k]


def test_equations_of_clean_planes_are_open3ds(open3d, tell):
    depth, truth = corner()
    planes = depthplanes.detect(depth, camera=CAMERA)
    assert len(planes) == 3
    worst = [0.0, 0.0]
    for k, cloud in enumerate(planes.to_open3d()):
        open3d.utility.random.seed(k + 1)
        model, inliers = cloud.segment_plane(distance_threshold=1e-4, ransac_n=3, num_iterations=100)
        assert len(inliers) == planes.pixel_counts[k]
        ours = planes.plane_model(k)
        model = np.array(model) * np.sign(model[3])
        of_truth = min(np.abs(ours - plane).max() for plane in truth)
        worst = np.maximum(worst, [np.abs(ours - model).max(), of_truth])
    assert worst[0] < 1e-6 and worst[1] < 1e-6, worst
    tell(f"equations of clean planes are Open3D's to {worst[0]:.1e}, and those of the truth to {worst[1]:.1e}:")


def test_equations_of_recorded_planes_are_open3ds(open3d, data, tell):
    frame = depthplanes.read(data / "gt_real" / "felix_0.depth.png")
    planes = depthplanes.detect(frame.depth, camera=(617.25, 617.55, 317.39, 245.98))[:5]
    angles, offsets = [], []
    for k, cloud in enumerate(planes.to_open3d()):
        open3d.utility.random.seed(k + 1)
        model, _ = cloud.segment_plane(distance_threshold=0.05, ransac_n=3, num_iterations=1000)
        model = np.array(model) * np.sign(model[3])
        angles.append(np.degrees(np.arccos(min(1.0, model[:3] @ planes.normals[k]))))
        offsets.append(abs(model[:3] @ planes.centroids[k] + model[3]))
    assert max(angles) < 1.5 and max(offsets) < 0.01, (angles, offsets)
    tell(f"those of the {len(planes)} largest planes of felix_0 to {max(angles):.2f} degrees:")
