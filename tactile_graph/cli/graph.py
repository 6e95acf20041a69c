"""``tactile-graph graph``: a pipeline's graph as SVG, mermaid or dot."""

from __future__ import annotations

from pathlib import Path

import click

from tactile_graph.cli.arguments import offered, pipeline_argument
from tactile_graph.cli.say import say
from tactile_graph.errors import UsageError
from tactile_graph.files import check_target, write_whole
from tactile_graph.plugins import registry

SUFFIXES = {".svg": "svg", ".mmd": "mermaid", ".mermaid": "mermaid", ".dot": "dot", ".gv": "dot"}
FORMATS = ("svg", "mermaid", "dot")


@click.command()
@pipeline_argument
@click.option(
    "--format",
    "form",
    type=click.Choice(FORMATS),
    help="Where the name of the output does not say; mermaid by default.",
)
@click.option("-o", "--output", metavar="FILE", help="Write to a file (.svg, .mmd, .dot).")
def graph(pipeline: str | None, form: str | None, output: str | None) -> None:
    """Draw PIPELINE's graph from left to right."""
    from tactile_graph.api.pipeline import load

    if pipeline is None:
        raise UsageError(f"name a pipeline, or a file of one\n{offered()}")
    to_file = output not in (None, "-")
    form = form or _format(str(output) if to_file else "")
    if to_file:
        check_target("-o", str(output))
    loaded = load(pipeline, registry.installed())
    if form == "svg":
        from tactile_graph.draw.svg import graph_svg

        text = graph_svg(loaded)
    else:
        from tactile_graph.draw.text import graph_dot, graph_mermaid

        text = graph_mermaid(loaded) if form == "mermaid" else graph_dot(loaded)
    text = text.rstrip("\n") + "\n"
    if to_file:
        write_whole(str(output), text)
        say(f"wrote {output}", err=True)
    else:
        say(text, nl=False)


def _format(output: str) -> str:
    if not output:
        return "mermaid"
    suffix = Path(output).suffix.lower()
    if suffix not in SUFFIXES:
        raise UsageError(
            f"-o {output}: its name must end in {', '.join(SUFFIXES)}, or give --format"
        )
    return SUFFIXES[suffix]
