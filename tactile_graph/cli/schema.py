"""``tactile-graph schema``: a JSON Schema of pipeline files."""

from __future__ import annotations

import json

import click

from tactile_graph.cli.say import say
from tactile_graph.files import check_target, write_whole
from tactile_graph.foreign_text import visible
from tactile_graph.plugins import registry


@click.command(
    epilog="An editor with a YAML language server checks a pipeline file as it is written when "
    "its first line is:  # yaml-language-server: $schema=pipeline.schema.json"
)
@click.option("-o", "--output", metavar="FILE", help="Write to a file instead of stdout.")
def schema(output: str | None) -> None:
    """Write a JSON Schema (draft 2020-12) of what the installed plugins allow in a pipeline."""
    from tactile_graph.schema import pipeline_schema

    if output not in (None, "-"):
        check_target("-o", str(output))
    made, troubles = pipeline_schema(registry.installed())
    for trouble in troubles:
        click.echo(f"{click.style('left open:', fg='yellow')} {visible(str(trouble))}", err=True)
    text = json.dumps(made, indent=2, ensure_ascii=False) + "\n"
    if output in (None, "-"):
        say(text, nl=False)
    else:
        write_whole(str(output), text)
        say(f"wrote {output}", err=True)
