"""What one half found is taken only if it holds on the other, in each kind of error."""

from __future__ import annotations

from math import inf

import numpy as np
import pytest

from tactile_graph.errors import UsageError
from tactile_graph_tune.search.front import Choice, Front
from tactile_graph_tune.search.select import Goal, merged, selected
from tactile_graph_tune.table.kinds import Means, Truths

FOLDS = [np.array([0, 1]), np.array([2, 3])]
TRUTHS = Truths(np.array([True, False, True, False]), 2.0, np.ones(4))
COLUMNS = {  # variant -> time and error of four frames, every other one empty
    0: ([9.0] * 4, [0.2, 2.0, 0.2, 2.0]),  # as given: false on empty
    1: ([1.0] * 4, [0.1, 0.0, 0.5, 0.0]),  # cheapest, and lucky on the first half
    2: ([3.0] * 4, [0.2, 2.0, 0.1, 2.0]),
    3: ([2.0] * 4, [2.0, 0.0, 0.2, 0.0]),  # misses, and wins where nothing lies
    4: ([0.5] * 4, [0.0] * 4),  # would be best, were it not that a step fails
}
FOUND = [Choice(v, (), {}) for v in COLUMNS]


def weigh(choice: Choice, rows: np.ndarray) -> Means:
    times, losses = map(np.array, COLUMNS[choice.variant])
    failed = np.full(len(rows), choice.variant == 4)
    return TRUTHS.taken(rows).means(times[rows], losses[rows], failed)


def goal(**limits: float) -> Goal:
    return Goal(FOUND[0], **limits)


def chosen(**limits: float) -> int:
    return selected(goal(**limits), FOUND, FOLDS, weigh).variant


def test_luck_on_one_half_is_not_taken():
    assert chosen() == 2
    assert chosen(error=0.5) == 1


def test_a_margin_is_a_share_of_the_error_as_it_is():
    assert chosen(margin=1.4) == 2
    assert chosen(margin=1.6) == 1


def test_what_wins_on_empty_frames_only_is_not_taken():
    COLUMNS_3 = goal().limits(np.arange(4), weigh)
    assert not weigh(FOUND[3], np.arange(4)).within(COLUMNS_3)
    assert chosen(error=2.0) == 1  # it misses more than what was given
    assert selected(goal(error=2.0, missed=1.0), FOUND[2:4], FOLDS, weigh).variant == 3


def test_within_a_time_the_best_is_taken():
    assert chosen(time_us=5.0) == 2
    assert chosen(time_us=1.5) == 1


@pytest.mark.parametrize(
    ("limits", "message"),
    [
        ({"error": 0.05}, r"error-at-most 0.05: no choice keeps it"),
        ({"time_us": 0.4}, r"time-at-most 0.4: the cheapest .* takes 0.5 "),
        ({"time_us": 1.5, "error": None, "missed": 0.0, "false": 0.0}, None),
        ({"error": 0.2, "false": 0.0}, r"error-at-most 0.2 --false-at-most 0: no choice keeps it"),
    ],
)
def test_what_is_out_of_reach_is_told_with_what_is_not(limits, message):
    if message is None:
        assert chosen(**limits) == 1
        return
    with pytest.raises(UsageError, match=message):
        chosen(**limits)


def test_the_front_of_both_is_weighed_anew_and_holds_what_is_allowed():
    fronts = [Front(n_weighed=3), Front(n_weighed=4)]
    limits = Means(inf, inf, 0.0, 1.0, 0.0)
    whole = merged(fronts, FOUND, np.arange(4), weigh, limits)
    told = [(p.time_us, round(p.error, 3)) for p in whole.points]
    assert told == [(1.0, 0.3), (3.0, 0.15)]
    assert whole.n_weighed == 7
