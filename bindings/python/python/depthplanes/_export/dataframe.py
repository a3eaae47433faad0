"""A table of pandas."""

from __future__ import annotations

import io
from typing import TYPE_CHECKING

from .._optional import need

if TYPE_CHECKING:
    import pandas

    from .._planes import Planes


def to_dataframe(planes: Planes) -> pandas.DataFrame:
    """The program's table, with the label as its index."""
    package = need("pandas", "pandas", "to_dataframe()")
    table: pandas.DataFrame = package.read_csv(io.BytesIO(planes._encode("planes", "csv")))
    return table.set_index("label")
