"""``tactile-graph steps``: a list of all, made without importing them, a search, or one in full."""

from __future__ import annotations

import sys
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any

import click

from tactile_graph.cli.say import say
from tactile_graph.errors import TactileGraphError, UsageError
from tactile_graph.plugins import registry

if TYPE_CHECKING:
    from rich.console import RenderableType
    from rich.text import Text

    from tactile_graph.cli.pages.search import Entry, Hit


NARROW = 80
"""Columns of a terminal below which a step's ports and words stand under its name."""


def complete_step(ctx: click.Context, param: click.Parameter, incomplete: str) -> list[str]:
    """Return the steps whose names begin so, for the shell."""
    return [n for n in registry.installed().names("steps") if n.startswith(incomplete)]


@click.command()
@click.argument("words", metavar="[NAME|WORD]...", nargs=-1, shell_complete=complete_step)
@click.option("-s", "--search", is_flag=True, help="Search, even where a step has that name.")
def steps(words: tuple[str, ...], search: bool) -> None:
    """List the steps by plugin, describe NAME, or search for WORDs.

    A step in full is its ports, settings with ranges, outputs, and its use in a pipeline. A search
    finds the steps whose name, first line or settings mention every WORD, best first.
    """
    from tactile_graph.cli.terminal import console

    found = registry.installed()
    out = console()
    if not words:
        if out.width < NARROW:
            for step in _listed(found):
                out.print(step)
            return
        out.print(_list(found))
    elif len(words) == 1 and not search and found.has("steps", words[0]):
        from tactile_graph.cli.pages.step_page import step_page

        if sys.flags.optimize > 1:
            say("python -OO leaves out what a step says of itself: run without it", err=True)
        for part in step_page(found, words[0]):
            out.print(part)
    else:
        out.print(_hits(found, words))


def _listed(found: registry.Registry) -> Iterator[RenderableType]:
    """Yield each plugin's name, and its steps with what belongs to each beneath it."""
    from rich.padding import Padding
    from rich.text import Text

    for plugin in sorted(found.plugins, key=lambda p: p.name):
        if plugin.offers.get("steps"):
            yield Text(plugin.name, style="bold cyan")
        for name, target in sorted(plugin.offers.get("steps", {}).items()):
            yield Padding(Text(name, style="bold"), (0, 0, 0, 2), expand=False)
            for told in _told(target):
                yield Padding(told, (0, 0, 0, 4), expand=False)


def _told(target: Any) -> tuple[Text, Text]:
    """Return what a step takes and gives, and what it does, or what is wrong with it."""
    from rich.text import Text

    from tactile_graph.plugins.outline import outline

    step = outline(target)
    what = Text(step.trouble, style="red") if step.trouble else Text(_what(step.summary))
    return Text(step.wiring, style="dim"), what


def _list(found: registry.Registry) -> RenderableType:
    from rich import box
    from rich.table import Table
    from rich.text import Text

    table = Table(box=box.SIMPLE_HEAD, pad_edge=False)
    table.add_column("step", no_wrap=True)
    table.add_column("takes → gives", overflow="fold")
    table.add_column("what", overflow="fold")
    for plugin in sorted(found.plugins, key=lambda p: p.name):
        names = sorted(plugin.offers.get("steps", {}))
        if names:
            table.add_row(Text(plugin.name, style="bold cyan"), "", "")
        for i, name in enumerate(names):
            told = _told(plugin.offers["steps"][name])
            last = i == len(names) - 1
            table.add_row(Text(f"  {name}", style="bold"), *told, end_section=last)
    return table


def _what(summary: str) -> str:
    text = summary.replace("`", "").removeprefix("Return ").removesuffix(".")
    return text[:1].upper() + text[1:]


def _hits(found: registry.Registry, words: Sequence[str]) -> RenderableType:
    """Return a table of the steps that mention every word.

    Raises
    ------
    UsageError
        If there is none; says which names are near.
    """
    from tactile_graph.cli.pages.search import best_first

    hits = best_first(words, (_entry(found, name) for name in found.names("steps")))
    if not hits:
        said = " ".join(words)
        if len(words) == 1:
            raise UsageError(found.unknown("steps", said) + " (and none mentions it)")
        raise UsageError(f"no step mentions all of {said!r}; tactile-graph steps lists them")
    return _hit_table(hits)


def _hit_table(hits: Sequence[Hit]) -> RenderableType:
    from rich import box
    from rich.table import Table
    from rich.text import Text

    table = Table(box=box.SIMPLE_HEAD, pad_edge=False)
    table.add_column("step", style="bold", no_wrap=True)
    table.add_column("what", overflow="fold")
    table.add_column("settings about it", style="cyan", overflow="fold")
    for hit in hits:
        what = Text(_what(hit.entry.about))
        table.add_row(Text(hit.entry.name), what, Text(", ".join(hit.parts)))
    return table


def _entry(found: registry.Registry, name: str) -> Entry:
    """Return what to search of a step: its settings are known once it is imported."""
    from tactile_graph.cli.pages.search import Entry
    from tactile_graph.docstring import parameters
    from tactile_graph.plugins.outline import outline

    try:
        step = found.step(name)
    except TactileGraphError:
        return Entry(name, outline(found.offer("steps", name).target).summary, {})
    meanings = parameters(step.doc)
    settings = {s.name: meanings.get(s.name, s.meaning) for s in step.settings}
    return Entry(name, step.summary, settings)
