"""Planes of very many frames: a function from a path to a row, and a run of it over all paths, on this machine, on Dask or on Ray.

`process` is the work on a frame. `run` cuts the paths into parts and has each part made by one worker into one Parquet file, which
has its name only when it is whole: however often an engine tries a part again, each frame is there exactly once, and a run that
ended early goes on when it is repeated. `read_rows` reads the parts. Tables need pyarrow; folders, patterns and URLs fsspec.
"""

from __future__ import annotations

import io
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any, NamedTuple

from .. import _accept
from .._errors import FileError, InputError
from .._optional import need
from .._options import Path
from ._engines import ENGINES
from ._files import EXTRA, absolute, expand, storage
from ._parts import Job, begin, count, counts_of, name_of, parts_in, settings_in
from ._rows import Processor, Row, parquet, schema

if TYPE_CHECKING:
    import pyarrow

__all__ = ["Summary", "process", "read_rows", "run"]


class Summary(NamedTuple):
    """What is in the folder of the parts, once a run has ended."""

    frames: int
    """All frames."""
    failed: int
    """Those that could not be read or searched: rows with an `error`."""
    planes: int
    """The planes of all frames."""
    parts: int
    """All parts."""
    skipped: int
    """Frames that this run left out, since an earlier one had done them."""


def process(path: Path, *, labels: Path | None = None, **options: Any) -> Row:
    """Reads a frame and finds its planes. An error is in the row, and never raised.

    Parameters
    ----------
    path : path or URL
        The frame: a file, or what fsspec opens, such as ``"s3://bucket/depth.png"`` or ``"zip://1.png::depth.zip"``.
    labels : path or URL, optional
        A folder for the label image, a PNG of 16 bits; its name has a checksum of the path.
    **options
        As for `depthplanes.read` and `depthplanes.Detector`: `sensor`, `camera`, `unit`, `method`, `min_pixels` and others.

    Returns
    -------
    dict
        `path`; `error`, None or the text; `width`, `height`, `valid_pixels`; `notes`, what is odd about the frame; `labels`, where
        the label image is, or None; `planes`, a dict for each with the columns of the program's table (docs/planes-schema.md).
        Of a frame with an error there are no planes, and the numbers are None.

    Raises
    ------
    InputError, InputTypeError
        For options that are not accepted.

    Examples
    --------
    >>> from depthplanes import batch
    >>> row = batch.process("nothing-there.png", unit="mm")
    >>> row["planes"], row["error"][:17]
    ([], 'nothing-there.png')
    """
    processor = Processor(None if labels is None else absolute("labels", labels), options)
    return processor(_accept.path("path", path))


def run(
    paths: Path | Iterable[Path],
    out: Path,
    *,
    engine: str = "local",
    workers: int | None = None,
    part: int = 256,
    labels: Path | None = None,
    client: Any = None,
    retry_failed: bool = False,
    **options: Any,
) -> Summary:
    """Processes all frames into `out`, a Parquet file for each part, and says what came of it.

    Parts that are there already are left out, so that a run that ended early goes on when it is repeated.

    Parameters
    ----------
    paths : path, URL, or several
        Frames. A folder is the maps in it, without the program's results; a pattern (``*``, ``**``, ``?``) what matches; both by
        name. A frame of a list that is not there is a row with its error. They may be URLs of fsspec. Files of this machine have to be there, under the same names, for all workers.
    out : path or URL
        The folder of the parts, and of ``_batch.json`` and ``_frames.json``, which say what was asked for. All workers write to it.
        What reads folders of Parquet, such as ``pandas.read_parquet(out)``, reads it.
    engine : {"local", "dask", "ray"}, optional
        Threads of this process, workers of Dask, or actors of Ray Data.
    workers : int, optional
        How many. Without it as many as there are processors, on this machine or in Ray's cluster.
    part : int, optional
        Frames of a part.
    labels : path or URL, optional
        A folder for the label images.
    client : distributed.Client, optional
        A cluster of Dask that is there already, all of which is used; without it workers are started on this machine. Ray takes
        what is running (``ray.init``).
    retry_failed : bool, optional
        Whether parts are made again in which a frame failed.
    **options
        As for `process`.

    Returns
    -------
    Summary

    Raises
    ------
    InputError, InputTypeError
        For options that are not accepted, paths without a frame, and a folder that has results of other options or frames.
    MissingFileError
        For a path or a folder that is not there.
    FileError
        If `out` is a file, or the workers have written where this process does not see it.
    MissingPackageError
        Without pyarrow, fsspec or the engine.
    """
    _check(engine, workers, part, client)
    retry_failed = _accept.flag("retry_failed", retry_failed)
    job = Job.of(out, labels, options)
    frames = expand(paths)
    there = begin(job, frames, part)
    if retry_failed:
        numbers = sorted(there)
        there = {number for number, counts in zip(numbers, counts_of(job.out, numbers), strict=True) if counts.failed == 0}
    parts = [(number, frames[at : at + part]) for number, at in enumerate(range(0, len(frames), part))]
    due = [(number, of_part) for number, of_part in parts if number not in there]
    if due:
        ENGINES[engine](job, due, workers, client)
    missing = len(parts) - len(parts_in(*storage(job.out), len(parts)))
    if missing:
        text = f"{job.out}: {missing} of {len(parts)} parts were written, but not here"
        raise FileError(f"{text}; accepted: a folder or URL that this process shares with all workers")
    counts = counts_of(job.out, range(len(parts)))
    failed, planes = sum(of.failed for of in counts), sum(of.planes for of in counts)
    return Summary(len(frames), failed, planes, len(parts), len(frames) - sum(len(of_part) for _, of_part in due))


def read_rows(out: Path, *, partial: bool = False) -> pyarrow.Table:
    """All rows that `run` wrote, in the order of the frames.

    Parameters
    ----------
    out : path or URL
        The folder of the parts.
    partial : bool, optional
        Whether parts may be missing, of a run that has not ended.

    Returns
    -------
    pyarrow.Table
        A row for each frame, with the fields of `process`.

    Raises
    ------
    InputError
        For a folder without results, and for one that misses parts.
    """
    arrow = need("pyarrow", "pyarrow", "batch.read_rows()", EXTRA)
    files, folder = storage(absolute("out", out))
    settings = settings_in(files, folder)
    if settings is None:
        raise InputError(f"{out} has no results; accepted: a folder that depthplanes.batch.run has written to")
    parts = count(settings["frames"], settings["part"])
    numbers = sorted(parts_in(files, folder, parts))
    if len(numbers) < parts and not _accept.flag("partial", partial):
        text = f"{out} has {len(numbers)} of {parts} parts; repeat the run that they are of, or state partial=True"
        raise InputError(text)
    tables = [parquet().read_table(io.BytesIO(files.cat_file(f"{folder}/{name_of(number)}"))) for number in numbers]
    return arrow.concat_tables([schema().empty_table(), *tables])


def _check(engine: str, workers: int | None, part: int, client: Any) -> None:
    if _accept.text("engine", engine) not in ENGINES:
        raise _accept.wrong_value("engine", engine, ", ".join(map(repr, ENGINES)))
    _accept.whole("part", part, least=1)
    if workers is not None:
        _accept.whole("workers", workers, least=1)
    if client is not None and (engine != "dask" or workers is not None):
        text = f"client with engine={engine!r} and workers={workers!r}"
        raise InputError(f'{text}; accepted: engine="dask", and all workers of the client')
