"""Finds the program that is built beside the package."""

import importlib
import os
import pathlib
import subprocess
import sys

import pytest

import depthplanes

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.path.append(str(ROOT / "tests"))

from shared_fixtures import data, tell  # noqa: E402, F401


@pytest.fixture(scope="session", autouse=True)
def no_flags():
    """No error that a test comes across speaks of the program's flags."""

    def checked(error, *words, **named):
        assert not any("--" in str(word) for word in words), words
        super(depthplanes.Error, error).__init__(*words, **named)

    depthplanes.Error.__init__ = checked
    yield
    del depthplanes.Error.__init__


@pytest.fixture(scope="session")
def program():
    """Runs the program that cargo built, not the package's; returns what it ended with."""
    path = ROOT / os.environ.get("CARGO_TARGET_DIR", "target") / "release" / "depthplanes"
    assert path.is_file(), f"{path} is not there; `make python` builds it"

    def run(*words, check=True, **options):
        ran = subprocess.run([path, *map(str, words)], capture_output=True, **options)
        assert not check or ran.returncode == 0, ran.stderr.decode()
        return ran

    return run


@pytest.fixture(scope="session")
def engine():
    """Imports what frames in parts ask for; without it a test is skipped, on CI it fails."""
    return importlib.import_module if os.environ.get("CI") == "true" else pytest.importorskip


@pytest.fixture(scope="session")
def room():
    """A furnished room without noise, in millimetres: the frame of `depthplanes demo`."""
    return depthplanes.scene("room:sensor=clean_mm")


@pytest.fixture(scope="session")
def planes(room):
    return depthplanes.detect(room)
