"""What is taken keeps every limit on either half of the frames, and is surely no worse."""

from __future__ import annotations

import numpy as np
import pytest

from tactile_graph.errors import UsageError
from tactile_graph_tune.search.cascade import Predicted
from tactile_graph_tune.search.front import Choice
from tactile_graph_tune.search.select import Allowed, Goal, selected
from tactile_graph_tune.table.kinds import Truths

HALVES = [np.array([0, 1]), np.array([2, 3])]
TRUTHS = Truths(np.array([True, False, True, False]), 2.0)
COLUMNS = {  # time and error of four frames, every other one empty
    "as given": (9.0, [0.2, 2.0, 0.2, 2.0]),  # false on empty
    "lucky": (1.0, [0.0, 0.0, 0.3, 0.0]),  # cheap, and worse on one half
    "good": (3.0, [0.2, 2.0, 0.1, 2.0]),
    "misses": (2.0, [2.0, 0.0, 0.2, 0.0]),  # and wins where nothing lies
    "fails": (0.5, [0.0] * 4),
    "unsure": (2.5, [0.2, 0.0, 0.19, 0.0]),
}
FOUND = [Choice(v, (), {}) for v in range(len(COLUMNS))]


def predict(choice: Choice) -> Predicted:
    name = list(COLUMNS)[choice.variant]
    time_us, loss = COLUMNS[name]
    failed = np.full(4, name == "fails")
    return Predicted(np.full(4, time_us), np.array(loss), np.ones(4, bool), failed)


def chosen(*names: str, **limits: float) -> str:
    allowed = Allowed(Goal(**limits), TRUTHS, predict(FOUND[0]), HALVES)
    candidates = [FOUND[list(COLUMNS).index(n)] for n in names or COLUMNS]
    return list(COLUMNS)[selected(allowed, candidates, predict).variant]


def test_luck_on_one_half_is_not_taken():
    assert chosen("as given", "lucky", "good") == "good"
    assert chosen("as given", "lucky", "good", error=0.5) == "lucky"


def test_what_wins_on_empty_frames_pays_for_no_miss():
    assert chosen("as given", "misses") == "as given"
    assert chosen("as given", "misses", error=2.0) == "as given"
    assert chosen("as given", "misses", error=2.0, missed=1.0) == "misses"


def test_what_fails_more_often_is_never_taken():
    assert chosen("as given", "fails", error=2.0, missed=1.0, false=1.0) == "as given"


def test_a_gain_within_its_noise_is_none_but_no_difference_is_none_either():
    noisy = Truths(np.ones(40, bool), 2.0)
    rng = np.random.default_rng(4)
    today = np.full(40, 0.2)
    given = Predicted(np.ones(40), today, np.ones(40, bool), np.zeros(40, bool))
    allowed = Allowed(Goal(), noisy, given, [np.arange(40)])
    off = rng.normal(size=40)
    off -= off.mean()
    for shift, is_allowed in ((-0.1, False), (-0.3, True)):
        its = given._replace(loss=today + 0.05 * (off + shift))
        assert allowed(its) == is_allowed, shift
    assert allowed(given)


def test_within_a_time_the_best_is_taken():
    assert chosen(time_us=5.0) == "lucky"
    assert chosen("as given", "good", "unsure", time_us=5.0) == "good"
    assert chosen("as given", "good", "unsure", time_us=2.6) == "unsure"


@pytest.mark.parametrize(
    ("limits", "message"),
    [
        ({"error": 0.05}, "--error-at-most 0.05: no choice keeps it"),
        ({"time_us": 0.4}, r"--time-at-most 0.4: the cheapest choice takes 0.5 µs a frame"),
        ({"time_us": 0.9}, "--time-at-most 0.9: no choice keeps it"),
        ({"error": 0.1, "false": 0.0}, "--error-at-most 0.1 --false-at-most 0: no choice keeps it"),
    ],
)
def test_what_is_out_of_reach_is_told(limits, message):
    with pytest.raises(UsageError, match=message):
        chosen(**limits)
