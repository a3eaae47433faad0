"""The worker survives what it is sent: it refuses, or ends with code 1 and a message."""

import struct
import subprocess

import numpy as np
import pytest

from worker import Refused, request

MAP = np.arange(6, dtype=np.uint16).reshape(2, 3)


def run(program, data):
    return subprocess.run([program], input=data, capture_output=True, timeout=60)


def test_bad_parameters_are_refused_and_the_next_map_is_read(worker):
    for theta in (-1, float("nan"), float("-inf")):
        with pytest.raises(Refused, match="theta"):
            worker.labels(MAP, theta, 0, 1)
    assert worker.labels(MAP, 5, 0, 2).tolist() == [[[[0, 1, 1], [1, 1, 1]]] * 2] * len(worker.kernels)


@pytest.mark.parametrize("header, message", [
    ((3, 2, 2, 1, 0), "pixel type 3"),
    ((1, 0, 2, 1, 0), "a map of 0 x 2"),
    ((1, 2, 65536, 1, 0), "a map of 2 x 65536"),
    ((1, 65535, 65535, 1, 0), "a map of 65535 x 65535"),
    ((1, 2, 2, 0, 0), "0 threads"),
    ((1, 2, 2, 2**32 - 1, 0), "4294967295 threads"),
])
def test_headers_that_hide_how_much_follows_end_it(worker_program, header, message):
    ran = run(worker_program, struct.pack("<5Id", *header, 1.0) + bytes(4))
    assert ran.returncode == 1
    assert message in ran.stderr.decode()


def test_requests_that_break_off_end_it(worker_program):
    whole = request(MAP, 1, 0, 1)
    for end in range(1, len(whole)):
        ran = run(worker_program, whole[:end]) if end % 5 == 0 or end > 35 else None
        assert ran is None or (ran.returncode == 1 and b"the input ends after" in ran.stderr)
    assert run(worker_program, b"").returncode == 0
    # A giant is promised, nothing comes: no memory is taken for it.
    giant = run(worker_program, struct.pack("<5Id", 4, 32768, 32768, 1, 0, 1.0))
    assert giant.returncode == 1
