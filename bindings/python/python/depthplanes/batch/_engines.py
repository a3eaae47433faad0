"""Where parts are made. Each engine makes all parts; what an engine is like only this file knows."""

from __future__ import annotations

import functools
import os
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from typing import Any

from .._optional import need
from ._parts import Job
from ._rows import Row

#: The number of a part, and its frames.
Part = tuple[int, list[str]]


def _local(job: Job, parts: list[Part], workers: int | None, client: None) -> None:
    """Threads that share a detector, one part after the other."""
    processor = job.processor()
    with ThreadPoolExecutor(workers or os.cpu_count()) as threads:
        for number, frames in parts:
            job.write(number, list(threads.map(processor, frames)))


def _dask(job: Job, parts: list[Part], workers: int | None, client: Any) -> None:
    """A task for each part. Of a worker that dies others make the parts."""
    distributed = need("distributed", "dask[distributed]", 'batch.run(engine="dask")', "'depthplanes[dask]'")
    if client is None:
        cluster = distributed.LocalCluster(n_workers=workers or os.cpu_count(), threads_per_worker=1, dashboard_address=None)
        with cluster, distributed.Client(cluster) as own:
            _dask(job, parts, None, own)
        return
    tasks = client.map(functools.partial(_make, job), parts, retries=2, pure=False)
    for _ in distributed.as_completed(tasks, with_results=True):  # which raises what a task raised
        pass


def _make(job: Job, part: Part) -> None:
    """A part, with a detector of its own."""
    number, frames = part
    job.write(number, list(map(job.processor(), frames)))


def _ray(job: Job, parts: list[Part], workers: int | None, client: None) -> None:
    """Actors, each of a processor of the cluster. Ray Data starts what dies anew."""
    ray = need("ray", "ray[data]", 'batch.run(engine="ray")', "'depthplanes[ray]'")
    data = need("ray.data", "ray[data]", 'batch.run(engine="ray")', "'depthplanes[ray]'")
    if not ray.is_initialized():
        ray.init()
    most = min(len(parts), workers or max(1, int(ray.cluster_resources().get("CPU", 1))))
    rows = [{"number": number, "frames": frames} for number, frames in parts]
    actors = data.ActorPoolStrategy(size=most)
    made = data.from_items(rows, override_num_blocks=len(rows)).map(_Actor, fn_constructor_args=(job,), compute=actors)
    for _ in made.iter_rows():
        pass


class _Actor:
    """What Ray Data keeps on a worker: a detector for all of its parts."""

    def __init__(self, job: Job) -> None:
        self._job = job
        self._processor = job.processor()

    def __call__(self, part: Row) -> Row:
        rows = [self._processor(str(path)) for path in part["frames"]]
        self._job.write(int(part["number"]), rows)
        return {"number": part["number"]}


ENGINES: dict[str, Callable[[Job, list[Part], int | None, Any], None]] = {"local": _local, "dask": _dask, "ray": _ray}
