"""No choice lies below the oracle, and it takes what is cheapest for each frame."""

from __future__ import annotations

import numpy as np
import pytest

from tactile_graph_tune.search.oracle import Bound, Options
from tactile_graph_tune.table.kinds import Truths

PRICE = 2.0


def test_it_answers_each_frame_by_what_is_cheapest_for_its_error():
    times = np.array([[0.0, 0.0], [1.0, 1.0], [10.0, 10.0]])
    losses = np.array([[2.0, 0.0], [0.1, 2.0], [0.1, 2.0]])
    bound = Bound(Options(times, losses), Truths(np.array([True, False]), PRICE, np.ones(2)))
    assert bound.time_at(0.1, 0.0) == pytest.approx(0.5, rel=1e-3)  # nothing on the empty frame
    assert bound.time_at(1.05, 0.5) == pytest.approx(0.25, rel=1e-3)  # half of that, half nothing
    assert np.isnan(bound.time_at(0.09, 0.0))


def test_it_may_not_buy_time_by_missing_more():
    times = np.array([[0.0] * 4, [8.0] * 4])
    losses = np.array([[PRICE] * 4, [0.0] * 4])
    bound = Bound(Options(times, losses), Truths(np.ones(4, bool), PRICE, np.ones(4)))
    assert bound.time_at(1.0, 0.5) == pytest.approx(4.0, rel=1e-3)
    assert bound.time_at(1.0, 0.25) == pytest.approx(6.0, rel=1e-3)


def test_no_choice_of_one_option_for_all_lies_below_it():
    rng = np.random.default_rng(3)
    times, losses = rng.uniform(1.0, 9.0, (4, 30)), rng.uniform(0.0, 2.5, (4, 30)).clip(max=PRICE)
    truths = Truths(rng.random(30) < 0.6, PRICE, np.ones(30))
    bound = Bound(Options(times, losses), truths)
    for k in range(4):
        own = truths.means(times[k], losses[k], np.zeros(30, bool))
        assert bound.time_at(own.error, own.missed) <= own.time_us


def test_where_nothing_lies_in_any_frame_it_takes_no_time():
    options = Options(np.ones((2, 3)), np.zeros((2, 3)))
    assert Bound(options, Truths(np.zeros(3, bool), PRICE, np.ones(3))).time_at(0.0, 0.0) == 0.0
