"""Groups of four share their weight, and their mean scatters far less than single elements."""

from __future__ import annotations

import numpy as np
import pytest

from tactile_graph_pads.pad import Pad, load_pad
from tactile_graph_thesis.items.chapter_2.figures_2_15_to_2_17_groups_of_four import (
    ErrorBars,
    error_bars,
)
from tactile_graph_thesis.measure.groups_of_four import group_readings

THESIS, PLAIN = load_pad("thesis"), load_pad("plain")


def bars_of(pad: Pad, seed: int) -> ErrorBars:
    return error_bars(group_readings(pad, np.random.default_rng(seed)))


def test_four_elements_bear_the_whole_weight() -> None:
    found = group_readings(THESIS, np.random.default_rng(0))
    assert found.volts.shape == (9, len(found.weight_g), 4)
    np.testing.assert_allclose(found.load_g.sum(axis=2), np.tile(found.weight_g, (9, 1)))
    assert (found.corner < 15).all()


def test_decoupled_conductance_is_that_of_the_true_load_on_an_even_pad() -> None:
    found = group_readings(PLAIN, np.random.default_rng(0), np.array([100.0, 800.0]), 2)
    true = PLAIN.law.conductance_s(found.load_g.reshape(4, 4)).reshape(found.siemens.shape)
    np.testing.assert_allclose(found.siemens, true, rtol=1e-9)


def test_observations_are_a_quarter_of_the_weight_each() -> None:
    seen = group_readings(PLAIN, np.random.default_rng(0), np.array([100.0]), 3).observations()
    assert [o.load_g for o in seen] == [25.0] * 3
    assert seen[0].readings.shape == (4,)


def test_averaging_four_takes_about_100_percent_to_about_20() -> None:
    bars = [bars_of(THESIS, seed) for seed in range(4)]
    single = np.mean([np.median(b.single_percent) for b in bars])
    four = np.mean([np.median(b.group_percent) for b in bars])
    assert 80.0 < single < 220.0
    assert 8.0 < four < 35.0
    assert single > 4.0 * four


def test_an_even_pad_scatters_only_by_where_the_stack_stands() -> None:
    bars = bars_of(PLAIN, 0)
    uneven = bars_of(THESIS, 0)
    assert (bars.group_sd_percent < uneven.group_sd_percent).mean() > 0.9
    assert bars.mean_v[-1] < 2.5 + 1e-9  # two share a column, and so the supply


def test_the_range_holds_the_largest_deviation() -> None:
    bars = bars_of(THESIS, 1)
    largest = abs(bars.group_range_v - bars.mean_v).max(axis=0) / bars.mean_v
    assert bars.group_percent == pytest.approx(100 * largest)
