"""The process that runs steps for another process; no command for people."""

from __future__ import annotations

import importlib
import os
import pickle
import struct
import sys
import threading
import time
from collections.abc import Callable
from contextlib import ExitStack
from typing import IO, Any

from tactile_graph.changes import changes

MADE, VALUE, ERROR, ENDED = "made", "value", "error", "ended"
Message = tuple[str, Any]
"""What it is, and that; of an error that a call raised also where."""
KERNELS = "tactile_graph.compiled.kernel"
_LENGTH = struct.Struct("<Q")
LOOK_S = 1.0


def sent(file: IO[bytes], message: Any) -> None:
    """Write a message."""
    written(file, pickle.dumps(message))


def written(file: IO[bytes], data: bytes) -> None:
    """Write a message that is pickled already."""
    file.write(_LENGTH.pack(len(data)) + data)
    file.flush()


def received(file: IO[bytes]) -> Any:
    """Return the next message.

    Raises
    ------
    EOFError
        If there is none.
    """
    head = file.read(_LENGTH.size)
    if len(head) < _LENGTH.size:
        raise EOFError
    (length,) = _LENGTH.unpack(head)
    data = file.read(length)
    if len(data) < length:
        raise EOFError
    return pickle.loads(data)


def end_with_parent() -> None:
    """End this process when the one that began it is gone, even within a step that hangs."""
    parent = os.getppid()

    def watch() -> None:
        while os.getppid() == parent:
            time.sleep(LOOK_S)
        os._exit(1)

    threading.Thread(target=watch, name="end with parent", daemon=True).start()


def serve(orders: IO[bytes], answers: IO[bytes], made: Callable[[], None]) -> None:
    """Make steps, and run them on whatever comes, until nothing more comes.

    An order is a number and the pickled step, or the number of one made before and what goes into
    it. A step that cannot be made is told, and takes nothing from the others.

    Parameters
    ----------
    orders, answers : file
    made : callable
        Called when a step is made, before that is told.
    """
    sys.path[:] = received(orders)
    steps: dict[int, Callable[..., Any]] = {}
    while True:
        try:
            order = received(orders)
        except EOFError:
            return
        number, *given = order
        if len(given) == 1:
            try:
                steps[number] = _made(*given)
                made()
            except Exception as error:
                sent(answers, (ERROR, f"{type(error).__name__}: {error}"))
            else:
                sent(answers, (MADE, None))
            continue
        args, kwargs = given
        before = changes.n
        try:
            answer: Message = VALUE, steps[number](*args, **kwargs)
        except SystemExit:  # it ends its process
            raise
        except BaseException as error:  # KeyboardInterrupt too: no Ctrl-C comes here
            answer = ERROR, _told(error)
        if changes.forked_at >= before:  # the copy that the step forked answers nobody
            os._exit(0)
        _answer(answers, answer)


def _made(order: bytes) -> Callable[..., Any]:
    from tactile_graph.steps.own import bound  # a step needs numpy; this process can do without

    target, settings, is_class = pickle.loads(order)
    made: Callable[..., Any] = target(**settings) if is_class else bound(target, settings)
    return made


class _Kernels:
    """Sees that calls, which have a limit, wait for no compiler, nor for its import."""

    def __init__(self) -> None:
        self._answering = ExitStack()
        self._ready = False

    def make_ready(self) -> None:
        """Have plain code answer while kernels are compiled, if a step has brought any."""
        if self._ready or KERNELS not in sys.modules:
            return
        from tactile_graph.compiled import answered_meanwhile

        importlib.import_module("tactile_graph.compiled.machine_code")
        self._answering.enter_context(answered_meanwhile())
        self._ready = True

    def __enter__(self) -> _Kernels:
        return self

    def __exit__(self, *_: object) -> None:
        self._answering.close()


def _told(error: BaseException) -> tuple[Exception, str]:
    """Return an error as it can be sent, and the line it was raised at."""
    from tactile_graph.engine.outcomes.outcome import raised_at, travelling

    return travelling(error), raised_at(error)


def _answer(answers: IO[bytes], answer: Message) -> None:
    try:
        sent(answers, answer)
    except Exception as error:  # whatever pickle says of it
        text = f"gave what pickle cannot send from its own process: {error}"
        sent(answers, (ERROR, (RuntimeError(text), "")))


def own_channels() -> tuple[IO[bytes], IO[bytes]]:
    """Return where orders come from and answers go to, which were stdin and stdout until now.

    What a step reads from there is at its end; what it prints is for people.
    """
    orders, answers = os.fdopen(os.dup(0), "rb"), os.fdopen(os.dup(1), "wb")
    nothing = os.open(os.devnull, os.O_RDONLY)
    os.dup2(nothing, 0)
    os.close(nothing)
    os.dup2(2, 1)
    return orders, answers


if __name__ == "__main__":
    channels = own_channels()
    end_with_parent()
    with _Kernels() as kernels:
        serve(*channels, kernels.make_ready)
