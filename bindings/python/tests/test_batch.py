"""Frames in parts: every engine gives the same rows, each frame once, whatever dies meanwhile."""

import contextlib
import json
import os
import pathlib
import signal
import subprocess
import sys
import threading
import time
import zipfile

import numpy as np
import pytest

import depthplanes
from depthplanes import batch
from depthplanes._words import in_python

FRAMES = 500
OPTIONS = {"unit": "mm", "camera": (58.0, 58.0, 31.5, 23.5)}
#: Folders of the recorded data beside those with known answers.
RECORDED = ("gt_real", "stairs_kinect_v2", "azure_kinect", "tum")


def picture(path, at):
    """Writes a frame of two walls of its own."""
    Image = pytest.importorskip("PIL.Image")  # Matplotlib brings it
    u, v = np.meshgrid(np.arange(64), np.arange(48))
    depth = 1000 + 7 * at + np.where(u < 20 + at % 20, 0, 400) + (u + 2 * v) % 3
    Image.fromarray(depth.astype(np.uint16)).save(path)


@pytest.fixture(scope="module")
def frames(tmp_path_factory):
    """Many small frames."""
    folder = tmp_path_factory.mktemp("frames")
    for at in range(FRAMES):
        picture(folder / f"{at:04}.png", at)
    return sorted(map(str, folder.iterdir()))


@pytest.fixture(scope="module")
def expected(frames):
    """The rows of these, in this process."""
    rows = [batch.process(path, **OPTIONS) for path in frames]
    assert all(row["error"] is None and len(row["planes"]) == 2 for row in rows)
    assert len({str(row["planes"]) for row in rows}) == FRAMES
    return rows


@pytest.fixture(scope="module")
def recorded(data):
    """Recorded frames, and their rows in this process."""
    paths = [str(path) for folder in RECORDED for path in sorted((data / folder).glob("*.png"))]
    rows = [batch.process(path, unit="mm") for path in paths]
    assert len(rows) > 60 and sum(len(row["planes"]) for row in rows) > 500
    assert any(row["error"] for row in rows), "there are colour pictures among them"
    return paths, rows


@pytest.fixture(scope="module")
def all_frames(frames, recorded):
    """Both, as engines are given them."""
    paths, rows = recorded
    return [*frames, *paths], [*(batch.process(path, unit="mm") for path in frames), *rows]


def rows_in(out):
    return batch.read_rows(out).to_pylist()


def part_files(out):
    return sorted(pathlib.Path(out).glob("part-*.parquet"))


def wait_for_parts(out, count):
    start = time.monotonic()
    while len(part_files(out)) < count:
        assert time.monotonic() < start + 120, "no parts are made"
        time.sleep(0.002)


def test_threads_give_the_rows_of_one_frame_after_the_other(frames, expected, tmp_path):
    found = batch.run(pathlib.Path(frames[0]).parent, tmp_path / "out", labels=tmp_path / "labels", part=64, **OPTIONS)
    assert found == batch.Summary(frames=FRAMES, failed=0, planes=2 * FRAMES, parts=8, skipped=0) and len(part_files(tmp_path / "out")) == 8
    rows = rows_in(tmp_path / "out")
    for row, path in zip(rows[::50], frames[::50], strict=True):
        labels = depthplanes.read(row["labels"], unit="grey").depth
        assert np.array_equal(labels, depthplanes.detect(path, **OPTIONS).labels)
    assert len({row.pop("labels") for row in rows}) == FRAMES == len(list((tmp_path / "labels").iterdir()))
    assert rows == [{name: value for name, value in row.items() if name != "labels"} for row in expected]


def test_rows_are_the_programs_table(engine, recorded, program, tmp_path):
    paths, rows = recorded
    program("detect", "--encoding", "millimetre", "--table", tmp_path / "planes.parquet", *paths, check=False)
    table = engine("pyarrow.parquet").read_table(tmp_path / "planes.parquet")
    assert [{"source": row["path"]} | plane for row in rows for plane in row["planes"]] == table.to_pylist()
    batch.run(paths, tmp_path / "out", unit="mm")
    assert rows_in(tmp_path / "out") == rows
    plane = batch.read_rows(tmp_path / "out").schema.field("planes").type.value_type
    assert [(field.name, field.type) for field in plane] == [(field.name, field.type) for field in table.schema][1:]


@contextlib.contextmanager
def killed_meanwhile(paths, out, **options):
    """A run in which somebody is killed by what is inside the `with`."""
    parts = -(-len(paths) // 5)
    said = []
    thread = threading.Thread(target=lambda: said.append(batch.run(paths, out, part=5, unit="mm", **options)))
    thread.start()
    wait_for_parts(out, 8)
    yield
    assert len(part_files(out)) < parts, "the run was over before the kill"
    thread.join(180)
    assert [(found.frames, found.skipped, found.parts) for found in said] == [(len(paths), 0, parts)]


@pytest.mark.filterwarnings("ignore")
def test_a_worker_of_dask_that_is_killed_loses_nothing(engine, all_frames, tmp_path, tell):
    distributed = engine("distributed")
    paths, rows = all_frames
    with distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster:
        with distributed.Client(cluster) as client:
            pids = client.run(os.getpid)
            start = time.monotonic()
            with killed_meanwhile(paths, tmp_path / "out", engine="dask", client=client):
                os.kill(next(iter(pids.values())), signal.SIGKILL)
            tell(f"dask: {len(paths)} frames, a worker killed, in {time.monotonic() - start:.1f} s:")
            assert set(client.run(os.getpid).values()) != set(pids.values())
    assert rows_in(tmp_path / "out") == rows


@pytest.mark.filterwarnings("ignore")
def test_dask_starts_workers_where_there_is_no_cluster(engine, frames, expected, tmp_path):
    engine("distributed")
    assert batch.run(frames[:40], tmp_path / "out", engine="dask", workers=2, part=10, **OPTIONS) == (40, 0, 80, 4, 0)
    assert rows_in(tmp_path / "out") == expected[:40]


@pytest.mark.filterwarnings("ignore")
def test_an_actor_of_ray_that_is_killed_loses_nothing(engine, all_frames, tmp_path, tell):
    ray, psutil = engine("ray"), engine("psutil")
    engine("ray.data")
    paths, rows = all_frames
    start = time.monotonic()
    ray.init(num_cpus=2, include_dashboard=False, _node_ip_address="127.0.0.1", log_to_driver=False)
    try:
        ready = time.monotonic()
        with killed_meanwhile(paths, tmp_path / "out", engine="ray"):
            actors = [child for child in psutil.Process().children(recursive=True) if "_Actor)" in "".join(child.cmdline())]
            assert len(actors) == 2
            actors[0].kill()
    finally:
        ray.shutdown()
    tell(f"ray: ready in {ready - start:.1f} s, {len(paths)} frames, an actor killed, in {time.monotonic() - ready:.1f} s:")
    assert rows_in(tmp_path / "out") == rows


def test_a_run_that_is_killed_goes_on(frames, expected, tmp_path):
    out = tmp_path / "out"
    code = "import json, sys; from depthplanes import batch; batch.run(sys.argv[2:], sys.argv[1], part=5, workers=1, unit='mm', "
    code += f"camera={OPTIONS['camera']})"
    child = subprocess.Popen([sys.executable, "-c", code, out, *frames])
    wait_for_parts(out, 10)
    child.kill()
    child.wait()
    there = {path: path.stat().st_mtime_ns for path in part_files(out)}
    assert 10 <= len(there) < 100, "the run was over before the kill"
    with pytest.raises(depthplanes.InputError, match="of 100 parts"):
        batch.read_rows(out)
    assert batch.read_rows(out, partial=True).num_rows == 5 * len(there)
    found = batch.run(frames, out, part=5, **OPTIONS)
    assert found == (FRAMES, 0, 2 * FRAMES, 100, 5 * len(there))
    assert all(path.stat().st_mtime_ns == then for path, then in there.items())
    part_files(out)[7].write_bytes(b"")  # as a machine that lost its power leaves it
    assert batch.run(frames, out, part=5, **OPTIONS).skipped == FRAMES - 5
    assert rows_in(out) == expected
    assert batch.run(frames, out, part=5, **OPTIONS) == (FRAMES, 0, 2 * FRAMES, 100, FRAMES)


def test_a_frame_that_fails_is_a_row(frames, expected, program, tmp_path):
    (tmp_path / "broken.png").write_bytes(pathlib.Path(frames[0]).read_bytes()[:100])
    (tmp_path / "empty.png").touch()
    paths = [frames[0], *(str(tmp_path / name) for name in ("broken.png", "empty.png", "nothing.png")), frames[1]]
    assert batch.run(paths, tmp_path / "out", part=2, labels=tmp_path / "labels", **OPTIONS) == (5, 3, 4, 3, 0)
    rows = rows_in(tmp_path / "out")
    assert [row["path"] for row in rows] == paths
    assert [row["planes"] for row in rows[::4]] == [row["planes"] for row in expected[:2]]
    for row in rows[1:4]:
        said = program("detect", row["path"], check=False).stderr.decode().removeprefix("error: ").strip()
        assert row["error"] == in_python(said) and row["planes"] == [] and row["width"] is None and row["labels"] is None
    picture(tmp_path / "broken.png", 1)
    assert batch.run(paths, tmp_path / "out", part=2, labels=tmp_path / "labels", **OPTIONS) == (5, 3, 4, 3, 5)
    again = batch.run(paths, tmp_path / "out", part=2, labels=tmp_path / "labels", retry_failed=True, **OPTIONS)
    assert again == (5, 2, 6, 3, 1) and rows_in(tmp_path / "out")[1]["planes"] == expected[1]["planes"]


def test_what_reads_folders_of_parquet_reads_the_results(engine, frames, expected, tmp_path):
    pandas, dataset = engine("pandas"), engine("pyarrow.dataset")
    out = tmp_path / "out"
    batch.run(frames[:10], out, part=4, **OPTIONS)
    (out / ".part-00003.parquet.0.partial").write_bytes(b"of a worker that was killed")
    table = pandas.read_parquet(out)
    assert table.path.tolist() == frames[:10] and [len(planes) for planes in table.planes] == [2] * 10
    assert dataset.dataset(out).to_table().to_pylist() == expected[:10] == rows_in(out)


def test_results_of_other_settings_are_not_mixed(frames, tmp_path):
    camera = tmp_path / "camera.json"
    camera.write_text(json.dumps({"fx": 58, "fy": 58, "cx": 31.5, "cy": 23.5, "width": 64, "height": 48}))
    words = {"unit": "mm", "camera": camera}
    batch.run(frames[:10], tmp_path / "out", part=5, **words)
    before = [path.stat().st_mtime_ns for path in part_files(tmp_path / "out")]
    for others, what in [
        ({"min_pixels": 123}, "parameters: "),
        ({"method": "ngaf"}, "method: planar instead of ngaf"),
        ({"unit": "tum"}, "options: "),
        ({"curved": True}, "options: "),
        ({"labels": tmp_path / "labels"}, "labels: None instead of "),
        ({"part": 6}, "part: 5 instead of 6"),
    ]:
        with pytest.raises(depthplanes.InputError, match=f"has results of other settings.*{what}.*another folder"):
            batch.run(frames[:10], tmp_path / "out", **({"part": 5} | words | others))
    for others, what in [
        (frames[:13], "of 10 frames, since then 3 were added and 0 have gone; accepted: the frames of then, or another folder"),
        (frames[2:11], "of 10 frames, since then 1 were added and 2 have gone"),
        (frames[:10][::-1], "of 10 frames, which were in another order"),
    ]:
        with pytest.raises(depthplanes.InputError, match=what):
            batch.run(others, tmp_path / "out", part=5, **words)
    default = depthplanes.Detector().parameters["min_pixels"]
    assert batch.run(frames[:10], tmp_path / "out", part=5, threads=2, min_pixels=default, workers=1, **words).skipped == 10
    camera.write_text(camera.read_text().replace("23.5", "24.5"))
    with pytest.raises(depthplanes.InputError, match="files_sha256"):
        batch.run(frames[:10], tmp_path / "out", part=5, **words)
    assert [path.stat().st_mtime_ns for path in part_files(tmp_path / "out")] == before
    (tmp_path / "out" / "_batch.json").write_text("hello")
    with pytest.raises(depthplanes.InputError, match="not of depthplanes.batch"):
        batch.run(frames[:10], tmp_path / "out", part=5, **words)


def test_links_are_frames(frames, tmp_path):
    (tmp_path / "links").mkdir()
    for path in frames[:3]:
        (tmp_path / "links" / os.path.basename(path)).symlink_to(path)
    (tmp_path / "links" / "gone.png").symlink_to(tmp_path / "nothing.png")
    (tmp_path / "links" / "folder.png").symlink_to(tmp_path)
    assert batch.run(tmp_path / "links", tmp_path / "out", **OPTIONS) == (3, 0, 6, 1, 0)


def test_a_name_that_is_no_text_fails_alone(frames, tmp_path):
    (tmp_path / "maps").mkdir()
    for name in (b"a.png", b"b-\xff.png"):
        (tmp_path / "maps" / os.fsdecode(name)).write_bytes(pathlib.Path(frames[0]).read_bytes())
    assert batch.run(tmp_path / "maps", tmp_path / "out", labels=tmp_path / "labels", **OPTIONS) == (2, 1, 2, 1, 0)
    assert batch.run(tmp_path / "maps", tmp_path / "out", labels=tmp_path / "labels", **OPTIONS).skipped == 2
    failed = rows_in(tmp_path / "out")[1]
    assert failed["path"].endswith("b-\\udcff.png") and "not UTF-8" in failed["error"]


def test_what_is_no_part_is_told_from_parts(frames, tmp_path):
    out = tmp_path / "out"
    batch.run(frames[:10], out, part=5, **OPTIONS)
    whole = (out / "part-00001.parquet").read_bytes()
    for name in ("part-abc.parquet", "part-00000 (copy).parquet", "part-000000.parquet", "part-1.parquet"):
        (out / name).write_bytes(b"something else")
    assert batch.run(frames[:10], out, part=5, **OPTIONS).skipped == 10
    for cut in (whole[:-10], whole[10:], whole[:3]):
        (out / "part-00001.parquet").write_bytes(cut)
        assert batch.run(frames[:10], out, part=5, **OPTIONS) == (10, 0, 20, 2, 5)
        assert (out / "part-00001.parquet").read_bytes() == whole
    (out / "part-00007.parquet").write_bytes(whole)
    for call in (lambda: batch.run(frames[:10], out, part=5, **OPTIONS), lambda: batch.read_rows(out)):
        with pytest.raises(depthplanes.InputError, match="has part-00007.parquet, but the run is of 2 parts, the last of which is part-00001"):
            call()
    with pytest.raises(depthplanes.FileError, match="out/_batch.json is a file; accepted: a folder"):
        batch.run(frames[:1], out / "_batch.json", **OPTIONS)


def test_words_that_are_not_accepted_are_refused_before_any_work(frames, tmp_path):
    out = tmp_path / "out"
    for words, what in [
        ({"engine": "spark"}, "'local', 'dask', 'ray'"),
        ({"part": 0}, "part is 0; accepted: a whole number from 1"),
        ({"workers": 1.5}, "workers is 1.5"),
        ({"client": object()}, 'accepted: engine="dask"'),
        ({"unit": "inch"}, "millimetre"),
        ({"min_pixels": -1}, "min_pixels"),
        ({"frob": 1}, "there is no keyword frob"),
    ]:
        with pytest.raises(depthplanes.Error, match=what):
            batch.run(frames[:1], out, **words)
    for paths, what in [
        ([], "there is no path"),
        (tmp_path, "no map in this folder"),
        (tmp_path / "*.png", "nothing matches"),
        ([frames[0], frames[0]], "is there 2 times"),
    ]:
        with pytest.raises(depthplanes.InputError, match=what):
            batch.run(paths, out)
    for paths in ("nofolder", ["nofolder"], "nothing.png", "memory://nofolder", "memory://nothing.png"):
        with pytest.raises(depthplanes.MissingFileError, match="no(folder|thing.png): there is no such file or folder"):
            batch.run(paths, out)
    with pytest.raises(depthplanes.InputError, match="has no results"):
        batch.read_rows(out)
    assert not out.exists()


def test_frames_and_results_may_be_behind_urls(engine, frames, expected, tmp_path):
    fsspec = engine("fsspec")
    memory = fsspec.filesystem("memory")
    for path in frames[:20]:
        memory.pipe_file(f"/batch/maps/{os.path.basename(path)}", pathlib.Path(path).read_bytes())
    memory.pipe_file("/batch/maps/0000.labels.png", b"a result, which is no frame")
    with zipfile.ZipFile(tmp_path / "maps.zip", "w") as packed:
        for path in frames[:20]:
            packed.write(path, f"maps/{os.path.basename(path)}")
    wanted = [row["planes"] for row in expected[:20]]
    for at, paths in enumerate(["memory://batch/maps", "memory://batch/maps/*.png", f"zip://maps/*.png::{tmp_path}/maps.zip"]):
        out = f"memory://batch/out{at}"
        assert batch.run(paths, out, labels="memory://batch/labels", part=8, **OPTIONS).parts == 3
        rows = rows_in(out)
        assert [row["planes"] for row in rows] == wanted
        assert all(row["path"].partition("://")[0] == paths.partition("://")[0] for row in rows)
        image = fsspec.open(rows[3]["labels"]).open().read()
        assert np.array_equal(depthplanes.read(image, unit="grey").depth, depthplanes.detect(frames[3], **OPTIONS).labels)
        assert rows[3] == batch.process(rows[3]["path"], labels="memory://batch/labels", **OPTIONS)
        assert batch.run(paths, out, labels="memory://batch/labels", part=8, **OPTIONS) == (20, 0, 40, 3, 20)
    assert "nothing.png" in batch.process("memory://batch/nothing.png")["error"]
    assert not [path for path in memory.find("/batch") if path.endswith(".partial")]


@pytest.mark.filterwarnings("ignore")
def test_workers_that_write_elsewhere_are_noticed(engine, frames):
    """The memory of another process is not seen."""
    engine("distributed")
    with pytest.raises(depthplanes.FileError, match="1 of 1 parts were written, but not here"):
        batch.run(frames[:3], "memory://elsewhere/out", engine="dask", workers=1, **OPTIONS)


def test_what_is_missing_is_said_with_what_to_type(frames, tmp_path):
    code = """
import sys, importlib.abc
missing = set(sys.argv[1].split(","))
class Alone(importlib.abc.MetaPathFinder):
    def find_spec(self, name, path, target=None):
        if name.split(".")[0] in missing:
            raise ModuleNotFoundError("No module named " + repr(name))
sys.meta_path.insert(0, Alone())
from depthplanes import MissingPackageError, batch
assert len(batch.process(sys.argv[3], unit="mm")["planes"]) == 2  # with NumPy alone
try:
    batch.run(sys.argv[3:], sys.argv[2], engine=sys.argv[1].split(",")[-1])
except MissingPackageError as error:
    print(error)
"""
    for missing, package, extra in [
        ("pyarrow,fsspec,local", "pyarrow", "batch"),
        ("fsspec,local", "fsspec", "batch"),
        ("distributed,dask", "dask[distributed]", "dask"),
        ("ray", "ray[data]", "ray"),
    ]:
        words = [sys.executable, "-W", "ignore", "-c", code, missing, tmp_path / missing, frames[0]]
        ran = subprocess.run(words, capture_output=True, text=True, check=True)
        assert f"needs the package `{package}`" in ran.stdout and f"pip install 'depthplanes[{extra}]'" in ran.stdout, (missing, ran.stdout)
