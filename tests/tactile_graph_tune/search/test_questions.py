"""Levels lie between values, as short as they can be said."""

from __future__ import annotations

import numpy as np

from tactile_graph_tune.search.questions import FINER, SHARES, levels_between


def test_a_level_parts_two_values_by_the_fewest_digits():
    assert levels_between(np.array([1.23456, 1.29, 1.29, 70.0])) == [1.26, 40.0]
    assert levels_between(np.array([3.0, 3.0])) == []


def test_of_many_values_so_many_levels_are_taken_as_are_asked_for():
    known = np.random.default_rng(1).normal(size=500)
    assert len(levels_between(known)) <= len(SHARES)
    assert len(SHARES) < len(levels_between(known, FINER)) <= FINER
