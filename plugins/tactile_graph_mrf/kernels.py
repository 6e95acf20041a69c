"""Kernels fit for the work at hand: compiled at once where there is much to do."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from tactile_graph.compiled import Kernel, mode

WORTH_COMPILING = 2000
"""Visits of a cell or line from which on the compiler's start costs less than plain loops."""


def fit_for(kernel: Kernel[Any, Any], visits: int) -> Callable[..., Any]:
    """Return the kernel, its compiled twin at once if there is much to do and no other wish."""
    if mode() == "auto" and visits >= WORTH_COMPILING:
        try:
            return kernel.compiled
        except ImportError:  # installed but broken
            return kernel.call
    return kernel.call
