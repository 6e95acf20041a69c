"""``tactile-graph pipelines``: what there is and what evolved from what, a search, or a file."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass
from typing import TYPE_CHECKING

import click

from tactile_graph.cli.pages.listing import complete, file_text
from tactile_graph.cli.say import hand_over
from tactile_graph.errors import UsageError
from tactile_graph.plugins import registry
from tactile_graph.text_files import decoded

if TYPE_CHECKING:
    from rich.text import Text


@dataclass(frozen=True)
class Head:
    """What a pipeline file says of itself, and the steps and pipelines that its nodes use."""

    name: str
    about: str
    evolves: str
    plugin: str
    trouble: str = ""
    uses: tuple[str, ...] = ()


def heads(found: registry.Registry) -> list[Head]:
    """Return the heads of all pipelines on offer; no step is looked at."""
    return [_head(found, name) for name in found.names("pipelines")]


def _head(found: registry.Registry, name: str) -> Head:
    from tactile_graph.pipeline.declaration import declare
    from tactile_graph.pipeline.document import read_document

    offer = found.offer("pipelines", name)
    path = found.path("pipelines", name)
    try:
        document = read_document(decoded(path.read_bytes()), path.name)
    except (OSError, UnicodeDecodeError) as error:
        return Head(name, "", "", offer.plugin.name, f"cannot be read: {error}")
    declared = declare(document)
    trouble = str(document.problems[0]).partition("\n")[0] if document.problems else ""
    uses = dict.fromkeys(node.step or node.use or "" for node in declared.nodes.values())
    uses.pop("", None)
    parent = declared.evolves
    with suppress(UsageError):
        parent = found.spelled("pipelines", parent, str(path))
    return Head(name, declared.about, parent, offer.plugin.name, trouble, tuple(uses))


@click.command()
@click.argument("words", metavar="[NAME|WORD]...", nargs=-1,
                shell_complete=lambda c, p, word: complete("pipelines", word))  # fmt: skip
@click.option("-s", "--search", is_flag=True, help="Search, even where a pipeline has that name.")
def pipelines(words: tuple[str, ...], search: bool) -> None:
    """List the pipelines, each below the one it evolved from; or print NAME, or search for WORDs.

    NAME prints the file of a pipeline, from which one's own can be made. A search finds the
    pipelines whose name or line about it mentions every WORD, or whose nodes run such steps.
    """
    found = registry.installed()
    if not words:
        _show_tree(heads(found))
    elif len(words) == 1 and not search and found.has("pipelines", words[0]):
        hand_over(file_text(found.path("pipelines", words[0])))
    else:
        _show_hits(found, words)


def _show_hits(found: registry.Registry, words: Sequence[str]) -> None:
    """Print the pipelines that mention every word, best first.

    Raises
    ------
    UsageError
        If there is none; says which names are near.
    """
    from rich.text import Text

    from tactile_graph.cli.pages.search import Entry, best_first
    from tactile_graph.cli.terminal import console

    hits = best_first(words, (Entry(h.name, h.about, dict.fromkeys(h.uses, ""))
                              for h in heads(found)))  # fmt: skip
    if not hits:
        said = " ".join(words)
        if len(words) == 1:
            raise UsageError(found.unknown("pipelines", said) + " (and none mentions it)")
        raise UsageError(
            f"no pipeline mentions all of {said!r}; tactile-graph pipelines lists them"
        )
    out = console()
    width = max(len(hit.entry.name) for hit in hits)
    for hit in hits:
        text = Text.assemble((hit.entry.name.ljust(width), "bold"), f"  {hit.entry.about}")
        text.append(f"  runs {', '.join(hit.parts)}" if hit.parts else "", style="cyan")
        out.print(text, soft_wrap=True)


def _show_tree(found: list[Head]) -> None:
    from tactile_graph.cli.terminal import console

    out = console()
    names = {h.name for h in found}
    children: dict[str, list[Head]] = {}
    for head in found:
        children.setdefault(head.evolves if head.evolves in names else "", []).append(head)
    lines = _lines(children, "", "", set())
    lines += [("", h) for h in found if h.name not in {e.name for _, e in lines}]
    width = max((len(branch) + len(head.name) for branch, head in lines), default=0)
    several = len({h.plugin for h in found}) > 1
    for branch, head in lines:
        out.print(_line(branch, head, width, several), soft_wrap=True)
    if not lines:
        out.print("no plugin offers a pipeline")


def _line(branch: str, head: Head, width: int, several: bool) -> Text:
    from rich.text import Text

    text = Text.assemble((branch, "dim"), (head.name, "bold"))
    text.append(" " * (width - len(text.plain) + 2))
    if head.trouble:
        text.append(head.trouble, style="red")
    else:
        text.append(head.about)
    text.append(f"  ({head.plugin})" if several else "", style="cyan")
    return text


def _lines(
    children: dict[str, list[Head]], parent: str, indent: str, seen: set[str]
) -> list[tuple[str, Head]]:
    """Return the branch to draw and the head for each pipeline below a parent."""
    lines: list[tuple[str, Head]] = []
    below = [h for h in children.get(parent, []) if h.name not in seen]
    for i, head in enumerate(below):
        seen.add(head.name)
        last = i == len(below) - 1
        branch = indent + ("└─ " if last else "├─ ") if parent else ""
        lines.append((branch, head))
        deeper = indent + ("   " if last else "│  ") if parent else ""
        lines += _lines(children, head.name, deeper, seen)
    return lines
