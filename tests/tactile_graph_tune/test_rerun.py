"""The last few pipelines have their turns in an order that no slow spell can favour."""

from __future__ import annotations

from collections import Counter

from tactile_graph_tune.rerun import STRETCH, _turns


def test_every_pipeline_has_every_stretch_once_a_round_and_comes_first_as_often():
    n, labels = 6 * STRETCH - 3, ["given", "always", "tuned"]
    turns = list(_turns(2, n, labels))
    starts = range(0, n, STRETCH)
    assert Counter(turns) == Counter((k, s, c) for k in (0, 1) for s in starts for c in labels)
    first = Counter(label for _, _, label in turns[:: len(labels)])
    assert set(first.values()) == {2 * len(starts) // len(labels)}
