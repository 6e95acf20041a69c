"""Calls in a thread that the end of the program does not wait for."""

from __future__ import annotations

import asyncio
import threading
import time

import pytest

pytest.importorskip("starlette", reason="the live extra is not installed")

from tactile_graph_live.server.unawaited import unawaited


def test_what_a_call_gives_or_raises_is_had() -> None:
    assert asyncio.run(unawaited(divmod, 7, 2)) == (3, 1)
    with pytest.raises(ZeroDivisionError):
        asyncio.run(unawaited(divmod, 7, 0))


def test_the_end_does_not_wait_for_a_call_that_hangs() -> None:
    goes_on, began = threading.Event(), time.monotonic()

    async def impatient() -> None:
        with pytest.raises(TimeoutError):
            await asyncio.wait_for(unawaited(goes_on.wait, 60), 0.05)

    asyncio.run(impatient())
    assert time.monotonic() - began < 30
    goes_on.set()
