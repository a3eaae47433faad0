"""What there is to choose from."""

from __future__ import annotations

import json
from typing import Any

from . import _native


def tables() -> dict[str, list[dict[str, Any]]]:
    """The names that are accepted, each with what it means.

    Returns
    -------
    dict
        Rows of `methods` (each with its `parameters`: name, default, unit, accepted, about), `sensors`, `units`, `formats` (with
        their `extensions`), `outputs` (with the end of their files' names, `file`), `scenes` and `scene_sensors`.

    Examples
    --------
    >>> [method["name"] for method in depthplanes.tables()["methods"]][:3]
    ['planar', 'ngaf', 'ransac']
    """
    rows: dict[str, list[dict[str, Any]]] = json.loads(_native.tables())
    return rows
