"""Point clouds of Open3D."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from .. import _native
from .._optional import need

if TYPE_CHECKING:
    import open3d

    from .._planes import Planes


def to_open3d(planes: Planes) -> list[open3d.geometry.PointCloud]:
    """The points of each plane, in its colour."""
    package = need("open3d", "open3d", "to_open3d()")
    colours = _native.colours(len(planes)) / 255
    clouds = []
    for k, normal in enumerate(planes.normals):
        points = planes.points(k)
        cloud = package.geometry.PointCloud(package.utility.Vector3dVector(points))
        cloud.normals = package.utility.Vector3dVector(np.broadcast_to(normal, points.shape))
        cloud.paint_uniform_color(colours[k + 1])
        clouds.append(cloud)
    return clouds
