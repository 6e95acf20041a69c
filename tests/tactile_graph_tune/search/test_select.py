"""What one half found is taken only if it holds on the other."""

from __future__ import annotations

import numpy as np
import pytest

from tactile_graph.errors import UsageError
from tactile_graph_tune.search.cascade import Predicted
from tactile_graph_tune.search.front import Choice, Front
from tactile_graph_tune.search.select import Goal, merged, selected

FOLDS = [np.array([0, 1]), np.array([2, 3])]
COLUMNS = {  # variant -> time and error of four frames
    0: ([9.0] * 4, [0.2] * 4),  # as given
    1: ([1.0] * 4, [0.1, 0.1, 0.5, 0.5]),  # cheapest, and lucky on the first half
    2: ([3.0] * 4, [0.2, 0.1, 0.2, 0.1]),
}


def predict(choice: Choice) -> Predicted:
    times, losses = map(np.array, COLUMNS[choice.variant])
    return Predicted(times, losses, np.ones(4, bool))


def fronts() -> list[Front]:
    found = [Front(), Front()]
    for front, variant in zip(found, (1, 2), strict=True):
        times, losses = map(np.array, COLUMNS[variant])
        front.enter(times[:1], losses[:1], lambda k, v=variant: Choice(v, (), {}))
    return found


def goal(allowed: float | None = None, by_time: bool = False) -> Goal:
    return Goal(allowed, by_time, (Choice(0, (), {}),))


def test_luck_on_one_half_is_not_taken():
    assert selected(goal(), fronts(), FOLDS, predict).variant == 2
    assert selected(goal(0.5), fronts(), FOLDS, predict).variant == 1


def test_within_a_time_the_best_is_taken():
    assert selected(goal(5.0, by_time=True), fronts(), FOLDS, predict).variant == 2


def test_what_is_out_of_reach_is_told_with_what_is_not():
    with pytest.raises(UsageError, match=r"error-at-most 0.05: the best .* 0.15"):
        selected(goal(0.05), fronts(), FOLDS, predict)
    with pytest.raises(UsageError, match=r"time-at-most 0.5: the cheapest .* takes 1 "):
        selected(goal(0.5, by_time=True), fronts(), FOLDS, predict)


def test_the_front_of_both_is_weighed_anew():
    whole = merged(fronts(), np.arange(4), predict)
    assert [(p.time_us, round(p.loss, 3)) for p in whole.points] == [(1.0, 0.3), (3.0, 0.15)]
    assert whole.n_weighed == 2
