"""A session: the bench, the pipeline that runs on it, and whoever looks at it."""

from __future__ import annotations

import asyncio
from typing import Any

from starlette.websockets import WebSocket

from tactile_graph import Pipeline
from tactile_graph_live.server import messages
from tactile_graph_live.server.bench_link import BenchLink
from tactile_graph_live.server.graph_message import graph_message
from tactile_graph_live.server.viewers import Asked, Picture, Viewer, Viewers


class Session:
    """What the page shows and what it asks for come together here.

    Parameters
    ----------
    pipeline : Pipeline
    seed : int
    """

    def __init__(self, pipeline: Pipeline, seed: int) -> None:
        self.pipeline = pipeline
        self.viewers = Viewers(lambda shown: self._link.send("show", tuple(shown)))
        self._link = BenchLink(pipeline, seed)
        self._graph = graph_message(pipeline, 1, pipeline.text, {}, 0.0)
        source = pipeline.source.name if pipeline.source else ""
        self._hello = messages.Hello(
            pipeline.name, pipeline.about, source, False, pipeline.file, ".", None, "0.1.0"
        )

    async def run(self) -> None:
        """Take what the bench sends until told to end."""
        queue: asyncio.Queue[Any] = asyncio.Queue()
        self._link.start(asyncio.get_running_loop(), queue.put_nowait)
        while True:
            frame = await queue.get()
            self.viewers.show(Picture(frame))
            self.viewers.drop_stuck()

    async def serve(self, websocket: WebSocket) -> None:
        """Serve a page."""
        await self.viewers.serve(websocket, (self._hello, self._graph), self._asked)

    async def serve_results(self, websocket: WebSocket) -> None:
        """Serve a program."""

    def _asked(self, viewer: Viewer, asked: Asked) -> None:
        kind = asked.get("type")
        if kind == "pong":
            viewer.answered(asked["index"])
        elif kind == "show":
            viewer.shown = frozenset(asked["nodes"])
            self.viewers.shown_changed()

    def close(self) -> None:
        """End the bench."""
        self._link.close()
