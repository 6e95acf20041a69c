"""Readings' logarithms and states, and the largest of them: loops beside the references."""

import numpy as np
import pytest

import references_likelihood as references
from tactile_graph_likelihood.single.readings import ranked, split


@pytest.mark.parametrize("form", ["loops", "compiled"])
@pytest.mark.parametrize("least", [0.0, 0.4])
def test_readings_are_split_as_by_the_reference(form, least):
    values = np.random.default_rng(0).normal(0.3, 0.5, (5, 7))
    values[2, 3], values[4, 6] = 0.0, least
    (logs, other), (states, others) = np.empty((2, 5, 7)), np.empty((2, 5, 7), np.uint8)
    n = references.split(values, least, logs, states)
    assert getattr(split, form)(values, least, other, others) == n
    assert 0 < n < values.size
    np.testing.assert_allclose(other, logs, rtol=1e-15)
    assert np.array_equal(others, states)


@pytest.mark.parametrize("form", ["loops", "compiled"])
@pytest.mark.parametrize("bad", [np.nan, np.inf])
def test_readings_that_are_no_numbers_are_not_split(form, bad):
    values = np.array([[1.0, bad]])
    with np.errstate(invalid="ignore"):
        assert getattr(split, form)(values, 0.0, np.empty((1, 2)), np.empty((1, 2), np.uint8)) == -1


@pytest.mark.parametrize("form", ["loops", "compiled"])
@pytest.mark.parametrize("rank", [1, 3, 8])
def test_the_eighth_largest_is_that_of_a_partition(form, rank):
    values = np.random.default_rng(rank).integers(0, 12, (6, 5)).astype(float)
    assert getattr(ranked, form)(values, rank) == references.ranked(values, rank)
