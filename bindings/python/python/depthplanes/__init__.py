"""Finds planes in depth and disparity maps: floors, walls, tables, steps.

>>> import depthplanes
>>> frame = depthplanes.scene("room:sensor=clean_mm")  # or depthplanes.read("depth.png"), or an array of your own
>>> planes = depthplanes.detect(frame.depth, unit="mm", camera=frame.camera)
>>> planes.labels.shape, planes.labels.dtype  # 0 where there is no plane, k + 1 on plane k
((480, 640), dtype('uint16'))
>>> largest = planes[0]
>>> print(f"{largest.distance:.2f} m from the camera, normal {largest.normal.round(3)}")
1.55 m from the camera, normal [ 0.    -0.966 -0.259]

`Detector` is for many maps of one camera, `read` for files, `floor` for what a robot stands on, `Tracker` for video, the module
`depthplanes.batch` for millions of files. Lengths are metres. Camera coordinates are x right, y down, z forward; normals point to
the camera. Pixels are column u and row v from 0.

`python -m depthplanes` is the program of the same name.
"""

import os as _os

from . import _native
from ._detector import Detector, detect
from ._errors import (
    Error,
    FileError,
    InputError,
    InputIndexError,
    InputTypeError,
    MissingFileError,
    MissingPackageError,
    OutOfMemoryError,
    ReadingWarning,
)
from ._explanation import Explanation
from ._frame import Frame, Pose, read, scene, video
from ._ground import Ground, floor
from ._measures import noise, score
from ._plane import Plane, Polygon, Rectangle
from ._planes import Planes, write
from ._tables import tables
from ._tracker import TrackedPlane, Tracker, Tracks

__version__ = _native.__version__

if hasattr(_os, "register_at_fork"):
    _os.register_at_fork(after_in_child=_native.forked)

__all__ = [
    "Detector",
    "Error",
    "Explanation",
    "FileError",
    "Frame",
    "Ground",
    "InputError",
    "InputIndexError",
    "InputTypeError",
    "MissingFileError",
    "MissingPackageError",
    "OutOfMemoryError",
    "Plane",
    "Planes",
    "Polygon",
    "Pose",
    "ReadingWarning",
    "Rectangle",
    "TrackedPlane",
    "Tracker",
    "Tracks",
    "__version__",
    "detect",
    "floor",
    "noise",
    "read",
    "scene",
    "score",
    "tables",
    "video",
    "write",
]
