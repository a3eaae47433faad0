"""The result: planes of a map, with the map."""

from __future__ import annotations

import json
from collections.abc import Iterator
from functools import cached_property
from typing import TYPE_CHECKING, Any, overload

import numpy as np
import numpy.typing as npt

from . import _accept, _native
from ._errors import InputError, InputIndexError, InputTypeError
from ._explanation import Explanation
from ._options import Path
from ._plane import TOLERANCE, Floats, Plane, Polygon, Rectangle
from ._words import in_python

if TYPE_CHECKING:
    import matplotlib.axes
    import open3d
    import pandas
    import supervision


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

    def __init__(self, found: _native.Found, places: tuple[int, ...] | None = None) -> None:
        self._found = found
        self._places = places

    def __len__(self) -> int:
        return len(self._found)

    @overload
    def __getitem__(self, index: int) -> Plane: ...

    @overload
    def __getitem__(self, index: slice | list[int] | npt.NDArray[Any]) -> Planes: ...

    def __getitem__(self, index: int | slice | list[int] | npt.NDArray[Any]) -> Plane | Planes:
        try:
            chosen = np.arange(len(self))[index]
        except IndexError as error:
            raise InputIndexError(f"index is {_accept.shown(index)}: {error}; accepted: {self._accepted}") from None
        if np.ndim(chosen) == 0:
            return Plane(self, int(chosen))
        if np.ndim(chosen) != 1:
            raise InputIndexError(f"index is {_accept.shown(index)}; accepted: {self._accepted}")
        is_all = self._places is None and chosen.tolist() == list(range(len(self)))
        return Planes(self._found.select(chosen.tolist()), None if is_all else tuple(self.indices[chosen].tolist()))

    def __iter__(self) -> Iterator[Plane]:
        return (Plane(self, index) for index in range(len(self)))

    def __reduce__(self) -> Any:
        """Refuses to be pickled."""
        raise InputTypeError(
            "planes cannot be pickled, since they hold the map in the library's memory; accepted: planes.to_dict(), arrays of planes such as "
            "planes.labels, and the Detector"
        )

    def __deepcopy__(self, memo: dict[int, Any]) -> Planes:
        """The same planes, which never change, with arrays of their own."""
        return Planes(self._found, self._places)

    def __repr__(self) -> str:
        width, height = self._found.size
        return f"<Planes: {len(self)} on {100 * np.count_nonzero(self.labels) / (width * height):.1f} % of {width} x {height} pixels>"

    # What was found, with a row for each plane.

    @cached_property
    def indices(self) -> npt.NDArray[np.int64]:
        """The place of each plane in the whole result, (N,): 0, 1, .. unless this is a selection."""
        return np.arange(len(self)) if self._places is None else np.array(self._places, dtype=np.int64)

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
        """What a person should know of how the map was read and of what was found."""
        return [in_python(note) for note in self._found.notes()]

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
        label, rays = self._label(k), self._rays
        u0, v0, u1, v1 = self.xyxy[label - 1]
        part = np.s_[v0:v1, u0:u1]
        inside = self.labels[part] == label
        depth = self._depth_m[part][inside].astype(np.float64)
        return np.column_stack([rays[part][inside] * depth[:, None], depth])

    def plane_model(self, k: int) -> Floats:
        """(a, b, c, d) of plane k, (4,): a x + b y + c z + d = 0 in metres and camera coordinates.

        (a, b, c) is the unit normal towards the camera, so that d is the distance of the camera, from 0 up. Open3D's
        ``segment_plane`` gives the same four numbers with either sign.
        """
        place = self._label(k) - 1
        return np.append(self.normals[place], self.distances[place])

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
        metric, label = _accept.flag("metric", metric), self._label(k)
        found = self._outlines(tolerance, min_hole).polygons(label, metric)
        return [Polygon(outer, holes) for outer, holes in _metric(found, metric)]

    def hull(self, k: int, *, metric: bool = False) -> Floats:
        """The convex hull of plane k, (corners, 2) in pixels or (corners, 3) in metres."""
        metric, label = _accept.flag("metric", metric), self._label(k)
        hull: Floats = _metric(self._outlines(TOLERANCE, 0).hull(label, metric), metric)
        return hull

    def rectangle(self, k: int, *, metric: bool = False) -> Rectangle:
        """The rectangle of least area around plane k, on the picture in pixels or on the plane in metres."""
        metric, label = _accept.flag("metric", metric), self._label(k)
        centre, axes, sides = _metric(self._outlines(TOLERANCE, 0).rectangle(label, metric), metric)
        return Rectangle(np.array(centre), np.array(axes), np.array(sides))

    def explain(self, u: int, v: int) -> Explanation:
        """Says why the pixel in column u and row v has a plane or none, and which parameters would give it one.

        Examples
        --------
        >>> planes = depthplanes.detect(depthplanes.scene("room:sensor=clean_mm"))
        >>> planes.explain(320, 400).verdict
        'plane'
        """
        width, height = self.size
        u, v = _accept.whole("u", u, least=0, most=width - 1), _accept.whole("v", v, least=0, most=height - 1)
        return Explanation(json.loads(self._found.explain(u, v)))

    # Pictures.

    def draw(self, image: npt.NDArray[np.uint8] | None = None) -> npt.NDArray[np.uint8]:
        """The map in grey, or a picture of yours, with each plane in its colour, (height, width, 3), sRGB.

        Parameters
        ----------
        image : array of shape (height, width, 3) or (height, width), uint8, optional
            A picture that the camera took at the same time, registered to the map: sRGB, or grey.
        """
        return self._found.overlay(None if image is None else self._picture(image))

    def plot(self, ax: matplotlib.axes.Axes | None = None) -> matplotlib.axes.Axes:
        """Draws the planes with their labels into a plot of Matplotlib, and returns its axes."""
        from ._export.plot import plot

        if ax is not None and not hasattr(ax, "imshow"):
            raise _accept.wrong_type("ax", ax, "axes of Matplotlib, or None for the current ones")
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

        to_rerun(self, _accept.text("path", path), recording)

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

        accepted = "(seconds, nanoseconds), whole numbers"
        seconds, nanoseconds = (int(part) for part in _accept.pair("stamp", stamp, accepted))
        if types is not None and not hasattr(types, "types"):
            raise _accept.wrong_type("types", types, "a typestore of rosbags, or None")
        return to_ros(self, _accept.text("frame_id", frame_id), (seconds, nanoseconds), types)

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
            For a name that no form has, for no file at all, and what the system does not let be written.
        """
        given = {"labels": labels, "overlay": overlay, "planes": planes, "cloud": cloud, "mesh": mesh, "curved": curved}
        files = [(name, _accept.path(name, path)) for name, path in given.items() if path is not None]
        if not files:
            raise InputError(f"there is no file to write; accepted: any of {', '.join(given)}, each with a path")
        self._found.write(files, _source(source), _outlines(outlines), _accept.flag("legend", legend))

    def _encode(self, name: str, extension: str, source: str | None = None, outlines: float | None = None) -> bytes:
        return self._found.encode(name, extension, _source(source), _outlines(outlines))

    def _picture(self, image: npt.NDArray[np.uint8]) -> npt.NDArray[np.uint8]:
        """A picture of the size of the map, (height, width, 3)."""
        (width, height), array = self.size, np.asarray(image)
        accepted = f"uint8 of the map's size, ({height}, {width}, 3) in sRGB or ({height}, {width}) in grey"
        if array.dtype != np.uint8:
            raise _accept.wrong_type("image", array if array.ndim else image, accepted)
        if array.shape == (height, width):
            array = np.repeat(array[:, :, None], 3, axis=2)
        if array.shape != (height, width, 3):
            raise _accept.wrong_value("image", array, accepted)
        return np.ascontiguousarray(array)

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
        tolerance, min_hole = _accept.number("tolerance", tolerance, least=0), _accept.whole("min_hole", min_hole, least=0)
        known = self._known_outlines
        if (tolerance, min_hole) not in known:
            known[tolerance, min_hole] = self._found.outlines(tolerance, min_hole)
        return known[tolerance, min_hole]

    @cached_property
    def _known_outlines(self) -> dict[tuple[float, int], _native.Outlines]:
        return {}

    def _label(self, k: int) -> int:
        """The label of plane k; negative k count from the end."""
        try:
            return range(1, len(self) + 1)[k]
        except IndexError:
            raise InputIndexError(f"k is {k}; accepted: {self._accepted}") from None
        except TypeError:
            raise _accept.wrong_type("k", k, "a whole number, the place of a plane") from None

    @property
    def _accepted(self) -> str:
        """The places that there are."""
        return f"0 to {len(self) - 1}, the places of {len(self)} planes" if len(self) else "nothing, since there are no planes"

    @property
    def _is_selection(self) -> bool:
        return self._places is not None


def write(result: Planes, /, **files: Any) -> None:
    """Writes planes to files: `Planes.write`."""
    if not isinstance(result, Planes):
        raise _accept.wrong_type("result", result, "Planes")
    result.write(**files)


def _source(source: str | None) -> str | None:
    return None if source is None else _accept.text("source", source)


def _outlines(tolerance: float | None) -> tuple[float, int] | None:
    return None if tolerance is None else (_accept.number("outlines", tolerance, least=0), 0)


def _metric(found: Any, metric: bool) -> Any:
    """What was found, which there is none of only in metres."""
    if found is None:
        wanted = "in metres" if metric else "in pixels"
        raise InputError(f"the plane's outline is not known {wanted}: that needs unit and camera, and a plane that ends before infinity")
    return found
