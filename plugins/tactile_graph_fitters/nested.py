"""Kernels that compiled loops may call as they call a function of their own."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, ParamSpec, TypeVar

from tactile_graph.compiled import Kernel

P = ParamSpec("P")
R = TypeVar("R")


class NestedKernel(Kernel[P, R]):
    """A kernel that looks like its compiled twin to a caller that is itself compiled."""

    __slots__ = ()

    @property
    def _numba_type_(self) -> Any:
        from numba.core.types import Dispatcher

        return Dispatcher(self.compiled)


def nested_twin_of(reference: Callable[P, R]) -> Callable[[Callable[..., R]], NestedKernel[P, R]]:
    """Decorate loops as the compiled twin of ``reference``, callable from other loops."""

    def pair(loops: Callable[..., R]) -> NestedKernel[P, R]:
        return NestedKernel(reference, loops)

    return pair


def compiled_as_is(loops: Callable[P, R]) -> NestedKernel[P, R]:
    """Decorate loops that are their own reference: plain Python, compiled from the same text."""
    return NestedKernel(loops, loops)
