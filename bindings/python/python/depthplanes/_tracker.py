"""Planes that keep their identity from frame to frame."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from . import _native
from ._frame import Pose
from ._planes import Planes


class TrackedPlane(NamedTuple):
    """A plane over frames."""

    id: int
    """Its lasting number, from 1; never given twice."""
    state: str
    """``"new"``, ``"tracked"``, ``"lost"`` (not seen) or ``"subsumed"`` (now part of another plane)."""
    label: int | None
    """Its label in this frame's `Planes.labels`; None while it is not seen."""
    age: int
    """Frames since it was first seen, this one included."""
    seen: int
    """Frames in which it was seen."""
    unseen: int
    """Frames since it was last seen; 0 while it is."""
    subsumed_by: int | None
    """The id of the plane that it is part of now."""
    split_from: int | None
    """The id of the plane that it was part of before."""
    normal: npt.NDArray[np.float64] | None
    """Unit normal towards the camera, filtered over the frames, (3,); None without unit and camera."""
    distance: float | None
    """Distance of the camera from the plane, filtered over the frames, metres."""
    covariance: npt.NDArray[np.float64] | None
    """Covariance of (nx, ny, nz, distance), (4, 4)."""


class Tracks:
    """The planes that are followed, after a frame."""

    def __init__(self, ids: list[int], records: list[dict[str, Any]], labels: npt.NDArray[np.uint16]) -> None:
        self._labels = labels
        self.ids: npt.NDArray[np.uint32] = np.array(ids, dtype=np.uint32)
        """The id of each plane of the frame, (N,)."""
        self.planes: list[TrackedPlane] = [_tracked(record) for record in records]
        """All planes that are followed, by id; also those that are lost or subsumed."""

    @property
    def labels(self) -> npt.NDArray[np.uint32]:
        """The id of each pixel's plane, (height, width); 0 where there is none.

        Its borders do not flicker: where planes meet, pixels that lie on both are of the one that they were of before.
        """
        of_label = np.concatenate([np.zeros(1, np.uint32), self.ids])
        labels: npt.NDArray[np.uint32] = of_label[self._labels]
        return labels

    def __repr__(self) -> str:
        return f"<Tracks: {len(self.ids)} planes seen, {len(self.planes)} followed>"


class Tracker:
    """Gives planes ids that last from frame to frame. Call it with the planes of each frame, in order.

    Parameters
    ----------
    kept_frames : int, optional
        For how many frames a plane that is not seen keeps its id.

    Examples
    --------
    >>> tracker = depthplanes.Tracker()
    >>> planes = depthplanes.detect(depthplanes.scene("planes3:size=160x120"))
    >>> tracker(planes).ids
    array([1, 2, 3], dtype=uint32)
    """

    def __init__(self, kept_frames: int = 30) -> None:
        self._native = _native.Tracker(kept_frames)

    def __call__(self, planes: Planes, pose: Pose | tuple[npt.ArrayLike, npt.ArrayLike] | None = None) -> Tracks:
        """Takes in the planes of the next frame.

        Parameters
        ----------
        planes : Planes
            What was found in it; all of it, not a selection.
        pose : Pose or (rotation, translation), optional
            Where the camera was, camera to world. Without it the motion is estimated from the planes.
        """
        place = None if pose is None else tuple(np.asarray(part, dtype=np.float64).tolist() for part in pose)
        return Tracks(*self._native.track(planes._found, place))


def _tracked(record: dict[str, Any]) -> TrackedPlane:
    arrays = {name: None if record[name] is None else np.array(record[name]) for name in ("normal", "covariance")}
    return TrackedPlane(**{**record, **arrays})
