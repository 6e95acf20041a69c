"""Whoever looks: each viewer gets the newest it can take, and holds up nobody."""

from __future__ import annotations

import asyncio
import json
import time
from collections import deque
from collections.abc import Callable, Collection, Mapping
from dataclasses import replace
from functools import cached_property
from typing import Any, Protocol

from starlette.websockets import WebSocket, WebSocketDisconnect

from tactile_graph_live.server import messages
from tactile_graph_live.server.messages import PATIENCE_S, UNANSWERED, encoded

TRY_LATER = 1013
MOST_TOLD = 20
Asked = Mapping[str, Any]


class Picture:
    """A frame's message, made into text once for all viewers; each has the pictures it asked for.

    Parameters
    ----------
    frame : messages.Frame
    arrived_ns : int
        When the sensor's frame was here, by ``time.perf_counter_ns``; 0 for one shown again.
    """

    def __init__(self, frame: messages.Frame, arrived_ns: int = 0) -> None:
        self.frame = frame
        self.arrived_ns = arrived_ns
        self._looks: dict[str, str] = {}

    def shown_again(self) -> Picture:
        """Return the same to be shown later: the time it takes then says nothing."""
        return Picture(self.frame)

    @cached_property
    def _bare(self) -> str:
        """All but the pictures, which go in behind; without the closing bracket."""
        return encoded(replace(self.frame, pictures={})).replace('"pictures":{},', "", 1)[:-1]

    def text(self, shown: Collection[str]) -> str:
        """Return the message for a viewer that is shown these nodes."""
        looks = ",".join(self._look(n) for n in self.frame.pictures if n in shown)
        return f'{self._bare},"pictures":{{{looks}}}}}'

    def _look(self, node: str) -> str:
        found = self._looks.get(node)
        if found is None:
            shapes = json.dumps(self.frame.pictures[node], separators=(",", ":"))
            found = self._looks[node] = f"{json.dumps(node)}:{shapes}"
        return found


class Channel(Protocol):
    """What a viewer is sent through."""

    async def send_text(self, data: str) -> None:
        """Send a message; waits while the other side takes nothing."""


class Viewer:
    """One page: what waits to be sent to it, never more than the newest of each kind."""

    def __init__(self, channel: Channel) -> None:
        self.shown: frozenset[str] = frozenset()
        self.dropped = ""
        self._channel = channel
        self._news: dict[str, str] = {}
        self._told: deque[str] = deque(maxlen=MOST_TOLD)
        self._newest: Picture | None = None
        self._unanswered: deque[tuple[Picture, float]] = deque()
        self._wake = asyncio.Event()
        self._busy_since: float | None = None

    def tell(self, kind: str, text: str) -> None:
        """Have a message sent; one of the same kind that waits still gives way to it."""
        if kind == "told":
            self._told.append(text)
        else:
            self._news.pop(kind, None)
            self._news[kind] = text
        self._wake.set()

    def show(self, picture: Picture) -> None:
        """Have a frame sent, if no newer one comes before the viewer is ready."""
        self._newest = picture
        self._wake.set()

    def answered(self, index: int) -> int:
        """Note that a frame is drawn; return when it had arrived, 0 for one not waited for."""
        for number, (picture, _) in enumerate(self._unanswered):
            if picture.frame.index == index:
                for _ in range(number + 1):
                    self._unanswered.popleft()
                self._wake.set()
                return picture.arrived_ns
        return 0

    def stuck_s(self, now: float) -> float:
        """Return for how long it has taken nothing though something is there for it."""
        since = [t for _, t in list(self._unanswered)[:1]]
        if self._busy_since is not None:
            since.append(self._busy_since)
        return max((now - t for t in since), default=0.0)

    async def sending(self) -> None:
        """Send what waits, for ever."""
        while True:
            await self._wake.wait()
            self._wake.clear()
            while self._told or self._news:
                text = (
                    self._told.popleft() if self._told else self._news.pop(next(iter(self._news)))
                )
                await self._send(text)
            if self._newest is not None and len(self._unanswered) < UNANSWERED:
                picture, self._newest = self._newest, None
                self._unanswered.append((picture, time.perf_counter()))
                await self._send(picture.text(self.shown))

    async def _send(self, text: str) -> None:
        self._busy_since = time.perf_counter()
        await self._channel.send_text(text)
        self._busy_since = None


class Viewers:
    """All viewers there are.

    Parameters
    ----------
    on_shown : callable
        Told which nodes' pictures somebody looks at, whenever that changes.
    on_left : callable
        Told who has left.
    """

    def __init__(
        self, on_shown: Callable[[frozenset[str]], None], on_left: Callable[[Viewer], None]
    ) -> None:
        self._all: dict[Viewer, asyncio.Task[None]] = {}
        self._on_shown, self._on_left = on_shown, on_left
        self.shown: frozenset[str] = frozenset()
        self.n_dropped = 0

    def __len__(self) -> int:
        return len(self._all)

    def tell(self, message: messages.Message) -> None:
        """Send a message to all."""
        text, kind = encoded(message), type(message).__name__.lower()
        for viewer in self._all:
            viewer.tell(kind, text)

    def show(self, picture: Picture) -> None:
        """Send a frame to all."""
        for viewer in self._all:
            viewer.show(picture)

    def drop_stuck(self) -> None:
        """Let go of those who have read nothing for `PATIENCE_S`."""
        now = time.perf_counter()
        for viewer, task in list(self._all.items()):
            if viewer.stuck_s(now) > PATIENCE_S and not viewer.dropped:
                viewer.dropped = f"it read nothing for {PATIENCE_S:g} s"
                self.n_dropped += 1
                task.cancel()

    async def serve(
        self,
        websocket: WebSocket,
        greeting: Collection[messages.Message],
        asked: Callable[[Viewer, Asked], None],
        picture: Picture | None = None,
    ) -> None:
        """Serve one viewer until it goes or is let go of.

        Parameters
        ----------
        websocket : WebSocket
        greeting : collection of Message
            What it is told first.
        asked : callable
            Does what it asks for.
        picture : Picture, optional
            What all look at now.
        """
        viewer = Viewer(websocket)
        if picture is not None:
            viewer.show(picture.shown_again())
        for message in greeting:
            viewer.tell(type(message).__name__.lower(), encoded(message))
        sending = asyncio.create_task(viewer.sending())
        reading = asyncio.create_task(_reading(websocket, lambda a: asked(viewer, a)))
        self._all[viewer] = sending
        try:
            await asyncio.wait({sending, reading}, return_when=asyncio.FIRST_COMPLETED)
        finally:
            self._all.pop(viewer)
            for task in (sending, reading):
                task.cancel()
            await asyncio.gather(sending, reading, return_exceptions=True)
            self.shown_changed()
            self._on_left(viewer)
        if viewer.dropped:
            await websocket.close(TRY_LATER, viewer.dropped)

    def shown_changed(self) -> None:
        """Find out which nodes are looked at."""
        shown = frozenset().union(*(v.shown for v in self._all))
        if shown != self.shown:
            self.shown = shown
            self._on_shown(shown)


async def _reading(websocket: WebSocket, asked: Callable[[Asked], None]) -> None:
    """Hand on what a page asks for, as a message of no type what is none; ends when it goes."""
    while True:
        try:
            found = json.loads(await websocket.receive_text())
        except (WebSocketDisconnect, KeyError):
            return
        except (ValueError, RecursionError):
            found = None
        asked(found if isinstance(found, dict) else {})
