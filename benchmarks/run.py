"""Group + select + labels against cc3d and cv2.filterSpeckles, interleaved in one run.

    python benchmarks/run.py [--rounds N] [--record FILE] [--data DIR] [--threads N]

Every round times each rival five times at a stretch after 10 ms of untimed calls, in turn, so that the machine's drift meets all of them alike;
what is quoted are ratios of medians. The rivals run in this process, ours in a worker that answers
commands (crates/depthplanes/examples/bench_worker.rs). Labels are compared with the rival's before
anything is timed; a difference ends the run.
"""

import argparse
import csv
import datetime
import functools
import importlib.metadata
import pathlib
import platform
import statistics
import subprocess
import sys
import tempfile
import time

import cc3d
import cv2
import numpy as np

ROOT = pathlib.Path(__file__).resolve().parent.parent
EXAMPLES = ROOT / "target" / "release" / "examples"
WARM_UP_MS = 10  # the worker's too; a processor that was waiting takes that long to its full speed
FIELDS = ["frame", "width", "height", "type", "theta", "min_pixels", "runs", "planes", "ours_us", "copy_us",
          "cc3d_filter_us", "cc3d_alone_us", "filter_speckles_us", "times_cc3d_filter", "times_cc3d_alone",
          "times_filter_speckles", "copies_of_the_frame", "ours_ns_per_pixel"]


def synthetic(spec, kind):
    """A frame of the scene generator."""
    with tempfile.NamedTemporaryFile(suffix=".raw") as file:
        size = subprocess.run([EXAMPLES / "bench_frame", spec, file.name], check=True, capture_output=True, text=True)
        width, height = map(int, size.stdout.split())
        return np.fromfile(file.name, kind).reshape(height, width)


def real(data, path):
    return cv2.imread(str(data / path), cv2.IMREAD_UNCHANGED) if data else None


def frames(data):
    """(name, map, theta, min_pixels): quantised and raw noisy ones, small and large."""
    large = "size=4096x3000"
    yield "synthetic room, disparity 8 bit", synthetic("room:sensor=disparity", np.uint8), 1, 64
    room = synthetic("room:sensor=kinect_white", np.uint16)
    yield "synthetic room, Kinect >> 5", (room >> 5).astype(np.uint8), 1, 64
    yield "synthetic room, Kinect mm", room, 2, 64
    yield "synthetic room, ToF mm", synthetic("room:sensor=tof_white", np.uint16), 2, 64
    yield "synthetic room, disparity 8 bit, large", synthetic(f"room:sensor=disparity,{large}", np.uint8), 1, 64
    room = synthetic(f"room:sensor=kinect_white,{large}", np.uint16)
    yield "synthetic room, Kinect >> 5, large", (room >> 5).astype(np.uint8), 1, 64
    yield "synthetic room, Kinect mm, large", room, 2, 64
    kinect = real(data, "kinect_v1/cape_depth_0.png")
    if kinect is not None:
        yield "Kinect v1 >> 5 as 8 bit", (kinect >> 5).astype(np.uint8), 1, 64
        yield "Kinect v1 >> 5 as 16 bit", kinect >> 5, 2, 64
        yield "Kinect v1 mm", kinect, 2, 64
        yield "Kinect v1 mm, theta 10", kinect, 10, 64
        yield "TUM fr3 1/5000 m", real(data, "tum/deplex_fr3_1341848230.910894.png"), 2, 64
        seven = real(data, "video_7scenes/frame-000000.depth.png")
        yield "7-Scenes mm", np.where(seven == 65535, 0, seven).astype(np.uint16), 2, 64
        yield "ICL-NUIM 1/5000 m", real(data, "gt_evops/icl_0.depth.png"), 2, 64
        yield "Teddy disparity", real(data, "middlebury/teddy/disp2.png"), 1, 64


def group_and_filter(depth, theta, least):
    """The rival's way to the same label image: components, then a size filter through bincount."""
    labels, count = cc3d.connected_components(depth, connectivity=4, delta=theta, return_N=True)
    keep = np.bincount(labels.ravel(), minlength=count + 1) > least
    keep[0] = False
    return np.where(keep, np.cumsum(keep), 0).astype(np.uint16)[labels]


def canonical(labels):
    """Labels by decreasing size, ties by first pixel."""
    flat = labels.ravel()
    values, first, counts = np.unique(flat, return_index=True, return_counts=True)
    order = sorted((-count, at, value) for value, at, count in zip(values, first, counts) if value)
    table = np.zeros(int(values.max()) + 1, np.uint16)
    for label, (_, _, value) in enumerate(order, 1):
        table[value] = label
    return table[labels]


def microseconds(work, times):
    """Times of that many calls, after untimed ones for WARM_UP_MS."""
    begin, taken = time.perf_counter_ns(), []
    while len(taken) < times:
        start = time.perf_counter_ns()
        work()
        if start - begin >= WARM_UP_MS * 1e6:
            taken.append((time.perf_counter_ns() - start) / 1000)
    return taken


class Worker:
    """Our side: one process per frame that answers commands."""

    def __init__(self, depth, theta, least, threads, folder):
        self.frame = pathlib.Path(folder) / "frame.raw"
        self.painted = pathlib.Path(folder) / "labels.raw"
        depth.tofile(self.frame)
        kind = {"uint8": "u8", "uint16": "u16", "float32": "f32"}[depth.dtype.name]
        height, width = depth.shape
        self.shape = depth.shape
        self.process = subprocess.Popen(
            [EXAMPLES / "bench_worker", str(width), str(height), kind, str(theta), str(least), str(threads), "best",
             str(self.frame)],
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, bufsize=1)

    def ask(self, command):
        self.process.stdin.write(command + "\n")
        answer = self.process.stdout.readline().strip()
        if not answer:
            sys.exit(f"the worker gave no answer to `{command}`")
        return answer

    def microseconds(self, command, times):
        return [int(nanoseconds) / 1000 for nanoseconds in self.ask(f"{command} {times}").split()]

    def labels(self):
        self.ask("detect 1")
        self.ask(f"labels {self.painted}")
        return np.fromfile(self.painted, np.uint16).reshape(self.shape)


def measure(name, depth, theta, least, rounds, threads):
    with tempfile.TemporaryDirectory() as folder:
        worker = Worker(depth, theta, least, threads, folder)
        labels = worker.labels()
        if not np.array_equal(labels, canonical(group_and_filter(depth, theta, least))):
            sys.exit(f"{name}: our labels differ from cc3d's; nothing is timed")
        # cv2.filterSpeckles takes 8 bit unsigned and 16 bit signed, in place; the copy is part of its use.
        speckle_map = depth if depth.dtype == np.uint8 else depth.astype(np.int16)
        speckles = depth.dtype == np.uint8 or depth.max() < 32768
        if speckles:
            filtered = speckle_map.copy()
            cv2.filterSpeckles(filtered, 0, least, theta)
            if not np.array_equal(filtered != 0, labels != 0):
                sys.exit(f"{name}: our kept pixels differ from cv2.filterSpeckles'; nothing is timed")
        calls = {
            "cc3d_filter_us": lambda: group_and_filter(depth, theta, least),
            "cc3d_alone_us": lambda: cc3d.connected_components(depth, connectivity=4, delta=theta),
            "filter_speckles_us": lambda: cv2.filterSpeckles(speckle_map.copy(), 0, least, theta),
        }
        if not speckles:
            del calls["filter_speckles_us"]
        rivals = {rival: functools.partial(microseconds, call) for rival, call in calls.items()}
        rivals["ours_us"] = functools.partial(worker.microseconds, "detect")
        rivals["copy_us"] = functools.partial(worker.microseconds, "copy")
        times = {rival: [] for rival in rivals}
        for _ in range(rounds):
            for rival, timed in rivals.items():
                times[rival] += timed(5)
        runs = worker.ask("runs")
        worker.process.stdin.close()
        worker.process.wait()
    row = {rival: statistics.median(values) for rival, values in times.items()}
    ours = row["ours_us"]
    row |= {"frame": name, "width": depth.shape[1], "height": depth.shape[0], "type": depth.dtype.name, "theta": theta,
            "min_pixels": least, "runs": runs, "planes": int(labels.max()), "times_cc3d_filter": row["cc3d_filter_us"] / ours,
            "times_cc3d_alone": row["cc3d_alone_us"] / ours, "copies_of_the_frame": ours / row["copy_us"],
            "ours_ns_per_pixel": 1000 * ours / depth.size}
    if speckles:
        row["times_filter_speckles"] = row["filter_speckles_us"] / ours
    return row


def processor():
    for line in pathlib.Path("/proc/cpuinfo").read_text().splitlines() if sys.platform == "linux" else []:
        if line.startswith("model name"):
            return line.split(":")[1].strip()
    return platform.processor() or "unknown"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rounds", type=int, default=31)
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--record", type=pathlib.Path, help="also write the rows to this CSV file")
    parser.add_argument("--data", type=pathlib.Path, default=ROOT.parent / "shared" / "data", help="folder of real maps")
    options = parser.parse_args()
    data = options.data if options.data.is_dir() else None
    if data is None:
        print(f"no real maps at {options.data}; synthetic frames only")
    cv2.setNumThreads(1)
    print(f"{processor()}, {options.threads} thread(s), medians of {options.rounds} interleaved rounds, microseconds")
    header = f"{'frame':38} {'size':>9} {'theta':>5} {'runs':>8} {'ours':>8} {'copy':>7} {'cc3d+f':>9} {'speckles':>9} " \
             f"{'x cc3d+f':>8} {'x cc3d':>7} {'x speck':>7} {'copies':>6} {'ns/px':>6}"
    print(header)
    rows = []
    for name, depth, theta, least in frames(data):
        rounds = options.rounds if depth.size < 2e6 else max(5, options.rounds // 3)
        row = measure(name, np.ascontiguousarray(depth), theta, least, rounds, options.threads)
        rows.append(row)
        speckle, ratio = row.get("filter_speckles_us", float("nan")), row.get("times_filter_speckles", float("nan"))
        print(f"{name:38} {row['width']:4}x{row['height']:<4} {theta:5} {row['runs']:>8} {row['ours_us']:8.1f} "
              f"{row['copy_us']:7.1f} {row['cc3d_filter_us']:9.0f} {speckle:9.0f} {row['times_cc3d_filter']:8.1f} "
              f"{row['times_cc3d_alone']:7.1f} {ratio:7.1f} {row['copies_of_the_frame']:6.1f} "
              f"{row['ours_ns_per_pixel']:6.3f}", flush=True)
    if options.record:
        options.record.parent.mkdir(parents=True, exist_ok=True)
        with options.record.open("w", newline="") as file:
            file.write(f"# {processor()}, {options.threads} thread(s), {options.rounds} rounds, "
                       f"{datetime.date.today()}, cc3d {importlib.metadata.version('connected-components-3d')}, "
                       f"cv2 {cv2.__version__}, numpy {np.__version__}\n")
            writer = csv.DictWriter(file, FIELDS)
            writer.writeheader()
            writer.writerows({key: f"{value:.4g}" if isinstance(value, float) else value for key, value in row.items()}
                             for row in rows)


if __name__ == "__main__":
    main()
