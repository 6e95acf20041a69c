"""In which order variants are run."""

from __future__ import annotations

from collections import Counter

from helpers_tune import frames
from tactile_graph import load
from tactile_graph_tune.table import record
from tactile_graph_tune.table.record import Judged, Rounds


def test_each_pipeline_comes_first_in_some_frames(hand_made, monkeypatch):
    first: Counter[str] = Counter()

    def noted(runner, frame):
        first[next(iter(runner.plan.nodes)).name] += 1
        return anew(runner, frame)

    anew = record._anew
    monkeypatch.setattr(record, "_anew", noted)
    plain = load("ladder.yaml")
    levels = [plain.with_settings({"footprint.level_v": x}) for x in (0.5, 0.50001, 0.50002)]
    judged = Judged("circle", "centre", "cm", 2.0)
    rounds = Rounds(3, 0, lambda n, of: None)
    tables = record.record(levels, (), frames(24), judged, rounds)
    assert [t.n for t in tables] == [24] * 3
    assert len(first) == 3
    assert min(first.values()) > 0.2 * 72
