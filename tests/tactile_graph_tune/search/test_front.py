"""The front keeps what nothing beats in both time and error, and what is allowed."""

from __future__ import annotations

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from tactile_graph_tune.search.front import Choice, Front

POINTS = st.lists(st.tuples(st.integers(0, 9), st.integers(0, 9)), min_size=1, max_size=30)


@settings(max_examples=30)
@given(POINTS)
def test_it_holds_all_that_is_not_beaten_and_nothing_else(points):
    front = Front()
    for time_us, error in points:
        times, errors = np.array([time_us] * 2), np.array([error, -1])
        front.enter(times, errors, np.array([True, False]), lambda k: Choice(0, (), {}))
    kept = {
        p for p in points
        if not any(q != p and q[0] <= p[0] and q[1] <= p[1] for q in points)
    }  # fmt: skip
    assert [(p.time_us, p.error) for p in front.points] == sorted(kept)
    assert front.n_weighed == 2 * len(points)
