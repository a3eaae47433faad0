"""The floor, and what stands on it."""

from __future__ import annotations

import json
from collections.abc import Sequence
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from . import _accept, _native
from ._detector import detect
from ._errors import InputTypeError
from ._frame import Frame
from ._options import Camera, DetectorOptions, Path
from ._planes import Planes

if TYPE_CHECKING:
    from typing_extensions import Unpack


class Ground:
    """The floor of a map, how the camera stands above it, and what everything else is. See docs/robot.md."""

    #: Values of `marks`.
    UNKNOWN, FLOOR, OBSTACLE, DROP, OVERHEAD = 0, 1, 2, 4, 8

    def __init__(self, native: _native.Ground, planes: Planes) -> None:
        self._native = native
        self.planes = planes
        """The planes of the map."""

    def to_dict(self) -> dict[str, Any]:
        """The record, as ``depthplanes floor --json`` writes it (docs/robot.md)."""
        return self._record

    @property
    def floor(self) -> dict[str, Any] | None:
        """The floor: label, height_m of the camera above it, tilt_deg, roll_deg, their standard deviations; None if there is none."""
        floor: dict[str, Any] | None = self._record["floor"]
        return floor

    @property
    def height(self) -> float:
        """Height of the camera above the floor, metres; NaN without a floor."""
        return float("nan") if self.floor is None else float(self.floor["height_m"])

    @property
    def up(self) -> npt.NDArray[np.float64] | None:
        """The direction that is up, camera coordinates, (3,); None if it is not known."""
        up = self._record["up"]
        return None if up is None else np.array(up)

    @property
    def classes(self) -> list[str]:
        """What each plane is: ``"floor"``, ``"wall"``, ``"ceiling"``, ``"step"`` and others; empty without a floor."""
        return [plane["class"] for plane in self._record["planes"]]

    @property
    def heights(self) -> npt.NDArray[np.float64]:
        """Height of each plane's middle above the floor, metres, (N,); empty without a floor."""
        return np.array([plane["height_m"] for plane in self._record["planes"]], dtype=np.float64)

    @property
    def obstacles(self) -> list[dict[str, Any]]:
        """What stands on the floor and where it falls, the nearest first: kind, distance_m, bearing_deg, width_m, height_m."""
        return list(self._record["obstacles"])

    @property
    def sectors(self) -> list[dict[str, Any]]:
        """How far the floor is free, from left to right: from_deg, to_deg, free_m, blocked."""
        return list(self._record["sectors"])

    @property
    def steps(self) -> list[dict[str, Any]]:
        """Steps up from the floor, then steps down: rise_m, run_m, distance_m and others."""
        return list(self._record["steps"])

    @cached_property
    def marks(self) -> npt.NDArray[np.uint8] | None:
        """What each pixel is, (height, width): `UNKNOWN`, `FLOOR`, `OBSTACLE`, `DROP` or `OVERHEAD`; None without a floor."""
        return self._native.marks()

    def grid(self, resolution: float = 0.05) -> tuple[npt.NDArray[np.int8], npt.NDArray[np.float64]]:
        """The floor from above, as in ROS' nav_msgs/OccupancyGrid.

        Parameters
        ----------
        resolution : float, optional
            Side of a cell, metres, 0.01 to 1.

        Returns
        -------
        cells : array of int8, (along y, along x)
            -1 unknown, 0 free, 100 occupied. x is ahead of the camera, y to its left.
        origin : array, (2,)
            x and y of the corner of the first cell, metres from the point of the floor below the camera.
        """
        cells, origin = self._native.grid(_accept.number("resolution", resolution))
        return cells, np.array(origin)

    @cached_property
    def _record(self) -> dict[str, Any]:
        record: dict[str, Any] = json.loads(self._native.record(self.planes._found.source))
        return record

    def __reduce__(self) -> Any:
        """Refuses to be pickled."""
        raise InputTypeError("a ground cannot be pickled, since its map is in the library's memory; accepted: ground.to_dict(), its arrays")

    def __repr__(self) -> str:
        if self.floor is None:
            return "<Ground: no floor>"
        return f"<Ground: the floor is {self.height:.3f} m below the camera, {len(self.obstacles)} obstacles>"


def floor(
    depth: npt.ArrayLike | Frame | Path | Planes,
    *,
    up: Sequence[float] | None = None,
    camera_height: float | None = None,
    sensor: str | None = None,
    camera: Camera | None = None,
    unit: str | None = None,
    method: str = "planar",
    **options: Unpack[DetectorOptions],
) -> Ground:
    """Finds the floor of a map, how the camera stands above it, what every plane is, obstacles and steps.

    Parameters
    ----------
    depth : array of shape (height, width), Frame, path, or Planes
        The map, or what was found in it.
    up : (x, y, z), optional
        The direction that is up, camera coordinates: what an accelerometer at rest measures. Without it the planes say.
    camera_height : float, optional
        Height of the camera above the floor, metres, if it is known: of several levels the one nearest to it is the floor.
    sensor, camera, unit, method, **options
        As for `Detector`; for `Planes` they are of no use.

    Raises
    ------
    InputError
        Without unit and camera.

    Examples
    --------
    >>> ground = depthplanes.floor(depthplanes.scene("corridor:sensor=kinect,size=320x240"))
    >>> round(ground.height, 1), ground.classes[ground.floor["label"] - 1]
    (1.4, 'floor')
    """
    direction = None if up is None else _accept.numbers("up", up, (3,), "(x, y, z), camera coordinates").tolist()
    height = None if camera_height is None else _accept.number("camera_height", camera_height)
    finder = _native.GroundFinder(direction, height)
    if isinstance(depth, Planes):
        planes = depth
    else:
        planes = detect(depth, sensor=sensor, camera=camera, unit=unit, method=method, **options)
    return Ground(finder.find(planes._found), planes)
