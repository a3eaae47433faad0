"""The program `depthplanes`, as `python -m depthplanes` and as a command of its own."""

from __future__ import annotations

import signal
import sys
from typing import NoReturn

from . import _native


def main() -> NoReturn:
    """Runs the program with the words of the command line, and ends Python with its exit code."""
    # The program hears interruptions by itself; Python would wait for it to end.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    sys.exit(_native.main(["depthplanes", *sys.argv[1:]]))


if __name__ == "__main__":
    main()
