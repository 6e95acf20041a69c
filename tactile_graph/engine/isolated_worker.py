"""The process that runs steps for another process; no command for people."""

from __future__ import annotations

import os
import pickle
import struct
import sys
from collections.abc import Callable
from functools import partial
from typing import IO, Any

MADE, VALUE, ERROR, ENDED = "made", "value", "error", "ended"
Message = tuple[str, Any]
_LENGTH = struct.Struct("<Q")


def sent(file: IO[bytes], message: Any) -> None:
    """Write a message."""
    data = pickle.dumps(message)
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


def serve(orders: IO[bytes], answers: IO[bytes]) -> None:
    """Make steps, and run them on whatever comes, until nothing more comes.

    An order is the pickled step, or the number of one made before and what goes into it.
    """
    sys.path[:] = received(orders)
    steps: list[Callable[..., Any]] = []
    while True:
        try:
            order = received(orders)
        except EOFError:
            return
        if isinstance(order, bytes):
            try:
                steps.append(_made(order))
            except Exception as error:
                sent(answers, (ERROR, f"{type(error).__name__}: {error}"))
                return
            sent(answers, (MADE, None))
            continue
        number, args, kwargs = order
        try:
            answer: Message = VALUE, steps[number](*args, **kwargs)
        except Exception as error:
            answer = ERROR, error
        _answer(answers, answer)


def _made(order: bytes) -> Callable[..., Any]:
    target, settings, is_class = pickle.loads(order)
    made: Callable[..., Any] = target(**settings) if is_class else partial(target, **settings)
    return made


def _answer(answers: IO[bytes], answer: Message) -> None:
    try:
        sent(answers, answer)
    except (pickle.PicklingError, AttributeError, TypeError) as error:
        kind, value = answer
        told = f"{type(value).__name__}: {value}" if kind == ERROR else f"gave {error}"
        sent(answers, (ERROR, RuntimeError(told)))


if __name__ == "__main__":
    channel = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)  # what a step prints is for people
    serve(sys.stdin.buffer, channel)
