"""Programs that take every result: rows as JSON over a WebSocket."""

from __future__ import annotations

import asyncio
import json
import time
from collections import deque
from collections.abc import Callable
from dataclasses import asdict

from starlette.websockets import WebSocket

from tactile_graph_live.bench.wire import Row, Rows
from tactile_graph_live.server.messages import PATIENCE_S
from tactile_graph_live.server.viewers import TRY_LATER, Channel

MOST_WAITING = 1024


class Program:
    """One program: results wait for it in order, and the oldest go when too many do."""

    def __init__(self, channel: Channel) -> None:
        self.n_lost = 0
        self.dropped = ""
        self._channel = channel
        self._waiting: deque[str] = deque()
        self._wake = asyncio.Event()
        self.busy_since: float | None = None

    def take(self, texts: list[str], n_lost: int) -> None:
        """Have results sent."""
        self._waiting.extend(texts)
        self.n_lost += n_lost + max(0, len(self._waiting) - MOST_WAITING)
        while len(self._waiting) > MOST_WAITING:
            self._waiting.popleft()
        self._wake.set()

    async def sending(self) -> None:
        """Send what waits, for ever."""
        while True:
            await self._wake.wait()
            self._wake.clear()
            while self._waiting:
                if self.n_lost:
                    lost, self.n_lost = self.n_lost, 0
                    await self._send(json.dumps({"type": "lost", "results": lost}))
                await self._send(self._waiting.popleft())

    async def _send(self, text: str) -> None:
        self.busy_since = time.perf_counter()
        await self._channel.send_text(text)
        self.busy_since = None


class Programs:
    """All programs there are.

    Parameters
    ----------
    on_number : callable
        Called when a program came or went.
    """

    def __init__(self, on_number: Callable[[], None]) -> None:
        self._all: dict[Program, asyncio.Task[None]] = {}
        self._on_number = on_number

    def __len__(self) -> int:
        return len(self._all)

    def take(self, rows: Rows) -> None:
        """Send results to all."""
        if self._all:
            texts = [result_text(row) for row in rows.rows]
            for program in self._all:
                program.take(texts, rows.n_lost)

    def drop_stuck(self) -> None:
        """Let go of those that have read nothing for `PATIENCE_S`."""
        now = time.perf_counter()
        for program, task in self._all.items():
            since = program.busy_since
            if since is not None and now - since > PATIENCE_S and not program.dropped:
                program.dropped = f"it read nothing for {PATIENCE_S:g} s"
                task.cancel()

    async def serve(self, websocket: WebSocket) -> None:
        """Serve one program until it goes or is let go of."""
        program = Program(websocket)
        sending = asyncio.create_task(program.sending())
        reading = asyncio.create_task(_until_gone(websocket))
        self._all[program] = sending
        self._on_number()
        try:
            await asyncio.wait({sending, reading}, return_when=asyncio.FIRST_COMPLETED)
        finally:
            self._all.pop(program)
            self._on_number()
            for task in (sending, reading):
                task.cancel()
            await asyncio.gather(sending, reading, return_exceptions=True)
        if program.dropped:
            await websocket.close(TRY_LATER, program.dropped)


def result_text(row: Row) -> str:
    """Return a result as the JSON that programs get."""
    return json.dumps({"type": "result", **asdict(row)}, separators=(",", ":"))


async def _until_gone(websocket: WebSocket) -> None:
    """Return when the other side goes; what it says is not heard."""
    while (await websocket.receive())["type"] != "websocket.disconnect":
        pass
