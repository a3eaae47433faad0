"""From maps to planes."""

from __future__ import annotations

import copy
import os
import warnings
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from . import _accept, _native
from ._errors import InputTypeError, ReadingWarning
from ._frame import Frame
from ._options import PARAMETERS, Camera, DetectorOptions, Path, camera_of, reading_of, searching_of
from ._planes import Planes

if TYPE_CHECKING:
    from typing_extensions import Unpack


class Detector:
    """Finds planes in the maps of one camera.

    Keep it for all frames of the camera: after the first frame of a size it needs no further memory. Threads of Python may
    share it, and run at the same time. The same map gives the same planes, whatever came before.

    Parameters
    ----------
    sensor : str, optional
        A known sensor, such as ``"kinect1"``: its unit, its nominal camera and its noise.
        ``depthplanes.tables()["sensors"]`` lists them.
    camera : (fx, fy, cx, cy), 3 x 3 array, or path, optional
        Focal lengths and principal point in pixels, the matrix of them, or a camera file of ROS, OpenCV, RealSense, COLMAP,
        KITTI and many more programs. Without a camera planes have labels and no metres.
    unit : str, optional
        What the numbers mean: ``"mm"``, ``"m"``, ``"tum"`` (1/5000 m), ``"disparity"``, ``"inverse-depth"`` and others
        (``depthplanes.tables()["units"]``). Without it 16-bit numbers are millimetres, floats are metres, and 8-bit numbers
        are grey levels without a unit.
    method : str, optional
        ``"planar"``, which needs no parameter, or another of ``depthplanes.tables()["methods"]``.
    **options
        More of the map: `scale` (map units per metre), `depth_scale` (metres per map unit), `ray_distance` (the numbers are
        distances along the rays), `disparity` with `focal` (pixels), `baseline` (metres) and `doffs` (pixels) of a stereo
        rig, `missing` (a number that means so, beside 0, NaN and infinity), `valid_range` (low, high; map units),
        `camera_size` (width, height of the picture that the camera is for), `rectified` (whether lens distortion is
        ignored), `swap_bytes`, `noise_table` (a CSV file, or rows of range and standard deviation in metres).
        How it works: `threads` (1), `curved` (whether curved surfaces are wanted as well), `merge_coplanar` (degrees,
        metres: within what pieces of one plane are joined), and the parameters of the method, such as `min_pixels`
        (``depthplanes.tables()["methods"]``).

    Raises
    ------
    InputError
        For a value that is not accepted; the text says what is.
    InputTypeError
        For a keyword that the method does not have.

    Examples
    --------
    >>> import numpy as np
    >>> depth = np.full((480, 640), 2.0, dtype=np.float32)  # a wall, 2 m away
    >>> detector = depthplanes.Detector(camera=(525, 525, 319.5, 239.5))
    >>> planes = detector(depth)
    >>> len(planes), planes.distances, planes.pixel_counts
    (1, array([2.]), array([307200]))
    """

    def __init__(
        self,
        sensor: str | None = None,
        camera: Camera | None = None,
        unit: str | None = None,
        method: str = "planar",
        **options: Unpack[DetectorOptions],
    ) -> None:
        searching = searching_of(method, options)
        self._native = _native.Detector(reading_of(sensor, camera, unit, options), method, *searching)
        given = {"sensor": sensor, "camera": camera_of(camera), "unit": unit, "method": method, **copy.deepcopy(options)}
        self._given = {name: value for name, value in given.items() if value is not None}

    def __call__(self, depth: npt.ArrayLike | Frame | Path) -> Planes:
        """Finds the planes of one map.

        Parameters
        ----------
        depth : array of shape (height, width), Frame, or path
            The map: an array of NumPy, or anything that becomes one without a copy (``__array__``, DLPack), such as a
            tensor of PyTorch or a DataArray of xarray. Pixels of type uint8, uint16 and float32 are read where they lie,
            also in a crop of a larger array; they must not be written to meanwhile. Other types are converted. A `Frame`
            knows what was stated when it was read; of what it does not know this detector's words hold. Or the path of a file.

        Returns
        -------
        Planes
            The largest first.

        Raises
        ------
        InputError, InputTypeError, FileError
            For what is no map, and for a `Frame` that contradicts what is stated here.

        Warns
        -----
        ReadingWarning
            With what is odd about the first map of each size and type; of each file and each frame.
        """
        planes, is_first = self._find(depth)
        return _warned(planes) if is_first else planes

    def _find(self, depth: npt.ArrayLike | Frame | Path) -> tuple[Planes, bool]:
        """The planes, and whether it is to be said what is odd about the map."""
        if type(depth) is np.ndarray:  # most calls; all else takes longer to tell apart
            found, is_first = self._native.detect(depth)
            return Planes(found), is_first
        if isinstance(depth, (str, os.PathLike)):
            return Planes(self._native.detect_file(os.fspath(depth))), True
        if isinstance(depth, Frame):
            return Planes(self._native.detect_frame(depth._native)), True
        found, is_first = self._native.detect(as_array(depth))
        return Planes(found), is_first

    def __repr__(self) -> str:
        given = {"method": self._native.parameters()[0], **self._given}
        stated = [f"{name}={_accept.shown(value)}" for name, value in given.items() if name not in PARAMETERS]
        parameters = [f"{name}={value:g}" for name, value in self.parameters.items()]
        return f"Detector({', '.join(stated + parameters)})"

    def __reduce__(self) -> tuple[Any, ...]:
        """Other processes make it anew of the same words."""
        return _made_of, (self._given,)

    @property
    def parameters(self) -> dict[str, float]:
        """The value of each parameter of the method."""
        return {name.replace("-", "_"): value for name, value in self._native.parameters()[1]}


def _made_of(given: dict[str, Any]) -> Detector:
    return Detector(**given)


def detect(
    depth: npt.ArrayLike | Frame | Path,
    *,
    sensor: str | None = None,
    camera: Camera | None = None,
    unit: str | None = None,
    method: str = "planar",
    **options: Unpack[DetectorOptions],
) -> Planes:
    """Finds the planes of one map. For many maps of a camera keep a `Detector`, which takes the same words.

    Parameters
    ----------
    depth : array of shape (height, width), Frame, or path
        The map, as `Detector.__call__` takes it.
    sensor, camera, unit, method, **options
        As for `Detector`.

    Returns
    -------
    Planes
        The largest first.

    Examples
    --------
    >>> frame = depthplanes.scene("planes3:sensor=clean_mm")
    >>> depthplanes.detect(frame.depth, unit="mm", camera=frame.camera).distances.round(2)
    array([2.14, 1.4 , 2.17])
    """
    planes, _ = Detector(sensor, camera, unit, method, **options)._find(depth)
    return _warned(planes)


#: What is a map.
MAPS = "an array of numbers of shape (height, width), a Frame, or the path of a file"


def as_array(depth: Any) -> npt.NDArray[Any]:
    """The map as an array of NumPy, without a copy where that can be; pixels that are masked are 0."""
    if isinstance(depth, np.ma.MaskedArray):
        filled: npt.NDArray[Any] = np.where(depth.mask, 0, depth.data).astype(depth.dtype, copy=False)
        return filled
    if isinstance(depth, np.ndarray):
        return depth
    try:
        if not hasattr(depth, "__array__") and hasattr(depth, "__dlpack__"):
            return np.from_dlpack(depth)
        array = np.asarray(depth)
    except Exception as error:  # of whatever package the map is of: a tensor of a GPU, rows of several lengths
        raise InputTypeError(f"depth is a {type(depth).__name__} that is no array of NumPy ({error}); accepted: {MAPS}") from error
    if array.dtype.kind not in "buifc":
        raise _accept.wrong_type("depth", depth, MAPS)
    return array


def _warned(planes: Planes) -> Planes:
    """Warns whoever called the caller of what is odd."""
    for note in planes.notes:
        warnings.warn(note, ReadingWarning, stacklevel=3)
    return planes
