"""Finds what `scripts/c` has built."""

import os
import pathlib
import subprocess
import sys

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.path.append(str(ROOT / "tests"))

from shared_fixtures import data, tell  # noqa: E402, F401

TARGET = ROOT / os.environ.get("CARGO_TARGET_DIR", "target")


def run(*words, **options):
    """What a program ended with; it has to end well, and what it says of an error is shown."""
    ran = subprocess.run([str(word) for word in words], capture_output=True, text=True, **options)
    assert ran.returncode == 0, f"{words}\n{ran.stdout}\n{ran.stderr}"
    return ran


@pytest.fixture(scope="session")
def built():
    """The folder of the builds `plain` and `sanitized`, and of `prefix`, where the library is installed."""
    folder = TARGET / "c"
    assert (folder / "plain" / "labels").is_file(), f"{folder} has no programs; `make c` builds them"
    return folder


@pytest.fixture(scope="session")
def program():
    """Runs the program that cargo built."""
    return lambda *words, **options: run(TARGET / "release" / "depthplanes", *words, **options)
