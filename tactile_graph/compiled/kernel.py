"""A kernel: hot loops behind one name, answered by plain code or by machine code.

Most kernels are compiled before their first answer. Kernels of short pipelines, which plain code
answers sooner than the compiler can even be imported, are plain at first and compiled once
there is enough to do. Plain loops answer as machine code does: without a warning of an overflow or
of an infinity's difference, and with Python's own numbers. What counts is the calls and the
elements handed over, never the clock, so that a replay is answered by the same code. The
environment variable ``TACTILE_GRAPH_KERNELS``
(``auto``, ``plain``, ``compiled``) decides otherwise.
"""

from __future__ import annotations

import os
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any, Generic, ParamSpec, TypeAlias, TypeVar, cast

from tactile_graph.errors import UsageError, did_you_mean

ENVIRONMENT = "TACTILE_GRAPH_KERNELS"
MODES = ("auto", "plain", "compiled")
SWITCH_AFTER_CALLS = 200
SWITCH_AFTER_ELEMENTS = 400_000
"""Of all arrays handed over. One pass of plain loops takes 0.1 to 0.6 us for each, a quarter second
at most; loops that take much longer have a reference beside them, see `compiled_twin_of`."""

P = ParamSpec("P")
R = TypeVar("R")
Answer: TypeAlias = "Callable[[Kernel[Any, Any], tuple[Any, ...]], Any]"
Note: TypeAlias = "Callable[[Kernel[Any, Any], tuple[Any, ...]], None]"


class _Running(threading.local):
    """Whether this thread is within a kernel's plain loops, and if in place of machine code."""

    plain_loops = False
    as_machine_code = False


_running = _Running()
_kernels: list[Kernel[Any, Any]] = []
_warm = False
_notes: list[Note] = []
answering: list[Answer] = []
"""Who answers kernels whose machine code may not be on disk yet; see `meanwhile`."""


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
    """A function answered by plain code or by machine code; calls look the same.

    Parameters
    ----------
    loops : callable
        Loops that numba can compile; positional arguments only.
    reference : callable
        Plain code with the same answers: the loops themselves, or what is faster uncompiled.
    plain_first : bool
        Whether the reference answers until there is enough to do for the compiler.

    Attributes
    ----------
    call : callable
        Whichever code answers now. A step in a hurry calls ``kernel.call(…)``, which spares
        the way through the object; fetch it anew for each call.
    direct : callable
        The same for arguments that are known to be of the very types of every other direct call,
        in number type, dimensions and order in memory: machine code then takes them without a
        search for its code, which saves 0.1 us an array. An array of other dimensions, numbers or
        order is refused with a TypeError (under a version of numba that kernels were not tried with
        it may end the process): a step that has an array from elsewhere asks for its ``dtype``,
        ``ndim`` and ``flags.c_contiguous`` first, for the class of a number, and uses `call` if
        they are others.
    passes : int
        As how many passes over the elements handed over a call of the plain loops counts.
    """

    def __init__(
        self, loops: Callable[..., R], reference: Callable[P, R], plain_first: bool
    ) -> None:
        self.loops = loops
        self.reference = reference
        self.plain_first = plain_first
        self.passes = 1
        self.__name__ = reference.__name__
        self.__doc__ = reference.__doc__
        self._entry: Callable[..., R] | None = None
        self._callee: Any = None
        self.reset()
        _kernels.append(self)

    def __call__(self, *args: P.args, **kwargs: P.kwargs) -> R:
        """Run whichever code answers now; positional arguments only."""
        if kwargs:
            raise TypeError(f"{self.__name__}() takes positional arguments only, got {[*kwargs]}")
        return self.call(*args)

    def reset(self) -> None:
        """Go back to the start, as the mode and `warm_up` say."""
        wanted = mode()
        self._calls_left = SWITCH_AFTER_CALLS
        self._elements_left = SWITCH_AFTER_ELEMENTS
        self.direct: Callable[..., R] = self._first_direct
        if _notes:
            self.call: Callable[..., R] = self._noted
        elif wanted == "plain":
            self.call = self.plain
        elif wanted == "compiled" or _warm or not self.plain_first:
            self.call = self._first_compiled
        else:
            self.call = self._counted

    def _counted(self, *args: Any) -> R:
        if _running.as_machine_code:
            return self.loops(*args)
        return self._first_compiled(*args) if self._enough_to_do(args) else self.plain(*args)

    def _enough_to_do(self, args: tuple[Any, ...]) -> bool:
        """Count a call; return whether it is time for machine code."""
        self._calls_left -= 1
        self._elements_left -= self.passes * n_elements(args)
        return self._calls_left < 0 or self._elements_left < 0

    def _noted(self, *args: Any) -> R:
        """Answer by plain code, and note the call if machine code would have answered it."""
        asked = not _running.plain_loops
        if asked and (_warm or not self.plain_first or self._enough_to_do(args)):
            _notes[-1](self, args)
        return self.plain(*args)

    def plain(self, *args: Any) -> R:
        """Answer by plain code: the reference, or the loops as machine code would run them."""
        if _running.as_machine_code:
            return self.loops(*args)
        if self.reference is not self.loops:
            return self.reference(*args)  # type: ignore[call-arg]
        if _running.plain_loops:  # within others': a number's kind decides what dividing by 0 does
            return self.loops(*args)
        import numpy as np  # only now: a command's help must not pay for it

        before = [(array, array.copy()) for array in _writeable(args)]
        _running.plain_loops, _running.as_machine_code = True, not self.plain_first
        try:
            with np.errstate(all="ignore"):
                return cast(R, _unboxed(self.loops(*args)))
        except (ArithmeticError, ValueError):
            if mode() == "plain":
                raise
        finally:
            _running.plain_loops = _running.as_machine_code = False
        # Python refuses what is no number, as exp(1000) and log(0): machine code gives infinity.
        for array, values in before:
            array[...] = values
        return self.compiled(*args)

    def _first_compiled(self, *args: Any) -> R:
        if answering and not self.plain_first:
            if _running.plain_loops:
                return self.plain(*args)
            return cast(R, answering[-1](self, args))
        self.call = self.compiled
        return self.call(*args)

    def _first_direct(self, *args: Any) -> R:
        answer = self.call(*args)
        if self._entry is not None and self.call is self._entry:
            from tactile_graph.compiled.machine_code import entry_point

            self.direct = entry_point(self._entry, args)
        return answer

    @property
    def compiled(self) -> Callable[..., R]:
        """The machine code, made at its first call or loaded from disk; imports numba."""
        if self._entry is None:
            from tactile_graph.compiled.machine_code import entry

            self._entry = entry(self.loops)
        return self._entry

    @property
    def _numba_type_(self) -> Any:
        """What lets compiled loops call this kernel as they call a function of their own."""
        if self._callee is None:
            from tactile_graph.compiled.machine_code import Callee

            self._callee = Callee(self.loops)
        return self._callee.numba_type()


def n_elements(value: object) -> int:
    """Return how many numbers an argument holds: of an array, of records of them, or one."""
    if isinstance(value, tuple):
        return sum(map(n_elements, value))
    return int(getattr(value, "size", 1))


def _writeable(value: object) -> Iterator[Any]:
    """Yield the arrays of an argument that loops may write to."""
    if isinstance(value, tuple):
        for item in value:
            yield from _writeable(item)
    elif getattr(getattr(value, "flags", None), "writeable", False):
        yield value


def _unboxed(answer: Any) -> Any:
    """Return an answer of plain loops with Python's own numbers, as machine code gives them."""
    import numpy as np

    if isinstance(answer, np.generic):
        return answer.item()
    if isinstance(answer, tuple):
        items = map(_unboxed, answer)
        return tuple(items) if type(answer) is tuple else type(answer)(*items)
    return answer


def compiled_as_is(loops: Callable[P, R]) -> Kernel[P, R]:
    """Decorate loops that are compiled before their first answer."""
    return Kernel(loops, loops, plain_first=False)


def compiled_later(loops: Callable[P, R]) -> Kernel[P, R]:
    """Decorate loops that run as they are until there is enough to do for the compiler.

    Calls between plain loops count too: loops that call small kernels for every cell or corner
    would load the compiler within a frame or two, and ask for `compiled_twin_of`.
    """
    return Kernel(loops, loops, plain_first=True)


def compiled_twin_of(reference: Callable[P, R]) -> Callable[[Callable[..., R]], Kernel[P, R]]:
    """Decorate loops that take over from ``reference`` once there is enough to do.

    The name then means the pair. A reference is worth its lines where a short run of a shipped
    pipeline (its own frames, or some hundred of its pad's size) takes over 50 ms longer without,
    by measurement: where the loops take milliseconds a frame, or load the compiler by the calls
    between them. References that only tests need stand there.
    """

    def pair(loops: Callable[..., R]) -> Kernel[P, R]:
        return Kernel(loops, reference, plain_first=True)

    return pair


@contextmanager
def plain_and_noted(note: Note) -> Iterator[None]:
    """Let plain code answer everything, and tell what machine code would have answered.

    Parameters
    ----------
    note : callable
        Takes the kernel and the call's arguments.
    """
    _notes.append(note)
    try:
        _reset_all()
        yield
    finally:
        _notes.pop()
        _reset_all()


def is_warm() -> bool:
    """Return whether `warm_up` was called."""
    return _warm


def warm_up() -> None:
    """Use machine code from the next call on: for live sources and long runs."""
    global _warm
    if not _warm:
        _warm = True
        _reset_all()


def _reset_all() -> None:
    for kernel in _kernels:
        kernel.reset()
