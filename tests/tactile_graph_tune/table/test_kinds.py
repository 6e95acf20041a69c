"""Errors where something lies, misses and false answers are told apart."""

from __future__ import annotations

import numpy as np
import pytest

from tactile_graph_tune.table.kinds import Means, Truths

TRUTHS = Truths(np.array([True, True, True, False, False]), 2.0, np.ones(5))
FAILED = np.array([False, False, True, False, False])


def test_each_kind_is_of_its_own_frames():
    found = TRUTHS.means(np.arange(5.0), np.array([0.1, 0.5, 2.0, 0.0, 2.0]), FAILED)
    assert found == pytest.approx(Means(2.0, 2.6 / 3.0, 1.0 / 3.0, 0.5, 0.2))


def test_many_choices_come_to_what_each_comes_to_alone():
    rng = np.random.default_rng(1)
    times, losses = rng.random((3, 5)), rng.uniform(0.0, 2.5, (3, 5))
    failed = rng.random((3, 5)) < 0.5
    at_once = TRUTHS.means(times, losses, failed)
    for k in range(3):
        alone = TRUTHS.means(times[k], losses[k], failed[k])
        assert [m[k] for m in at_once] == pytest.approx(list(alone))


def test_a_gain_on_empty_frames_makes_up_for_no_error_elsewhere():
    today = TRUTHS.means(np.zeros(5), np.array([0.1, 0.1, 0.1, 2.0, 2.0]), FAILED)
    wins = TRUTHS.means(np.zeros(5), np.array([0.2, 0.2, 0.2, 0.0, 0.0]), FAILED)
    assert not wins.within(today)
    assert today.within(today)


@pytest.mark.parametrize("full", [True, False])
def test_what_no_frame_tells_is_no_error(full):
    found = Truths(np.full(2, full), 2.0, np.ones(2)).means(
        np.ones(2), np.full(2, 2.0), np.zeros(2, bool)
    )
    assert found == ((1.0, 2.0, 1.0, 0.0, 0.0) if full else (1.0, 0.0, 0.0, 1.0, 0.0))
