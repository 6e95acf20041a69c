"""Plain code answers while another process makes the machine code that is not on disk yet.

A kernel's loops are Python, and give the same answers uncompiled, to the last bit: who waits for
a first frame need not wait for the compiler. Both processes look at the same files; whichever
kernel is found there answers by machine code from then on.
"""

from __future__ import annotations

import os
import pickle
import sys
import time
from base64 import b64encode
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from typing import TYPE_CHECKING, Any, NamedTuple

from tactile_graph.compiled import kernel as kernels
from tactile_graph.compiled.kernel import Kernel, n_elements
from tactile_graph.compiled.preparing import preparing

if TYPE_CHECKING:
    import subprocess

SERVICE = "tactile_graph.compiled.service"
"""The program of the other process."""

MOST_ELEMENTS = 100_000
"""Of all arrays of a call: with more, plain loops may take longer than the compiler."""

PATIENCE_S = 15.0
"""Time that plain code may take in all; a run that goes on is sooner done by waiting."""

LOOK_S = 0.2
"""Between two looks for machine code on disk."""


class Call(NamedTuple):
    """A kernel, and the types of the arguments it is called with."""

    kernel: Kernel[Any, Any]
    types: tuple[Any, ...]

    def on_disk(self) -> bool:
        """Return whether its machine code is there."""
        from tactile_graph.compiled.machine_code import on_disk

        return on_disk(self.kernel.compiled, self.types)

    def line(self) -> bytes:
        """Return what asks another process for it, as a line."""
        loops = self.kernel.loops
        asked = (loops.__module__, loops.__qualname__, self.types)
        return b64encode(pickle.dumps(asked)) + b"\n"


class Meanwhile:
    """Who answers a kernel's calls, and the process that compiles meanwhile.

    Attributes
    ----------
    under_way : subprocess.Popen or None
        The process, once there is something for it to do.
    patience_s : float
        Time that plain code may take in all; none where it is negative.
    spent_s : float
        Time that it has taken so far.
    """

    def __init__(self, patience_s: float = PATIENCE_S) -> None:
        self.patience_s = patience_s
        self.under_way: subprocess.Popen[bytes] | None = None
        self._looked_s: dict[Call, float] = {}
        self.spent_s = 0.0
        self._since_s = 0.0

    def answer(self, kernel: Kernel[Any, Any], args: tuple[Any, ...]) -> Any:
        """Answer a call of a kernel whose machine code is not loaded."""
        if n_elements(args) > MOST_ELEMENTS or self._compiled(kernel, args):
            kernel.call = kernel.compiled
            return kernel.call(*args)
        began = time.monotonic()
        answer = kernel.plain(*args)
        self.spent_s += time.monotonic() - began
        preparing.meanwhile(kernel.__name__, time.monotonic() - self._since_s)
        return answer

    def _compiled(self, kernel: Kernel[Any, Any], args: tuple[Any, ...]) -> bool:
        """Return whether machine code is to answer now; ask for it if it is not there."""
        from numba.core.typing.typeof import Purpose, typeof

        call = Call(kernel, tuple(typeof(arg, Purpose.argument) for arg in args))
        now_s, looked_s = time.monotonic(), self._looked_s.get(call)
        if looked_s is not None and now_s - looked_s < LOOK_S:
            return False
        self._looked_s[call] = now_s
        if call.on_disk() or self.spent_s > self.patience_s:
            return True
        return not self._asked(call) if looked_s is None else not self._works()

    def _works(self) -> bool:
        return self.under_way is not None and self.under_way.poll() is None

    def _asked(self, call: Call) -> bool:
        """Ask the other process for machine code; return whether it will try."""
        if self.under_way is None:
            self._since_s = time.monotonic()
            self.under_way = _process()
            preparing.on_first = None  # no third process
        pipe = self.under_way.stdin
        try:
            if pipe is not None:
                pipe.write(call.line())
                pipe.flush()
        except (OSError, pickle.PicklingError, AttributeError):
            return False
        return self._works()

    def leave(self, *, finish: bool) -> bool:
        """Let the process finish what it was asked, or stop it; return whether it still works."""
        process = self.under_way
        if process is None:
            return False
        if process.stdin is not None:
            with suppress(OSError):  # it has ended, with something unread
                process.stdin.close()
        if process.poll() is not None:
            return False
        if not finish:
            process.terminate()
            process.wait()
            return False
        process.returncode = 0  # it may outlive us: nobody waits for it
        return True


@contextmanager
def answered_meanwhile(
    tell: Callable[[int], None] | None = None, patience_s: float = PATIENCE_S
) -> Iterator[Meanwhile | None]:
    """Answer by plain code for as long as another process compiles what is not on disk yet.

    The process outlives a run that ends well, so that the next one finds the machine code; it is
    stopped by an error or an interrupt. On one processor, or with `TACTILE_GRAPH_KERNELS` set,
    none is started.

    Parameters
    ----------
    tell : callable, optional
        Called at the end with the number of the process, if it still works.
    patience_s : float
        Time that plain code may take in all before it is waited for the compiler.

    Yields
    ------
    Meanwhile or None
        Whose patience may be changed; None where there is none.
    """
    if (os.cpu_count() or 1) < 2 or kernels.mode() != "auto":
        yield None
        return
    meanwhile = Meanwhile(patience_s)
    kernels.answering.append(meanwhile.answer)
    finish = False
    try:
        yield meanwhile
        finish = True
    finally:
        kernels.answering.remove(meanwhile.answer)
        works = meanwhile.leave(finish=finish)
        preparing.all_told()
        if works and tell is not None and meanwhile.under_way is not None:
            tell(meanwhile.under_way.pid)


def _process() -> subprocess.Popen[bytes]:
    import subprocess

    nowhere = subprocess.DEVNULL
    return subprocess.Popen(
        [sys.executable, "-P", "-m", SERVICE], stdin=subprocess.PIPE, stdout=nowhere, stderr=nowhere
    )
