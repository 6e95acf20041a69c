"""``tactile-graph pipelines``: what there is, and what evolved from what."""

from __future__ import annotations

from dataclasses import dataclass

import click

from tactile_graph.plugins import registry


@dataclass(frozen=True)
class Head:
    """What the head of a pipeline file says."""

    name: str
    about: str
    evolves: str
    plugin: str
    trouble: str = ""


def heads(found: registry.Registry) -> list[Head]:
    """Return the heads of all pipelines on offer; no step is looked at."""
    return [_head(found, name) for name in found.names("pipelines")]


def _head(found: registry.Registry, name: str) -> Head:
    from tactile_graph.pipeline.declaration import declare
    from tactile_graph.pipeline.document import read_document

    offer = found.offer("pipelines", name)
    path = found.path("pipelines", name)
    try:
        document = read_document(path.read_text(encoding="utf-8-sig"), path.name)
    except (OSError, UnicodeDecodeError) as error:
        return Head(name, "", "", offer.plugin.name, f"cannot be read: {error}")
    declared = declare(document)
    trouble = str(document.problems[0]).partition("\n")[0] if document.problems else ""
    return Head(name, declared.about, declared.evolves, offer.plugin.name, trouble)


@click.command()
def pipelines() -> None:
    """List the pipelines, each below the one it evolved from."""
    from rich.text import Text

    from tactile_graph.cli.terminal import console

    out = console()
    found = heads(registry.installed())
    names = {h.name for h in found}
    children: dict[str, list[Head]] = {}
    for head in found:
        children.setdefault(head.evolves if head.evolves in names else "", []).append(head)
    lines = _lines(children, "", "", set())
    lines += [("", h) for h in found if h.name not in {e.name for _, e in lines}]
    width = max((len(branch) + len(head.name) for branch, head in lines), default=0)
    several = len({h.plugin for h in found}) > 1
    for branch, head in lines:
        text = Text.assemble((branch, "dim"), (head.name, "bold"))
        text.append(" " * (width - len(text.plain) + 2))
        if head.trouble:
            text.append(head.trouble, style="red")
        else:
            text.append(head.about)
        text.append(f"  ({head.plugin})" if several else "", style="cyan")
        out.print(text, soft_wrap=True)
    if not lines:
        out.print("no plugin offers a pipeline")


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
