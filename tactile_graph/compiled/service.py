"""The process that compiles kernels for another one, which answers by plain code meanwhile.

No command for people. It takes a line for each kernel from its standard input, and ends when all
that was asked for before the input's end is on disk.
"""

from __future__ import annotations

import importlib
import os
import pickle
import sys
from base64 import b64decode
from collections.abc import Iterable
from functools import reduce
from typing import Any

NICE = 5
"""Whoever works on this machine comes first."""


def serve(lines: Iterable[bytes]) -> None:
    """Compile the kernels that the lines name, unless another process does."""
    from tactile_graph.compiled.machine_code import make_ahead

    for line in lines:
        try:
            module, name, types = pickle.loads(b64decode(line))
            kernel: Any = reduce(getattr, name.split("."), importlib.import_module(module))
        except (ImportError, AttributeError):
            continue  # who asked will compile it
        make_ahead(kernel.loops, types)


if __name__ == "__main__":
    if hasattr(os, "nice"):
        os.nice(NICE)
    serve(sys.stdin.buffer)
