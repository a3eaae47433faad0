"""What a run is asked for, and the parts that are there."""

from __future__ import annotations

import hashlib
import json
import os
import posixpath
import re
from collections.abc import Iterable, Mapping
from concurrent.futures import ThreadPoolExecutor
from typing import Any, NamedTuple

import numpy as np

from .. import _native
from .._errors import FileError, InputError
from .._options import Path
from .._tables import tables
from ._files import absolute, storage, write
from ._rows import Processor, Row, packed, parquet, schema

#: The files beside the parts that say what was asked for, and of which frames. Readers of folders of Parquet leave out
#: what begins with `_`.
SETTINGS = "_batch.json"
FRAMES = "_frames.json"
SCHEMA = "depthplanes.batch/1"
#: Options that may be files; workers read them again.
FILES = ("camera", "noise_table")
#: With what files of Parquet begin and end.
MAGIC = b"PAR1"
#: Threads that wait for the ends of files.
READERS = 16


class Counts(NamedTuple):
    """What is in a part, or in several."""

    failed: int
    planes: int


class Job(NamedTuple):
    """What workers are told."""

    out: str
    labels: str | None
    options: Mapping[str, Any]

    @classmethod
    def of(cls, out: Path, labels: Path | None, options: Mapping[str, Any]) -> Job:
        """The same with paths that do not depend on the folder that a worker runs in."""
        paths = {name: absolute(name, options[name]) for name in FILES if isinstance(options.get(name), (str, os.PathLike))}
        return cls(absolute("out", out), None if labels is None else absolute("labels", labels), {**options, **paths})

    def processor(self) -> Processor:
        """What turns frames into rows."""
        return Processor(self.labels, self.options)

    def write(self, number: int, rows: list[Row]) -> None:
        """Writes a part."""
        files, folder = storage(self.out)
        counts = Counts(sum(row["error"] is not None for row in rows), sum(len(row["planes"]) for row in rows))
        write(files, f"{folder}/{name_of(number)}", packed(rows, counts._asdict()))


def begin(job: Job, frames: list[str], part: int) -> set[int]:
    """Notes what is asked for, or holds it against what was; the numbers of the parts that are there.

    Raises
    ------
    InputError
        If the folder has results of something else.
    FileError
        If it is a file.
    """
    schema()  # a package that is missing is missed before any work
    files, folder = storage(job.out)
    if files.isfile(folder):
        raise FileError(f"{job.out} is a file; accepted: a folder, which need not be there")
    settings = _settings(job, part)
    known = settings_in(files, folder)
    if known is None:
        write(files, f"{folder}/{FRAMES}", _packed(frames))
        write(files, f"{folder}/{SETTINGS}", _packed(settings | {"frames": len(frames)}))
        return _whole(files, folder, parts_in(files, folder, count(len(frames), part)))
    others = [f"{name}: {known.get(name)} instead of {value}" for name, value in settings.items() if known.get(name) != value]
    if others:
        raise InputError(f"{job.out} has results of other settings: {'; '.join(others)}; accepted: the same ones, or another folder")
    _check_frames(job.out, files.cat_file(f"{folder}/{FRAMES}"), frames)
    return _whole(files, folder, parts_in(files, folder, count(len(frames), part)))


def _check_frames(out: str, known: bytes, frames: list[str]) -> None:
    """Refuses frames that are not those of the results."""
    before = json.loads(known)
    if before == frames:
        return
    added, gone = len(set(frames) - set(before)), len(set(before) - set(frames))
    if added or gone:
        changed = f"since then {added} were added and {gone} have gone"
    else:
        changed = "which were in another order"
    raise InputError(
        f"{out} has results of {len(before)} frames, {changed}; accepted: the frames of then, or another folder: for all frames, or for "
        "those that were added alone"
    )


def _packed(record: Any) -> bytes:
    return (json.dumps(record, indent=1) + "\n").encode()


def _settings(job: Job, part: int) -> Row:
    """All that rows depend on beside their frames."""
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


def count(frames: int, part: int) -> int:
    """How many parts there are of so many frames."""
    return -(-frames // part)


def parts_in(files: Any, folder: str, parts: int) -> set[int]:
    """The numbers of the parts that are there, of so many. Empty files are none, nor is what has another form of name.

    Raises
    ------
    InputError
        If there are parts behind the last.
    """
    files.invalidate_cache(folder)
    names = (posixpath.basename(entry["name"]) for entry in files.ls(folder, detail=True) if entry["size"] != 0)
    matches = (re.fullmatch(r"part-([0-9]{5,})\.parquet", name) for name in names)
    numbers = {int(match[1]) for match in matches if match and match[0] == name_of(int(match[1]))}
    others = sorted(number for number in numbers if number >= parts)
    if others:
        text = f"{folder} has {name_of(others[0])}, but the run is of {parts} parts, the last of which is {name_of(parts - 1)}"
        raise InputError(f"{text}; accepted: a folder of this run alone")
    return numbers


def _whole(files: Any, folder: str, numbers: set[int]) -> set[int]:
    """Those of the parts that begin and end as Parquet does; a machine that lost its power may leave others."""

    def is_whole(number: int) -> bool:
        path = f"{folder}/{name_of(number)}"
        return all(files.cat_file(path, *ends) == MAGIC for ends in ((0, len(MAGIC)), (-len(MAGIC), None)))

    with ThreadPoolExecutor(READERS) as threads:
        ordered = sorted(numbers)
        return {number for number, whole in zip(ordered, threads.map(is_whole, ordered), strict=True) if whole}


def counts_of(out: str, numbers: Iterable[int]) -> list[Counts]:
    """What is in each of these parts, by the ends of their files."""
    files, folder = storage(out)

    def counts(number: int) -> Counts:
        with files.open(f"{folder}/{name_of(number)}", "rb") as file:
            known = parquet().read_schema(file).metadata
        return Counts(*(int(known[name.encode()]) for name in Counts._fields))

    with ThreadPoolExecutor(READERS) as threads:
        return list(threads.map(counts, numbers))
