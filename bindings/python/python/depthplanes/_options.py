"""Keywords of `Detector`, `read` and others: what is stated of a map, and how planes are looked for.

The keywords are the program's flags with `_` for `-`; the library's tables hold their defaults and ranges.
"""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, TypedDict

import numpy as np
import numpy.typing as npt

from . import _native
from ._errors import InputError

if TYPE_CHECKING:
    from typing_extensions import TypeAlias

Path: TypeAlias = "str | os.PathLike[str]"
#: (fx, fy, cx, cy) in pixels, a 3 x 3 matrix, or the path of a camera file.
Camera: TypeAlias = "Sequence[float] | npt.NDArray[Any] | Path"


class ReadingOptions(TypedDict, total=False):
    """What is stated of a map beside `sensor`, `camera` and `unit`."""

    scale: float | None
    depth_scale: float | None
    ray_distance: bool
    disparity: bool
    focal: float | None
    baseline: float | None
    doffs: float | None
    missing: float | None
    valid_range: tuple[float, float] | None
    camera_size: tuple[int, int] | None
    rectified: bool | None
    swap_bytes: bool
    noise_table: Path | Sequence[Sequence[float]] | None


class FileOptions(ReadingOptions, total=False):
    """What is stated of a file as well."""

    member: str | None
    raw_size: tuple[int, int] | None
    raw_type: str | None


class Parameters(TypedDict, total=False):
    """The parameters of all methods; `depthplanes.tables()["methods"]` says what they are."""

    min_pixels: float
    min_area: float
    noise: float
    noise_growth: float
    smooth_noise: float
    smooth_noise_growth: float
    noise_scale: float
    lateral_noise: float
    inlier_threshold: float
    theta: float
    window: float
    passes: float
    max_rms: float
    min_fill: float
    margin: float
    epsilon: float
    angle: float
    overlooked: float
    reach: float
    seed: float
    eps: float
    delta: float
    spacing: float
    radius: float
    draws: float
    distance: float
    votes: float
    misses: float
    block: float
    theta_gradient: float
    continuity: float


class DetectorOptions(ReadingOptions, Parameters, total=False):
    """Everything that `Detector` takes beside `sensor`, `camera`, `unit` and `method`."""

    threads: int
    curved: bool
    merge_coplanar: tuple[float, float] | None


def split(options: Mapping[str, Any]) -> tuple[dict[str, Any], dict[str, Any]]:
    """What is stated of the map, and all else."""
    stated = {name: value for name, value in options.items() if name in FileOptions.__annotations__}
    return stated, {name: value for name, value in options.items() if name not in stated}


def reading_of(sensor: str | None, camera: Camera | None, unit: str | None, stated: Mapping[str, Any]) -> _native.Reading:
    """What is stated of a map, as the library takes it."""
    return _native.Reading(sensor=sensor, unit=unit, **_camera(camera), **stated)


def _camera(camera: Camera | None) -> dict[str, Any]:
    if camera is None:
        return {}
    if isinstance(camera, (str, os.PathLike)):
        return {"camera_file": os.fspath(camera)}
    numbers = np.asarray(camera, dtype=np.float64)
    if numbers.shape == (4,):
        return {"intrinsics": tuple(numbers.tolist())}
    if numbers.shape == (3, 3) and numbers[0, 1] == numbers[1, 0] == 0 and numbers[2].tolist() == [0, 0, 1]:
        return {"intrinsics": (numbers[0, 0].item(), numbers[1, 1].item(), numbers[0, 2].item(), numbers[1, 2].item())}
    raise InputError(
        f"camera is {numbers.tolist()}; accepted: (fx, fy, cx, cy) in pixels, a matrix of 3 x 3 without skew "
        "([fx, 0, cx], [0, fy, cy], [0, 0, 1]), or the path of a camera file"
    )
