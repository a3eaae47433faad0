"""Planes as pictures, as files, and in the forms of other packages."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any, cast

import numpy as np
import numpy.typing as npt

from . import _accept
from ._errors import InputError
from ._options import Path
from ._plane import TOLERANCE

if TYPE_CHECKING:
    import matplotlib.axes
    import open3d
    import pandas
    import supervision

    from . import _native
    from ._planes import Planes


#: Outputs of the program that have another name here.
OUTPUTS = {"curved": "curved-labels"}


class Forms:
    """What `Planes` is turned into."""

    _found: _native.Found

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
        return plot(self._planes, ax)

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

        return to_dataframe(self._planes)

    def to_open3d(self) -> list[open3d.geometry.PointCloud]:
        """The points of each plane as a point cloud of Open3D in the plane's colour, with its normal. Needs open3d."""
        from ._export.open3d import to_open3d

        return to_open3d(self._planes)

    def to_supervision(self) -> supervision.Detections:
        """The planes as detections of supervision: boxes, masks, and the other arrays as `data`. Needs supervision."""
        from ._export.supervision import to_supervision

        return to_supervision(self._planes)

    def to_rerun(self, path: str = "planes", recording: Any = None) -> None:
        """Logs camera, depth, labels and outlines to Rerun below an entity path. Needs rerun-sdk."""
        from ._export.rerun import to_rerun

        to_rerun(self._planes, _accept.text("path", path), recording)

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
        return to_ros(self._planes, _accept.text("frame_id", frame_id), (seconds, nanoseconds), types)

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
            Label image of curved surfaces, ``.png`` or ``.npy``; of a `Detector` with ``curved=True``.
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
        files = [(OUTPUTS.get(name, name), _accept.path(name, path)) for name, path in given.items() if path is not None]
        if not files:
            raise InputError(f"there is no file to write; accepted: any of {', '.join(given)}, each with a path")
        self._found.write(files, _source(source), _outlines(outlines), _accept.flag("legend", legend))

    @property
    def _planes(self) -> Planes:
        """What it is the base of."""
        return cast("Planes", self)

    def _encode(self, name: str, extension: str, source: str | None = None, outlines: float | None = None) -> bytes:
        return self._found.encode(name, extension, _source(source), _outlines(outlines))

    def _picture(self, image: npt.NDArray[np.uint8]) -> npt.NDArray[np.uint8]:
        """A picture of the size of the map, (height, width, 3)."""
        (width, height), array = self._found.size, np.asarray(image)
        accepted = f"uint8 of the map's size, ({height}, {width}, 3) in sRGB or ({height}, {width}) in grey"
        if array.dtype != np.uint8:
            raise _accept.wrong_type("image", array if array.ndim else image, accepted)
        if array.shape == (height, width):
            array = np.repeat(array[:, :, None], 3, axis=2)
        if array.shape != (height, width, 3):
            raise _accept.wrong_value("image", array, accepted)
        return np.ascontiguousarray(array)


def _source(source: str | None) -> str | None:
    return None if source is None else _accept.text("source", source)


def _outlines(tolerance: float | None) -> tuple[float, int] | None:
    return None if tolerance is None else (_accept.number("outlines", tolerance, least=0), 0)
