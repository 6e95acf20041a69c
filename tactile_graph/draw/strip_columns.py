"""Which nodes a picture strip shows, what each column is called, and its fixed colour range."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from tactile_graph.draw.display import drawn_of, images_in, is_picture
from tactile_graph.engine.operations.fields import field_getter
from tactile_graph.engine.outcomes.outcome import NO_VALUE, NOT_ASKED
from tactile_graph.engine.outcomes.outcomes import Outcomes
from tactile_graph.pipeline.graph import FRAME, Graph, NodeKind
from tactile_graph.quantities import unit_of

MOST_COLUMNS = 10


@dataclass(frozen=True)
class Column:
    """One column: what is drawn in it, its step, the range and quantity of its images."""

    name: str
    step: str
    low: float = 0.0
    high: float = 1.0
    quantity: str = ""

    @property
    def scale(self) -> str:
        """Label of the colour bar: the unit, or the quantity that is its own; not both."""
        return unit_of(self.quantity)


def columns(results: Sequence[Outcomes], nodes: Sequence[str] | None) -> list[Column]:
    """Return the columns to draw; without ``nodes`` the frame and every node with a picture.

    Raises
    ------
    UsageError
        If a node or output is not there.
    """
    pipeline = results[0].plan.pipeline
    names = _picturable(results, pipeline) if nodes is None else list(dict.fromkeys(nodes))
    return [_column(name, results, pipeline) for name in names]


def outcome_of(result: Outcomes, name: str) -> Any:
    """Return the outcome of a node, an output, or the frame itself."""
    if name == FRAME:
        return result.frame
    asked = name in result.plan.asked or name in result.plan.slots
    if asked or name in result.plan.pipeline.nodes:
        return result.outcome(name)
    ref = result.plan.pipeline.ref(name)  # a field of a node that nobody asked for by name
    if ref.node == FRAME:
        value: Any = result.frame
    else:
        value = result.outcome(ref.node)
    return value if value.__class__ in NO_VALUE or ref.whole else field_getter(ref)(value)


def _picturable(results: Sequence[Outcomes], pipeline: Graph) -> list[str]:
    found = [n for n in pipeline.nodes if _worth_a_column(n, results, pipeline)]
    outputs = {ref.node for ref in pipeline.outputs.values()}
    spare = len(found) + 1 - MOST_COLUMNS
    if spare > 0:
        middle = [n for n in found if n not in outputs]
        # Of a long chain its beginning says least about the answer.
        dropped = set(middle[:spare])
        found = [n for n in found if n not in dropped]
    return [FRAME, *found[: MOST_COLUMNS - 1]]


def _worth_a_column(name: str, results: Sequence[Outcomes], pipeline: Graph) -> bool:
    node = pipeline.nodes[name]
    outcomes = [r.outcome(name) for r in results]
    if all(o is NOT_ASKED for o in outcomes):
        return False
    if node.kind is NodeKind.PASS and node.choices[0].node in pipeline.nodes:
        return False  # it shows what the node it hands on shows
    values = [o for o in outcomes if o.__class__ not in NO_VALUE]
    if not values:
        return not node.is_sink and not _is_scalar_type(node.output)
    with drawn_of(name):
        return any(is_picture(v) for v in values)


def _is_scalar_type(kind: Any) -> bool:
    return isinstance(kind, type) and issubclass(kind, bool | int | float | str | np.generic)


def _column(name: str, results: Sequence[Outcomes], pipeline: Graph) -> Column:
    with drawn_of(name):
        images = [i for r in results for i in images_in(outcome_of(r, name))]
    node = pipeline.nodes.get(name)
    step = "" if node is None else "first of" if node.choices else node.what
    if not images:
        return Column(name, step)
    shown = [i.values if i.valid is None else i.values[i.valid] for i in images]
    low = min((float(v.min()) for v in shown if v.size), default=0.0)
    high = max((float(v.max()) for v in shown if v.size), default=1.0)
    low = min(low, 0.0)  # a pad's values are read from nothing up
    return Column(name, step, low, high if high > low else low + 1.0, images[0].quantity)
