"""Fixtures of all Python tests, those of `tests/oracles` and those of the Python package; their `conftest.py` import them."""

import os
import pathlib

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[1]


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


@pytest.fixture
def tell(capsys):
    """Prints a line that is seen even if the test passes."""

    def tell(line):
        with capsys.disabled():
            print(f"\n{line}", end=" ")

    return tell
