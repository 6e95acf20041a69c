"""How loops become machine code: whole below what Python calls, kept on disk.

numba makes each function ready to be called from Python: optimised, with wrappers, as machine
code; a caller takes the callee's code in, and optimises and emits it again. In a tree of a hundred
kernels that is most of the time. Here a kernel within others is only typed and lowered; the one
that Python calls, the entry, takes in all below it, is optimised once and emitted once, and is
alone kept on disk, under a digest of all it is made of.

What this takes of numba is no public interface. In a version that it was not tried with, kernels
are compiled in numba's own way, with the same answers.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, cast

import numba
from numba import types
from numba.core.dispatcher import Dispatcher
from numba.core.event import Event, Listener, register
from numba.core.typing.typeof import Purpose, typeof

from tactile_graph.compiled.preparing import preparing

TRIED = ("0.68",)
"""Versions of numba whose inner working is known to fit."""


class _Counting(Listener):  # type: ignore[misc]  # numba tells no types
    """Counts what numba compiles, by whichever way and for whom."""

    def on_start(self, event: Event) -> None:
        """Wait for the end."""

    def on_end(self, event: Event) -> None:
        """Count it."""
        preparing.n_made += 1


register("numba:compile", _Counting())


def whole() -> bool:
    """Return whether kernels are compiled whole below their entries."""
    return ".".join(numba.__version__.split(".")[:2]) in TRIED


def entry(loops: Callable[..., Any]) -> Callable[..., Any]:
    """Return what runs the machine code of ``loops``; made at the first call, kept on disk."""
    if not whole():
        return _numbas_own(loops)
    from tactile_graph.compiled.whole import entry_of

    return entry_of(loops)


def _numbas_own(loops: Callable[..., Any]) -> Dispatcher:
    from tactile_graph.compiled.kept import Kept, kept

    dispatcher = numba.njit(error_model="numpy", nogil=True)(loops)
    dispatcher._cache = kept(Kept, loops)  # type: ignore[attr-defined]
    return dispatcher


def entry_point(entry: Any, args: tuple[Any, ...]) -> Callable[..., Any]:
    """Return the machine code of an entry for arguments of the types of these, no others.

    Where numba made none for these very types (it may take a whole number for a float), it is the
    entry itself.
    """
    made = entry.overloads.get(tuple(typeof(arg, Purpose.argument) for arg in args))
    return entry if made is None else cast("Callable[..., Any]", made.entry_point)


def make_ahead(loops: Callable[..., Any], arguments: tuple[types.Type, ...]) -> None:
    """Make the machine code of ``loops`` for types of arguments, unless another process does."""
    if whole():
        from tactile_graph.compiled.whole import entry_of

        entry_of(loops).compile_unless_claimed(arguments)
    else:
        _numbas_own(loops).compile(arguments)


def on_disk(entry: Any, arguments: tuple[types.Type, ...]) -> bool:
    """Return whether an entry's machine code for types of arguments is there to be loaded.

    Under a version of numba that this was not tried with nobody knows, and where no code is kept
    nobody else can make it: it is as if it were.
    """
    return not whole() or not entry.is_kept or entry.on_disk(arguments)


class Callee:
    """``loops`` as other compiled code calls them.

    An entry takes them in as a part; a plugin's own function, compiled by numba alone, finds them
    compiled in the same way.
    """

    def __init__(self, loops: Callable[..., Any]) -> None:
        self._loops = loops
        self._part: Any = None
        self._alone: Any = None

    def numba_type(self) -> types.Dispatcher:
        """Return the type that numba calls them by."""
        if whole() and _under_way():
            if self._part is None:
                self._part = _part_of(self._loops)
            return types.Dispatcher(self._part)
        if self._alone is None:
            self._alone = _numbas_own(self._loops)
        return types.Dispatcher(self._alone)


def _under_way() -> bool:
    from tactile_graph.compiled.whole import entry_under_way

    return entry_under_way()


def _part_of(loops: Callable[..., Any]) -> Any:
    from tactile_graph.compiled.whole import part_of

    return part_of(loops)
