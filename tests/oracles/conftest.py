"""Builds what the tests run, and finds the real maps."""

import os
import pathlib
import subprocess

import pytest

from worker import Worker

ROOT = pathlib.Path(__file__).resolve().parents[2]


def build(*what):
    """Builds in release mode, which does nothing if it is fresh; returns the folder of the programs."""
    subprocess.run(["cargo", "build", "--release", *what], cwd=ROOT, check=True)
    return ROOT / os.environ.get("CARGO_TARGET_DIR", "target") / "release"


@pytest.fixture(scope="session")
def worker_program():
    return build("-p", "depthplanes", "--example", "oracle_worker") / "examples" / "oracle_worker"


@pytest.fixture
def worker(worker_program):
    worker = Worker(worker_program)
    assert "portable" in worker.kernels
    yield worker
    worker.close()


@pytest.fixture(scope="session")
def program():
    return build("-p", "depthplanes-cli") / "depthplanes"


def of_tests(name):
    """A program as `make test` has built it already; a release of those with many crates takes minutes."""
    command = f"cargo build --workspace --profile test --features depthplanes/serde --bin {name}"
    subprocess.run(command.split(), cwd=ROOT, check=True)
    return ROOT / os.environ.get("CARGO_TARGET_DIR", "target") / "debug" / name


@pytest.fixture(scope="session")
def ros2_program():
    return of_tests("depthplanes-ros2")


@pytest.fixture(scope="session")
def rerun_program():
    return of_tests("depthplanes-rerun")


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
