"""Annotations, stubs and keywords are those of the package as it is installed."""

import inspect
import pathlib
import subprocess
import sys

import pytest

import depthplanes
from depthplanes import _native, _options


def test_every_parameter_of_every_method_is_a_keyword_that_editors_know():
    names = {parameter["name"] for method in depthplanes.tables()["methods"] for parameter in method["parameters"]}
    assert names == set(_options.Parameters.__annotations__)


def test_everything_that_is_stated_of_a_map_is_a_keyword_that_editors_know():
    stated = set(inspect.signature(_native.Reading).parameters)
    own = {"sensor", "unit", "intrinsics", "camera_file"}
    assert stated - own == set(_options.FileOptions.__annotations__)


def test_the_defaults_are_those_of_the_tables():
    for method in depthplanes.tables()["methods"]:
        detector = depthplanes.Detector(method=method["name"])
        assert detector.parameters == {row["name"]: row["default"] for row in method["parameters"]}
        assert all(f"{name}=" in repr(detector) for name in detector.parameters)


def test_what_is_public_has_a_page_of_its_own():
    for name in depthplanes.__all__:
        thing = getattr(depthplanes, name)
        if name == "__version__":
            continue
        assert inspect.getdoc(thing), name
        if inspect.isclass(thing):
            for part, member in vars(thing).items():
                if not part.startswith("_") and (callable(member) or isinstance(member, property)):
                    assert inspect.getdoc(member), f"{name}.{part}"


def test_the_version_is_the_programs():
    ran = subprocess.run([sys.executable, "-m", "depthplanes", "--version"], capture_output=True, text=True, check=True)
    assert ran.stdout.split() == ["depthplanes", depthplanes.__version__]


def mypy(*words):
    pytest.importorskip("mypy")
    ran = subprocess.run([sys.executable, "-m", *words], capture_output=True, text=True)
    assert ran.returncode == 0, ran.stdout + ran.stderr


def test_the_stub_is_what_the_module_has(tmp_path):
    mypy("mypy.stubtest", "depthplanes._native")


def test_the_package_is_typed(tmp_path):
    (tmp_path / "user.py").write_text(
        "import numpy as np, depthplanes\n"
        "planes = depthplanes.detect(np.zeros((4, 4), np.uint16), camera=(1, 1, 2, 2), min_pixels=3)\n"
        "normal: float = planes[0].distance\n"
        "few: depthplanes.Planes = planes[planes.areas > 1]\n"
    )
    mypy("mypy", "--strict", str(tmp_path / "user.py"))


def test_the_sources_pass_the_type_checker():
    sources = pathlib.Path(depthplanes.__file__).parent
    mypy("mypy", "--strict", "--ignore-missing-imports", "-p", "depthplanes")
    assert (sources / "py.typed").is_file()
