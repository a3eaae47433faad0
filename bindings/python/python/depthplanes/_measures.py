"""How good an answer is, and how noisy a sensor."""

from __future__ import annotations

import json
from collections.abc import Iterable
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _native
from ._errors import InputError
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
    scores: dict[str, dict[str, float | None]] = json.loads(
        _native.score(_labels(truth, "truth"), _labels(prediction, "prediction"), tolerance, truth_from)
    )
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
    several = [frames] if isinstance(frames, Frame) else list(frames)
    estimate: dict[str, Any] = json.loads(_native.noise([frame._native for frame in several]))
    return estimate


def _labels(labels: npt.ArrayLike, name: str) -> npt.NDArray[np.uint16]:
    array = np.asarray(labels)
    if array.dtype == np.uint16 and array.ndim == 2:
        return array
    is_whole = np.issubdtype(array.dtype, np.integer) or array.dtype == np.bool_
    if array.ndim != 2 or not is_whole or array.size == 0 or array.min() < 0 or array.max() > np.iinfo(np.uint16).max:
        raise InputError(
            f"the {name} is an array of {array.dtype}, shape {array.shape}; accepted: a label image of two dimensions with whole "
            "numbers from 0 (no plane) to 65535"
        )
    return array.astype(np.uint16)
