"""Packages that are asked for only where they are needed."""

from __future__ import annotations

import importlib
from typing import Any

from ._errors import MissingPackageError


def need(module: str, package: str, purpose: str, install: str | None = None) -> Any:
    """The module of that name; `install` is what brings the package, if not its own name.

    Raises
    ------
    MissingPackageError
        If it cannot be imported; the text says what to install, or, of a package that is there, what it lacks.
    """
    try:
        return importlib.import_module(module)
    except ImportError as error:
        if isinstance(error, ModuleNotFoundError):
            text = f"{purpose} needs the package `{package}`, which cannot be imported ({error}): pip install {install or package}"
        else:
            text = f"{purpose} needs the package `{package}`, which is installed, but cannot be imported: {error}"
        raise MissingPackageError(text, name=module) from error
