"""How good an answer is, and how noisy a sensor."""

from __future__ import annotations

import json
from collections.abc import Iterable
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _accept, _native
from ._frame import Frame


def score(
    prediction: npt.ArrayLike, truth: npt.ArrayLike, *, tolerance: float = 0.8, truth_from: int = 1
) -> dict[str, dict[str, float | None]]:
    """Holds a label image against the truth, by the measures of SegComp, EVOPS, the Rand index and others (docs/metrics.md).

    Parameters
    ----------
    prediction, truth : array of whole numbers, shape (height, width)
        Label images; 0 is no plane.
    tolerance : float, optional
        SegComp: the share of a plane that an overlap must exceed, 0.51 to 0.95.
    truth_from : int, optional
        The lowest label of the truth that is a plane.

    Returns
    -------
    dict
        The fields of ``depthplanes score --json``: for each family of measures a dictionary of them.

    Examples
    --------
    >>> frame = depthplanes.scene("room:sensor=clean_mm")
    >>> scores = depthplanes.score(depthplanes.detect(frame).labels, frame.truth)
    >>> scores["segcomp"]["correct"], scores["planes"]["truth"]  # found whole, of all down to the smallest
    (41, 70)
    """
    images = _labels("truth", truth), _labels("prediction", prediction)
    tolerance, truth_from = _accept.number("tolerance", tolerance), _accept.whole("truth_from", truth_from, least=0, most=65535)
    scores: dict[str, dict[str, float | None]] = json.loads(_native.score(*images, tolerance, truth_from))
    return scores


def noise(frames: Frame | Iterable[Frame]) -> dict[str, Any]:
    """Estimates how noisy a sensor is from frames of it.

    Parameters
    ----------
    frames : Frame or several
        Frames of one sensor, as of `read`. A few are enough.

    Returns
    -------
    dict
        The fields of ``depthplanes noise --json`` (docs/noise.md): among others ``depth``, the standard deviation at 1, 2, 3
        and 4 m of single pixels (``sigma_m``) and of what neighbours share (``smooth_m``).

    Raises
    ------
    InputError
        For frames with too little that is flat.

    Examples
    --------
    >>> estimate = depthplanes.noise(depthplanes.scene("room:sensor=tof_white"))
    >>> 0.5 < 1000 * estimate["depth"][1]["sigma_m"] < 10  # millimetres at 2 m
    True
    """
    try:
        several = [frames] if isinstance(frames, Frame) else list(frames)
    except TypeError:
        raise _accept.wrong_type("frames", frames, FRAMES) from None
    for frame in several:
        if not isinstance(frame, Frame):
            raise _accept.wrong_type("frames", frame, FRAMES)
    estimate: dict[str, Any] = json.loads(_native.noise([frame._native for frame in several]))
    return estimate


#: What noise is estimated from.
FRAMES = "a Frame of depthplanes.read, or several"


def _labels(name: str, labels: npt.ArrayLike) -> npt.NDArray[np.uint16]:
    accepted = "a label image of two dimensions with whole numbers from 0 (no plane) to 65535"
    try:
        array = np.asarray(labels)
    except ValueError:
        raise _accept.wrong_type(name, labels, accepted) from None
    if array.dtype == np.uint16 and array.ndim == 2:
        return array
    if array.ndim != 2 or array.dtype.kind not in "bui":
        raise _accept.wrong_type(name, array if array.ndim else labels, accepted)
    if array.size == 0 or array.min() < 0 or array.max() > np.iinfo(np.uint16).max:
        raise _accept.wrong_value(name, array, accepted)
    return array.astype(np.uint16)
