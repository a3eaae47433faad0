"""What callers hand over, as the library takes it.

Each function is told the name of an argument and its value. It gives the value in the type that is wanted, or raises an error that
says what was given and what is accepted.
"""

from __future__ import annotations

import math
import operator
import os
import sys
from typing import Any

import numpy as np
import numpy.typing as npt

from ._errors import InputError, InputTypeError

#: Longest text of a value in a message.
LONGEST = 80


def wrong_type(name: str, value: Any, accepted: str) -> InputTypeError:
    """The error of an argument of a type that is not accepted."""
    return InputTypeError(f"{name} is {shown(value)}; accepted: {accepted}")


def wrong_value(name: str, value: Any, accepted: str) -> InputError:
    """The error of an argument with a value that is not accepted."""
    return InputError(f"{name} is {shown(value)}; accepted: {accepted}")


def shown(value: Any) -> str:
    """A value in a message: itself if it is short, or else what it is."""
    if hasattr(value, "dtype") and getattr(value, "shape", ()) != ():
        return f"an array of {value.dtype}, shape {tuple(value.shape)}"
    text = repr(value)
    return text if len(text) <= LONGEST and "\n" not in text else f"a {type(value).__name__}"


def number(name: str, value: Any, *, least: float = -math.inf) -> float:
    """A number from `least` up; it may be NaN or infinite, which the library judges."""
    accepted = "a number" if least == -math.inf else f"a number from {least:g}"
    try:
        given = float(_scalar(value))
    except (TypeError, ValueError, OverflowError):
        raise wrong_type(name, value, accepted) from None
    if given < least:
        raise wrong_value(name, value, accepted)
    return given


def whole(name: str, value: Any, *, least: int, most: int = sys.maxsize) -> int:
    """A whole number of a range."""
    accepted = f"a whole number from {least}" + ("" if most == sys.maxsize else f" to {most}")
    try:
        given = operator.index(_scalar(value))
    except (TypeError, ValueError):
        raise wrong_type(name, value, accepted) from None
    if not least <= given <= most:
        raise wrong_value(name, value, accepted)
    return given


def flag(name: str, value: Any) -> bool:
    """True or False."""
    if not isinstance(value, (bool, np.bool_)):
        raise wrong_type(name, value, "True or False")
    return bool(value)


def text(name: str, value: Any) -> str:
    """A text."""
    if not isinstance(value, str):
        raise wrong_type(name, value, "a text")
    return value


def path(name: str, value: Any) -> str:
    """The path of a file or a folder."""
    try:
        given = os.fspath(value)
    except TypeError:
        raise wrong_type(name, value, "a path: a text or a pathlib.Path") from None
    return os.fsdecode(given)


def numbers(name: str, value: Any, shape: tuple[int, ...], accepted: str) -> npt.NDArray[np.float64]:
    """An array of numbers of a shape; -1 stands for any length."""
    try:
        array = np.asarray(value, dtype=np.float64)
    except (TypeError, ValueError):
        raise wrong_type(name, value, accepted) from None
    fits = array.ndim == len(shape) and all(wanted in (-1, length) for wanted, length in zip(shape, array.shape, strict=True))
    if not fits:
        raise wrong_value(name, value, accepted)
    return array


def pair(name: str, value: Any, accepted: str) -> tuple[float, float]:
    """Two numbers."""
    first, second = numbers(name, value, (2,), accepted).tolist()
    return first, second


def size(name: str, value: Any) -> tuple[int, int]:
    """Columns and rows."""
    accepted = "(width, height), whole numbers from 1"
    try:
        width, height = (operator.index(side) for side in value)
    except (TypeError, ValueError):
        raise wrong_type(name, value, accepted) from None
    if not (1 <= width <= sys.maxsize and 1 <= height <= sys.maxsize):
        raise wrong_value(name, value, accepted)
    return width, height


def _scalar(value: Any) -> Any:
    """The value, unless it is a text or has dimensions."""
    if isinstance(value, (str, bytes)) or np.ndim(value) != 0:
        raise TypeError
    return value
