"""Levels lie between values, as short as they can be said."""

from __future__ import annotations

import numpy as np
import pytest

from tactile_graph_tune.search.questions import FINER, SHARES, levels_between


def test_a_level_parts_two_values_by_the_fewest_digits():
    assert levels_between(np.array([1.23456, 1.29, 1.29, 70.0])) == [1.26, 40.0]
    assert levels_between(np.array([3.0, 3.0])) == []


def test_of_many_values_so_many_levels_are_taken_as_are_asked_for():
    known = np.random.default_rng(1).normal(size=500)
    assert len(levels_between(known)) <= len(SHARES)
    assert len(SHARES) < len(levels_between(known, FINER)) <= FINER


@pytest.mark.parametrize("n_finer", [0, 60])
def test_infinity_is_a_value_like_others_and_never_a_level(n_finer: int) -> None:
    known = np.array([-np.inf] * 5 + list(np.arange(200.0)) + [np.inf] * 30)
    with np.errstate(all="raise"):
        levels = levels_between(known, n_finer)
    assert np.isfinite(levels).all()
    assert any(level > 199.0 for level in levels)
    if n_finer:
        assert any(level < 0.0 for level in levels)
    assert all(np.isfinite(levels_between(np.array([-np.inf, np.inf]))))
