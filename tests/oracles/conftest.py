"""Builds what the tests run."""

import os
import pathlib
import subprocess
import sys

import pytest

from worker import Worker

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.append(str(ROOT / "tests"))

from shared_fixtures import data, tell  # noqa: E402, F401


def build(*what):
    """Builds in release mode, which does nothing if it is fresh; returns the folder of the programs."""
    subprocess.run(["cargo", "build", "--release", *what], cwd=ROOT, check=True)
    return ROOT / os.environ.get("CARGO_TARGET_DIR", "target") / "release"


@pytest.fixture(scope="session")
def worker_program():
    # With the feature that the program needs as well, so that the library is compiled once for both.
    return build("-p", "depthplanes", "--features", "serde", "--example", "oracle_worker") / "examples" / "oracle_worker"


@pytest.fixture
def worker(worker_program):
    worker = Worker(worker_program)
    assert "portable" in worker.kernels
    yield worker
    worker.close()


@pytest.fixture(scope="session")
def program():
    return build("-p", "depthplanes-cli", "--features", "parquet") / "depthplanes"  # as the Python package has it


def of_tests(name):
    """A program as `make test` has built it already; a release of those with many crates takes minutes."""
    # With a test of its package, and one of those that ask most of other crates: crates with other features would be made anew.
    tests = "--test broken --test layouts --test rerun"
    command = f"cargo test --workspace --features depthplanes/serde,depthplanes-cli/parquet {tests} --no-run"
    subprocess.run(command.split(), cwd=ROOT, check=True)
    return ROOT / os.environ.get("CARGO_TARGET_DIR", "target") / "debug" / name


@pytest.fixture(scope="session")
def ros2_program():
    return of_tests("depthplanes-ros2")


@pytest.fixture(scope="session")
def rerun_program():
    return of_tests("depthplanes-rerun")
