"""No choice lies below the oracle, and it takes what is cheapest for each frame."""

from __future__ import annotations

import numpy as np
import pytest

from tactile_graph_tune.search.oracle import Options, bound_of


def test_it_answers_each_frame_by_what_is_cheapest_for_its_error():
    times = np.array([[0.0, 0.0], [1.0, 1.0], [10.0, 10.0]])
    losses = np.array([[2.0, 0.0], [0.1, 2.0], [0.1, 2.0]])
    bound = bound_of(Options(times, losses))
    assert (bound.time_us[-1], bound.loss[-1]) == (0.5, 0.05)
    assert bound.time_at(0.05) == 0.5
    assert bound.time_at(0.525) == pytest.approx(0.25)  # a mixture of nothing and the best
    assert np.isnan(bound.time_at(0.04))


def test_no_choice_of_one_option_for_all_lies_below_it():
    rng = np.random.default_rng(3)
    times, losses = rng.uniform(1.0, 9.0, (4, 30)), rng.uniform(0.0, 1.0, (4, 30))
    bound = bound_of(Options(times, losses))
    for time_us, loss in zip(times.mean(axis=1), losses.mean(axis=1), strict=True):
        assert bound.time_at(loss) <= time_us
