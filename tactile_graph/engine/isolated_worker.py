"""The process that runs one step for another process; no command for people."""

from __future__ import annotations

import os
import pickle
import struct
import sys
from typing import IO, Any

READY, VALUE, ERROR, ENDED = "ready", "value", "error", "ended"
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
    """Make the step, and run it on whatever comes, until nothing more comes."""
    sys.path[:] = received(orders)
    try:
        target, settings, is_class = pickle.loads(received(orders))
        step = target(**settings) if is_class else target
        settings = {} if is_class else settings
    except Exception as error:
        sent(answers, (ERROR, f"{type(error).__name__}: {error}"))
        return
    sent(answers, (READY, None))
    while True:
        try:
            args, kwargs = received(orders)
        except EOFError:
            return
        try:
            answer: Message = VALUE, step(*args, **settings, **kwargs)
        except Exception as error:
            answer = ERROR, error
        _answer(answers, answer)


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
