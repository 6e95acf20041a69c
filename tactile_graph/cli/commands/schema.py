"""``tactile-graph schema``: a JSON Schema of pipeline, pad and other files, or all their keys."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

import click

from tactile_graph.cli.file_kinds import PIPELINE, file_kind, kind_names
from tactile_graph.cli.say import say
from tactile_graph.errors import UsageError
from tactile_graph.files import check_target, write_whole
from tactile_graph.foreign_text import visible
from tactile_graph.plugins import registry

if TYPE_CHECKING:
    from tactile_graph.cli.pages.key_tables import KeyTable


def complete_kind(ctx: click.Context, param: click.Parameter, incomplete: str) -> list[str]:
    """Return the kinds of files that begin so, for the shell."""
    return [n for n in kind_names(registry.installed()) if n.startswith(incomplete)]


@click.command(
    epilog="An editor with a YAML language server checks a pipeline file as it is written when "
    "its first line is:  # yaml-language-server: $schema=pipeline.schema.json"
)
@click.argument("kind", metavar="[KIND]", default=PIPELINE, shell_complete=complete_kind)
@click.option("-o", "--output", metavar="FILE", help="Write to a file instead of stdout.")
@click.option("--keys", is_flag=True, help="Print tables of all keys for people instead.")
def schema(kind: str, output: str | None, keys: bool) -> None:
    """Write a JSON Schema (draft 2020-12) of what the installed plugins allow in a file.

    KIND is pipeline (the default), pad, preset, scene, or what else plugins read.
    """
    if output not in (None, "-"):
        check_target("-o", str(output))
    if keys:
        if output is not None:
            raise UsageError("--keys prints tables for people: it takes no -o")
        _show_keys(kind)
        return
    text = json.dumps(_made(kind), indent=2, ensure_ascii=False) + "\n"
    if output in (None, "-"):
        say(text, nl=False)
    else:
        write_whole(str(output), text)
        say(f"wrote {output}", err=True)


def _made(kind: str) -> dict[str, Any]:
    found = registry.installed()
    if kind != PIPELINE:
        from tactile_graph.record_schema import record_schema

        return record_schema(file_kind(found, kind), kind)
    from tactile_graph.schema import pipeline_schema

    made, troubles = pipeline_schema(found)
    for trouble in troubles:
        click.echo(f"{click.style('left open:', fg='yellow')} {visible(str(trouble))}", err=True)
    return made


def _show_keys(kind: str) -> None:
    from tactile_graph.cli.pages.key_tables import key_tables
    from tactile_graph.cli.terminal import console

    if kind == PIPELINE:
        raise UsageError(
            "--keys is for files of one record, such as pad; the keys of a pipeline are those of "
            "its steps: tactile-graph steps NAME"
        )
    out = console()
    for table in key_tables(_made(kind)):
        _show_table(out, kind, table)


def _show_table(out: Any, kind: str, table: KeyTable) -> None:
    from rich import box
    from rich.padding import Padding
    from rich.table import Table
    from rich.text import Text

    out.print(Text.assemble((table.place or f"a {kind} file", "bold"), f"  {table.about}"))
    shown = Table(box=box.SIMPLE_HEAD, pad_edge=False)
    shown.add_column("key", style="cyan", no_wrap=True)
    for head in ("holds", "default", ""):
        shown.add_column(head)
    for key in table.keys:
        shown.add_row(*(Text(cell) for cell in key))
    out.print(Padding(shown, (0, 0, 0, 2)))
