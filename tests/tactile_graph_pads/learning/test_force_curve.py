"""A law from whole weights: it never falls, and weighs what it has not seen."""

import numpy as np
import pytest

from tactile_graph_pads.learning.force_curve import force_curve


def weighed(n=40, seed=0):
    """Return readings of 12 elements that go with the root of the load, and the weights."""
    rng = np.random.default_rng(seed)
    load = rng.uniform(5.0, 100.0, (n, 1)) * rng.uniform(0.3, 1.0, (n, 12))
    return 10.0 * np.sqrt(load), load.sum(axis=1)


def test_a_curved_law_is_found_from_sums_alone():
    readings, weight_g = weighed()
    found = force_curve(readings, weight_g, 1.0)
    assert found is not None
    at, grams = np.array(found.points).T
    assert (np.diff(grams) >= 0.0).all()
    assert np.interp(60.0, at, grams) == pytest.approx(36.0, rel=0.1)
    assert found.off_percent < 5.0
    assert len(found.found_g) == 40


def test_unknown_weights_are_left_out_and_too_few_or_alike_tell_nothing():
    readings, weight_g = weighed()
    weight_g[10:] = np.nan
    found = force_curve(readings, weight_g, 1.0)
    assert found is not None
    assert len(found.true_g) == 10
    weight_g[3:] = np.nan
    assert force_curve(readings, weight_g, 1.0) is None
    assert force_curve(readings, np.full(40, 300.0), 1.0) is None
    assert force_curve(0.0 * readings, weighed()[1], 1.0) is None


def test_what_shows_nothing_weighs_nothing_and_no_reading_is_past_the_last_point():
    readings, weight_g = weighed()
    noisy = np.hstack([readings, np.random.default_rng(1).normal(0.0, 0.3, (40, 400))])
    found = force_curve(noisy, weight_g, 1.23456789)
    assert found is not None
    at, grams = np.array(found.points).T
    assert (at[0], grams[0]) == (1.23457, 0.0)
    assert at[-1] >= readings.max()
    assert [float(f"{x:.6g}") for x in at] == at.tolist()
    weighs = np.interp(noisy, at, grams).sum(axis=1)
    assert np.median(np.abs(weighs / weight_g - 1.0)) < 0.05
