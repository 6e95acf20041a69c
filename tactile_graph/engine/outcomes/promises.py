"""What steps promise to give, held against what they first give: type, quantity and shape.

An author who returns something else would otherwise get empty cells, or an error three steps
further on. Each node is checked once, at its first value, so that the frames to come pay nothing.
"""

from __future__ import annotations

import typing
from collections.abc import Callable, Iterable, Mapping, Sequence, Sized
from functools import partial
from math import isclose
from typing import Any, get_args, get_origin

import numpy as np

from tactile_graph.engine.outcomes.outcome import NO_VALUE, defined_at
from tactile_graph.engine.outcomes.outcomes import Outcomes
from tactile_graph.errors import PluginError
from tactile_graph.pipeline.graph import Node, NodeKind
from tactile_graph.pipeline.wiring import arms, public_fields
from tactile_graph.plugins.registry import Registry
from tactile_graph.steps.checks import odd_columns
from tactile_graph.steps.rules import Grid
from tactile_graph.steps.signature import Signature, list_item, type_name
from tactile_graph.wires.image import Image, Mask

MOST_ITEMS = 16
"""How many items of a list are looked at."""
_NUMBERS: dict[Any, tuple[type, ...]] = {
    bool: (bool, np.bool_),
    int: (int, np.integer),
    float: (int, float, np.integer, np.floating),
}


class Promises:
    """The promises of a pipeline's steps that no value has been held against yet.

    Parameters
    ----------
    nodes : iterable of Node
    registry : Registry, optional
        Names the plugin that a step is of.
    """

    def __init__(self, nodes: Iterable[Node], registry: Registry | None = None) -> None:
        self.waiting = [n for n in nodes if n.kind is NodeKind.STEP and not n.is_sink]
        self._registry = registry

    def check(self, result: Outcomes) -> None:
        """Hold the values of a frame against the promises that wait for one.

        Raises
        ------
        PluginError
            If a step gave something else than it promises.
        """
        for node in [*self.waiting]:
            value = result.outcome(node.name)
            if value.__class__ in NO_VALUE:
                continue
            broken = misfit(value, node.output) or absent_column(value)
            broken = broken or _of_node(node, value, result)
            if broken:
                raise PluginError(f"node {node.name!r}: {self._step(node)} {broken}")
            # Another thread may have checked it too, or put it back: then it is checked again.
            self.waiting = [n for n in self.waiting if n is not node]

    def _step(self, node: Node) -> str:
        signature = node.signature
        assert signature is not None
        known = self._registry is not None and self._registry.has("steps", signature.name)
        offer = self._registry.offer("steps", signature.name) if known and self._registry else None
        of = f" of {offer.plugin.label}" if offer is not None else ""
        place = defined_at(signature.target)
        return f"step {signature.name!r}{of}" + (f" ({place})" if place else "")


def misfit(value: Any, kind: Any) -> str:
    """Return what a type promises and the value is not; "" where it fits or nobody can tell."""
    if any(_fits(value, arm) for arm in arms(kind)):
        return _field_misfit(value, kind)
    return f"promises {type_name(kind)}, but gave {_described(value)}"


def _field_misfit(value: Any, kind: Any) -> str:
    """Return what is wrong with an output of a NamedTuple; None there means not known."""
    for name in getattr(kind, "_fields", ()):
        field = getattr(value, name)
        wrong = "" if field is None else misfit(field, public_fields(kind).get(name, Any))
        if wrong:
            return f"{wrong} as .{name}"
    return ""


def absent_column(value: Any) -> str:
    """Return which field its type says tables show and a record has not; "" where all are there.

    Of a list its items are looked at, of a named tuple its fields.
    """
    if isinstance(value, list | tuple):
        return next(filter(None, map(absent_column, value[:MOST_ITEMS])), "")
    odd = odd_columns(type(value), dir(value), partial(hasattr, value))
    return f"gave {type(value).__name__}, which {odd}" if odd else ""


def _fits(value: Any, arm: Any) -> bool:
    if arm in (Any, object) or isinstance(arm, typing.TypeVar):
        return True
    if arm is type(None) or arm is None:
        return value is None
    if arm in _NUMBERS:
        boolean = isinstance(value, bool | np.bool_)
        return isinstance(value, _NUMBERS[arm]) and (arm is bool or not boolean)
    if get_origin(arm) is typing.Literal:
        return value in get_args(arm)
    item = list_item(arm)
    if item is not None:
        return _is_list(value) and all(
            v.__class__ in NO_VALUE or not misfit(v, item) for v in list(value)[:MOST_ITEMS]
        )
    plain = get_origin(arm) or arm
    if plain is tuple and get_args(arm):
        parts = get_args(arm)
        return _is_list(value) and len(value) == len(parts) and not any(map(misfit, value, parts))
    try:
        return isinstance(value, plain)
    except TypeError:  # a protocol that can only be read by a type checker
        return True


def _is_list(value: Any) -> bool:
    listed = isinstance(value, Sequence | np.ndarray) or hasattr(value, "__getitem__")
    return listed and isinstance(value, Sized) and not isinstance(value, str | Mapping)


def _described(value: Any) -> str:
    name = type(value).__name__
    if isinstance(value, list | tuple) and value and not hasattr(value, "_fields"):
        kinds = dict.fromkeys(type(v).__name__ for v in value[:MOST_ITEMS])
        return f"a {name} of {', '.join(kinds)}"
    shape = getattr(getattr(value, "values", value), "shape", None)
    cells = f" of {' x '.join(map(str, shape))}" if isinstance(shape, tuple) and shape else ""
    return f"{name}{cells}"


# -- quantity and shape ----------------------------------------------------------------------


def broken_rule(
    signature: Signature, settings: Mapping[str, Any], given: Callable[[str], Any], value: Any
) -> str:
    """Return which rule of quantity or grid an image or mask breaks; "" where it breaks none.

    Parameters
    ----------
    signature : Signature
    settings : mapping
        Every setting of the step.
    given : callable
        Returns what came in at a port, None where nobody can tell.
    value : object
        What the step gave.
    """
    if not isinstance(value, Image | Mask):
        return ""
    if value.values.ndim != 2:
        return f"gave values of shape {value.values.shape}, not (rows, columns)"
    if value.values.dtype.kind not in "biuf":
        return f"gave values of type {value.values.dtype}, not numbers"
    wrong = _broken_grid(signature.output_grid, settings, given, value)
    rule = signature.output_quantity
    if wrong or rule is None or not isinstance(value, Image):
        return wrong
    came = given(rule.port)
    allowed = (came.quantity,) if isinstance(came, Image) else rule.names
    if not allowed or value.quantity in allowed:
        return ""
    return f"promises {' or '.join(allowed)}, but gave {value.quantity}"


def _broken_grid(
    grid: Grid | None, settings: Mapping[str, Any], given: Callable[[str], Any], value: Image | Mask
) -> str:
    came = given(grid.port) if grid is not None else None
    if grid is None or not isinstance(came, Image | Mask):
        return ""
    finer = grid.finer_by if isinstance(grid.finer_by, int) else settings[grid.finer_by]
    rows, columns = came.shape[0] * finer, came.shape[1] * finer
    if value.shape != (rows, columns):
        got = " x ".join(map(str, value.shape))
        return f"promises {rows} x {columns} cells, but gave {got}"
    x_cm, y_cm = came.pitch_cm[0] / finer, came.pitch_cm[1] / finer
    if isclose(value.pitch_cm[0], x_cm) and isclose(value.pitch_cm[1], y_cm):
        return ""
    got = " by ".join(f"{p:g}" for p in value.pitch_cm)
    return f"promises a pitch of {x_cm:g} by {y_cm:g} cm, but gave {got}"


def _of_node(node: Node, value: Any, result: Outcomes) -> str:
    if node.signature is None:
        return ""
    given = partial(_at_port, node, result=result)
    return broken_rule(node.signature, node.settings, given, value)


def _at_port(node: Node, port: str, result: Outcomes) -> Image | Mask | None:
    """Return the image a frame brought to a port; None where there is none to be had."""
    for binding in node.inputs:
        if binding.port.name == port and not binding.collects and not binding.iterates:
            value = result.outcome_at(binding.refs[0])
            return value if isinstance(value, Image | Mask) else None
    return None
