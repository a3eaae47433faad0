"""Every snippet of the docs, every example of a docstring and the notebook are run."""

import doctest
import importlib
import os
import pathlib
import pkgutil
import re
import shutil
import subprocess
import sys
import warnings

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


@pytest.fixture
def batch_page(tmp_path, monkeypatch):
    """The page on many frames, in a folder where its commands have been run by the package's program."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("PATH", os.path.dirname(sys.executable) + os.pathsep + os.environ["PATH"])
    page = ROOT / "docs" / "batch.md"
    for command in re.findall(r"^\$ (.*)$", page.read_text(), re.MULTILINE):
        subprocess.run(["bash", "-c", command], check=True, capture_output=True)
    assert len(list(tmp_path.glob("maps/*.png"))) == 8
    return page


def block(page, kind):
    (found,) = re.findall(rf"^```{kind}\n(.*?)^```", page.read_text(), re.MULTILINE | re.DOTALL)
    return found


def test_the_snippets_on_many_frames_run(batch_page, engine):
    engine("distributed")
    engine("ray.data")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of the engines
        names = {}
        for snippet in snippets(batch_page):
            exec(compile(snippet, "docs/batch.md", "exec"), names)
    assert names["found"] == (8, 0, 520, 2, 0) and names["rows"].num_rows == 8 and len(names["planes"]) == 520


def test_arrays_of_slurm_and_jobs_of_kubernetes_make_all_parts(batch_page, engine, tmp_path):
    parquet, yaml = engine("pyarrow.parquet"), engine("yaml")

    def run(words, cwd, **variables):
        subprocess.run(words, check=True, capture_output=True, cwd=cwd, env=os.environ | variables)

    for cluster in ("slurm", "data"):
        shutil.copytree("maps", f"{cluster}/maps")
    for task in (*range(1, 9), 16):  # the last ones have no frame
        words = {"SLURM_ARRAY_TASK_ID": str(task), "SLURM_ARRAY_TASK_COUNT": "16", "SLURM_CPUS_PER_TASK": "2"}
        run(["bash", "-e", "-c", block(batch_page, "sh")], "slurm", **words)
    job = yaml.safe_load(block(batch_page, "yaml"))
    pod = job["spec"]["template"]["spec"]
    (container,) = pod["containers"]
    assert (job["kind"], job["spec"]["completionMode"]) == ("Job", "Indexed")
    assert [mount["name"] for mount in container["volumeMounts"]] == [volume["name"] for volume in pod["volumes"]]
    words = [word.replace("/data/", f"{tmp_path}/data/") for word in (*container["command"], *container["args"])]
    assert job["spec"]["completions"] == 16
    for index in (*range(8), 15):
        run(words, tmp_path, JOB_COMPLETION_INDEX=str(index))
    for cluster in ("slurm", "data"):
        tables = [parquet.read_table(path) for path in (tmp_path / cluster).glob("tables/*.parquet")]
        assert len(tables) == 8 and sum(table.num_rows for table in tables) == 520
        made = {path.name: path.read_bytes() for path in (tmp_path / cluster).glob("results/*.png")}
        assert made == {path.name: path.read_bytes() for path in (tmp_path / "shards").glob("*.png")} and len(made) == 8


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
