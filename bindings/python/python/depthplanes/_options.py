"""Keywords of `Detector`, `read` and others: what is stated of a map, and how planes are looked for.

The keywords are the program's flags with `_` for `-`; the library's tables hold their defaults and ranges.
"""

from __future__ import annotations

import difflib
import functools
import os
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, TypedDict

import numpy as np
import numpy.typing as npt

from . import _accept, _native
from ._errors import InputTypeError
from ._tables import tables

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


def _noise_table(name: str, value: Any) -> Any:
    if isinstance(value, (str, os.PathLike)):
        return _accept.path(name, value)
    return _accept.numbers(name, value, (-1, 2), "a CSV file, or rows of range and standard deviation, metres").tolist()


def _member(name: str, value: Any) -> str:
    return value if isinstance(value, str) else str(_accept.whole(name, value, least=0))


def _range(name: str, value: Any) -> tuple[float, float]:
    return _accept.pair(name, value, "(low, high), map units")


def _coplanar(name: str, value: Any) -> tuple[float, float] | None:
    return None if value is None else _accept.pair(name, value, "(degrees, metres), or None")


def _threads(name: str, value: Any) -> int:
    return _accept.whole(name, value, least=1)


#: What is stated of a map or a file, with what makes it of the library's type; None states nothing.
STATED: dict[str, Callable[[str, Any], Any]] = {
    **dict.fromkeys(("scale", "depth_scale", "focal", "baseline", "doffs", "missing"), _accept.number),
    **dict.fromkeys(("ray_distance", "disparity", "rectified", "swap_bytes"), _accept.flag),
    **dict.fromkeys(("camera_size", "raw_size"), _accept.size),
    "valid_range": _range,
    "noise_table": _noise_table,
    "member": _member,
    "raw_type": _accept.text,
}
#: How planes are looked for, beside the parameters of the method.
SEARCHING: dict[str, Callable[[str, Any], Any]] = {"threads": _threads, "curved": _accept.flag, "merge_coplanar": _coplanar}
#: The parameters of all methods.
PARAMETERS = tuple(Parameters.__annotations__)
#: Flags of the program that have another name here; all others differ in their spelling alone.
FLAGS = {"preset": "sensor", "encoding": "unit", "intrinsics": "camera"}


def searching_of(method: str, options: Mapping[str, Any]) -> tuple[dict[str, float], int, bool, tuple[float, float] | None]:
    """How planes are looked for, as the library takes it: parameters, threads, and whether curved surfaces and joined planes are wanted.

    Raises
    ------
    InputTypeError
        For a keyword that there is not, and for a value of another type.
    """
    names = _parameters().get(_accept.text("method", method), PARAMETERS)
    _check(options, [*STATED, *SEARCHING, *names], method)
    found = {name: make(name, options[name]) for name, make in SEARCHING.items() if name in options}
    parameters = {name: _accept.number(name, value) for name, value in options.items() if name in PARAMETERS}
    return parameters, found.get("threads", 1), found.get("curved", False), found.get("merge_coplanar")


def reading_of(sensor: str | None, camera: Camera | None, unit: str | None, stated: Mapping[str, Any]) -> _native.Reading:
    """What is stated of a map, as the library takes it; what is no such keyword is left out.

    Raises
    ------
    InputError, InputTypeError
        For what is not accepted.
    """
    given = {name: STATED[name](name, value) for name, value in stated.items() if name in STATED and value is not None}
    given |= {name: _accept.text(name, value) for name, value in (("sensor", sensor), ("unit", unit)) if value is not None}
    seen_by = camera_of(camera)
    if seen_by is not None:
        given["camera_file" if isinstance(seen_by, str) else "intrinsics"] = seen_by
    return _native.Reading(**given)


def reading_of_file(sensor: str | None, camera: Camera | None, unit: str | None, stated: Mapping[str, Any]) -> _native.Reading:
    """The same of a file, of which nothing else can be stated."""
    _check(stated, STATED)
    return reading_of(sensor, camera, unit, stated)


def _check(given: Iterable[str], known: Iterable[str], method: str | None = None) -> None:
    """Refuses keywords that there are not."""
    every = ["sensor", "camera", "unit", *(["method"] if method else []), *known]
    for name in given:
        if name in every:
            continue
        others = [f'"{other}"' for other, names in _parameters().items() if name in names] if method else []
        if others:
            meant = f' of the method "{method}", but of {", ".join(others)}'
        else:
            near = FLAGS.get(name) or next(iter(difflib.get_close_matches(name, every, 1)), None)
            meant = f"; did you mean {near}?" if near else ""
        there_are = " There are" if meant.endswith("?") else "; there are"
        raise InputTypeError(f"there is no keyword {name}{meant}{there_are}: {', '.join(every)}")


@functools.cache
def _parameters() -> dict[str, list[str]]:
    """The parameters of each method."""
    return {method["name"]: [parameter["name"] for parameter in method["parameters"]] for method in tables()["methods"]}


def camera_of(camera: Camera | None) -> str | tuple[float, float, float, float] | None:
    """The path of a camera file, or the four numbers."""
    if camera is None:
        return None
    if isinstance(camera, (str, os.PathLike)):
        return _accept.path("camera", camera)
    accepted = (
        "(fx, fy, cx, cy) in pixels, a matrix of 3 x 3 without skew ([fx, 0, cx], [0, fy, cy], [0, 0, 1]), or the path of a camera file"
    )
    try:
        numbers = np.asarray(camera, dtype=np.float64)
    except (TypeError, ValueError):
        raise _accept.wrong_type("camera", camera, accepted) from None
    if numbers.shape == (3, 3) and numbers[0, 1] == numbers[1, 0] == 0 and numbers[2].tolist() == [0, 0, 1]:
        numbers = numbers[[0, 1, 0, 1], [0, 1, 2, 2]]
    if numbers.shape != (4,):
        raise _accept.wrong_value("camera", numbers.tolist(), accepted)
    fx, fy, cx, cy = numbers.tolist()
    return fx, fy, cx, cy
