"""``LiveStream``: a live run for ``async for``."""

from __future__ import annotations

import asyncio
from collections import deque
from collections.abc import AsyncIterator
from threading import Thread
from typing import Generic, Self, TypeVar

from tactile_graph.engine.outcomes.outcomes import Outcomes
from tactile_graph.live.asked import checked_room
from tactile_graph.live.live_result import LiveResult
from tactile_graph.live.live_run import LiveRun

ResultT = TypeVar("ResultT", bound=Outcomes)


class LiveStream(AsyncIterator[LiveResult[ResultT]], Generic[ResultT]):
    """The results of a live run, which goes on in a thread of its own.

    A slow reader costs no frame: results that nobody takes go, the oldest first, and are counted.
    Leave the loop early by ``break``, then ``await stream.aclose()``, or use it as an asynchronous
    context manager.

    Parameters
    ----------
    run : LiveRun
        It is stopped when the stream is closed.
    unread : int
        How many results may wait; at least 1.
    """

    def __init__(self, run: LiveRun[ResultT], unread: int) -> None:
        self.run = run
        self.n_unread = 0
        """How many results went because nobody took them."""
        self._results: deque[LiveResult[ResultT]] = deque(maxlen=checked_room("unread", unread))
        self._error: BaseException | None = None
        self._thread: Thread | None = None
        self._ended = False
        self._loop: asyncio.AbstractEventLoop
        self._news: asyncio.Event

    async def __aenter__(self) -> Self:
        return self

    async def __aexit__(self, *_: object) -> None:
        await self.aclose()

    def __aiter__(self) -> Self:
        return self

    async def __anext__(self) -> LiveResult[ResultT]:
        if self._thread is None:
            self._begin()
        while not self._results:
            if self._ended:
                if self._error is not None:
                    error, self._error = self._error, None
                    raise error
                raise StopAsyncIteration
            self._news.clear()
            if not self._results and not self._ended:
                await self._news.wait()
        return self._results.popleft()

    async def aclose(self) -> None:
        """End the run, and wait for the frame that is under way."""
        self.run.stop()
        if self._thread is not None:
            await asyncio.to_thread(self._thread.join)

    def _begin(self) -> None:
        self._loop, self._news = asyncio.get_running_loop(), asyncio.Event()
        self._thread = Thread(target=self._go, name="tactile-graph live", daemon=True)
        self._thread.start()

    def _go(self) -> None:
        try:
            for live in self.run:
                if len(self._results) == self._results.maxlen:
                    self.n_unread += 1
                self._results.append(live)
                self._tell()
        except BaseException as error:
            self._error = error
        finally:
            self._ended = True
            self._tell()

    def _tell(self) -> None:
        try:
            self._loop.call_soon_threadsafe(self._news.set)
        except RuntimeError:  # the loop is closed: nobody reads any more
            self.run.stop()
