"""A small kernel to compile, in a file of its own so that machine code can be kept on disk."""

from __future__ import annotations

from tactile_graph.compiled import compiled_twin_of


def repeated(x: float, n: int) -> float:
    """Return x times n."""
    return x * n


@compiled_twin_of(repeated)
def total(x: float, n: int) -> float:
    result = 0.0
    for _ in range(n):
        result += x
    return result
