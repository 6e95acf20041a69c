"""A frame that is kept is run again by the pipeline as it is now."""

from __future__ import annotations

import numpy as np
import pytest

pytest.importorskip("starlette", reason="the live extra is not installed")

import tactile_graph as tg
from tactile_graph_live.bench.wire import Kept
from tactile_graph_live.server.lookback import LEAD, Lookback

TRACKED = """
pipeline: tracked
nodes:
  footprint: {step: threshold, in: frame, with: {level_v: 0.5}}
  objects: {step: split_contacts, in: [frame, footprint]}
  tracks: {step: track, in: objects.contacts}
outputs: [tracks]
"""
STATELESS = "pipeline: p\nnodes: {seen: {step: threshold, in: frame, with: {level_v: 0.5}}}\noutputs: [seen]"  # noqa: E501


def kept(n: int, baseline: bool = False) -> Kept:
    values = np.zeros((6, 6))
    values[2:4, 2:4] = 2.0
    frames = tuple(
        tg.Frame.of(values, (1.0, 1.0), (0.0, 0.0), "volt", index=i, time_s=i / 10)
        for i in range(n)
    )
    return Kept(1, frames, 0.5, False, values if baseline else None)


def test_only_a_pipeline_that_keeps_something_needs_frames_before() -> None:
    assert Lookback(tg.loads(STATELESS), 1, 0).lead == 0
    assert Lookback(tg.loads(TRACKED), 1, 0).lead == LEAD


def test_the_same_frame_looked_at_twice_is_run_twice_from_the_same_state() -> None:
    for text, node, n in ((TRACKED, "tracks", 4), (STATELESS, "seen", 1)):
        look = Lookback(tg.loads(text), 3, 0)
        first, second = (look.frame(kept(n), {node}, None) for _ in range(2))
        assert first.rows == second.rows
        assert first.pictures == second.pictures
        assert {s["outcome"] for s in second.nodes.values()} == {"ran"}
        assert (second.version, second.back_s, second.index) == (3, 0.5, n - 1)


def test_the_baseline_is_taken_off_and_colours_keep_their_range() -> None:
    look = Lookback(tg.loads(STATELESS), 1, 0)
    tared = look.frame(kept(1, baseline=True), (), {"low": -1.0, "high": 8.0})
    assert (tared.pad["low"], tared.pad["high"]) == (-1.0, 8.0)
    assert tared.rows[0]["count"] == 0
    again = look.frame(kept(1), (), None)  # the tare is taken back
    assert (again.pad["low"], again.pad["high"]) == (0.0, 2.0)
