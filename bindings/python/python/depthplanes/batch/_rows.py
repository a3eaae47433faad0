"""From a frame to its row, and from rows to a table."""

from __future__ import annotations

import csv
import functools
import hashlib
import io
import posixpath
from collections.abc import Mapping
from typing import Any

import numpy as np

from .._detector import Detector
from .._frame import read
from .._optional import need
from .._options import STATED
from .._planes import Planes
from ._files import EXTRA, is_url, storage, write

Row = dict[str, Any]

#: The columns of the program's table that are whole numbers; the others are of double precision.
WHOLE = ("label", "pixel_count", "u_min", "v_min", "u_max", "v_max")


class Processor:
    """Turns frames into rows, with one detector for all of them; threads may share it.

    Raises
    ------
    InputError, InputTypeError
        For options that are not accepted.
    """

    def __init__(self, labels: str | None, options: Mapping[str, Any]) -> None:
        Detector(**options)  # what is wrong is refused before any frame is read
        self._stated = {name: value for name, value in options.items() if name in (*STATED, "sensor", "camera", "unit")}
        self._labels = labels
        self.detector = Detector(**{name: value for name, value in options.items() if name not in self._stated})

    def __call__(self, path: str) -> Row:
        nothing: Row = {"path": path, "error": None, "width": None, "height": None, "valid_pixels": None}
        nothing |= {"notes": [], "labels": None, "planes": []}
        name = path.encode("utf-8", "backslashreplace").decode()
        if name != path:
            return nothing | {"path": name, "error": f"{name}: the name is not UTF-8, of which rows are; accepted: a file with such a name"}
        try:
            return nothing | self._found(path)
        except Exception as error:  # whatever a file or a store comes up with is of this frame alone
            return nothing | {"error": str(error) or type(error).__name__}

    def _found(self, path: str) -> Row:
        if is_url(path):
            files, inside = storage(path)
            frame = read(files.cat_file(inside), name=path, **self._stated)
        else:
            frame = read(path, **self._stated)
        planes, _ = self.detector._find(frame)
        record = planes.to_dict()
        row = {name: record[name] for name in ("width", "height", "valid_pixels")}
        row |= {"notes": planes.notes, "planes": _rows_of(planes)}
        if self._labels is not None:
            row["labels"] = _write_labels(self._labels, path, planes)
        return row


def _rows_of(planes: Planes) -> list[Row]:
    """The program's table, without the source."""
    lines = csv.DictReader(io.StringIO(planes._encode("planes", "csv").decode()))
    return [{name: _number(name, text) for name, text in line.items() if name != "source"} for line in lines]


def _number(name: str, text: str) -> float | None:
    if text == "":
        return None
    return int(text) if name in WHOLE else float(text)


def _write_labels(folder: str, path: str, planes: Planes) -> str:
    """Writes the label image. A path always has the same name for it, and paths that end alike have others."""
    stem = posixpath.splitext(posixpath.basename(path.partition("::")[0]))[0]
    name = f"{stem[:50]}-{hashlib.sha256(path.encode()).hexdigest()[:12]}.labels.png"
    files, inside = storage(folder)
    write(files, f"{inside}/{name}", planes._encode("labels", "png"))
    return f"{folder.rstrip('/')}/{name}"


def parquet() -> Any:
    """The module that reads and writes tables."""
    return need("pyarrow.parquet", "pyarrow", "depthplanes.batch", EXTRA)


def packed(rows: list[Row], counts: Mapping[str, int]) -> bytes:
    """Rows as a file of Parquet, at whose end the counts are."""
    arrow = need("pyarrow", "pyarrow", "depthplanes.batch", EXTRA)
    file = io.BytesIO()
    parquet().write_table(arrow.Table.from_pylist(rows, schema=schema().with_metadata({name: str(count) for name, count in counts.items()})), file, compression="zstd")
    return file.getvalue()


@functools.cache
def schema() -> Any:
    """The columns of the table, of pyarrow."""
    arrow = need("pyarrow", "pyarrow", "depthplanes.batch", EXTRA)
    nothing, _ = Detector()._find(np.zeros((2, 2), np.uint8))
    columns = nothing._encode("planes", "csv").decode().strip().split(",")[1:]
    plane = arrow.struct([(name, arrow.int64() if name in WHOLE else arrow.float64()) for name in columns])
    numbers = [(name, arrow.int64()) for name in ("width", "height", "valid_pixels")]
    texts = [("notes", arrow.list_(arrow.string())), ("labels", arrow.string())]
    return arrow.schema([("path", arrow.string()), ("error", arrow.string()), *numbers, *texts, ("planes", arrow.list_(plane))])
