"""The text of section 2.3.2, in numbers."""

from __future__ import annotations

import numpy as np

from tactile_graph_pads.pad import load_pad
from tactile_graph_thesis.items.chapter_2.figures_2_8_to_2_11_bias import (
    COMPARED_OHM,
    bias_curves,
    element_volts,
    neighbour_curves,
)

CURVES = bias_curves(5.0)


def test_the_most_is_read_with_100_kohm_and_the_least_with_10_at_every_load() -> None:
    assert (CURVES.alone_v.argmax(axis=0) == 9).all()
    assert (CURVES.alone_v.argmin(axis=0) == 0).all()


def test_the_sensitivity_changes_less_and_less_and_half_as_fast_beyond_40_kohm() -> None:
    at = CURVES.at_80_kohm(CURVES.alone_v)
    gained = np.diff(at)
    assert (np.diff(gained) < 0.0).all()
    assert gained[3:].mean() < 0.55 * gained[:3].mean()


def test_loaded_curves_cluster_beyond_50_kohm() -> None:
    loaded, alone = CURVES.loaded_v[4:], CURVES.alone_v[4:]
    assert (np.ptp(loaded, axis=0) <= 0.1 * loaded.max(axis=0)).all()
    k = np.argmin(abs(CURVES.resistance_ohm - 80e3))
    assert np.ptp(alone, axis=0)[k] > 0.3 * alone.max(axis=0)[k]


def test_coupling_is_least_at_30_kohm_of_30_40_and_50_at_every_load() -> None:
    taken = bias_curves(5.0, COMPARED_OHM).coupling_v
    assert (taken[1:].argmin(axis=0) == 0).all()


def test_the_curves_are_those_of_the_closed_form() -> None:
    r = CURVES.resistance_ohm
    np.testing.assert_allclose(CURVES.alone_v[2], 5.0 * 30e3 / (30e3 + r))
    expected = 5.0 / r / (1 / 30e3 + 1 / r + 8 / 80e3)
    np.testing.assert_allclose(CURVES.loaded_v[2], expected)


def test_where_in_the_column_the_neighbours_sit_makes_no_difference() -> None:
    volts = element_volts([1e4, 1e5], [33e3, 66e3], [60e3, 300e3], 3.0)
    again = element_volts([1e4, 1e5], [33e3, 66e3], [300e3, 60e3], 3.0)
    assert volts.shape == (2, 2)
    np.testing.assert_allclose(volts, again)
    np.testing.assert_allclose(volts[1, 0], 3.0 / 1e4 / (1 / 66e3 + 1 / 1e4 + 1 / 60e3 + 1 / 300e3))


def test_at_33_kohm_smaller_loading_resistances_couple_more() -> None:
    found = neighbour_curves(load_pad("plain"), np.random.default_rng(0))
    assert (np.diff(found.loaded_v[:-1], axis=0) > 0.0).all()
    drawn = found.neighbours_ohm[-1]
    assert len(set(drawn)) == 8
    assert ((drawn > 60e3) & (drawn < 300e3)).all()
    assert (found.loaded_v[-1] > found.loaded_v[0]).all()
    assert (found.loaded_v[-1] < found.loaded_v[-2]).all()
