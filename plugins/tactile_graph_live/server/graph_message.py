"""A pipeline as the page has it: boxes and wires, settings with their ranges, columns."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from itertools import pairwise
from typing import Any

from tactile_graph import Pipeline
from tactile_graph.docstring import parameters
from tactile_graph.draw.blocks import blocks, wires
from tactile_graph.draw.layers import Joint
from tactile_graph.draw.layout import Point, layout
from tactile_graph.foreign_text import visible
from tactile_graph.inspect import Node, make_table, plain
from tactile_graph.steps.settings import adapter
from tactile_graph.steps.signature import REQUIRED
from tactile_graph.steps.signature import Setting as StepSetting
from tactile_graph.vocabulary import words_and_unit
from tactile_graph_live.server import messages

BOX_PX = (150.0, 150.0)
SMALL_BOX_PX = (110.0, 64.0)
LONGEST_LABEL = 40
Overrides = Mapping[str, Mapping[str, Any]]


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
    shown, joined = blocks(pipeline), wires(pipeline)
    sizes = {b.key: SMALL_BOX_PX if b.role == "source" else BOX_PX for b in shown}
    placed = layout(sizes, [Joint(w.start, w.end, _room(w.label), _pull(w.kind)) for w in joined])
    boxes = []
    for block in shown:
        at = placed.boxes[block.key]
        sources = tuple(dict.fromkeys(w.start for w in joined if w.end == block.key))
        boxes.append(messages.Box(block.key, visible(block.step or block.title), block.role,
                                  at.x, at.y, at.width, at.height, sources))  # fmt: skip
    return messages.Graph(
        version,
        visible(pipeline.name),
        visible(pipeline.about),
        *texts,
        tuple(boxes),
        tuple(
            messages.Wire(w.start, w.end, w.kind, visible(w.label)[:LONGEST_LABEL], _path(route))
            for w, route in zip(joined, placed.routes, strict=True)
        ),
        placed.width,
        placed.height,
        tuple(_node(n, changed.get(n.name, {})) for n in pipeline.nodes.values()),
        tuple(pipeline.outputs),
        tuple(_columns(pipeline)),
    )


def _room(label: str) -> float:
    return 7.0 * min(len(label), LONGEST_LABEL) + 14 if label else 0.0


def _pull(kind: str) -> float:
    return 0.01 if kind == "guard" else 1.0  # what the data goes through stays in line


def _path(route: tuple[Point, ...]) -> str:
    """Return a wire as the path of an SVG; every other piece of it is straight."""
    told = [f"M{route[0].x:.1f} {route[0].y:.1f}"]
    for number, (a, b) in enumerate(pairwise(route)):
        if number % 2 or a.y == b.y:
            told.append(f"L{b.x:.1f} {b.y:.1f}")
        else:
            half = (a.x + b.x) / 2
            told.append(f"C{half:.1f} {a.y:.1f} {half:.1f} {b.y:.1f} {b.x:.1f} {b.y:.1f}")
    return "".join(told)


def _columns(pipeline: Pipeline) -> Iterator[messages.Column]:
    for column in make_table(pipeline, tuple(pipeline.outputs), True).columns:
        words, unit = words_and_unit(column.key)
        yield messages.Column(column.key, words, unit or column.unit)


# -- settings ------------------------------------------------------------------------------------


def _node(node: Node, changed: Mapping[str, Any]) -> messages.Node:
    signature = node.signature
    meanings = parameters(signature.doc) if signature else {}
    settings = tuple(
        setting_message(s, node.settings.get(s.name), meanings.get(s.name, ""), s.name in changed)
        for s in (signature.settings if signature else ())
    )
    about = signature.summary if signature else ""
    guard = visible(node.guard.text) if node.guard else ""
    return messages.Node(node.name, visible(node.what), visible(about), guard, settings)


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
    import yaml

    return (
        str(yaml.safe_dump(value, default_flow_style=True, width=10**6))
        .strip()
        .removesuffix("\n...")
    )
