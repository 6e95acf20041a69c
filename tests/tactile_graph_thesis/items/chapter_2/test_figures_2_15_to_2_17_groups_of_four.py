"""Groups of four share their weight, and their mean scatters far less than single elements."""

from __future__ import annotations

import numpy as np
import pytest

from tactile_graph_pads.pad import Pad, load_pad
from tactile_graph_thesis.items.chapter_2.figures_2_15_to_2_17_groups_of_four import (
    ErrorBars,
    about_as_in_the_thesis,
    error_bars,
    rises_and_flattens,
)
from tactile_graph_thesis.measure.groups_of_four import GroupReadings, group_readings

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


@pytest.mark.slow
def test_averaging_four_takes_about_100_percent_to_about_20() -> None:
    bars = [bars_of(THESIS, seed) for seed in range(4)]
    single = np.mean([np.median(b.single_percent) for b in bars])
    four = np.mean([np.median(b.group_percent) for b in bars])
    assert 80.0 < single < 220.0
    assert 8.0 < four < 35.0
    assert single > 4.0 * four


@pytest.mark.slow
def test_an_even_pad_scatters_only_by_where_the_stack_stands() -> None:
    bars = bars_of(PLAIN, 0)
    uneven = bars_of(THESIS, 0)
    assert (bars.group_sd_percent < uneven.group_sd_percent).mean() > 0.9
    assert bars.mean_v[-1] < 2.5 + 1e-9  # two share a column, and so the supply


def test_the_range_holds_the_largest_deviation() -> None:
    bars = bars_of(THESIS, 1)
    largest = abs(bars.group_range_v - bars.mean_v).max(axis=0) / bars.mean_v
    assert bars.group_percent == pytest.approx(100 * largest)


def bars(single_percent: float, group_percent: float) -> ErrorBars:
    one = np.ones(3)
    single, group = single_percent * one, group_percent * one
    return ErrorBars(one, one, group, single, 0.5 * group, 0.5 * single, one, one)


@pytest.mark.parametrize(
    ("single", "group", "expected"),
    [
        (100.0, 20.0, [True, True, True]),
        (45.0, 20.0, [False, True, False]),
        (210.0, 20.0, [False, True, True]),
        (190.0, 45.0, [True, False, True]),
        (60.0, 9.0, [True, False, True]),
        (60.0, 30.0, [True, True, False]),
        (200.0, 40.0, [False, False, True]),
        (50.0, 10.0, [False, False, True]),
    ],
)
def test_bars_of_another_size_refute_the_thesis(
    single: float, group: float, expected: list[bool]
) -> None:
    assert [f.holds for f in about_as_in_the_thesis(bars(single, group))] == expected


def test_independent_elements_are_no_dramatic_improvement() -> None:
    rng = np.random.default_rng(2)
    read = 1.0 + 0.3 * rng.standard_normal((9, 20, 4))
    even = GroupReadings(np.arange(1.0, 21.0), np.zeros((9, 2), np.intp), read, read, read)
    assert not about_as_in_the_thesis(error_bars(even))[2].holds


@pytest.mark.parametrize(
    ("law", "expected"),
    [
        (lambda g: 1.0 - np.exp(-g / 600.0), [True, True]),
        (lambda g: g / 3000.0, [True, False]),
        (lambda g: 1.0 - np.abs(g - 2000.0) / 3000.0, [False, True]),
    ],
    ids=["flattens", "straight", "falls"],
)
def test_a_straight_curve_does_not_flatten_and_a_falling_one_does_not_rise(
    law: object, expected: list[bool]
) -> None:
    weights = np.array([50.0, 100.0, 400.0, 700.0, 750.0, 1500.0, 2000.0, 2500.0, 3000.0])
    read = np.repeat(law(weights)[None, :, None], 4, axis=2)  # type: ignore[operator]
    found = rises_and_flattens(GroupReadings(weights, np.zeros((1, 2), np.intp), read, read, read))
    assert [f.holds for f in found] == expected
