"""Maps that were read from files, made of scenes, or taken from videos."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cached_property
from typing import IO, TYPE_CHECKING, Any, NamedTuple

import numpy as np
import numpy.typing as npt

from . import _accept, _native
from ._errors import InputError, InputTypeError
from ._options import Camera, FileOptions, Path, reading_of_file
from ._words import in_python

if TYPE_CHECKING:
    from typing_extensions import Unpack


class Pose(NamedTuple):
    """Where a camera is: a point X of the camera is ``rotation @ X + translation`` in the world, metres."""

    rotation: npt.NDArray[np.float64]
    """(3, 3)."""
    translation: npt.NDArray[np.float64]
    """(3,), metres."""


class Frame:
    """A map with all that is known of it. What a `Detector` states as well holds where the frame says nothing."""

    def __init__(self, native: _native.Frame) -> None:
        self._native = native

    @cached_property
    def depth(self) -> npt.NDArray[Any]:
        """The numbers of the map, (height, width), uint8, uint16 or float32, in units of the map. It cannot be written to."""
        return self._native.depth

    @cached_property
    def depth_m(self) -> npt.NDArray[np.float32]:
        """Depth along the view in metres, (height, width); NaN where there is none.

        Raises
        ------
        InputError
            For disparities of an unknown rig, and other numbers that are not metric.
        """
        return self._native.depth_m()

    @property
    def camera(self) -> tuple[float, float, float, float] | None:
        """(fx, fy, cx, cy) in pixels, if the camera is known."""
        return self._native.camera

    @property
    def source(self) -> str:
        """What it is called: the path, or the text of the scene."""
        return self._native.source

    @property
    def unit(self) -> str:
        """What the numbers mean: a name of ``depthplanes.tables()["units"]``, or ``"scene"``."""
        return self._native.encoding[1]

    @property
    def metres_per_unit(self) -> float | None:
        """Metres in a unit of the map; None unless its numbers are depths."""
        return self._native.metres_per_unit

    @property
    def missing(self) -> float | None:
        """The number that means "missing", beside 0, NaN and infinity."""
        return self._native.missing

    @property
    def notes(self) -> list[str]:
        """What is odd about the map."""
        return [in_python(note) for note in self._native.warnings]

    @property
    def time(self) -> float | None:
        """When it was taken, seconds; of videos that say so."""
        return self._native.time_s

    @property
    def up(self) -> tuple[float, float, float] | None:
        """The direction that is up, camera coordinates; of videos that say so."""
        return self._native.up

    @cached_property
    def pose(self) -> Pose | None:
        """Where the camera was; of videos that say so."""
        pose = self._native.pose
        return None if pose is None else Pose(np.array(pose[0]), np.array(pose[1]))

    @cached_property
    def truth(self) -> npt.NDArray[np.uint16] | None:
        """The label image of what is really there, (height, width); of scenes alone."""
        return self._native.truth()

    def __reduce__(self) -> Any:
        """Refuses to be pickled."""
        raise InputTypeError("a frame cannot be pickled, since its map is in the library's memory; accepted: frame.depth, or the path")

    def __deepcopy__(self, memo: dict[int, Any]) -> Frame:
        """The same frame, which never changes."""
        return self

    def __repr__(self) -> str:
        width, height = self._native.size
        return f"<Frame {self.source!r}: {width} x {height}, {self.unit}>"


def read(
    path: Path | bytes | IO[bytes],
    *,
    sensor: str | None = None,
    camera: Camera | None = None,
    unit: str | None = None,
    name: str | None = None,
    **options: Unpack[FileOptions],
) -> Frame:
    """Reads a map from a file, or from its bytes: PNG, TIFF, PFM, NPY, NPZ, PCD, RVL and every other format of the program.

    The format is recognised by the content, not by the name. What is stated goes before the sensor's usual, and that before
    what the numbers look like; `Frame.unit` and `Frame.notes` say what it was taken for.

    Parameters
    ----------
    path : path, bytes or file object
        The file, or what is in it; a file that is open (``open(path, "rb")``, ``io.BytesIO``) is read from where it is.
    name : str, optional
        What bytes are called, in `Frame.source` and in messages; ``"bytes"`` unless it is stated, or the name of the open file.
    sensor, camera, unit, **options
        What is stated of it, as for `Detector`; of files also `member` (which of several maps: the array's name in NPZ, its
        index in NPY, the page of TIFF), `raw_size` (width, height) and `raw_type` (such as ``"uint16"``) of files without a
        header.

    Returns
    -------
    Frame

    Raises
    ------
    MissingFileError, FileError
        For a file that cannot be read.
    InputError
        For one that is no map; the text says what it is.
    """
    reading = reading_of_file(sensor, camera, unit, options)
    if isinstance(path, (bytes, bytearray, memoryview)) or hasattr(path, "read"):
        content, known_as = _bytes_of(path)
        return Frame(_native.Frame.decode(content, known_as if name is None else _accept.text("name", name), reading))
    if name is not None:
        raise InputError(f"name={name!r} is for bytes; the frame of a file is called by its path, which is given")
    return Frame(_native.Frame.read(_accept.path("path", path), reading))


def _bytes_of(file: Any) -> tuple[bytes, str]:
    """What is in a file object or in memory, and what it is called."""
    if not hasattr(file, "read"):
        return bytes(file), "bytes"
    content, name = file.read(), getattr(file, "name", None)
    if not isinstance(content, bytes):
        raise _accept.wrong_type("path", file, 'a file that gives bytes: open(path, "rb")')
    return content, name if isinstance(name, str) else "bytes"


def scene(spec: str = "room") -> Frame:
    """Makes a frame of a synthetic scene, which knows its camera and what is really there.

    Parameters
    ----------
    spec : str, optional
        The name of a scene, then any of ``seed=``, ``sensor=`` and ``size=WIDTHxHEIGHT``:
        ``"stairs:sensor=kinect,size=320x240"``. ``depthplanes.tables()`` lists `scenes` and `scene_sensors`.

    Examples
    --------
    >>> frame = depthplanes.scene("boxes:sensor=kinect,size=320x240")
    >>> frame.depth.shape, int(frame.truth.max()) > 5
    ((240, 320), True)
    """
    return Frame(_native.Frame.scene(_accept.text("spec", spec)))


def video(
    source: Path,
    *,
    sensor: str | None = None,
    camera: Camera | None = None,
    unit: str | None = None,
    **options: Unpack[FileOptions],
) -> Iterator[Frame]:
    """The frames of a folder of maps, of TUM RGB-D, 7-Scenes or rosbag2, of a recording (``FILE.mcap``, ``FILE.mcap:/topic``),
    or of a synthetic camera (``scene:room:frames=30``), one after the other, with time and pose where they are known.

    Parameters
    ----------
    source : path or str
        Where the frames come from.
    sensor, camera, unit, **options
        What is stated of the maps, as for `read`.

    Examples
    --------
    >>> tracker, detector = depthplanes.Tracker(), depthplanes.Detector()
    >>> for frame in depthplanes.video("scene:planes3:size=160x120,frames=3"):
    ...     print(tracker(detector(frame), pose=frame.pose).ids)
    [1 2 3]
    [1 2 3]
    [1 2 3]
    """
    native = _native.Video(_accept.path("source", source), reading_of_file(sensor, camera, unit, options))
    return (Frame(frame) for frame in iter(native.next, None))
