"""Planes that keep their identity from frame to frame."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from . import _accept, _native
from ._errors import InputError, InputTypeError
from ._frame import Pose
from ._planes import Planes


#: How far a product of two rows of a rotation may be from that of a true one, as in the library.
NEAR = 0.02


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
        self._native = _native.Tracker(_accept.whole("kept_frames", kept_frames, least=0, most=2**32 - 1))

    def __call__(self, planes: Planes, pose: Pose | tuple[npt.ArrayLike, npt.ArrayLike] | npt.ArrayLike | None = None) -> Tracks:
        """Takes in the planes of the next frame.

        Parameters
        ----------
        planes : Planes
            What was found in it; all of it, not a selection. The ids of a selection are ``tracks.ids[selection.indices]``.
        pose : 4 x 4 array, Pose or (rotation, translation), optional
            Where the camera was, camera to world: a point X of the camera is ``rotation @ X + translation`` in the world, metres.
            As a matrix [[rotation, translation], [0, 0, 0, 1]]. Without it the motion is estimated from the planes.

        Raises
        ------
        InputError, InputTypeError
            For a selection, and for a pose that is no motion of a rigid body.
        """
        if not isinstance(planes, Planes):
            raise _accept.wrong_type("planes", planes, "Planes, as a Detector gives them")
        if planes._is_selection:
            raise InputError(
                f"planes is a selection of {len(planes)} planes; accepted: all planes of the frame, as a Detector gives them; the ids of a "
                "selection are tracks.ids[selection.indices]"
            )
        return Tracks(*self._native.track(planes._found, None if pose is None else _pose(pose)))

    def __reduce__(self) -> Any:
        """Refuses to be pickled."""
        raise InputTypeError("a tracker cannot be pickled, since what it follows is in the library's memory; accepted: its Tracks")


#: What is a pose.
POSE = (
    "camera to world, metres: a matrix of 4 x 4, [[rotation, translation], [0, 0, 0, 1]], or (rotation, translation), where the rotation is "
    "of 3 x 3, with rows of length 1 at right angles and the determinant 1; of a matrix from world to camera take the inverse"
)


def _pose(pose: Any) -> tuple[list[list[float]], list[float]]:
    """The rotation and the translation of a motion of a rigid body."""
    if isinstance(pose, Sequence) and len(pose) == 2:
        rotation, translation = _accept.numbers("pose", pose[0], (3, 3), POSE), _accept.numbers("pose", pose[1], (3,), POSE)
    else:
        matrix = _accept.numbers("pose", pose, (4, 4), POSE)
        if np.abs(matrix[3] - [0, 0, 0, 1]).max() > NEAR:
            raise InputError(f"pose has the last row {matrix[3].tolist()}; accepted: {POSE}")
        rotation, translation = matrix[:3, :3], matrix[:3, 3]
    is_rigid = np.abs(rotation @ rotation.T - np.eye(3)).max() <= NEAR and np.linalg.det(rotation) > 0 and np.isfinite(translation).all()
    if not is_rigid:
        raise InputError(f"pose is no motion of a rigid body, with the rotation {rotation.tolist()}; accepted: {POSE}")
    return rotation.tolist(), translation.tolist()


def _tracked(record: dict[str, Any]) -> TrackedPlane:
    arrays = {name: None if record[name] is None else np.array(record[name]) for name in ("normal", "covariance")}
    return TrackedPlane(**{**record, **arrays})
