"""The other side of crates/depthplanes/examples/oracle_worker.rs, whose header states the protocol."""

import struct
import subprocess

import numpy as np

KINDS = {"u8": np.dtype("u1"), "u16": np.dtype("<u2"), "f32": np.dtype("<f4")}


class Refused(Exception):
    """The worker refused the request and said why."""


class Worker:
    """One process that groups map after map on every kernel of this processor."""

    def __init__(self, program):
        self.process = subprocess.Popen([program], stdin=subprocess.PIPE, stdout=subprocess.PIPE)
        self.kernels = self.process.stdout.readline().decode().split()

    def labels(self, depth, theta, least, threads):
        """Label images, [kernel, threads - 1, row, column]."""
        self.process.stdin.write(request(depth, theta, least, threads))
        self.process.stdin.flush()
        (images,) = self._numbers("<I")
        if images == 0:
            (length,) = self._numbers("<I")
            raise Refused(self._bytes(length).decode())
        height, width = depth.shape
        data = np.frombuffer(self._bytes(images * depth.size * 2), "<u2")
        return data.reshape(len(self.kernels), threads, height, width)

    def close(self):
        """Ends the process; it must end well."""
        self.process.stdin.close()
        assert self.process.stdout.read() == b"", "an answer that nobody asked for"
        assert self.process.wait(timeout=60) == 0

    def _numbers(self, layout):
        return struct.unpack(layout, self._bytes(struct.calcsize(layout)))

    def _bytes(self, count):
        data = self.process.stdout.read(count)
        assert len(data) == count, f"the worker ended after {len(data)} of {count} bytes"
        return data


def request(depth, theta, least, threads):
    """The bytes of one request."""
    height, width = depth.shape
    kind = {np.dtype("u1"): 1, np.dtype("u2"): 2, np.dtype("f4"): 4}[depth.dtype]
    header = struct.pack("<5Id", kind, width, height, threads, least, theta)
    return header + np.ascontiguousarray(depth).astype(depth.dtype.newbyteorder("<"), copy=False).tobytes()
