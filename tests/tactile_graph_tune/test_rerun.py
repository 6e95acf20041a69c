"""The last few pipelines have their turns in an order that no slow spell can favour."""

from __future__ import annotations

from collections import Counter

import pytest

from tactile_graph_tune.rerun import STRETCH, _turns, rerun
from tactile_graph_tune.table.record import Judged


def test_every_pipeline_has_every_stretch_once_a_round_and_comes_first_as_often():
    n, labels = 6 * STRETCH - 3, ["given", "always", "tuned"]
    turns = list(_turns(2, n, labels))
    starts = range(0, n, STRETCH)
    assert Counter(turns) == Counter((k, s, c) for k in (0, 1) for s in starts for c in labels)
    first = Counter(label for _, _, label in turns[:: len(labels)])
    assert set(first.values()) == {2 * len(starts) // len(labels)}


def test_times_are_of_machine_code_whoever_made_the_table(monkeypatch: pytest.MonkeyPatch) -> None:
    """Where workers made it, nothing was warmed up in this process."""
    warmed: list[bool] = []
    monkeypatch.setattr("tactile_graph_tune.rerun.warm_up", lambda: warmed.append(True))
    assert rerun({}, [], Judged("a", "centre", "cm", 2.0), 1, 0) == {}
    assert warmed
