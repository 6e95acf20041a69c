"""Kernels answered by plain code or by machine code, as a test asks for."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any, Literal
from unittest.mock import patch

from numpy.typing import NDArray

from tactile_graph.compiled import kernel


@contextmanager
def answered_by(mode: Literal["auto", "plain", "compiled"]) -> Iterator[None]:
    """Let every kernel start anew in a mode, and once more as before afterwards."""
    if mode == "plain" == kernel.mode() and not kernel._notes:
        yield  # they are so already, and plain kernels have nothing to forget
        return
    with patch.dict("os.environ", {kernel.ENVIRONMENT: mode}):
        _restart()
        yield
    _restart()


def plainly(one: kernel.Kernel[..., Any]) -> Callable[..., Any]:
    """Return a kernel's loops, with all kernels below them plain as well.

    Those below would be compiled otherwise, each with all below it: seconds.
    """

    def run(*args: Any) -> Any:
        with answered_by("plain"):
            return one.loops(*args)

    return run


def compiled(one: kernel.Kernel[..., Any]) -> Callable[..., Any]:
    """Return a kernel's machine code: the counterpart of `plainly`."""
    return one.compiled


def held(values: NDArray[Any]) -> NDArray[Any]:
    """Return an array as frames, masks and points hold it, so that one machine code serves both."""
    values.setflags(write=False)
    return values


def cool_down() -> None:
    """Let kernels that `warm_up` told to be compiled, and that nobody called, be plain again."""
    if kernel._warm:
        kernel._warm = False
        for each in kernel._kernels:
            if each._entry is None:
                each.reset()


def _restart() -> None:
    for each in kernel._kernels:
        each.reset()
