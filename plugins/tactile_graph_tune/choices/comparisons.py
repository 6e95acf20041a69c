"""The comparisons a guard is made of, taken out of its text and put back."""

from __future__ import annotations

import ast
import math
from collections.abc import Collection, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tactile_graph.inspect import one_line

SIGNS = {ast.Lt: "<", ast.LtE: "<=", ast.Gt: ">", ast.GtE: ">=", ast.Eq: "==", ast.NotEq: "!="}
HOLDS, HOLDS_NOT = "is true", "is false"
"""Signs of a field that is true or false by itself: the guard names it, or says ``not``."""
_COMPARED = {
    "<": np.less, "<=": np.less_equal, ">": np.greater, ">=": np.greater_equal,
    "==": np.equal, "!=": np.not_equal, HOLDS: np.not_equal, HOLDS_NOT: np.equal,
}  # fmt: skip


class Comparison(NamedTuple):
    """A field held against a number: ``mask.count > 12``.

    Several of one node's that are joined by ``or`` are a field as well, true or false:
    ``(mask.count > 12 or mask.area_cm2 > 9)``. It is asked as it stands, or not at all.
    """

    field: str
    sign: str
    level: float

    @property
    def node(self) -> str:
        """The node whose field it is."""
        return node_of(self.field)

    @property
    def text(self) -> str:
        """The comparison as a guard has it."""
        if self.sign in (HOLDS, HOLDS_NOT):
            return self.field if self.sign == HOLDS else f"not {self.field}"
        return f"{self.field} {self.sign} {self.level:.12g}"

    def of(self, values: NDArray[np.float64]) -> NDArray[np.bool_]:
        """Return for which values it holds; never for NaN, shape (n_frames,)."""
        holds: NDArray[np.bool_] = _COMPARED[self.sign](values, self.level)
        return holds & ~np.isnan(values)


class Taken(NamedTuple):
    """A guard taken apart: all parts must hold."""

    comparisons: tuple[Comparison, ...]
    named: tuple[str, ...]
    fixed: tuple[str, ...]
    """Parts that are no comparison of a node's field with a number."""


def node_of(field: str) -> str:
    """Return the node whose field it is."""
    return field.lstrip("(").partition(".")[0]


def alternatives(field: str) -> tuple[Comparison, ...]:
    """Return the comparisons that a field joins by ``or``; none of a field of the node itself."""
    if not field.startswith("("):
        return ()
    tree = ast.parse(field, mode="eval").body
    assert isinstance(tree, ast.BoolOp)
    found = (_comparison(part, {node_of(field)}) for part in tree.values)
    return tuple(c for c in found if c is not None)


def one_of_them(parts: Sequence[Comparison]) -> Comparison:
    """Return the comparison that joins some of one node's by ``or``."""
    return Comparison(f"({' or '.join(part.text for part in parts)})", HOLDS, 0.0)


def taken_apart(text: str, nodes: Collection[str], conditions: Mapping[str, str]) -> Taken:
    """Return the parts of a condition that all must hold.

    Parameters
    ----------
    text : str
        A condition that has been found right.
    nodes : collection of str
        Nodes whose fields may be compared with another number.
    conditions : mapping
        Named conditions; those made of comparisons alone are told by name.
    """
    comparisons, named, fixed = [], [], []
    for part in _parts(text):
        found = _comparison(part, nodes)
        if found is not None:
            comparisons.append(found)
        elif isinstance(part, ast.Name) and is_free(conditions.get(part.id, ""), nodes):
            named.append(part.id)
        else:
            fixed.append(ast.unparse(part))
    return Taken(tuple(comparisons), tuple(named), tuple(fixed))


def is_free(text: str, nodes: Collection[str]) -> bool:
    """Return whether a condition is made of comparisons alone."""
    return bool(text) and all(_comparison(part, nodes) is not None for part in _parts(text))


def _parts(text: str) -> list[ast.expr]:
    tree = ast.parse(one_line(text), mode="eval").body
    return tree.values if isinstance(tree, ast.BoolOp) and isinstance(tree.op, ast.And) else [tree]


def _comparison(part: ast.expr, nodes: Collection[str]) -> Comparison | None:
    if isinstance(part, ast.BoolOp):
        joined = [_comparison(its, nodes) for its in part.values]
        of = {c.node if c is not None else "" for c in joined}
        plain = all(not isinstance(its, ast.BoolOp) for its in part.values)
        one = plain and len(of) == 1 and "" not in of and isinstance(part.op, ast.Or)
        return Comparison(f"({ast.unparse(part)})", HOLDS, 0.0) if one else None
    if isinstance(part, ast.UnaryOp) and isinstance(part.op, ast.Not):
        field = _field(part.operand, nodes)
        return Comparison(field, HOLDS_NOT, 0.0) if field else None
    if isinstance(part, ast.Compare) and len(part.ops) == 1:
        field, level = _field(part.left, nodes), _number(part.comparators[0])
        sign = SIGNS.get(type(part.ops[0]))
        return Comparison(field, sign, level) if field and sign and math.isfinite(level) else None
    field = _field(part, nodes)
    return Comparison(field, HOLDS, 0.0) if field else None


def _field(part: ast.expr, nodes: Collection[str]) -> str:
    """Return the reference that an expression is; empty if it is none to a node."""
    names: list[str] = []
    while isinstance(part, ast.Attribute):
        names.append(part.attr)
        part = part.value
    known = isinstance(part, ast.Name) and part.id in nodes
    return ".".join([part.id, *reversed(names)]) if known and isinstance(part, ast.Name) else ""


def _number(part: ast.expr) -> float:
    try:
        value: Any = ast.literal_eval(part)
    except ValueError:
        return math.nan
    is_number = isinstance(value, int | float) and not isinstance(value, bool)
    return float(value) if is_number else math.nan
