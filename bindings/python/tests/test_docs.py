"""Every snippet of the docs, every example of a docstring and the notebook are run."""

import doctest
import importlib
import pathlib
import pkgutil
import re

import numpy as np
import pytest

import depthplanes

ROOT = pathlib.Path(__file__).resolve().parents[3]
PYTHON = ROOT / "bindings" / "python"


def snippets(page):
    return re.findall(r"^```python\n(.*?)^```", page.read_text(), re.MULTILINE | re.DOTALL)


@pytest.mark.filterwarnings("default::depthplanes.ReadingWarning")
@pytest.mark.parametrize("page", ["docs/python.md", "bindings/python/README.md", "README.md"])
def test_the_snippets_of_a_page_run(page, tmp_path, monkeypatch, program):
    monkeypatch.chdir(tmp_path)
    program("demo", cwd=tmp_path)
    found = snippets(ROOT / page)
    assert found
    names = {}
    for snippet in found:
        exec(compile(snippet, page, "exec"), names)
    assert len(names["planes"]) > 3


def test_the_readmes_taste_is_short():
    (taste,) = snippets(ROOT / "README.md")
    assert len(taste.splitlines()) < 10


def modules():
    yield depthplanes
    for module in pkgutil.iter_modules(depthplanes.__path__):
        if module.name not in ("_native", "__main__", "_export"):
            yield importlib.import_module(f"depthplanes.{module.name}")


def test_the_examples_of_the_docstrings_print_what_they_say():
    tried = 0
    for module in modules():
        ran = doctest.testmod(module, extraglobs={"depthplanes": depthplanes, "np": np})
        assert ran.failed == 0, module.__name__
        tried += ran.attempted
    assert tried > 25


def test_the_notebook_runs(tmp_path):
    nbformat = pytest.importorskip("nbformat")
    nbclient = pytest.importorskip("nbclient")
    pytest.importorskip("matplotlib")
    notebook = nbformat.read(PYTHON / "examples" / "quickstart.ipynb", as_version=4)
    nbclient.NotebookClient(notebook, timeout=120, resources={"metadata": {"path": str(tmp_path)}}).execute()
    pictures = [output for cell in notebook.cells for output in cell.get("outputs", []) if "image/png" in output.get("data", {})]
    assert len(pictures) >= 2
