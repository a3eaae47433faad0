"""The library as WebAssembly gives the labels of the native program, byte for byte."""

import os
import shutil
import subprocess

import cv2
import numpy as np
import pytest

from conftest import ROOT, build

TARGET = "wasm32-unknown-unknown"
METHODS = ["planar", "ngaf", "ransac"]
# Of every kind of camera there is, in millimetres.
REAL = ["cape_tunnel", "felix_0", "k2stairs_0", "k7_000", "lpvo_hall_125", "mosd_learn17", "rspl_1", "tsdf_150"]


@pytest.fixture(scope="module")
def module():
    """The module of tests/wasm. Rust's target may be out of reach everywhere, node has to be there on CI."""
    sysroot = subprocess.run(["rustc", "--print", "sysroot"], check=True, capture_output=True, text=True).stdout.strip()
    if not os.path.isdir(f"{sysroot}/lib/rustlib/{TARGET}/lib"):
        pytest.skip(f"there is no {TARGET}; `make targets` installs it")
    if node_version() < 18:
        skip("there is no node 18 or later; `make targets` says how to get it")
    target_dir = ROOT / os.environ.get("CARGO_TARGET_DIR", "target")
    crate = ["--manifest-path", "tests/wasm/Cargo.toml", "--target-dir", target_dir, "--target", TARGET]
    build("--locked", *crate)
    return target_dir / TARGET / "release" / "depthplanes_wasm.wasm"


def node_version():
    """The major version of node; 0 if there is none."""
    if shutil.which("node") is None:
        return 0
    version = subprocess.run(["node", "--version"], check=True, capture_output=True, text=True).stdout
    return int(version.removeprefix("v").split(".")[0])


def skip(message):
    """On CI nothing may be missing."""
    if os.environ.get("CI") == "true":
        pytest.fail(message)
    pytest.skip(message)


def room():
    """A corner of three walls in millimetres, with noise that grows with depth, and pixels missing."""
    v, u = np.indices((240, 320))
    x, y = (u - 159.5) / 262.5, (v - 119.5) / 262.5
    depth = np.minimum(np.minimum(2500 / (1 + 0.4 * x), 900 / np.maximum(y, 1e-3)), 1100 / np.maximum(x, 1e-3))
    return with_errors(depth, 2e-7).round().astype(np.uint16)


def steps():
    """Boxes on a table, in floating-point metres; what is missing is 0, NaN or infinite."""
    v, u = np.indices((200, 300))
    depth = 1.2 + 0.002 * v + 0.15 * (u // 75) - 0.3 * ((abs(u - 150) < 40) & (abs(v - 90) < 50))
    depth = with_errors(depth, 1e-3).astype(np.float32)
    depth[::17, ::13], depth[5::19, ::11] = np.nan, np.inf
    return depth


def with_errors(depth, growth):
    rng = np.random.default_rng(7)
    depth = depth + rng.normal(0, growth, depth.shape) * depth**2
    return np.where(rng.random(depth.shape) < 0.02, 0, depth)


def recorded(data, name):
    path = data / "gt_real" / f"{name}.depth.png"
    if not path.is_file():
        skip(f"there is no {path}")
    return cv2.imread(str(path), cv2.IMREAD_UNCHANGED)


@pytest.fixture(params=[*REAL, room, steps], ids=lambda param: getattr(param, "__name__", param))
def depth(request):
    """One of ten maps; the synthetic ones are there without data."""
    return request.param() if callable(request.param) else recorded(request.getfixturevalue("data"), request.param)


@pytest.mark.parametrize("method", METHODS)
def test_labels_are_those_of_the_native_program(module, program, depth, method, tmp_path):
    planes, labels = under_node(module, depth, method, tmp_path)
    expected = native(program, depth, method, tmp_path)
    assert planes == expected.max() > 0
    assert labels == expected.tobytes()


def under_node(module, depth, method, folder):
    """(number of planes, bytes of the labels)"""
    kind = {np.dtype("u2"): "u16", np.dtype("f4"): "f32"}[depth.dtype]
    height, width = depth.shape
    pixels, labels = folder / "pixels.raw", folder / "labels.raw"
    pixels.write_bytes(depth.astype(depth.dtype.newbyteorder("<")).tobytes())
    command = ["node", ROOT / "tests" / "wasm" / "labels.mjs", module, method, kind, str(width), str(height), pixels, labels]
    planes = int(subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True).stdout)
    return planes, labels.read_bytes()


def native(program, depth, method, folder):
    pixels, labels = folder / "pixels.npy", folder / "labels.npy"
    np.save(pixels, depth)
    encoding = "metre" if depth.dtype == np.float32 else "millimetre"
    command = [program, "detect", pixels, "--encoding", encoding, "--method", method, "--labels", labels]
    subprocess.run(command, check=True, capture_output=True)
    return np.load(labels).astype("<u2", copy=False)
