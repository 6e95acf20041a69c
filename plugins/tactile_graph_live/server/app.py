"""The web application: the page's files, and the WebSockets behind them."""

from __future__ import annotations

from pathlib import Path

from starlette.applications import Starlette
from starlette.requests import Request
from starlette.responses import FileResponse, PlainTextResponse, Response
from starlette.routing import Route, WebSocketRoute
from starlette.websockets import WebSocket

from tactile_graph_live.server.guard import App, Door, Guard
from tactile_graph_live.server.session import Session

PAGE = Path(__file__).parents[1] / "page"
KINDS = {
    ".html": "text/html; charset=utf-8",
    ".js": "text/javascript; charset=utf-8",
    ".css": "text/css; charset=utf-8",
    ".svg": "image/svg+xml",
    ".png": "image/png",
    ".webmanifest": "application/manifest+json",
}
"""Of the page's files; whatever ends otherwise is not served."""


def make_app(session: Session, door: Door) -> App:
    """Return the application: ``/`` and the page's files, ``/live`` and ``/results``."""
    files = {p.name: p for p in sorted(PAGE.iterdir()) if p.suffix in KINDS}

    async def page(request: Request) -> Response:
        path = files.get(request.path_params.get("name", "") or "index.html")
        if path is None:
            return PlainTextResponse("There is no such page.\n", 404)
        return FileResponse(path, media_type=KINDS[path.suffix])

    async def live(websocket: WebSocket) -> None:
        await websocket.accept()
        await session.serve(websocket)

    async def results(websocket: WebSocket) -> None:
        await websocket.accept()
        await session.serve_results(websocket)

    app = Starlette(
        routes=[
            Route("/", page),
            Route("/{name}", page),
            WebSocketRoute("/live", live),
            WebSocketRoute("/results", results),
        ]
    )
    return Guard(app, door)
