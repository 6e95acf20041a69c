"""Compiled twins: a hot kernel beside the plain reference that it must agree with.

A step's kernel is written twice: a plain reference in NumPy or Python, and loops that numba (the
``speed`` extra) can compile. Tests compare the two. A short run never pays for importing the
compiler: the reference serves until `SWITCH_AFTER` calls have been made or `warm_up` was called.
The environment variable ``TACTILE_GRAPH_KERNELS`` (``auto``, ``plain``, ``compiled``) decides
otherwise.
"""

from __future__ import annotations

import os
from collections.abc import Callable
from functools import cache
from importlib.util import find_spec
from typing import Any, Generic, ParamSpec, TypeVar

from tactile_graph.errors import UsageError, did_you_mean

ENVIRONMENT = "TACTILE_GRAPH_KERNELS"
MODES = ("auto", "plain", "compiled")
SWITCH_AFTER = 200

P = ParamSpec("P")
R = TypeVar("R")

_kernels: list[Kernel[Any, Any]] = []
_warm = False


@cache
def have_compiler() -> bool:
    """Return whether numba is installed; does not import it."""
    return find_spec("numba") is not None


def mode() -> str:
    """Return the mode the environment asks for.

    Raises
    ------
    UsageError
        If the variable holds anything but one of `MODES`.
    """
    got = os.environ.get(ENVIRONMENT, "auto")
    if got not in MODES:
        raise UsageError(
            f"{ENVIRONMENT}={got!r}: must be one of {', '.join(MODES)}{did_you_mean(got, MODES)}"
        )
    return got


class Kernel(Generic[P, R]):
    """A function that runs as its reference or as its compiled twin; calls look the same.

    Parameters
    ----------
    reference : callable
        Plain and readable; what the twin is tested against.
    loops : callable
        The same in loops numba can compile; positional arguments only.

    Attributes
    ----------
    call : callable
        Whichever of the two serves now. A step in a hurry calls ``kernel.call(…)``, which spares
        the way through the object; fetch it anew for each call.
    """

    def __init__(self, reference: Callable[P, R], loops: Callable[..., R]) -> None:
        self.reference = reference
        self.loops = loops
        self.__name__ = reference.__name__
        self.__doc__ = reference.__doc__
        self._jitted: Callable[..., R] | None = None
        self.reset()
        _kernels.append(self)

    def __call__(self, *args: P.args, **kwargs: P.kwargs) -> R:
        """Run whichever of the two serves now; positional arguments only."""
        if kwargs:
            raise TypeError(f"{self.__name__}() takes positional arguments only, got {[*kwargs]}")
        return self.call(*args)

    def reset(self) -> None:
        """Go back to the start: reference first, unless the mode or `warm_up` says otherwise."""
        wanted = mode()
        self._calls_left = SWITCH_AFTER
        if wanted == "plain" or not have_compiler():
            self.call: Callable[..., R] = self.reference
        elif wanted == "compiled" or _warm:
            self.call = self._first_compiled
        else:
            self.call = self._counted

    def _counted(self, *args: Any) -> R:
        self._calls_left -= 1
        if self._calls_left < 0:
            return self._first_compiled(*args)
        return self.reference(*args)  # type: ignore[call-arg]

    def _first_compiled(self, *args: Any) -> R:
        try:
            self.call = self.compiled
        except ImportError:  # installed but broken
            if mode() == "compiled":
                raise
            self.call = self.reference
            return self.reference(*args)  # type: ignore[call-arg]
        return self.call(*args)

    @property
    def _numba_type_(self) -> Any:
        """What lets compiled loops call this kernel as they call a function of their own."""
        from numba.core.types import Dispatcher

        return Dispatcher(self.compiled)

    @property
    def compiled(self) -> Callable[..., R]:
        """The compiled twin; imports the compiler at first use, caches machine code on disk."""
        if self._jitted is None:
            from numba import njit

            self._jitted = njit(cache=True, error_model="numpy")(self.loops)
        return self._jitted


def compiled_twin_of(reference: Callable[P, R]) -> Callable[[Callable[..., R]], Kernel[P, R]]:
    """Decorate loops as the compiled twin of ``reference``; the name then means the pair."""

    def pair(loops: Callable[..., R]) -> Kernel[P, R]:
        return Kernel(reference, loops)

    return pair


def compiled_as_is(loops: Callable[P, R]) -> Kernel[P, R]:
    """Decorate loops that are their own reference: plain Python, compiled from the same text."""
    return Kernel(loops, loops)


def warm_up() -> None:
    """Use compiled twins from the next call on: for live sources and long runs."""
    global _warm
    if not _warm:
        _warm = True
        for kernel in _kernels:
            kernel.reset()
