"""A page for each command: its help as the terminal gives it, told once for the web."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import click

from making.markdown import code, fence, prose, table, toctree, write
from tactile_graph.cli import cli


def write_commands(into: Path) -> int:
    """Write a page a command into a folder, and return how many there are."""
    context = click.Context(cli, info_name="tactile-graph")
    rows = []
    names = cli.list_commands(context)
    for name in names:
        command = cli.get_command(context, name)
        assert command is not None, name
        write(into / "commands" / f"{name}.md", "\n".join(_page(name, command, context)))
        rows.append((f"[{name}]({name}.md)", prose(command.get_short_help_str(200))))
    head = "# All commands\n\n`tactile-graph COMMAND --help` says the same in a terminal.\n"
    epilog = fence("text", cli.get_help(context))
    pages = toctree(names, hidden=True)
    text = "\n".join([head, table(("command", "what it does"), rows), epilog, pages])
    write(into / "commands" / "index.md", text)
    return len(names)


def _page(name: str, command: click.Command, above: click.Context) -> Iterator[str]:
    context = click.Context(command, info_name=name, parent=above)
    usage = command.get_usage(context).removeprefix("Usage: ")
    yield f"# {name}\n\n{fence('text', usage)}"
    yield prose(click_text(command.help or "")) + "\n"
    rows = []
    for parameter in command.get_params(context):
        if isinstance(parameter, click.Option) and not parameter.hidden:
            told = parameter.get_help_record(context)
            if told is not None:
                rows.append((code(told[0]), prose(told[1])))
    yield table(("option", "what it does"), rows)


def click_text(text: str) -> str:
    r"""Return a help text without click's marks: ``\b`` keeps the lines of a paragraph."""
    parts = []
    for paragraph in text.split("\n\n"):
        if paragraph.startswith("\b\n"):
            parts.append("\n".join(f"    {line}" for line in paragraph[2:].splitlines()))
        else:
            parts.append(paragraph)
    return "\n\n".join(parts)
