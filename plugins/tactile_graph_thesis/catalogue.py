"""Every item in the order of the book, found by its id or its number."""

from __future__ import annotations

from functools import cache
from importlib import import_module

from tactile_graph.errors import UsageError, did_you_mean
from tactile_graph_thesis.item import Item

_MODULES = (
    "chapter_2",
    "thresholds",
    "variances",
    "circle_stages",
    "hull_stages",
    "rectangle_stages",
    "rounding_stages",
    "diagrams",
    "error_tables",
    "identification",
    "bayes",
    "subpixels",
    "noise_algorithms",
    "noise_blocks",
)
_AFTER = {
    "table-4.3": "4.12",
    "table-4.4": "4.17",
    "table-4.5": "4.20",
    "table-4.7": "4.28",
    "table-4.8": "4.36",
    "table-4.9": "4.37",
    "table-5.2": "5.13",
}
"""Table -> the number of the figure it stands after."""


@cache
def items() -> tuple[Item, ...]:
    """Return every item in the order of the thesis, studies last."""
    found = [
        item
        for name in _MODULES
        for item in import_module(f"tactile_graph_thesis.items.{name}").ITEMS
    ]
    return tuple(sorted(found, key=_order))


def _order(item: Item) -> tuple[bool, tuple[int, ...], bool]:
    number = _AFTER.get(item.id, item.number)
    place = tuple(int(part) for part in number.split(".")) if number else ()
    return not place, place, item.id in _AFTER


def chosen(names: tuple[str, ...]) -> list[Item]:
    """Return the items of these names, each once, in the order of the book.

    Parameters
    ----------
    names : tuple of str
        ``4.5`` is the table and the figure of that number; ``table-4.5``, ``figure-4.5`` or the
        name of a study is one; ``all`` is everything.

    Raises
    ------
    UsageError
        If there is none of a name.
    """
    wanted: set[str] = set()
    for name in names:
        found = [i.id for i in items() if name in ("all", i.id, i.number)]
        if not found:
            known = ["all", *(i.id for i in items()), *(i.number for i in items() if i.number)]
            hint = did_you_mean(name, known)
            raise UsageError(
                f"no table, figure or study named {name!r}{hint}; "
                "'tactile-graph reproduce' lists them"
            )
        wanted |= set(found)
    return [item for item in items() if item.id in wanted]
