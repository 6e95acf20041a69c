"""``tactile-graph live``: a running pad looked at in the browser."""

from __future__ import annotations

from typing import Any

import click

from tactile_graph.cli.arguments import open_pipeline, pipeline_argument, source_options


@click.command()
@pipeline_argument
@source_options
@click.option("--http-port", type=click.IntRange(0, 65535), default=8765, show_default=True,
              help="Port of the page.")  # fmt: skip
def live(
    pipeline: str | None,
    recordings: tuple[str, ...],
    source: str | None,
    source_settings: tuple[str, ...],
    settings: tuple[str, ...],
    seed: int,
    http_port: int,
    **_: Any,
) -> None:
    """Look at a running pad in the browser."""
    import asyncio

    import uvicorn

    from tactile_graph_live.server.app import make_app
    from tactile_graph_live.server.guard import Door
    from tactile_graph_live.server.session import Session

    opened = open_pipeline(pipeline, recordings, source, source_settings, settings)
    door = Door("127.0.0.1", http_port)
    session = Session(opened, seed)
    click.echo(f"{opened.name}: {door.address}   Ctrl-C ends")

    async def serve() -> None:
        app = make_app(session, door)
        config = uvicorn.Config(app, door.host, door.port, log_level="warning", ws="auto",
                                ws_per_message_deflate=False)  # fmt: skip
        running = asyncio.create_task(session.run())
        await uvicorn.Server(config).serve()
        running.cancel()
        session.close()

    asyncio.run(serve())
