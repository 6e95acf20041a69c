"""What a shell completes a word to: pipelines, sources and their settings, nodes and theirs.

Completing tells no error: where something is wrong with the line so far, there is nothing to offer.
"""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from tactile_graph.errors import TactileGraphError
from tactile_graph.plugins import registry

if TYPE_CHECKING:
    from tactile_graph.api.pipeline import Pipeline


def complete_pipeline(ctx: click.Context, param: click.Parameter, incomplete: str) -> list[Any]:
    """Return pipeline names and YAML files that begin so."""
    names = [n for n in registry.installed().names("pipelines") if n.startswith(incomplete)]
    return names + [str(p) for p in Path().glob(f"{incomplete}*.y*ml")]


def complete_source(ctx: click.Context, param: click.Parameter, incomplete: str) -> list[str]:
    """Return the source steps that begin so."""
    names = _beginning(registry.installed().names("steps"), incomplete)
    return [name for name in names if is_source(name)]


def is_source(step: str) -> bool:
    """Return whether a step that is there yields frames; it is not imported for that."""
    from tactile_graph.plugins.outline import outline

    return outline(registry.installed().offer("steps", step).target).kind == "source"


def complete_with(ctx: click.Context, param: click.Parameter, incomplete: str) -> list[str]:
    """Return ``KEY=`` of the source's settings: the one named, the pipeline's, or what reads."""
    found = registry.installed()
    step = ctx.params.get("source")
    pipeline = None if step or len(_words(ctx)) > 1 else _pipeline(ctx)  # a recording is read
    if pipeline is not None and pipeline.source is not None:
        step = pipeline.source.name
    step = step or found.reader()
    if step is None or not found.has("steps", step):
        return []
    return _beginning((f"{s.name}=" for s in found.step(step).settings), incomplete)


def complete_set(ctx: click.Context, param: click.Parameter, incomplete: str) -> list[str]:
    """Return ``NODE.SETTING=`` of the pipeline's nodes; of several pipelines, the first one's."""
    pipeline = _pipeline(ctx)
    if pipeline is None:
        return []
    words = (
        f"{node.name}.{setting.name}="
        for node in pipeline.nodes.values() if node.signature is not None
        for setting in node.signature.settings
    )  # fmt: skip
    return _beginning(words, incomplete)


def complete_node(ctx: click.Context, param: click.Parameter, incomplete: str) -> list[str]:
    """Return the nodes of the pipeline, and the frame."""
    pipeline = _pipeline(ctx)
    return [] if pipeline is None else _beginning(["frame", *pipeline.nodes], incomplete)


def _beginning(words: Iterable[str], incomplete: str) -> list[str]:
    return [word for word in words if word.startswith(incomplete)]


def _words(ctx: click.Context) -> list[str]:
    """Return the words of the line that belong to no option.

    Where an option still waits for its value, click has not given them to the arguments yet.
    """
    found: list[str] = list(ctx.args)
    for param in ctx.command.params if not found else ():
        value = ctx.params.get(param.name or "")
        if isinstance(param, click.Argument) and value:
            found += [value] if isinstance(value, str) else map(str, value)
    return found


def _pipeline(ctx: click.Context) -> Pipeline | None:
    """Return the pipeline that the line names, if it is right."""
    from tactile_graph.api.pipeline import load

    words = _words(ctx)
    try:
        return load(words[0]) if words else None
    except TactileGraphError:
        return None
