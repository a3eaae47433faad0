"""One plane of a result, and what it looks like."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import numpy.typing as npt

if TYPE_CHECKING:
    from ._planes import Planes

Floats = npt.NDArray[np.float64]

#: Furthest that outlines lie from the borders of pixels unless it is stated, pixels.
TOLERANCE = 1.5


class Polygon(NamedTuple):
    """A part of a plane: rings of corners, the last joined to the first, of shape (corners, 2) in pixels or (corners, 3) in metres."""

    outer: Floats
    """The ring around it, counter-clockwise seen from the camera."""
    holes: list[Floats]
    """The rings of its holes, clockwise."""


class Rectangle(NamedTuple):
    """A rectangle on the picture, in pixels, or on the plane, in metres."""

    centre: Floats
    """Its middle, (2,) or (3,)."""
    axes: Floats
    """Unit vectors along its sides, that of the longer side first, (2, 2) or (2, 3)."""
    sides: Floats
    """The lengths of its sides, the longer first, (2,)."""

    @property
    def corners(self) -> Floats:
        """Its corners, (4, 2) or (4, 3)."""
        along, across = self.axes * self.sides[:, None] / 2
        signs = np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]])
        corners: Floats = self.centre + signs @ np.stack([along, across])
        return corners


class Plane:
    """One plane of a `Planes`: its row of each table."""

    __slots__ = ("_index", "_planes")

    def __init__(self, planes: Planes, index: int) -> None:
        self._planes = planes
        self._index = index

    @property
    def label(self) -> int:
        """Its value in `Planes.labels`, from 1."""
        return self._index + 1

    @property
    def normal(self) -> Floats:
        """Unit normal towards the camera, camera coordinates, (3,); NaN without unit and camera."""
        row: Floats = self._planes.normals[self._index]
        return row

    @property
    def distance(self) -> float:
        """Distance of the camera from the plane, perpendicular to it, metres; NaN without unit and camera."""
        return float(self._planes.distances[self._index])

    @property
    def area(self) -> float:
        """Area of what is seen of it, square metres; NaN if it is not known."""
        return float(self._planes.areas[self._index])

    @property
    def rms(self) -> float:
        """Root mean square distance of the points from the plane, metres; NaN if it is not known."""
        return float(self._planes.rms[self._index])

    @property
    def centroid(self) -> Floats:
        """Mean of its points, metres in camera coordinates, (3,); NaN if it is not known."""
        row: Floats = self._planes.centroids[self._index]
        return row

    @property
    def centroid_px(self) -> Floats:
        """Mean of its pixels (u, v), (2,)."""
        row: Floats = self._planes.centroids_px[self._index]
        return row

    @property
    def covariance(self) -> Floats:
        """Covariance of (nx, ny, nz, distance), (4, 4); NaN if it is not known."""
        row: Floats = self._planes.covariances[self._index]
        return row

    @property
    def pixel_count(self) -> int:
        """How many pixels it has."""
        return int(self._planes.pixel_counts[self._index])

    @property
    def xyxy(self) -> npt.NDArray[np.int64]:
        """Its box of pixels, (4,), as in `Planes.xyxy`."""
        box: npt.NDArray[np.int64] = self._planes.xyxy[self._index]
        return box

    @property
    def mask(self) -> npt.NDArray[np.bool_]:
        """Its pixels, (height, width)."""
        return self._planes.mask(self._index)

    @property
    def points(self) -> Floats:
        """Its points, as of `Planes.points`."""
        return self._planes.points(self._index)

    @property
    def model(self) -> Floats:
        """(a, b, c, d), as of `Planes.plane_model`."""
        return self._planes.plane_model(self._index)

    def polygons(self, *, metric: bool = False, tolerance: float = TOLERANCE, min_hole: int = 0) -> list[Polygon]:
        """Its outlines, as of `Planes.polygons`."""
        return self._planes.polygons(self._index, metric=metric, tolerance=tolerance, min_hole=min_hole)

    def hull(self, *, metric: bool = False) -> Floats:
        """Its convex hull, as of `Planes.hull`."""
        return self._planes.hull(self._index, metric=metric)

    def rectangle(self, *, metric: bool = False) -> Rectangle:
        """The rectangle of least area around it, as of `Planes.rectangle`."""
        return self._planes.rectangle(self._index, metric=metric)

    def __repr__(self) -> str:
        where = "" if np.isnan(self.distance) else f", {self.distance:.3f} m away, normal {self.normal.round(3)}"
        return f"Plane(label={self.label}, {self.pixel_count} pixels{where})"
