"""What a run is asked for, and the parts that are there."""

from __future__ import annotations

import hashlib
import io
import json
import os
import posixpath
from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np

from .. import _native
from .._errors import InputError
from .._options import Path
from .._tables import tables
from ._files import absolute, storage, write
from ._rows import Processor, Row, packed, parquet, schema

#: The file beside the parts that says what was asked for, and its form.
SETTINGS = "batch.json"
SCHEMA = "depthplanes.batch/1"
#: Options that may be files; workers read them again.
FILES = ("camera", "noise_table")

#: Frames, failed frames and planes of a part.
Counts = tuple[int, int, int]


class Job(NamedTuple):
    """What workers are told."""

    out: str
    labels: str | None
    options: Mapping[str, Any]

    @classmethod
    def of(cls, out: Path, labels: Path | None, options: Mapping[str, Any]) -> Job:
        """The same with paths that do not depend on the folder that a worker runs in."""
        paths = {name: absolute(options[name]) for name in FILES if isinstance(options.get(name), (str, os.PathLike))}
        return cls(absolute(out), None if labels is None else absolute(labels), {**options, **paths})

    def processor(self) -> Processor:
        """What turns frames into rows."""
        return Processor(self.labels, self.options)

    def write(self, number: int, rows: list[Row]) -> Counts:
        """Writes a part."""
        files, folder = storage(self.out)
        write(files, f"{folder}/{name_of(number)}", packed(rows))
        failed = sum(row["error"] is not None for row in rows)
        return len(rows), failed, sum(len(row["planes"]) for row in rows)


def begin(job: Job, frames: list[str], part: int) -> set[int]:
    """Notes what is asked for, or holds it against what was; the numbers of the parts that are there.

    Raises
    ------
    InputError
        If the folder has results of something else.
    """
    schema()  # a package that is missing is missed before any work
    files, folder = storage(job.out)
    settings = _settings(job, frames, part)
    known = settings_in(files, folder)
    if known is None:
        write(files, f"{folder}/{SETTINGS}", (json.dumps(settings, indent=1) + "\n").encode())
    elif known != settings:
        others = [f"{name}: {known.get(name)} instead of {value}" for name, value in settings.items() if known.get(name) != value]
        text = f"{job.out} has results of other settings: " + "; ".join(others)
        raise InputError(f"{text}; accepted: the same ones, or another folder")
    return parts_in(files, folder)


def _settings(job: Job, frames: list[str], part: int) -> Row:
    """All that rows depend on, and which frame is in which part."""
    detector = job.processor().detector
    known = {"method", "threads"}  # planes do not depend on the number of threads
    known |= {parameter["name"] for method in tables()["methods"] for parameter in method["parameters"]}
    settings = {
        "schema": SCHEMA,
        "version": _native.__version__,
        "method": job.options.get("method", "planar"),
        "parameters": detector.parameters,
        "options": {name: value for name, value in sorted(job.options.items()) if name not in known and value is not None},
        "files_sha256": {name: _checksum(job.options[name]) for name in FILES if isinstance(job.options.get(name), str)},
        "labels": job.labels,
        "part": part,
        "frames": len(frames),
        "frames_sha256": hashlib.sha256("\n".join(frames).encode()).hexdigest(),
    }
    as_read: Row = json.loads(json.dumps(settings, default=lambda value: np.asarray(value).tolist()))
    return as_read


def _checksum(path: str) -> str:
    with open(path, "rb") as file:
        return hashlib.sha256(file.read()).hexdigest()


def settings_in(files: Any, folder: str) -> Row | None:
    """What was asked for when the folder's parts were made, if anything was."""
    try:
        settings = json.loads(files.cat_file(f"{folder}/{SETTINGS}"))
    except FileNotFoundError:
        return None
    except ValueError:
        settings = None
    if not isinstance(settings, dict) or settings.get("schema") != SCHEMA:
        text = f"{folder}/{SETTINGS} is not of depthplanes.batch"
        raise InputError(f"{text}; accepted: one with the schema {SCHEMA}, or another folder")
    return settings


def name_of(number: int) -> str:
    """The name of a part's file."""
    return f"part-{number:05}.parquet"


def parts_in(files: Any, folder: str) -> set[int]:
    """The numbers of the parts that are there, each of them whole; a machine that lost its power may leave empty ones."""
    files.invalidate_cache(folder)
    names = (posixpath.basename(entry["name"]) for entry in files.ls(folder, detail=True) if entry["size"] != 0)
    numbers = (name[len("part-") : -len(".parquet")] for name in names if name.startswith("part-") and name.endswith(".parquet"))
    return {int(number) for number in numbers}


def has_failed(out: str, number: int) -> bool:
    """Whether a part has a frame with an error."""
    files, folder = storage(out)
    table = parquet().read_table(io.BytesIO(files.cat_file(f"{folder}/{name_of(number)}")), columns=["error"])
    return bool(table["error"].null_count < table.num_rows)
