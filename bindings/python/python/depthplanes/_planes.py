"""The result: planes of a map, with the map."""

from __future__ import annotations

import json
from collections.abc import Iterator
from functools import cached_property
from typing import Any, overload

import numpy as np
import numpy.typing as npt

from . import _accept, _native
from ._errors import InputError, InputIndexError, InputTypeError
from ._explanation import Explanation
from ._forms import Forms
from ._plane import TOLERANCE, Floats, Plane, Polygon, Rectangle
from ._words import in_python


class Planes(Forms):
    """The planes of one map, the largest first, as arrays with a row for each plane.

    `planes[k]` is one `Plane`, and so is each element of a loop. `planes[planes.areas > 1]`, `planes[:3]` and
    `planes[[0, 4]]` are `Planes` again: their labels are numbered anew, and pixels of the others have label 0. In any
    of them the pixels of plane k have the label k + 1.

    `points`, `draw`, `explain`, `write` and the conversions read the map again; an array that is another map since is
    refused, while a change of a few pixels is not noticed. Without unit and camera what is in metres is NaN.

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
        """What a person should know of how the map was read and of what was found; of a selection, in the whole result."""
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


def _metric(found: Any, metric: bool) -> Any:
    """What was found, which there is none of only in metres."""
    if found is None:
        wanted = "in metres" if metric else "in pixels"
        raise InputError(f"the plane's outline is not known {wanted}: that needs unit and camera, and a plane that ends before infinity")
    return found
