"""The library's texts in the words of this package.

The library speaks of the program's flags, such as ``--encoding tum``, and spells parameters with hyphens. Here it is
``unit="tum"`` and ``min_pixels``.
"""

from __future__ import annotations

import functools
import re

from ._options import FLAGS, PARAMETERS
from ._tables import tables

#: Keywords that are True or False.
SWITCHES = ("ray_distance", "disparity", "rectified", "swap_bytes", "curved", "legend")

#: A flag with what follows it, if that may be its value: numbers, a size, what stands for a value, a name.
_FLAG = re.compile(
    r"--(?P<flag>[a-z]+(?:-[a-z]+)*)"
    r"(?:[ =](?P<value>-?\d+(?:\.\d+)?(?:,-?\d+(?:\.\d+)?)*(?![\d.]*x)|fx,fy,cx,cy|\d+x\d+|WIDTHxHEIGHT|WxH|[A-Z]+\b|[a-z0-9]+(?:-[a-z0-9]+)*))?"
)
#: The name of a parameter, which is in backquotes.
_PARAMETER = re.compile(r"(?P<before>parameter )?`(?P<name>[a-z]+(?:-[a-z]+)+)")
_TWICE = re.compile(r"\b(camera|sensor|unit)(?:,| and| or) \1\b(?!=)")


def in_python(text: str) -> str:
    """The same text with keywords for flags."""
    text = text.replace("`detect --curved`", "`curved=True`")
    return _TWICE.sub(r"\1", _PARAMETER.sub(_parameter, _FLAG.sub(_keyword, text)))


def _keyword(found: re.Match[str]) -> str:
    flag, value = found["flag"], found["value"]
    keyword = FLAGS.get(flag, flag.replace("-", "_"))
    after = "" if value is None else found[0].removeprefix(f"--{flag}")
    given = None if value is None else _value(keyword, value)
    if given is None:
        return f"{keyword}=True{after}" if keyword in SWITCHES else f"{keyword}{after}"
    return f"{keyword}={given}"


def _value(keyword: str, value: str) -> str | None:
    """A value as Python has it; None if it is no value of that keyword but the next word of the sentence."""
    if keyword == "rectified":
        return "False" if value == "no" else None
    if value in ("WxH", "WIDTHxHEIGHT") or re.fullmatch(r"\d+x\d+", value):
        return "({}, {})".format(*value.split("x"))
    if "," in value:
        return f"({', '.join(value.split(','))})"
    if value[0] == "-" or value[0].isdigit() or value.isupper():
        return value
    return f'"{value}"' if value in _names().get(keyword, ()) else None


def _parameter(found: re.Match[str]) -> str:
    keyword = found["name"].replace("-", "_")
    return found[0].replace(found["name"], keyword) if found["before"] or keyword in PARAMETERS else found[0]


@functools.cache
def _names() -> dict[str, set[str]]:
    """The names that are values of keywords."""
    rows = tables()
    return {keyword: {row["name"] for row in rows[table]} for keyword, table in (("unit", "units"), ("sensor", "sensors"))}
