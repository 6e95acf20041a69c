"""A step with a kernel, which tells how its process is made ready for calls."""

from __future__ import annotations

import sys

from tactile_graph import Image
from tactile_graph.compiled import compiled_as_is, kernel


@compiled_as_is
def doubled(number: int) -> int:
    """Return twice a number."""
    return 2 * number


def readiness(image: Image) -> tuple[bool, int]:
    """Return whether the compiler is imported, and how many answer in its place."""
    return "numba" in sys.modules, len(kernel.answering)
