"""The benchmark of learned reliefs: what it counts as named and found."""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import pytest

from tactile_graph_classifiers.distances.identity import UNKNOWN, Identity

FOLDER = Path(__file__).parents[2] / "benchmarks"
sys.path.insert(0, str(FOLDER))
import learned_reliefs  # noqa: E402


def test_what_is_unknown_though_near_enough_is_lost_or_found() -> None:
    named = Identity("box", "", True, 0.9, 2.0, "box", "disc", 4.0, 0.8)
    off = Identity(UNKNOWN, "", False, 0.9, 2.0, "box", "disc", 1.2, 0.25, note="partly off")
    far = Identity(UNKNOWN, "", False, 3.0, 2.0, "box", "disc", 4.0, 0.25)
    ratios = learned_reliefs.over_limit([named, off, far])
    assert ratios == pytest.approx([0.45, 1.0, 1.5])
    found = learned_reliefs.Answers(ratios, np.full(3, True), ratios, ratios)
    assert found.shares() == pytest.approx([100 / 3, 100, 200 / 3, 200 / 3, 200 / 3])
