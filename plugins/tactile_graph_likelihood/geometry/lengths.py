"""Lengths in the plane, to the last bit the same by plain code and by machine code.

`math.hypot` is not: Python's own and the C library's may differ in it.
"""

from __future__ import annotations

import math

from tactile_graph.compiled import compiled_as_is


@compiled_as_is
def length(x: float, y: float) -> float:
    """Return the length of a vector."""
    return math.sqrt(x * x + y * y)
