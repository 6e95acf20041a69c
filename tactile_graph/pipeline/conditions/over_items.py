"""``any``, ``all`` and ``count`` of a condition: what holds of the items of a list."""

from __future__ import annotations

import ast
from collections.abc import Callable, Iterable, Mapping
from typing import Any, NamedTuple

from tactile_graph.errors import did_you_mean, one_of
from tactile_graph.pipeline.references import ConditionError, resolve_reference
from tactile_graph.pipeline.wiring import Ref, field_type, public_fields, when_known
from tactile_graph.steps.signature import list_item, type_name


def _count(truths: Iterable[Any]) -> int:
    return sum(map(bool, truths))


OVER_ITEMS: dict[str, Callable[[Iterable[Any]], Any]] = {"any": any, "all": all, "count": _count}


class OfItems(NamedTuple):
    """What a condition reads of each item of a list: a field, or the item itself.

    Attributes
    ----------
    ref, kind
        Reference and type of the field.
    of : Ref
        The list.
    """

    ref: Ref
    kind: Any
    of: Ref


def resolve_of_items(
    chain: tuple[str, ...], types: Mapping[str, Any], offset: int
) -> OfItems | None:
    """Return what ``list.field…`` reads of the items; None where the chain passes no list.

    Raises
    ------
    ConditionError
        If the items have no such field.
    """
    for n in range(1, len(chain) + 1):
        try:
            of, kind = resolve_reference(chain[:n], types, [], offset)
        except ConditionError:
            continue  # a pipeline of several outputs has two names
        item = list_item(when_known(kind))
        if item is None:
            continue
        kind = when_known(item)
        for field in chain[n:]:
            found = None if field.startswith("_") else field_type(kind, field)
            if found is None:
                known = list(public_fields(kind))
                hint = did_you_mean(field, known) or f"; it has: {one_of(known)}"
                what = f"an item of {of} ({type_name(kind)}) has no field {field!r}{hint}"
                raise ConditionError(what, offset)
            kind = when_known(found)
        return OfItems(Ref(of.node, of.path, chain[n:]), kind, of)
    return None


def spelled_out(meaning: str, groups: Iterable[tuple[int, ...]]) -> ast.expr:
    """Return a condition in which each ``any(v0 > 1)`` goes over the rows of what it reads.

    ``groups`` holds the values that go side by side, for each such call in turn.
    """
    # Parsed, not copied: all trees share their Load(), and what others hang onto it comes along.
    tree = ast.parse(meaning, mode="eval").body
    return _Rows(groups).visit(tree)  # type: ignore[no-any-return]


class _Rows(ast.NodeTransformer):
    def __init__(self, groups: Iterable[tuple[int, ...]]) -> None:
        self._of = {index: group for group in groups for index in group}

    def visit_Call(self, node: ast.Call) -> ast.expr:
        if not isinstance(node.func, ast.Name) or node.func.id not in OVER_ITEMS:
            return self.generic_visit(node)  # type: ignore[return-value]
        read = [n for n in ast.walk(node.args[0]) if isinstance(n, ast.Name) and _index(n) >= 0]
        group = next(self._of[_index(n)] for n in read if _index(n) in self._of)
        for name in read:
            if _index(name) in group:
                name.id = f"i{_index(name)}"
        targets: list[ast.expr] = [ast.Name(f"i{i}", ast.Store()) for i in group]
        lists: list[ast.expr] = [ast.Name(f"v{i}", ast.Load()) for i in group]
        rows = ast.Call(ast.Name("zip", ast.Load()), lists, [])
        loop = ast.comprehension(ast.Tuple(targets, ast.Store()), rows, [], 0)
        node.args = [ast.ListComp(node.args[0], [loop])]
        return node


def _index(name: ast.Name) -> int:
    """Return the number of a value; -1 for the name of a function."""
    return int(name.id[1:]) if name.id[:1] == "v" and name.id[1:].isdigit() else -1
