"""Fields of what nodes give, and of each item where they give a list."""

from __future__ import annotations

from collections.abc import Callable
from operator import attrgetter
from typing import Any

from tactile_graph.engine.outcomes.outcome import NO_VALUE, Skipped, raised
from tactile_graph.pipeline.wiring import Ref

Get = Callable[[Any], Any]


def field_getter(ref: Ref) -> Get:
    """Return what turns a node's value into the field of it that a reference names.

    Of a list whose items it takes a field of, each keeps its place: one that has no value keeps its
    outcome, one whose field is not known or cannot be had is skipped or failed.
    """
    whole = attrgetter(".".join(ref.path)) if ref.path else None
    if not ref.item_path:
        assert whole is not None, f"{ref} is no field"
        return whole
    path, name = ".".join(ref.item_path), str(ref)
    of_item = attrgetter(path)

    def field(item: Any, i: int) -> Any:
        if item.__class__ in NO_VALUE:
            return item
        try:
            found = of_item(item)
        except Exception as error:
            return raised(name, error, (item,), "").of_item(i)
        if found is None:
            return Skipped(name, f"its {path} is not known", item=(i,), unforeseen=True)
        return found

    def of_each(value: Any) -> Any:
        items = value if whole is None else whole(value)
        return tuple([field(item, i) for i, item in enumerate(items)])

    return of_each
