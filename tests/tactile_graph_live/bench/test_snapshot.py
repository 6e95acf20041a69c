"""The range in which a pad is coloured."""

from __future__ import annotations

import numpy as np
import pytest

from tactile_graph import Image
from tactile_graph_live.bench import snapshot
from tactile_graph_live.bench.snapshot import KEPT_S, Range


def test_a_spike_stretches_the_colours_for_a_while_and_not_for_good(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    now_s = [1000.0]
    monkeypatch.setattr(snapshot.time, "perf_counter", lambda: now_s[0])
    colours = Range()

    def shown(highest: float, after_s: float) -> tuple[float, float]:
        now_s[0] += after_s
        return colours.of(Image(np.array([[0.0, highest]])))

    assert shown(100.0, 0.0) == (0.0, 100.0)
    assert shown(1e6, 1.0) == (0.0, 1e6)
    assert shown(100.0, KEPT_S - 2) == (0.0, 1e6)
    assert shown(100.0, 3.0) == (0.0, 1e6)
    assert shown(100.0, KEPT_S + 1) == (0.0, 100.0)
