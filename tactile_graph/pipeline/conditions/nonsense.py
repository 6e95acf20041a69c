"""Parts of conditions that come out the same in every frame, or fail in every one."""

from __future__ import annotations

import ast
from collections.abc import Callable, Iterator
from itertools import pairwise
from typing import Any, Literal, Protocol, get_args, get_origin

from tactile_graph.errors import did_you_mean
from tactile_graph.pipeline.conditions.comparable import is_scalar, sort_of
from tactile_graph.pipeline.conditions.over_items import OVER_ITEMS
from tactile_graph.pipeline.wiring import arms
from tactile_graph.steps.signature import list_item, strip

FUNCTIONS: dict[str, Callable[..., Any]] = {
    "abs": abs, "len": len, "max": max, "min": min, **OVER_ITEMS
}  # fmt: skip
NEVER_NEGATIVE = ("len", "abs", "count")
_HOLDS: dict[type, Callable[[float], bool]] = {
    ast.Lt: lambda limit: limit <= 0, ast.LtE: lambda limit: limit < 0,
    ast.Eq: lambda limit: limit < 0, ast.GtE: lambda limit: limit <= 0,
    ast.Gt: lambda limit: limit < 0, ast.NotEq: lambda limit: limit < 0,
}  # fmt: skip
"""Whether comparing what is never negative with a number comes out the same, by the sign."""


class Reading(Protocol):
    """What a condition reads: of which type each part is, and how the file spells it."""

    def kind(self, node: ast.expr) -> Any:
        """Return the type of a node's field; None for any other part."""

    def spell(self, node: ast.expr) -> str:
        """Return a part as the file has it."""


def no_truth(node: ast.expr, reading: Reading) -> str:
    """Return why a part of a condition is no yes or no that a frame decides; "" if it may be."""
    if isinstance(node, ast.Tuple | ast.List):
        return (
            "this is a list, which is always true: a list stands behind 'in', and the decimals of "
            "a number behind a point"
        )
    if isinstance(node, ast.Constant) and isinstance(node.value, bool):
        return ""
    if any(True for _ in _read(node)):
        return ""
    alone = isinstance(node, ast.Constant)
    return _always(node, reading) + ("; what is it to be compared with?" if alone else "")


def no_arithmetic(node: ast.BinOp, reading: Reading) -> str:
    """Return why something cannot be reckoned with; "" where it may be.

    A few signs of texts and lists can ask for all memory there is.
    """
    for side in (node.left, node.right):
        for part, its_items in _outcomes(side):
            kinds = arms(reading.kind(part))
            if its_items:
                kinds = tuple(k for kind in kinds for k in arms(list_item(kind) or kind))
            if isinstance(part, ast.Tuple | ast.List) or any(map(list_item, kinds)):
                return "arithmetic takes numbers, not a list"
            if _sort(part, reading) == "text" or "text" in map(sort_of, kinds):
                return f"arithmetic takes numbers, and {reading.spell(part)} is a text"
    return ""


def _outcomes(node: ast.expr, its_items: bool = False) -> Iterator[tuple[ast.expr, bool]]:
    """Yield the parts one of which a part comes out as; of each whether its items are meant."""
    if isinstance(node, ast.BoolOp):
        parts = [(part, False) for part in node.values]
    elif isinstance(node, ast.Tuple | ast.List) and its_items:
        parts = [(part, False) for part in node.elts]
    elif isinstance(node, ast.Call) and ast.unparse(node.func) in ("max", "min"):
        parts = [(part, len(node.args) == 1) for part in node.args]
    else:
        yield node, its_items
        return
    for part in parts:
        yield from _outcomes(*part)


def no_call(name: str, given: list[ast.expr], reading: Reading) -> str:
    """Return why a function cannot be told of what it is given; "" where it may be."""
    sort, spelled = _sort(given[0], reading), reading.spell(given[0])
    if name == "len" and sort == "number":
        return f"len() counts the items of a list, and {spelled} is a number"
    if name == "abs" and sort == "text":
        return f"abs() takes a number, and {spelled} is a text"
    if name in ("max", "min") and len(given) == 1 and sort == "number":
        return f"{name}() takes several numbers, or a list of them, and {spelled} is one number"
    return ""


def nonsense(node: ast.Compare, reading: Reading) -> str:
    """Return why a comparison never tells frames apart; "" where it may."""
    if not any(True for _ in _read(node)):
        return _always(node, reading)
    sides = [node.left, *node.comparators]
    for (left, right), operator in zip(pairwise(sides), node.ops, strict=True):
        if len(node.ops) > 1 and not any(True for side in (left, right) for _ in _read(side)):
            return _always(ast.Compare(left, [operator], [right]), reading)
        if isinstance(operator, ast.In | ast.NotIn):
            found = _no_list(left, right, operator, reading)
        else:
            found = (
                _mixed(left, right, reading)
                or _itself(left, right, operator, reading)
                or _negative(left, right, operator, reading)
            )
        found = found or _impossible(left, right, operator, reading)
        if found:
            return found
    return ""


def _read(node: ast.expr) -> Iterator[ast.Name]:
    """Yield what a part reads: all names but those of functions."""
    called = {id(n.func) for n in ast.walk(node) if isinstance(n, ast.Call)}
    for part in ast.walk(node):
        if isinstance(part, ast.Name) and id(part) not in called:
            yield part


def _always(node: ast.expr, reading: Reading) -> str:
    """Return how a part that reads no node comes out in every frame."""
    for part in ast.walk(node):
        if isinstance(part, ast.BinOp) and (words := no_arithmetic(part, reading)):
            return words
    code = compile(ast.fix_missing_locations(ast.Expression(node)), "<condition>", "eval")
    try:
        always = bool(eval(code, {"__builtins__": {}, **FUNCTIONS}))  # whitelisted by the caller
    except Exception as error:  # 1 / 0 > 2
        return f"{ast.unparse(node)} reads no node: it cannot be told ({error})"
    return f"{ast.unparse(node)} reads no node: it is always {str(always).lower()}"


def _mixed(left: ast.expr, right: ast.expr, reading: Reading) -> str:
    """Return the words for a number beside a text: comparing them fails, or never holds."""
    sorts = _sort(left, reading), _sort(right, reading)
    if None in sorts or sorts[0] == sorts[1]:
        return ""
    words = " and ".join(
        f"{reading.spell(side)} is a {sort}"
        for side, sort in zip((left, right), sorts, strict=True)
    )
    return f"{words}: they cannot be compared"


def _sort(node: ast.expr, reading: Reading) -> str | None:
    """Return ``number`` or ``text``, None where nobody knows."""
    if isinstance(node, ast.Constant):
        return "text" if isinstance(node.value, str) else "number"
    kind = reading.kind(node)
    found = {sort_of(arm) for arm in arms(kind)} if kind is not None else {None}
    return found.pop() if len(found) == 1 else None


def _itself(left: ast.expr, right: ast.expr, operator: ast.cmpop, reading: Reading) -> str:
    if ast.dump(left) != ast.dump(right):
        return ""
    always = isinstance(operator, ast.Eq | ast.LtE | ast.GtE)
    spelled = reading.spell(left)
    return f"{spelled} is compared with itself: that is always {str(always).lower()}"


def _negative(left: ast.expr, right: ast.expr, operator: ast.cmpop, reading: Reading) -> str:
    """Return the words for a count or size held against what it never falls below."""
    limit = _number(right)
    called = left.func.id if isinstance(left, ast.Call) and isinstance(left.func, ast.Name) else ""
    settled = _HOLDS.get(type(operator))
    if limit is None or called not in NEVER_NEGATIVE or settled is None or not settled(limit):
        return ""
    always = isinstance(operator, ast.GtE | ast.Gt | ast.NotEq)
    return f"{called}() is never negative: this is always {str(always).lower()}"


def _number(node: ast.expr) -> float | None:
    sign = 1
    if isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.USub):
        sign, node = -1, node.operand
    plain = isinstance(node, ast.Constant) and isinstance(node.value, int | float)
    return sign * node.value if plain else None  # type: ignore[attr-defined]


def _no_list(left: ast.expr, right: ast.expr, operator: ast.cmpop, reading: Reading) -> str:
    """Return the words for an ``in`` with no list behind it, or an empty one."""
    if isinstance(right, ast.Tuple | ast.List):
        always = "true" if isinstance(operator, ast.NotIn) else "false"
        return "" if right.elts else f"nothing is in an empty list: this is always {always}"
    if isinstance(right, ast.Constant) and isinstance(right.value, str):
        text = ast.unparse(right)
        return f"'in' looks into a list, and {text} is a text; a list is written ({text},)"
    kind = reading.kind(right)
    number = isinstance(right, ast.Constant)
    scalar = kind is not None and all(
        is_scalar(arm) and sort_of(arm) == "number" and list_item(arm) is None for arm in arms(kind)
    )
    if not (number or scalar):
        return ""
    spelled = reading.spell(right)
    return f"'in' looks into a list, and {spelled} is a number; a list is written ({spelled},)"


def any_hint(node: ast.expr, part: ast.expr, reading: Reading) -> str:
    """Return how to look into a list that stands behind an ``in``; "" for anything else."""
    if not isinstance(node, ast.Compare) or node.comparators != [part]:
        return ""
    of_item = list_item(reading.kind(part))
    if of_item is None or not all(is_scalar(arm) for arm in arms(of_item)):
        return ""
    operator, left = node.ops[0], node.left
    if not isinstance(operator, ast.In | ast.NotIn) or not isinstance(
        left, ast.Name | ast.Constant
    ):
        return ""
    no = "not " if isinstance(operator, ast.NotIn) else ""
    return f"; write {no}any({reading.spell(part)} == {reading.spell(left)})"


def _impossible(left: ast.expr, right: ast.expr, operator: ast.cmpop, reading: Reading) -> str:
    """Return the words for a text that a field never holds: one of a few is all it can be."""
    if not isinstance(operator, ast.Eq | ast.NotEq | ast.In | ast.NotIn):
        return ""
    for field, other in ((left, right), (right, left)):
        allowed = _choices(reading.kind(field))
        for given in _constants(other) if allowed else []:
            if given not in allowed:
                known = ", ".join(repr(a) for a in allowed)
                hint = did_you_mean(str(given), [str(a) for a in allowed])
                return f"{reading.spell(field)} is never {given!r}; it is one of {known}{hint}"
    return ""


def _choices(kind: Any) -> tuple[Any, ...]:
    """Return all that a value can be; nothing where it is not one of a few.

    ``Annotated[str, Literal["a", "b"]]`` says so of a text, beside ``Literal`` itself; so does a
    rule that tells its ``choices()``.
    """
    for rule in strip(kind)[1]:
        if get_origin(rule) is Literal:
            return get_args(rule)
        if callable(getattr(rule, "choices", None)):
            return tuple(rule.choices())
    found = arms(kind) if kind is not None else ()
    if not found or not all(arm is bool or get_origin(arm) is Literal for arm in found):
        return ()
    return tuple(v for arm in found for v in ((True, False) if arm is bool else get_args(arm)))


def _constants(node: ast.expr) -> list[Any]:
    """Return the constants a field is compared with: one, or those of a list."""
    parts = node.elts if isinstance(node, ast.Tuple | ast.List) else [node]
    return [part.value for part in parts if isinstance(part, ast.Constant)]
