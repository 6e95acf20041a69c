"""``tactile-graph live``: a running pad looked at in the browser."""

from __future__ import annotations

import pickle
import re
import signal
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import click

from tactile_graph.cli.arguments import Span, pipeline_argument
from tactile_graph.cli.completions import complete_set, complete_source, complete_with
from tactile_graph.cli.numbers import Finite
from tactile_graph.cli.say import clock, say
from tactile_graph.errors import UsageError

if TYPE_CHECKING:
    from tactile_graph import Pipeline
    from tactile_graph_live.server.session import Setup

PARTS = ("starlette", "uvicorn", "websockets")
MISSING = 'live needs {}: pip install "tactile-graph[live]"'
DEADLINE = re.compile(r"(?P<number>\d+(\.\d*)?|\.\d+)\s*(?P<unit>us|µs|ms|s)")
MICROSECONDS = {"us": 1.0, "µs": 1.0, "ms": 1e3, "s": 1e6}
EPILOG = """\b
The pipeline file may stay open in an editor: whatever is saved runs at once, on the same frames.

\b
  tactile-graph live locate
  tactile-graph live my.yaml --port /dev/ttyACM0 --preset fsrray
  tactile-graph live my.yaml monday.zarr --folder recordings

\b
Exit codes: 0 ended by Ctrl-C, 2 nothing could be shown, 143 ended by SIGTERM.
"""


def parse_deadline(ctx: click.Context, param: click.Parameter, value: str | None) -> float | None:
    """Return the microseconds that ``2ms`` spells.

    Raises
    ------
    click.BadParameter
        If it spells none.
    """
    if value is None:
        return None
    found = DEADLINE.fullmatch(value.strip())
    microseconds = float(found["number"]) * MICROSECONDS[found["unit"]] if found else 0.0
    if microseconds <= 0.0:
        raise click.BadParameter(f"{value!r}: must be a time such as 2ms or 800us", ctx, param)
    return microseconds


@click.command(epilog=EPILOG)
@pipeline_argument
@click.argument("recordings", metavar="[RECORDING]...", nargs=-1)
@click.option("--port", help="Device or pyserial URL of a pad; see 'ports'.")
@click.option("--device", default="serial", show_default=True,
              help="How the pad hangs on this machine; plugins may know other ways.")  # fmt: skip
@click.option("--preset", help="The kit's name, or a YAML file; see 'presets'.")
@click.option("--baud", type=click.IntRange(min=1), help="Instead of the preset's.")
@click.option(
    "--source",
    metavar="STEP",
    shell_complete=complete_source,
    help="Take frames from this source step.",
)
@click.option("--with", "source_settings", metavar="KEY=VALUE", multiple=True,
              shell_complete=complete_with,
              help="A setting of the source; can be repeated.")  # fmt: skip
@click.option("--set", "settings", metavar="NODE.SETTING=VALUE", multiple=True,
              shell_complete=complete_set,
              help="A setting of a node instead of the file's; can be repeated.")  # fmt: skip
@click.option("--rate", "rate_hz", type=Finite(min=0, min_open=True), metavar="HZ",
              help="Play a recording, or what is simulated, at so many frames a second instead of "
              "by its own times.")  # fmt: skip
@click.option("--unpaced", is_flag=True, help="Take frames as fast as the source gives them.")
@click.option("--once", is_flag=True, help="End a recording where it ends; it starts over else.")
@click.option("--deadline", "deadline_us", callback=parse_deadline, metavar="TIME",
              help="Answer each frame within this time (2ms, 800us) of its arrival.")  # fmt: skip
@click.option("--waiting", type=click.IntRange(min=1), metavar="N",
              help="Frames that may wait for the pipeline; of more the oldest go.  "
              "[default: 16, 64 with a deadline]")  # fmt: skip
@click.option("--beside", metavar="VARIANT",
              help="Run this one in what time is left, and tell how far both agree.")  # fmt: skip
@click.option("--seed", type=click.IntRange(min=0), default=0, show_default=True,
              help="Seed of everything random.")  # fmt: skip
@click.option("--folder", default=".", show_default=True,
              help="Where recordings and saved pipelines go.")  # fmt: skip
@click.option("--osc", default="", metavar="HOST:PORT",
              help="Send every result there as OSC over UDP.")  # fmt: skip
@click.option("--http-port", type=click.IntRange(0, 65535), default=8765, show_default=True,
              help="Port of the page; 0 for any that is free.")  # fmt: skip
@click.option("--host", default="127.0.0.1", show_default=True,
              help="Address of the page; any but this machine's own needs a token.")  # fmt: skip
@click.option("--token", default="", help="What a page must bring from elsewhere; made up if not "
              "given.")  # fmt: skip
def live(pipeline: str | None, recordings: tuple[str, ...], **options: Any) -> None:
    """Show PIPELINE at work on a running pad, in the browser.

    Without a pad (--port), a recording or --source it runs on the pipeline's own source, which is
    simulated for most. The page draws what was found, the graph, times and settings; it records,
    tares, and scrubs back over the last minute.
    """
    import asyncio

    asked = _Options(**options)
    _check_installed()
    from tactile_graph_live.server.serving import serve, taken_door

    opened = _opened(pipeline, recordings, asked)
    door, listener = taken_door(asked.host, asked.http_port, asked.token)
    with listener:
        setup = _setup(opened, asked)

        def begun() -> None:
            say(f"{opened.name} is shown at {door.address}")
            say("Ctrl-C ends it")

        try:
            session, number = asyncio.run(
                serve(setup, door, listener, lambda text, level: _tell(text, level), begun)
            )
        except KeyboardInterrupt:  # a second Ctrl-C
            click.get_current_context().exit(128 + signal.SIGINT)
    n, before = session.n_frames, session.n_shed_before
    ready = f", {before} while it got ready" if before else ""
    say(f"\n{n} frame{'s' if n != 1 else ''}, {session.n_shed} left out under load{ready}")
    if number not in (0, signal.SIGINT):
        click.get_current_context().exit(128 + number)


@dataclass(frozen=True)
class _Options:
    """What the command line says beside pipeline and recordings."""

    port: str | None
    device: str
    preset: str | None
    baud: int | None
    source: str | None
    source_settings: tuple[str, ...]
    settings: tuple[str, ...]
    rate_hz: float | None
    unpaced: bool
    once: bool
    deadline_us: float | None
    waiting: int | None
    beside: str | None
    seed: int
    folder: str
    osc: str
    http_port: int
    host: str
    token: str


def _check_installed() -> None:
    """Refuse to begin without what serves the page, and say what to install."""
    from importlib.util import find_spec

    missing = [name for name in PARTS if find_spec(name) is None]
    if missing:
        raise UsageError(MISSING.format(", ".join(missing)))


def _opened(name: str | None, recordings: Sequence[str], asked: _Options) -> Pipeline:
    """Return the pipeline on the source that the command line names."""
    from tactile_graph.cli.arguments import open_pipeline

    source, settings = asked.source, asked.source_settings
    if asked.port is not None or asked.preset is not None:
        source, settings = _captured(recordings, asked)
    return open_pipeline(name, recordings, source, settings, asked.settings, Span())


def _captured(recordings: Sequence[str], asked: _Options) -> tuple[str, tuple[str, ...]]:
    """Return the source step of a pad on this machine, and its settings as the command has them."""
    from tactile_graph.pipeline.document import on_one_line
    from tactile_graph_sources.commands.captured import captured

    if asked.source or recordings:
        other = f"--source {asked.source}" if asked.source else recordings[0]
        raise UsageError(f"give --port and --preset, or {other}, and not both")
    told = {"preset": asked.preset, "baud": asked.baud}
    step, given = captured(asked.port, asked.device, told, None)
    return step, (*(f"{k}={on_one_line(v)}" for k, v in given.items()), *asked.source_settings)


def _setup(opened: Pipeline, asked: _Options) -> Setup:
    from importlib.metadata import version

    from tactile_graph.cli.watch import files_read, stamp
    from tactile_graph_live.bench.wire import Order
    from tactile_graph_live.server.session import Setup, folder_of
    from tactile_graph_live.server.watching import FileSense

    order = Order(
        b"",
        seed=asked.seed,
        deadline_us=asked.deadline_us,
        rate_hz=asked.rate_hz,
        once=asked.once,
        unpaced=asked.unpaced,
        capacity=asked.waiting,
        beside=b"" if asked.beside is None else pickle.dumps(_variant(asked.beside, opened)),
    )
    return Setup(
        opened,
        version("tactile-graph"),
        folder_of(asked.folder),
        FileSense(stamp, files_read, read_source),
        order,
        asked.osc,
    )


def read_source(pipeline: Pipeline) -> None:
    """Open the pads, scenes and presets that a pipeline's source names.

    Raises
    ------
    PipelineError
        If one of them is wrong.
    """
    from tactile_graph.cli.source_files import problems_of_records
    from tactile_graph.errors import PipelineError
    from tactile_graph.plugins.registry import installed

    problems = problems_of_records(installed(), pipeline.source) if pipeline.source else []
    if problems:
        raise PipelineError(problems)


def _variant(name: str, opened: Pipeline) -> Pipeline:
    """Return the pipeline to run beside, checked against the source of the first."""
    from tactile_graph import load

    variant = load(name)
    source = opened.source
    return variant if source is None else variant.with_source(source.name, **source.given)


def _tell(text: str, level: str) -> None:
    say(text if level == "note" else f"{clock()}  {level}: {text}", err=True)
