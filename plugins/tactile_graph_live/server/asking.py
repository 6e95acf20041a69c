"""What a page asks, checked: nothing it sends is taken for what it is not."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from tactile_graph.errors import UsageError, did_you_mean, one_of, shown
from tactile_graph_live.server.messages import ASKED

OPTIONAL: Mapping[str, Mapping[str, Any]] = {
    "record": {"label": ""},
    "unset": {"node": "", "setting": ""},
}
LONGEST_TEXT = 10_000
MOST_NODES = 1000


def checked(asked: Mapping[str, Any]) -> tuple[str, dict[str, Any]]:
    """Return what is asked and its fields.

    Raises
    ------
    UsageError
        If there is no such thing to ask, or a field is missing or of another type.
    """
    kind = asked.get("type")
    if not isinstance(kind, str) or kind not in ASKED:
        hint = did_you_mean(str(kind), ASKED) or f"; there are: {one_of(ASKED, len(ASKED))}"
        raise UsageError(f"nothing is asked by type {shown(kind)}{hint}")
    fields = {}
    for name, allowed in ASKED[kind].items():
        value = asked.get(name, OPTIONAL.get(kind, {}).get(name))
        if value is None and name not in asked:
            raise UsageError(f"{kind}: {name!r} is missing")
        if not _fits(value, allowed):
            raise UsageError(f"{kind}: {name!r} is of the wrong kind, got {shown(value)}")
        fields[name] = value
    return kind, fields


def _fits(value: Any, allowed: type | tuple[type, ...]) -> bool:
    if allowed is object:
        return _size(value) <= LONGEST_TEXT
    if isinstance(value, bool) and allowed is not bool:
        return False
    if isinstance(value, int | float) and not _is_finite(value):
        return False
    if isinstance(value, list):
        if not (len(value) <= MOST_NODES and all(isinstance(v, str) for v in value)):
            return False
    elif isinstance(value, str) and len(value) > LONGEST_TEXT:
        return False
    return isinstance(value, allowed)


def _is_finite(value: float) -> bool:
    try:
        return math.isfinite(value)
    except OverflowError:  # an integer beyond all floating-point numbers
        return False


def _size(value: Any) -> int:
    return len(repr(value))
