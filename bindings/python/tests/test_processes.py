"""Processes that fork, and those that end while threads are at work."""

import multiprocessing
import subprocess
import sys
import warnings

import pytest

import depthplanes

#: What daemon threads do for ever, given a detector, a map and a folder.
WORK = ["detector(depth)", "depthplanes.read(folder + '/map.npy', unit='mm')", "detector(depth).write(labels=folder + '/labels.png')"]

ENDING = """
import sys, threading, time, warnings
import numpy as np
import depthplanes

warnings.simplefilter("ignore")
folder, depth, detector = sys.argv[1], np.full((480, 640), 2000, np.uint16), depthplanes.Detector()
np.save(folder + "/map.npy", depth)

def work():
    while True:
        {work}

for _ in range(3):
    threading.Thread(target=work, daemon=True).start()
time.sleep(0.3)
print("ends")
"""


@pytest.mark.parametrize("work", WORK)
def test_python_ends_while_daemon_threads_are_in_a_call(work, tmp_path):
    for _ in range(3):
        ran = subprocess.run([sys.executable, "-c", ENDING.format(work=work), tmp_path], capture_output=True, text=True, timeout=60)
        assert (ran.returncode, ran.stdout, ran.stderr) == (0, "ends\n", "")


def found_in(detector, depth, answers):
    answers.put(detector(depth).labels.tobytes())


@pytest.mark.skipif("fork" not in multiprocessing.get_all_start_methods(), reason="there is no fork")
@pytest.mark.filterwarnings("ignore:.*fork:DeprecationWarning")
def test_a_forked_process_finds_the_same_planes():
    depth = depthplanes.scene("room:sensor=kinect").depth
    detector = depthplanes.Detector(threads=2)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", depthplanes.ReadingWarning)
        expected = detector(depth).labels.tobytes()
    context = multiprocessing.get_context("fork")
    for tried in (detector, depthplanes.Detector(threads=2)):
        answers = context.Queue()
        child = context.Process(target=found_in, args=(tried, depth, answers), daemon=True)
        child.start()
        assert answers.get(timeout=30) == expected
        child.join(timeout=30)
        assert child.exitcode == 0
    assert detector(depth).labels.tobytes() == expected, "the parent goes on"
