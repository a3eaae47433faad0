"""The result: planes of a map, with the map."""

from __future__ import annotations

import json
import os
from collections.abc import Iterator
from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple, overload

import numpy as np
import numpy.typing as npt

from . import _native
from ._errors import InputError
from ._explanation import Explanation
from ._options import Path

if TYPE_CHECKING:
    import matplotlib.axes
    import open3d
    import pandas
    import supervision

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

    def __repr__(self) -> str:
        where = "" if np.isnan(self.distance) else f", {self.distance:.3f} m, normal {self.normal.round(3)}"
        return f"Plane(label={self.label}, {self.pixel_count} pixels{where})"


class Planes:
    """The planes of one map, the largest first, as arrays with a row for each plane.

    `planes[k]` is one `Plane`, and so is each element of a loop. `planes[planes.areas > 1]`, `planes[:3]` and
    `planes[[0, 4]]` are `Planes` again: their labels are numbered anew, and pixels of the others have label 0. In any
    of them the pixels of plane k have the label k + 1.

    `points`, `draw`, `explain`, `write` and the conversions read the map again; an array that was written to since is
    refused. Without unit and camera what is in metres is NaN.

    Examples
    --------
    >>> frame = depthplanes.scene("room:sensor=clean_mm")
    >>> planes = depthplanes.detect(frame)
    >>> large = planes[planes.areas > 2]
    >>> len(large), large.areas.round(2)
    (3, array([4.12, 2.66, 2.54]))
    >>> [plane.pixel_count for plane in large]
    [71407, 43723, 23531]
    """

    def __init__(self, found: _native.Found) -> None:
        self._found = found

    def __len__(self) -> int:
        return len(self._found)

    @overload
    def __getitem__(self, index: int) -> Plane: ...

    @overload
    def __getitem__(self, index: slice | list[int] | npt.NDArray[Any]) -> Planes: ...

    def __getitem__(self, index: int | slice | list[int] | npt.NDArray[Any]) -> Plane | Planes:
        chosen = np.arange(len(self))[index]
        if np.ndim(chosen) == 0:
            return Plane(self, int(chosen))
        return Planes(self._found.select(chosen.tolist()))

    def __iter__(self) -> Iterator[Plane]:
        return (Plane(self, index) for index in range(len(self)))

    def __repr__(self) -> str:
        width, height = self._found.size
        return f"<Planes: {len(self)} on {100 * np.count_nonzero(self.labels) / (width * height):.1f} % of {width} x {height} pixels>"

    # What was found, with a row for each plane.

    @cached_property
    def labels(self) -> npt.NDArray[np.uint16]:
        """The label image, (height, width): 0 where there is no plane, k + 1 on plane k. It cannot be written to."""
        return self._found.labels()

    @cached_property
    def curved(self) -> npt.NDArray[np.uint16] | None:
        """The label image of curved surfaces, (height, width); None unless `Detector` was asked for them."""
        return self._found.curved()

    @cached_property
    def normals(self) -> Floats:
        """Unit normals towards the camera, camera coordinates (x right, y down, z forward), (N, 3)."""
        return self._found.normals()

    @cached_property
    def distances(self) -> Floats:
        """Distance of the camera from each plane, perpendicular to it, metres from 0 up, (N,)."""
        return self._found.distances()

    @cached_property
    def areas(self) -> Floats:
        """Area of what is seen of each plane, square metres, (N,); NaN of planes that reach infinity."""
        return self._found.areas()

    @cached_property
    def rms(self) -> Floats:
        """Root mean square distance of each plane's points from it, metres, (N,)."""
        return self._found.rms()

    @cached_property
    def pixel_counts(self) -> npt.NDArray[np.int64]:
        """How many pixels each plane has, (N,)."""
        return self._found.pixel_counts()

    @cached_property
    def xyxy(self) -> npt.NDArray[np.int64]:
        """The box of each plane's pixels, (N, 4): its first column and row, and the column and row behind its last.

        ``depth[v0:v1, u0:u1]`` is the box ``u0, v0, u1, v1``.
        """
        return self._found.boxes()

    @cached_property
    def centroids(self) -> Floats:
        """Mean of each plane's points, metres in camera coordinates, (N, 3)."""
        return self._found.centroids()

    @cached_property
    def centroids_px(self) -> Floats:
        """Mean (u, v) of each plane's pixels, (N, 2)."""
        return self._found.centroids_px()

    @cached_property
    def covariances(self) -> Floats:
        """Covariance of (nx, ny, nz, distance) of each plane, (N, 4, 4).

        It is propagated from the noise of the sensor, which is stated, known, or estimated from the map. That of the normal
        has rank 2, since a unit vector cannot change its length.
        """
        return self._found.covariances()

    @cached_property
    def fits(self) -> Floats:
        """Each plane in map units, (N, 4): value = a u + b v + c by least squares, and the rms. NaN where there is none."""
        return self._found.fits()

    @cached_property
    def notes(self) -> list[str]:
        """What a person should know of how the map was read and of what was found, as the program says it."""
        return self._found.notes()

    @property
    def camera(self) -> tuple[float, float, float, float] | None:
        """(fx, fy, cx, cy) in pixels, if the camera is known."""
        return self._found.camera

    @property
    def size(self) -> tuple[int, int]:
        """Columns and rows of the map."""
        return self._found.size

    @property
    def seconds(self) -> float:
        """How long the library took: to say which pixels are valid, and to find the planes."""
        return self._found.seconds

    # One plane.

    def mask(self, k: int) -> npt.NDArray[np.bool_]:
        """The pixels of plane k, (height, width)."""
        mask: npt.NDArray[np.bool_] = self.labels == self._label(k)
        return mask

    def points(self, k: int) -> Floats:
        """The points of plane k as they were measured, (pixels, 3), metres in camera coordinates, row by row.

        Raises
        ------
        InputError
            Without unit and camera, and if the array was written to since.
        """
        rays = self._rays
        u0, v0, u1, v1 = self.xyxy[k]
        part = np.s_[v0:v1, u0:u1]
        inside = self.labels[part] == self._label(k)
        depth = self._depth_m[part][inside].astype(np.float64)
        return np.column_stack([rays[part][inside] * depth[:, None], depth])

    def plane_model(self, k: int) -> Floats:
        """(a, b, c, d) of plane k, (4,): a x + b y + c z + d = 0 in metres and camera coordinates.

        (a, b, c) is the unit normal towards the camera, so that d is the distance of the camera, from 0 up. Open3D's
        ``segment_plane`` gives the same four numbers with either sign.
        """
        return np.append(self.normals[k], self.distances[k])

    def polygons(self, k: int, *, metric: bool = False, tolerance: float = TOLERANCE, min_hole: int = 0) -> list[Polygon]:
        """The outlines of plane k: one polygon with its holes for each of its connected groups of pixels.

        Parameters
        ----------
        k : int
            The plane.
        metric : bool, optional
            Whether corners are points on the plane, metres, rather than (u, v), pixels.
        tolerance : float, optional
            How far outlines may be from the borders of the pixels, pixels; 0 keeps every corner.
        min_hole : int, optional
            Holes of fewer pixels are left out.

        Returns
        -------
        list of Polygon
            Centres of pixels are at whole numbers, so that the corners of pixel (0, 0) are at -0.5 and 0.5.
        """
        found = self._outlines(tolerance, min_hole).polygons(self._label(k), metric)
        return [Polygon(outer, holes) for outer, holes in _metric(found, metric)]

    def hull(self, k: int, *, metric: bool = False) -> Floats:
        """The convex hull of plane k, (corners, 2) in pixels or (corners, 3) in metres."""
        hull: Floats = _metric(self._outlines(TOLERANCE, 0).hull(self._label(k), metric), metric)
        return hull

    def rectangle(self, k: int, *, metric: bool = False) -> Rectangle:
        """The rectangle of least area around plane k, on the picture in pixels or on the plane in metres."""
        centre, axes, sides = _metric(self._outlines(TOLERANCE, 0).rectangle(self._label(k), metric), metric)
        return Rectangle(np.array(centre), np.array(axes), np.array(sides))

    def explain(self, u: int, v: int) -> Explanation:
        """Says why the pixel in column u and row v has a plane or none, and which parameters would give it one.

        Examples
        --------
        >>> planes = depthplanes.detect(depthplanes.scene("room:sensor=clean_mm"))
        >>> planes.explain(320, 400).verdict
        'plane'
        """
        return Explanation(json.loads(self._found.explain(u, v)))

    # Pictures.

    def draw(self, image: npt.NDArray[np.uint8] | None = None) -> npt.NDArray[np.uint8]:
        """The map in grey, or a picture of yours, with each plane in its colour, (height, width, 3), sRGB.

        Parameters
        ----------
        image : array of shape (height, width, 3), uint8, optional
            A picture that the camera took at the same time, registered to the map.
        """
        return self._found.overlay(None if image is None else np.ascontiguousarray(image))

    def plot(self, ax: matplotlib.axes.Axes | None = None) -> matplotlib.axes.Axes:
        """Draws the planes with their labels into a plot of Matplotlib, and returns its axes."""
        from ._export.plot import plot

        return plot(self, ax)

    # Other forms.

    def to_dict(self, *, source: str | None = None, outlines: float | None = None) -> dict[str, Any]:
        """The record of the map and its planes, as the program writes it (``--planes FILE.json``, docs/planes-schema.md).

        Parameters
        ----------
        source : str, optional
            What the map is called.
        outlines : float, optional
            With outlines within this tolerance, pixels.
        """
        record: dict[str, Any] = json.loads(self._encode("planes", "json", source, outlines))
        return record

    def to_coco(self, *, source: str | None = None) -> dict[str, Any]:
        """The planes as annotations of COCO, as the program writes them (``--planes FILE.coco.json``): masks by run lengths."""
        coco: dict[str, Any] = json.loads(self._encode("planes", "coco.json", source))
        return coco

    def to_geojson(self, *, source: str | None = None, outlines: float = TOLERANCE) -> dict[str, Any]:
        """The outlines as GeoJSON in pixels, as the program writes them (``--planes FILE.geojson``)."""
        collection: dict[str, Any] = json.loads(self._encode("planes", "geojson", source, outlines))
        return collection

    def to_dataframe(self) -> pandas.DataFrame:
        """A row for each plane, with the columns of the program's table (``--planes FILE.csv``). Needs pandas."""
        from ._export.dataframe import to_dataframe

        return to_dataframe(self)

    def to_open3d(self) -> list[open3d.geometry.PointCloud]:
        """The points of each plane as a point cloud of Open3D in the plane's colour, with its normal. Needs open3d."""
        from ._export.open3d import to_open3d

        return to_open3d(self)

    def to_supervision(self) -> supervision.Detections:
        """The planes as detections of supervision: boxes, masks, and the other arrays as `data`. Needs supervision."""
        from ._export.supervision import to_supervision

        return to_supervision(self)

    def to_rerun(self, path: str = "planes", recording: Any = None) -> None:
        """Logs camera, depth, labels and outlines to Rerun below an entity path. Needs rerun-sdk."""
        from ._export.rerun import to_rerun

        to_rerun(self, path, recording)

    def to_ros(self, frame_id: str = "camera", stamp: tuple[int, int] = (0, 0), types: Any = None) -> dict[str, Any]:
        """The labels and planes as messages of ROS 2: ``labels``, a sensor_msgs/Image, and ``planes``, a list of shape_msgs/Plane.

        Parameters
        ----------
        frame_id : str, optional
            The frame of coordinates of the camera (optical: x right, y down, z forward).
        stamp : (int, int), optional
            Seconds and nanoseconds.
        types : typestore of rosbags, optional
            Where messages are taken from. Without it they are those of the ROS that is installed, or else of rosbags.
        """
        from ._export.ros import to_ros

        return to_ros(self, frame_id, stamp, types)

    def write(
        self,
        *,
        labels: Path | None = None,
        overlay: Path | None = None,
        planes: Path | None = None,
        cloud: Path | None = None,
        mesh: Path | None = None,
        curved: Path | None = None,
        outlines: float | None = None,
        legend: bool = False,
        source: str | None = None,
    ) -> None:
        """Writes files as the program does: all of them, or none. The endings of names choose the form.

        Parameters
        ----------
        labels : path, optional
            Label image, ``.png`` (16 bits) or ``.npy``.
        overlay : path, optional
            Picture, ``.png``.
        planes : path, optional
            Planes, ``.json``, ``.csv``, ``.geojson`` or ``.coco.json``.
        cloud, mesh : path, optional
            Point cloud, and mesh of the planes, ``.ply``.
        curved : path, optional
            Label image of curved surfaces.
        outlines : float, optional
            With outlines within this tolerance, pixels.
        legend : bool, optional
            Whether the picture has a legend.
        source : str, optional
            What the map is called.

        Raises
        ------
        InputError, FileError
            For a name that no form has, and what the system does not let be written.
        """
        given = {"labels": labels, "overlay": overlay, "planes": planes, "cloud": cloud, "mesh": mesh, "curved": curved}
        files = [(name, os.fspath(path)) for name, path in given.items() if path is not None]
        self._found.write(files, source, _outlines(outlines), legend)

    def _encode(self, name: str, extension: str, source: str | None = None, outlines: float | None = None) -> bytes:
        return self._found.encode(name, extension, source, _outlines(outlines))

    @cached_property
    def _depth_m(self) -> npt.NDArray[np.float32]:
        return self._found.depth_m()

    @cached_property
    def _rays(self) -> Floats:
        rays = self._found.rays()
        if rays is None:
            raise InputError("points need the camera; state camera=(fx, fy, cx, cy)")
        return rays

    def _outlines(self, tolerance: float, min_hole: int) -> _native.Outlines:
        known = self._known_outlines
        if (tolerance, min_hole) not in known:
            known[tolerance, min_hole] = self._found.outlines(tolerance, min_hole)
        return known[tolerance, min_hole]

    @cached_property
    def _known_outlines(self) -> dict[tuple[float, int], _native.Outlines]:
        return {}

    def _label(self, k: int) -> int:
        """The label of plane k; negative k count from the end."""
        return range(1, len(self) + 1)[k]


def write(result: Planes, /, **files: Any) -> None:
    """Writes planes to files: `Planes.write`."""
    result.write(**files)


def _outlines(tolerance: float | None) -> tuple[float, int] | None:
    return None if tolerance is None else (tolerance, 0)


def _metric(found: Any, metric: bool) -> Any:
    """What was found, which there is none of only in metres."""
    if found is None:
        wanted = "in metres" if metric else "in pixels"
        raise InputError(f"the plane's outline is not known {wanted}: that needs unit and camera, and a plane that ends before infinity")
    return found
