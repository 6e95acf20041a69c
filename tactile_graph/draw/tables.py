"""Tables for terminals and notebooks: what a pipeline is, what a frame came to."""

from __future__ import annotations

import textwrap
from typing import TYPE_CHECKING, Any

from rich import box
from rich.table import Table
from rich.text import Text

from tactile_graph.engine.outcomes.outcome import Done, Failed, gaps, outcome_word, with_value
from tactile_graph.engine.tables.rows import scalars
from tactile_graph.pipeline.graph import Node, NodeKind
from tactile_graph.pipeline.plain import plain
from tactile_graph.steps.signature import type_name
from tactile_graph.vocabulary import words_and_unit

if TYPE_CHECKING:
    from tactile_graph.engine.outcomes.outcomes import Explained, Outcomes
    from tactile_graph.pipeline.graph import Graph

STATES = {"ran": "green", "reused": "cyan", "skipped": "yellow", "failed": "bold red"}
LONGEST_SETTING = 30


def pipeline_table(pipeline: Graph) -> Table:
    """Return a table of a pipeline's nodes: step, what it reads, settings, guard, output."""
    title = Text(pipeline.name, style="bold")
    if pipeline.about:
        title.append(f" — {pipeline.about}", style="not bold")
    table = Table(title=title, title_justify="left", box=box.SIMPLE_HEAD, pad_edge=False)
    table.add_column("node", style="bold", no_wrap=True)
    for name in ("step", "reads", "settings", "when", "gives"):
        table.add_column(name)
    asked = {ref.node for ref in pipeline.outputs.values()}
    for name, node in pipeline.nodes.items():
        style = "dim" if name in pipeline.unused else ""
        shown = Text(name + (" *" if name in asked else ""))
        guard = node.guard.text if node.guard else ""
        gives = "" if node.is_sink else type_name(node.output)
        table.add_row(shown, node.what, _reads(node), _settings(node), guard, gives, style=style)
    source = pipeline.source
    said = "no source" if source is None else f"source {source.name}{_given(source)}"
    evolves = f", evolves {pipeline.evolves}" if pipeline.evolves else ""
    table.caption = Text(f"* output; {said}{evolves}", style="dim")
    table.caption_justify = "left"
    return table


def _reads(node: Node) -> str:
    if node.kind is NodeKind.FIRST_OF:
        return ""
    wires = [(b.port.name, ", ".join(str(r) for r in b.refs)) for b in node.inputs]
    if len(wires) == 1:
        return wires[0][1]
    return "\n".join(f"{port}: {refs}" for port, refs in wires) or ", ".join(map(str, node.choices))


def _settings(node: Node) -> str:
    signature = node.signature
    if signature is None:
        return ""
    defaults = {s.name: s.default for s in signature.settings}
    changed = {k: v for k, v in node.settings.items() if not _same(v, defaults.get(k))}
    return "\n".join(f"{k}: {_short(v)}" for k, v in changed.items())


def _given(source: Any) -> str:
    defaults = {s.name: s.default for s in source.signature.settings}
    changed = {k: v for k, v in source.settings.items() if not _same(v, defaults.get(k))}
    return f" ({', '.join(f'{k}: {_short(v)}' for k, v in changed.items())})" if changed else ""


def _same(a: Any, b: Any) -> bool:
    return a is b or (type(a) is type(b) and plain(a) == plain(b))


def _short(value: Any) -> str:
    value = plain(value)
    text = "none" if value is None else str(value).lower() if isinstance(value, bool) else (
        f"{value:g}" if isinstance(value, float) else str(value))  # fmt: skip
    return textwrap.shorten(text, LONGEST_SETTING, placeholder="…")


def result_table(result: Outcomes) -> Table:
    """Return a table of a frame's nodes: state, time, and the value or why there is none."""
    table = Table(box=box.SIMPLE_HEAD, pad_edge=False)
    table.add_column("node", style="bold", no_wrap=True)
    table.add_column("step", style="dim", overflow="fold")
    table.add_column("state", no_wrap=True)
    table.add_column("µs", justify="right", no_wrap=True)
    table.add_column("value, or why there is none", overflow="fold")
    total = 0.0
    for story in result.explain():
        total += story.time_us
        spent = f"{story.time_us:.1f}" if story.time_us else ""
        name = f"{story.node} *" if story.node in result.plan.asked else story.node
        state = Text(story.state, style=STATES[story.state])
        table.add_row(name, story.step, state, spent, _story(result, story))
    ran = sum(s.state == "ran" for s in result.explain())
    asked = ", ".join(result.plan.asked)
    table.caption = Text(f"{ran} nodes ran in {total:.1f} µs; * asked for: {asked}", style="dim")
    table.caption_justify = "left"
    return table


def _story(result: Outcomes, story: Explained) -> Text:
    if story.state in ("ran", "reused"):
        return Text(summary(story.value))
    text = Text(story.reason, style=STATES[story.state])
    outcome = result.outcome(story.node)
    if isinstance(outcome, Failed) and outcome.origin == story.node:
        if outcome.where:
            text.append(f"\nat {outcome.where}", style="dim")
        if outcome.inputs:
            text.append(f"\nwith {outcome.inputs}", style="dim")
    return text


def summary(value: Any) -> str:
    """Return a value in a line: shape and size of images and lists, fields of records."""
    if isinstance(value, Done):
        return "done"
    if isinstance(value, bool | int | str):
        return textwrap.shorten(str(value), 80, placeholder="…")
    if isinstance(value, float):
        return f"{value:.6g}"
    if isinstance(value, tuple | list) and not hasattr(value, "_fields"):
        items = with_value(value)
        inner = f": {summary(items[0])}" if len(items) == 1 else ""
        lacking = f"; {outcome_word(value)}" if gaps(value) else ""
        return f"{len(items)} × {type(items[0]).__name__}{inner}{lacking}" if items else "no items"
    if hasattr(value, "rows") and hasattr(value, "columns"):
        return f"{type(value).__name__} {value.rows} x {value.columns}, {_fields(value)}"
    fields = _fields(value)
    return f"{type(value).__name__}: {fields}" if fields else repr(value)


def _fields(value: Any) -> str:
    found = []
    for key, scalar in scalars("v", value).items():
        words, unit = words_and_unit(key.removeprefix("v").lstrip("."))
        number = f"{scalar:.5g}" if isinstance(scalar, float) else str(scalar)
        found.append(" ".join(part for part in (words, number, unit) if part))
    return ", ".join(found)
