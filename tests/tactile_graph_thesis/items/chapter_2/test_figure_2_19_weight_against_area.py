"""Figure 2.19: the error that grows with area is the circuit's, and decoupling takes it off."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from tactile_graph.errors import UsageError
from tactile_graph_pads.geometry import Geometry
from tactile_graph_pads.pad import load_pad
from tactile_graph_thesis.items.chapter_2.figure_2_19_weight_against_area import (
    PRESSURES_G_CM2,
    Weighings,
    put_down,
    table_2_2_radii_cm,
    weight_area,
)
from tactile_graph_thesis.measure.bench import Bench


@cache
def weighed(pad: str, seed: int) -> Weighings:
    return weight_area(load_pad(pad), np.random.default_rng(seed), 12)


def size(found: Weighings, values: np.ndarray) -> np.ndarray:
    return abs(found.error_percent(values)).mean(axis=1)


@pytest.mark.parametrize("pad", ["thesis", "plain"])
@pytest.mark.parametrize("seed", [0, 1])
@pytest.mark.slow
def test_without_decoupling_the_error_grows_with_area(pad: str, seed: int) -> None:
    found = weighed(pad, seed)
    by_area = size(found, found.coupled_g)[np.argsort(found.area_cm2)]
    assert found.growth(found.coupled_g) > 12.0
    assert by_area[-1] > 2.0 * by_area[0]
    assert (np.diff(by_area) > 0.0).all()


@pytest.mark.slow
@pytest.mark.parametrize(
    ("pad", "seed"),
    [
        ("thesis", 0),
        *(pytest.param(*it, marks=pytest.mark.slow) for it in [("thesis", 1), ("plain", 1)]),
        ("plain", 0),
    ],
)
def test_with_decoupling_that_growth_is_gone(pad: str, seed: int) -> None:
    found = weighed(pad, seed)
    for values in (found.decoupled_g, found.sums_g):
        assert abs(found.growth(values)) < 0.1 * found.growth(found.coupled_g)
        assert np.ptp(size(found, values)) < 5.0


@pytest.mark.slow
def test_calibrated_by_sums_weights_come_out_right() -> None:
    found = weighed("thesis", 0)
    assert size(found, found.sums_g).max() < 5.0
    assert size(found, found.sums_g).max() < 0.5 * size(found, found.decoupled_g).min()


def test_objects_stand_under_equal_pressures() -> None:
    found = weighed("thesis", 0)
    radius = np.array([*table_2_2_radii_cm().values()])
    assert radius.tolist() == [6.9, 6.1, 4.3, 3.8, 2.5]
    np.testing.assert_allclose(found.area_cm2, np.pi * radius**2)
    np.testing.assert_allclose(found.weight_g / found.area_cm2[:, None], [PRESSURES_G_CM2] * 5)


@pytest.mark.slow
def test_at_one_weight_the_curve_without_decoupling_always_reads_too_little() -> None:
    found = weighed("plain", 0)
    assert (found.error_percent(found.coupled_g) < 0.0).all()


def test_an_object_that_does_not_fit_on_the_pad_is_told() -> None:
    flat = replace(load_pad("plain"), geometry=Geometry(5, 40, 0.8, 0.45))
    bench = Bench(flat, np.random.default_rng(0))
    told = "a disc of 3 cm radius does not fit on the pad of 49.55 by 5.8 cm"
    with pytest.raises(UsageError, match=told):
        put_down(bench, 3.0, 100.0)
    assert put_down(bench, 2.9, 100.0).shape == (5, 40)
