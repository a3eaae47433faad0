"""Finds the real maps and the program that is built beside the package."""

import os
import pathlib
import subprocess

import pytest

import depthplanes

ROOT = pathlib.Path(__file__).resolve().parents[3]


@pytest.fixture(scope="session")
def data():
    """The folder of real maps; without it a test is skipped, on CI it fails."""
    folder = pathlib.Path(os.environ.get("DEPTHPLANES_DATA", ROOT.parent / "shared" / "data"))
    if not (folder / "MANIFEST.tsv").is_file():
        message = f"no real maps at {folder}; DEPTHPLANES_DATA names their folder"
        if os.environ.get("CI") == "true":
            pytest.fail(message)
        pytest.skip(message)
    return folder


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
def room():
    """A furnished room without noise, in millimetres: the frame of `depthplanes demo`."""
    return depthplanes.scene("room:sensor=clean_mm")


@pytest.fixture(scope="session")
def planes(room):
    return depthplanes.detect(room)


@pytest.fixture
def tell(capsys):
    """Prints a line that is seen even if the test passes."""

    def tell(line):
        with capsys.disabled():
            print(f"\n{line}", end=" ")

    return tell
