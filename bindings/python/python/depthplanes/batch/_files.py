"""Files on this machine and behind URLs of fsspec, and the frames that paths stand for."""

from __future__ import annotations

import functools
import os
import posixpath
import uuid
from collections import Counter
from collections.abc import Iterable, Mapping
from typing import Any

from .. import _accept
from .._errors import InputError, MissingFileError
from .._optional import need
from .._options import Path
from .._tables import tables


def is_url(path: str) -> bool:
    """Whether it is for fsspec alone."""
    return "://" in path or "::" in path


#: What brings the packages of tables and URLs.
EXTRA = "'depthplanes[batch]'"


def absolute(name: str, path: Path) -> str:
    """As workers understand it, whatever folder they run in; `name` is that of the argument."""
    text = _accept.path(name, path)
    return text if is_url(text) else os.path.abspath(text)


def storage(path: str) -> tuple[Any, str]:
    """The file system of fsspec, and the path there."""
    core = need("fsspec.core", "fsspec", "depthplanes.batch", EXTRA)
    files, inside = core.url_to_fs(path)
    return files, inside.rstrip("/")


def write(files: Any, path: str, content: bytes) -> None:
    """Writes a file beside its name and then renames it, so that it is whole or not there. What is left of it nobody reads."""
    folder, name = posixpath.split(path)
    beside = f"{folder}/.{name}.{uuid.uuid4().hex}.partial"
    try:
        try:
            files.pipe_file(beside, content)
        except FileNotFoundError:
            files.makedirs(folder, exist_ok=True)
            files.pipe_file(beside, content)
        files.mv(beside, path)
    except BaseException:
        if files.exists(beside):
            files.rm_file(beside)
        raise


def expand(paths: Path | Iterable[Path]) -> list[str]:
    """All frames that paths, folders and patterns stand for, in order.

    Raises
    ------
    InputError
        If there is none, or one more than once.
    MissingFileError
        For a path by itself that is not there, and a folder.
    """
    is_one = isinstance(paths, (str, os.PathLike))
    try:
        words = [paths] if is_one else list(paths)  # type: ignore[arg-type]
    except TypeError:
        raise _accept.wrong_type("paths", paths, "a path, or several") from None
    frames = [frame for word in words for frame in _expand_word(absolute("paths", word), is_one)]  # type: ignore[arg-type]
    if not frames:
        raise InputError("there is no path; accepted: frames, folders, patterns, and URLs of these")
    frame, count = Counter(frames).most_common(1)[0]
    if count > 1:
        raise InputError(f"{frame} is there {count} times; accepted: each frame once")
    return frames


def _expand_word(word: str, is_one: bool) -> list[str]:
    path, joint, outer = word.partition("::")
    is_pattern = any(sign in path for sign in "*?[")
    if _is_map(path) and not is_pattern and not is_one:
        return [word]  # of which the system need not be asked, since there are many
    files, inside = storage(word)
    if is_pattern and not files.exists(inside):
        found = [path for path in files.glob(inside) if not _is_result(path)]
        lacking = "nothing matches"
    elif files.isdir(inside):
        found = [entry["name"] for entry in files.ls(inside, detail=True) if _is_map(entry["name"]) and _is_file(entry)]
        lacking = f"no map in this folder; looked for *{', *'.join(_endings())}"
    elif files.exists(inside):
        return [word]
    else:
        raise MissingFileError(f"{word}: there is no such file or folder")
    if not found:
        raise InputError(f"{word}: {lacking}")
    return sorted(files.unstrip_protocol(path) + joint + outer if is_url(word) else path for path in found)


def _is_file(entry: Mapping[str, Any]) -> bool:
    """Whether it is a file, or a link to one, of this machine."""
    return entry["type"] == "file" or (bool(entry.get("islink")) and os.path.isfile(entry["name"]))


def _is_map(path: str) -> bool:
    """Whether it has the name of a map, and not of a result of the program."""
    return path.lower().endswith(_endings()) and not _is_result(path)


@functools.cache
def _endings() -> tuple[str, ...]:
    return tuple("." + ending for form in tables()["formats"] for ending in form["extensions"])


def _is_result(path: str) -> bool:
    name = posixpath.basename(path)
    return any(name == result or name.endswith("." + result) for result in _results())


@functools.cache
def _results() -> tuple[str, ...]:
    return tuple(output["file"] for output in tables()["outputs"])
