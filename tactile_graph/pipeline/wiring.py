"""Which output fits which port: types, fields, and the views a record provides."""

from __future__ import annotations

import inspect
import types
from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Any, Union, get_args, get_origin, get_type_hints

import numpy as np

from tactile_graph.steps.signature import list_item, strip

UNKNOWN = Any
"""The type of a node whose own errors have been reported: it fits everywhere."""


@dataclass(frozen=True)
class Ref:
    """A value on a wire: a node's outcome, or what an attribute path makes of it.

    Where that is a list, ``item_path`` is applied to each of its items.
    """

    node: str
    path: tuple[str, ...] = ()
    item_path: tuple[str, ...] = ()

    def __str__(self) -> str:
        return ".".join((self.node, *self.path))

    @property
    def spelled(self) -> str:
        """The reference with the field of items, as conditions have it."""
        return ".".join((self.node, *self.path, *self.item_path))

    @property
    def whole(self) -> bool:
        """Whether it is the node's value itself."""
        return not self.path and not self.item_path


def arms(kind: Any) -> tuple[Any, ...]:
    """Return the arms of a union, or the type alone; ``Annotated`` stripped."""
    bare, _ = strip(kind)
    if get_origin(bare) in (Union, types.UnionType):
        return tuple(a for arm in get_args(bare) for a in arms(arm))
    return (bare,)


def assignable(given: Any, wanted: Any) -> bool:
    """Return whether every value of type ``given`` is fit for ``wanted``."""
    if given is Any or wanted is Any or wanted is object:
        return True
    return all(any(_arm_fits(g, w) for w in arms(wanted)) for g in arms(given))


def _arm_fits(given: Any, wanted: Any) -> bool:
    if given is Any or wanted is Any or wanted is object or given == wanted:
        return True
    given_item, wanted_item = list_item(given), list_item(wanted)
    if wanted_item is not None:
        return given_item is not None and assignable(given_item, wanted_item)
    given, wanted = _plain(given), _plain(wanted)
    if not (isinstance(given, type) and isinstance(wanted, type)):
        return False
    if wanted is float and issubclass(given, int | np.integer | np.floating):
        return given is not bool
    return issubclass(given, wanted)


def _plain(kind: Any) -> Any:
    origin = get_origin(kind)
    return origin if isinstance(origin, type) else kind


def fit(ref: Ref, given: Any, wanted: Any) -> Ref | None:
    """Return how ``ref`` of type ``given`` reaches a port of type ``wanted``; None if it cannot.

    A record that provides a view of a wanted type (a frame its image, a polygon its corners)
    is taken by that view; so is each item of a list.
    """
    if assignable(given, wanted):
        return ref
    view = view_of(given, wanted)
    if view is not None:
        return Ref(ref.node, (*ref.path, view))
    given_item, wanted_item = list_item(given), list_item(wanted)
    if given_item is not None and wanted_item is not None:
        view = view_of(given_item, wanted_item)
        if view is not None:
            return Ref(ref.node, ref.path, (view,))
    return None


def view_of(given: Any, wanted: Any) -> str | None:
    """Return the attribute through which every arm of ``given`` provides ``wanted``."""
    names = {_provided(_plain(arm), wanted) for arm in arms(given)}
    return names.pop() if len(names) == 1 else None


def _provided(given: Any, wanted: Any) -> str | None:
    for kind, name in getattr(given, "provides", {}).items():
        if assignable(kind, wanted):
            return str(name)
    return None


def public_fields(kind: Any) -> dict[str, Any]:
    """Return the public fields and properties of a type, with their types."""
    bare, _ = strip(kind)
    bare = _plain(bare)
    return dict(_fields(bare)) if isinstance(bare, type) else {}


@lru_cache(maxsize=256)
def _fields(kind: type) -> dict[str, Any]:
    try:
        hints = get_type_hints(kind, include_extras=True)
    except Exception:  # a plugin's own type may have hints that only its checker can read
        hints = {}
    result = {
        n: t for n, t in hints.items()
        if not n.startswith("_") and "ClassVar" not in str(t) and not n.isupper()
    }  # fmt: skip
    for name, member in inspect.getmembers_static(kind):
        getter = getattr(member, "fget", None) or getattr(member, "func", None)
        if name.startswith("_") or not callable(getter):
            continue
        try:
            result[name] = get_type_hints(getter, include_extras=True).get("return", Any)
        except Exception:
            result[name] = Any
    if issubclass(kind, np.ndarray | int | float | str | list | tuple) and not hasattr(
        kind, "_fields"
    ):
        return {}
    return result


def field_type(kind: Any, name: str) -> Any:
    """Return the type of a public field in every arm of ``kind``; None where an arm lacks it."""
    if kind is Any:
        return Any
    found = [public_fields(arm).get(name) for arm in arms(kind)]
    if any(f is None for f in found):
        return None
    first = found[0]
    return first if all(f == first for f in found) else Union[tuple(found)]  # noqa: UP007


def when_known(kind: Any) -> Any:
    """Return the type of what comes over a wire: a field that is None reads as skipped."""
    left = tuple(arm for arm in arms(kind) if arm is not type(None))
    return kind if not left or len(left) == len(arms(kind)) else common_type(left)


def common_type(kinds: Sequence[Any]) -> Any:
    """Return the one type of all, or their union."""
    if any(k is Any for k in kinds):
        return Any
    return kinds[0] if all(k == kinds[0] for k in kinds) else Union[tuple(kinds)]  # noqa: UP007
