"""A pipeline as the page has it: boxes and wires, settings with their ranges, columns."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from tactile_graph import Pipeline
from tactile_graph.docstring import parameters
from tactile_graph.draw.blocks import blocks, wires
from tactile_graph.foreign_text import visible
from tactile_graph.inspect import Graph, Node, make_table, plain
from tactile_graph.quantities import unit_of
from tactile_graph.steps.settings import adapter
from tactile_graph.steps.signature import REQUIRED
from tactile_graph.steps.signature import Setting as StepSetting
from tactile_graph.vocabulary import words_and_unit
from tactile_graph_live.server import messages

Overrides = Mapping[str, Mapping[str, Any]]
LARGEST = 1e300
"""Of a slider's ends: beyond, their distance is no number."""


def graph_message(
    pipeline: Pipeline, version: int, texts: tuple[str, str], changed: Overrides
) -> messages.Graph:
    """Return what the page knows of a pipeline.

    Parameters
    ----------
    pipeline : Pipeline
    version : int
    texts : (str, str)
        The YAML with what was set on the page, and without.
    changed : mapping
        Node -> setting -> value of what was set on the page.
    """
    return messages.Graph(
        version,
        visible(pipeline.name),
        visible(pipeline.about),
        *texts,
        tuple(messages.Box(b.key, visible(b.step or b.title), b.role) for b in blocks(pipeline)),
        tuple(messages.Wire(w.start, w.end, w.kind) for w in wires(pipeline)),
        tuple(_node(name, n, changed.get(name, {})) for name, n in _nodes(pipeline)),
        tuple(pipeline.outputs),
        tuple(_columns(pipeline)),
    )


def _columns(pipeline: Pipeline) -> Iterator[messages.Column]:
    for column in make_table(pipeline, tuple(pipeline.outputs), True).columns:
        words, unit = words_and_unit(column.key)
        units = {
            of_frames: unit_of(its) for of_frames, its in (column.quantities or {}).items() if its
        }
        yield messages.Column(column.key, words, unit or column.unit, units)


# -- settings ------------------------------------------------------------------------------------


def _nodes(graph: Graph, prefix: str = "") -> Iterator[tuple[str, Node]]:
    """Yield each node by the name that ``--set`` knows it by, also those run over a list."""
    for node in graph.nodes.values():
        if not prefix or node.signature is not None:
            yield prefix + node.name, node
        if node.inner is not None:
            yield from _nodes(node.inner, f"{prefix}{node.name}/")


def _node(name: str, node: Node, changed: Mapping[str, Any]) -> messages.Node:
    signature = node.signature
    meanings = parameters(signature.doc) if signature else {}
    settings = tuple(
        setting_message(s, node.settings.get(s.name), meanings.get(s.name, ""), s.name in changed)
        for s in (signature.settings if signature else ())
    )
    about = signature.summary if signature else ""
    guard = visible(node.guard.text) if node.guard else ""
    return messages.Node(
        name, visible(node.what), visible(about), guard, node.stateful, settings, _apart(node)
    )


def _apart(node: Node) -> messages.Apart | None:
    isolation = node.isolation
    if isolation is None:
        return None
    return messages.Apart(visible(isolation.process), isolation.time_limit_s)


def setting_message(
    setting: StepSetting, value: Any, meaning: str, changed: bool
) -> messages.Setting:
    """Return a setting as the page shows it: a slider, a box to tick, a choice or a text."""
    schema = _schema(setting)
    default = None if setting.default is REQUIRED else setting.default
    kind, choices = _kind(schema, value)
    low, high = _bound(schema, "inimum"), _bound(schema, "aximum")
    _, unit = words_and_unit(setting.name)
    slider: tuple[float | None, float | None, float | None] = (None, None, None)
    if kind in ("number", "integer"):
        slider = _slider(kind, [v for v in (value, default) if _is_number(v)], low, high)
    return messages.Setting(
        name=setting.name,
        kind=kind,
        value=_shown(value, kind),
        default=_shown(default, kind),
        low=low,
        high=high,
        slider_low=slider[0],
        slider_high=slider[1],
        step=slider[2],
        choices=choices,
        unit=unit,
        help=visible(meaning or setting.meaning),
        changed=changed,
    )


def _schema(setting: StepSetting) -> dict[str, Any]:
    """Return what may stand there, as JSON Schema has it; empty where that is not known."""
    try:
        schema = adapter(setting).json_schema()
    except Exception:  # a type of a plugin's own that has no schema
        return {}
    arms = [a for a in schema.get("anyOf", [schema]) if a.get("type") != "null"]
    return arms[0] if len(arms) == 1 else {}


def _kind(schema: dict[str, Any], value: Any) -> tuple[str, tuple[Any, ...]]:
    if "enum" in schema:
        return "choice", tuple(schema["enum"])
    kind = schema.get("type")
    if kind in ("number", "integer", "boolean"):
        return str(kind), ()
    return "text", ()


def _bound(schema: dict[str, Any], word: str) -> float | None:
    start = word[0]
    for name in (f"m{start.lower()}{word[1:]}", f"exclusiveM{start.lower()}{word[1:]}"):
        if name in schema:
            return float(schema[name])
    return None


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)


def _slider(
    kind: str, values: list[Any], low: float | None, high: float | None
) -> tuple[float, float, float]:
    """Return where a slider begins and ends, and its step: the allowed range, if that is of use.

    An open or very wide one is cut to some times what the value is.
    """
    values = [max(-LARGEST, min(LARGEST, v)) for v in values]
    size = max((abs(float(v)) for v in values), default=0.0) or 1.0
    first = low if low is not None and low >= -4 * size else (-4 * size if low != 0.0 else 0.0)
    if low is None and all(float(v) >= 0 for v in values):
        first = 0.0
    last = high if high is not None and high <= 20 * size else max(4 * size, first + size)
    if kind == "integer":
        return float(round(first)), float(round(last)), 1.0
    step = 10.0 ** (len(str(int(last - first))) - 3) if last - first >= 1 else (last - first) / 200
    return first, last, step


def _shown(value: Any, kind: str) -> Any:
    if value is None or kind in ("number", "integer", "boolean", "choice"):
        return plain(value)
    return value if isinstance(value, str) else visible(_yaml(plain(value)))


def _yaml(value: Any) -> str:
    from tactile_graph.pipeline.document import in_yaml

    return in_yaml(value, default_flow_style=True, width=10**6).strip().removesuffix("\n...")
