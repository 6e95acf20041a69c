"""Summaries, intervals and fronts against what can be computed by hand."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from tactile_graph_compare.score.scoring import QuantityErrors
from tactile_graph_compare.score.statistics import (
    LEAST_FRAMES,
    difference_of,
    for_all_together,
    mean_interval,
    score_of,
    tail_of,
    time_difference_of,
    times_of,
    with_pareto,
)

NAN = math.nan


def targets(errors, objects=None, offsets=None):
    made = QuantityErrors(n_extra=2)
    for i, error in enumerate(errors):
        made.add(i, objects[i] if objects else 0, error)
    made.offsets = offsets or []
    return made


def test_a_score_sums_up_absolute_errors_and_counts_what_is_missing():
    got = score_of("v", "radius", "cm", targets([-1.0, 3.0, NAN, 2.0]))
    assert (got.mean, got.median, got.largest) == (2.0, 2.0, 3.0)
    assert got.p95 == pytest.approx(2.9)
    assert got.bias == pytest.approx(4 / 3)
    assert (got.n_answered, got.n_missing, got.n_extra, got.unit) == (3, 1, 2, "cm")


def test_the_bias_of_centres_is_the_length_of_the_mean_offset():
    got = score_of("v", "centre", "cm", targets([5.0, 5.0], offsets=[(3.0, 4.0), (-3.0, 4.0)]))
    assert (got.mean, got.bias) == (5.0, 4.0)


def test_without_any_answer_there_are_no_figures():
    got = score_of("v", "angle", "°", targets([NAN]))
    assert (got.mean, got.p95, got.bias, got.n_missing) == (None, None, None, 1)


def test_paired_differences_take_only_what_both_answered():
    one = score_of("b", "radius", "cm", targets([1.0, -2.0, NAN, 4.0, NAN]))
    other = score_of("a", "radius", "cm", targets([0.5, 1.0, 7.0, NAN, NAN]))
    got = difference_of(one, other, np.random.default_rng(0))
    assert got.mean == pytest.approx(0.75)
    assert (got.n_both, got.n_only_variant, got.n_only_reference, got.n_neither) == (2, 1, 1, 1)
    assert got.method == "no bounds below 6 frames"
    assert (got.low, got.verdict) == (None, "no clear difference")


def test_where_nothing_was_answered_by_both_there_is_nothing_to_tell_apart():
    one, other = (score_of(v, "radius", "cm", targets(e)) for v, e in
                  (("b", [1.0, NAN]), ("a", [NAN, 1.0])))  # fmt: skip
    got = difference_of(one, other, np.random.default_rng(0))
    assert (got.n_both, got.mean, got.verdict) == (0, None, "none in common")


def test_objects_of_one_frame_count_as_one_frame():
    """Two objects in a frame are no more independent than one."""

    def score(label, errors):
        made = QuantityErrors()
        for number, error in enumerate(errors):
            made.add(0, number, error)
        return score_of(label, "radius", "cm", made)

    got = difference_of(score("b", [2.0, 4.0]), score("a", [1.0, 1.0]), np.random.default_rng(0))
    assert (got.mean, got.low, got.high, got.n_both) == (2.0, None, None, 2)


@pytest.mark.parametrize("many", [1, 400])
def test_a_paired_mean_is_over_objects_as_the_scores_are(many: int):
    """Better in many frames of one object, worse in fewer of six, with more objects in all."""
    mine, theirs = QuantityErrors(), QuantityErrors()
    for frame in range(18 * many):
        few = frame % 18 < 12
        for number in range(1 if few else 6):
            mine.add(frame, number, 0.4 if few else 0.6)
            theirs.add(frame, number, 0.5)
    one, other = (score_of(v, "radius", "cm", found) for v, found in (("b", mine), ("a", theirs)))
    got = difference_of(one, other, np.random.default_rng(0))
    assert got.mean == pytest.approx(one.mean - other.mean)
    assert got.low < got.mean < got.high
    if many > 1:  # by hand: sums of -0.1 and 0.6 a frame, less the mean of 0.05 an object
        scatter = np.sqrt((12 * 0.15**2 + 6 * 0.3**2) / 18) / (8 / 3)
        assert got.high - got.mean == pytest.approx(1.96 * scatter / np.sqrt(18 * many), rel=1e-3)


@pytest.mark.parametrize(("n", "method"), [
    (5, "no bounds below 6 frames that differ"), (6, "bootstrap over frames"),
])  # fmt: skip
def test_frames_in_which_nothing_differs_tell_no_verdict(n: int, method: str):
    values = np.zeros(200)
    values[:n] = 1.0
    values[n:] = 1e-16
    got = mean_interval(values, np.random.default_rng(0))
    assert (got.method, got.low is None) == (method, n < 6)


@pytest.mark.slow
@pytest.mark.parametrize("n", [LEAST_FRAMES, 10, 60])
def test_an_interval_holds_the_true_mean_about_as_often_as_it_says(n: int):
    rng = np.random.default_rng(4)
    held = 0
    for _ in range(200):
        got = mean_interval(rng.normal(1.0, 2.0, n), rng)
        held += got.low <= 1.0 <= got.high
    assert 180 <= held <= 198


def test_few_frames_of_one_sign_are_no_verdict_and_many_are_bounded_as_ever():
    one, other = (score_of(v, "radius", "cm", targets([e] * 5)) for v, e in (("b", 2), ("a", 1)))
    got = difference_of(one, other, np.random.default_rng(0))
    assert (got.mean, got.low, got.high) == (1.0, None, None)
    assert got.verdict == "no clear difference"
    tails = [tail_of(n) for n in (1, 6, 10, 100, 2000)]
    assert tails == pytest.approx([2.5, 0.2432, 0.8551, 2.3064, 2.4902], abs=1e-4)


def test_many_frames_have_the_normal_interval_of_the_same_width():
    values = np.random.default_rng(1).normal(0.0, 1.0, 3000)
    got = mean_interval(values, np.random.default_rng(0))
    assert got.method == "normal over frames"
    assert got.high - got.low == pytest.approx(2 * 1.96 / np.sqrt(3000), rel=0.05)
    few = mean_interval(values[:2000], np.random.default_rng(0))
    assert few.high - few.low == pytest.approx(2 * 1.96 / np.sqrt(2000), rel=0.1)


def test_intervals_are_the_same_under_the_same_seed():
    values = np.arange(10.0)
    first, again = (mean_interval(values, np.random.default_rng(3)) for _ in range(2))
    assert first == again


def test_times_leave_out_reused_frames_and_one_stall_moves_no_median():
    plain = [10.0, NAN, *[10.0] * 20]
    slow = times_of([12.0, NAN, *[12.0] * 19, 9000.0])
    assert (slow.median_us, slow.per_frame_us.size) == (12.0, 22)
    got = time_difference_of("b", "a", slow, times_of(plain))
    assert (got.median_us, got.low_us, got.high_us, got.ratio) == (2.0, 2.0, 2.0, 1.2)


def test_the_front_is_what_nobody_beats_in_both():
    scores = [score_of(v, "radius", "cm", targets([e])) for v, e in
              (("slow", 1.0), ("fast", 2.0), ("bad", 2.5), ("equal", 1.0))]  # fmt: skip
    scores.append(score_of("silent", "radius", "cm", targets([NAN])))
    times = {"slow": 9.0, "fast": 3.0, "bad": 3.0, "equal": 9.0, "silent": 0.0}
    front = [s.variant for s in with_pareto(scores, times) if s.pareto]
    assert front == ["slow", "fast", "equal"]


def test_who_answers_less_beats_nobody():
    often = score_of("often", "radius", "cm", targets([2.0, 2.0]))
    seldom = score_of("seldom", "radius", "cm", targets([1.0, NAN]))
    front = with_pareto([often, seldom], {"often": 5.0, "seldom": 1.0})
    assert [s.pareto for s in front] == [True, True]


def test_verdicts_hold_for_all_comparisons_together():
    """Twenty variants that differ by nothing but noise, and one that is better."""
    said = []
    for seed in range(6):
        rng = np.random.default_rng(seed)
        first, *others = (score_of(str(k), "radius", "cm", targets(rng.normal(9.0, 1.0, 60)))
                          for k in range(21))  # fmt: skip
        others.append(score_of("good", "radius", "cm", targets(rng.normal(7.0, 1.0, 60))))
        alone = [difference_of(o, first, rng) for o in others]
        *equal, good = for_all_together(alone)
        said += [d.verdict for d in equal]
        assert good.verdict == "better"
        assert [(d.low, d.high, d.p) for d in alone[:-1]] == [(d.low, d.high, d.p) for d in equal]
    assert not {"better", "worse"} & set(said)
    assert {"perhaps better", "perhaps worse"} & set(said)


def test_by_how_many_comparisons_a_chance_is_multiplied():
    one = difference_of(*(score_of(v, "radius", "cm", targets(e)) for v, e in
                          (("b", np.arange(1.0, 9.0)), ("a", np.ones(8)))),
                        np.random.default_rng(0))  # fmt: skip
    assert one.p == pytest.approx(0.0049, abs=1e-4)  # t = 3.5 / sqrt(6 / 8), 7 degrees of freedom
    none = replace(one, p=None)
    for n, told in ((1, True), (10, True), (11, False)):
        made = for_all_together([one, none, *[replace(one, p=0.5)] * (n - 1)])
        assert made[0].for_all is told
