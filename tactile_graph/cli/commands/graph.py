"""``tactile-graph graph``: a pipeline's graph as a picture, or as text that others draw."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING

import click

from tactile_graph.cli.arguments import offered, pipeline_argument
from tactile_graph.cli.say import hand_over, say
from tactile_graph.cli.targets import check_targets
from tactile_graph.errors import UsageError, did_you_mean
from tactile_graph.files import check_target, write_whole
from tactile_graph.plugins import registry

if TYPE_CHECKING:
    from tactile_graph.api.pipeline import Pipeline

SUFFIXES = {
    ".svg": "svg", ".png": "png", ".pdf": "pdf", ".mmd": "mermaid", ".mermaid": "mermaid",
    ".dot": "dot", ".gv": "dot",
}  # fmt: skip
FORMATS = ("svg", "png", "pdf", "mermaid", "dot")
BINARY = ("png", "pdf")


@click.command()
@pipeline_argument
@click.option(
    "--format",
    "form",
    type=click.Choice(FORMATS),
    help="Where the name of the output does not say; mermaid by default.",
)
@click.option(
    "-o",
    "--output",
    metavar="FILE",
    help="Write to a file (.png, .svg, .pdf; .mmd for mermaid, .dot for Graphviz).",
)
def graph(pipeline: str | None, form: str | None, output: str | None) -> None:
    """Draw PIPELINE's graph from left to right, as a picture or as text."""
    from tactile_graph.api.pipeline import load

    if pipeline is None:
        raise UsageError(f"name a pipeline, or a file of one\n{offered()}")
    to_file = output not in (None, "-")
    form = form or _format(str(output) if to_file else "")
    if to_file:
        check_target("-o", str(output))
    elif form in BINARY and on_screen():
        raise UsageError(f"--format {form}: is nothing to read on a screen; give -o FILE.{form}")
    loaded = load(pipeline, registry.installed())
    check_targets([("-o", output)], [loaded])
    drawn = _drawn(loaded, form)
    if to_file:
        write_whole(str(output), drawn)
        say(f"wrote {output}", err=True)
    elif isinstance(drawn, bytes):
        click.echo(drawn, nl=False)
    else:
        hand_over(drawn)


def on_screen() -> bool:
    """Return whether stdout is a terminal."""
    return sys.stdout.isatty()


def _drawn(pipeline: Pipeline, form: str) -> str | bytes:
    if form in BINARY:
        from tactile_graph.draw.paint_graph import graph_picture

        return graph_picture(pipeline, form)
    if form == "svg":
        from tactile_graph.draw.svg import graph_svg

        return graph_svg(pipeline)
    from tactile_graph.draw.text import graph_dot, graph_mermaid

    return graph_mermaid(pipeline) if form == "mermaid" else graph_dot(pipeline)


def _format(output: str) -> str:
    if not output:
        return "mermaid"
    suffix = Path(output).suffix.lower()
    if suffix not in SUFFIXES:
        near = did_you_mean(suffix, SUFFIXES) if suffix else ""
        raise UsageError(
            f"-o {output}: its name must end in {', '.join(SUFFIXES)}, or give --format{near}"
        )
    return SUFFIXES[suffix]
