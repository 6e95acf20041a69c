"""What a page asks, checked."""

from __future__ import annotations

from typing import Any

import pytest

from tactile_graph.errors import UsageError
from tactile_graph_live.server.asking import checked


def test_what_is_right_is_taken_with_its_fields() -> None:
    assert checked({"type": "scrub", "back_s": 3, "more": 1}) == ("scrub", {"back_s": 3})
    assert checked({"type": "record", "on": True}) == ("record", {"on": True, "label": ""})
    assert checked({"type": "set", "node": "a", "setting": "b", "value": None})[1]["value"] is None
    assert checked({"type": "unset"}) == ("unset", {"node": "", "setting": ""})


@pytest.mark.parametrize(
    ("asked", "why"),
    [
        ({}, "type None"),
        ({"type": "pausee"}, "did you mean 'pause'"),
        ({"type": ["pause"]}, "nothing is asked by type"),
        ({"type": "scrub"}, "'back_s' is missing"),
        ({"type": "scrub", "back_s": "3"}, "wrong kind"),
        ({"type": "scrub", "back_s": True}, "wrong kind"),
        ({"type": "scrub", "back_s": float("nan")}, "wrong kind"),
        ({"type": "scrub", "back_s": 10**400}, "wrong kind"),
        ({"type": "pong", "index": 10**400}, "wrong kind"),
        ({"type": "pong", "index": 1.5}, "wrong kind"),
        ({"type": "record", "on": 1}, "wrong kind"),
        ({"type": "show", "nodes": "frame"}, "wrong kind"),
        ({"type": "show", "nodes": [1]}, "wrong kind"),
        ({"type": "show", "nodes": ["x"] * 2000}, "wrong kind"),
        ({"type": "save", "name": "x" * 20_000}, "wrong kind"),
        ({"type": "set", "node": "a", "setting": "b"}, "'value' is missing"),
        ({"type": "set", "setting": "b", "value": 1}, "'node' is missing"),
        ({"type": "set", "node": "a", "setting": "b", "value": "x" * 20_000}, "wrong kind"),
    ],
)
def test_what_is_not_is_refused_and_named(asked: dict[str, Any], why: str) -> None:
    with pytest.raises(UsageError, match=why):
        checked(asked)
