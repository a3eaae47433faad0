"""Packages that are asked for only where they are needed."""

from __future__ import annotations

import importlib
from typing import Any

from ._errors import MissingPackageError


def need(module: str, package: str, purpose: str) -> Any:
    """The module of that name.

    Raises
    ------
    MissingPackageError
        If it cannot be imported; the text says what to install.
    """
    try:
        return importlib.import_module(module)
    except ImportError as error:
        text = f"{purpose} needs the package `{package}`, which cannot be imported ({error}): pip install {package}"
        raise MissingPackageError(text, name=module) from error
