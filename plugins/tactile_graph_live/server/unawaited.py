"""``unawaited``: people's code in a thread that the end of the program does not wait for."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from threading import Thread
from typing import ParamSpec, TypeVar

P = ParamSpec("P")
T = TypeVar("T")


async def unawaited(call: Callable[P, T], /, *args: P.args, **kwargs: P.kwargs) -> T:
    """Return what a call gives, as `asyncio.to_thread` does.

    That one's threads are joined in the end: a step that hangs would keep Ctrl-C from ending the
    program.
    """
    loop = asyncio.get_running_loop()
    given: asyncio.Future[T] = loop.create_future()

    def settle(value: T | None, error: BaseException | None) -> None:
        if given.done():  # nobody waits any more
            return
        if error is not None:
            given.set_exception(error)
        else:
            given.set_result(value)  # type: ignore[arg-type]

    def work() -> None:
        value: T | None = None
        raised: BaseException | None = None
        try:
            value = call(*args, **kwargs)
        except BaseException as error:
            raised = error
        try:
            loop.call_soon_threadsafe(settle, value, raised)
        except RuntimeError:  # the loop is closed
            return

    Thread(target=work, name="tactile-graph unawaited", daemon=True).start()
    return await given
