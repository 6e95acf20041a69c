"""Loops of several kernels as one entry, whose text is written when it is known who follows whom.

The text names kernels, which the entry takes in like any other. It is kept on disk as kernels are,
under a digest of all it is made of.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Mapping
from hashlib import sha256
from typing import Any, cast

from tactile_graph.compiled.kernel import mode


class Chained:
    """A function that is written out, and its machine code for one list of arguments.

    Parameters
    ----------
    lines : sequence of str
        The function's body.
    arguments : mapping
        Names of the arguments -> a value of the type of each.
    names : mapping
        What else the body names: kernels, named tuples, numbers. ``now_ns()`` is there besides, the
        clock of `time.perf_counter_ns`.
    """

    def __init__(
        self, lines: list[str], arguments: Mapping[str, Any], names: Mapping[str, Any]
    ) -> None:
        self._lines, self._arguments, self._names = lines, arguments, names
        self._entry: Any = None

    @staticmethod
    def possible() -> bool:
        """Return whether such entries can be made here, and read Python's clock."""
        if sys.platform != "linux" or mode() == "plain":
            return False
        from tactile_graph.compiled.machine_code import whole

        return whole()

    def machine_code(self, *, make: bool) -> Callable[..., Any] | None:
        """Return the machine code; None if it is not on disk, unless it is to be made.

        Its arguments must be of the very types of those it was made for, as with `Kernel.direct`.
        """
        types = self._types()
        if not make and not self.entry.on_disk(types):
            return None
        self.entry.compile(types)
        return cast("Callable[..., Any]", self.entry.overloads[types].entry_point)

    @property
    def entry(self) -> Any:
        """What makes the machine code."""
        if self._entry is None:
            from tactile_graph.compiled.clock import now_ns
            from tactile_graph.compiled.machine_code import entry

            self._entry = entry(self.loops(now_ns))
        return self._entry

    def _types(self) -> tuple[Any, ...]:
        from numba.core.typing.typeof import Purpose, typeof

        return tuple(typeof(value, Purpose.argument) for value in self._arguments.values())

    def loops(self, clock: Callable[[], int]) -> Callable[..., Any]:
        """Return the function, named after its text and the kernels in it."""
        of = [f"{name} {getattr(v, '__name__', v)}" for name, v in self._names.items()]
        digest = sha256("\n".join([*self._lines, *self._arguments, *of]).encode()).hexdigest()
        name = f"chain_{digest[:16]}"
        body = "\n".join(f"    {line}" for line in self._lines)
        text = f"def {name}({', '.join(self._arguments)}):\n{body}\n"
        names = {**self._names, "now_ns": clock, "__name__": __name__}
        exec(compile(text, __file__, "exec"), names)  # a file, beside which the cache finds a place
        return cast("Callable[..., Any]", names[name])
