"""Each kind of curve finds the law its readings were made by, or says why not."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tactile_graph.errors import DataError
from tactile_graph_pads.calibration.fit import (
    calibrated,
    fit_isotonic,
    fit_polynomial,
    fit_power,
    fit_sums,
    fitted_g,
)
from tactile_graph_pads.calibration.points import Observation, points_of

LOADS = np.array([15.0, 30, 60, 100, 160, 250, 400, 650])


def seen_of(readings: np.ndarray) -> list[Observation]:
    return [Observation(float(g), np.full(4, r)) for g, r in zip(LOADS, readings, strict=True)]


def test_a_fifth_order_polynomial_comes_back_exactly() -> None:
    readings = np.linspace(0.2, 2.0, 8)
    true = np.array([0.0, 5.0, 3.0, 1.0, 0.5, 0.25])
    found = fit_polynomial(readings, np.polyval(true[::-1], readings), 5)
    np.testing.assert_allclose(found.coefficients, true, atol=1e-8)


def test_a_power_law_comes_back_exactly_in_siemens() -> None:
    siemens = 1.3e-8 * LOADS**1.463
    found = fit_power(siemens, LOADS)
    assert found.unit == 1e-6
    assert found.exponent == pytest.approx(1 / 1.463)
    np.testing.assert_allclose(found.grams(siemens), LOADS, rtol=1e-12)


def test_isotonic_lines_pass_through_points_that_rise() -> None:
    readings = np.sqrt(LOADS)
    found = fit_isotonic(readings, LOADS, np.ones(8))
    np.testing.assert_allclose(found.grams(readings), LOADS)
    assert found.points[0] == (0.0, 0.0)


@pytest.mark.slow
@given(st.lists(st.floats(0.01, 10.0), min_size=8, max_size=8))
@settings(max_examples=60)
def test_isotonic_lines_are_the_nearest_that_do_not_fall(readings: list[float]) -> None:
    """Against scipy's own regression, in the values at each load."""
    isotonic_regression = pytest.importorskip("scipy.optimize").isotonic_regression
    expected = np.unique(np.round(isotonic_regression(readings).x, 9))
    if len(expected) < 2:
        with pytest.raises(DataError, match="do not rise with the loads at all"):
            fit_isotonic(np.array(readings), LOADS, np.ones(8))
        return
    found = fit_isotonic(np.array(readings), LOADS, np.ones(8))
    np.testing.assert_allclose([r for r, _ in found.points[1:]], expected, atol=1e-8)


def test_sums_see_through_unevenness_where_means_do_not() -> None:
    """Elements of an uneven group bear different loads; only their sum is known."""
    rng = np.random.default_rng(0)
    seen = []
    for _ in range(60):
        share = rng.lognormal(0.0, 0.9, 4)
        seen += [Observation(float(g), (g * 4 * share / share.sum()) ** 1.46) for g in LOADS]
    points = points_of(seen)
    load = np.array([60.0, 160.0, 400.0])
    by_sums = calibrated(points, "sums", "siemens", observations=seen)
    by_means = calibrated(points, "power", "siemens")
    off = [c.grams_of(load**1.46).load_g / load - 1.0 for c in (by_sums, by_means)]
    assert abs(off[0]).max() < 0.05
    assert abs(off[1]).max() > 0.08
    assert by_sums.quality.rms_percent < 2.0


def test_sums_need_the_observations() -> None:
    with pytest.raises(ValueError, match="the fit by sums needs the observations"):
        fit_sums([], LOADS)


def test_weights_that_no_rising_curve_explains_are_refused() -> None:
    seen = [Observation(10.0, np.array([-1.0, -1.0]))]
    with pytest.raises(DataError, match="no rising curve explains"):
        fit_sums(seen, np.array([1.0]))


def test_a_polynomial_that_falls_is_refused() -> None:
    readings = np.array([0.1, 0.2, 0.3, 0.4, 1.9, 1.95, 2.0])
    loads = np.array([10.0, 20, 30, 2000, 2100, 2200, 9000])
    with pytest.raises(DataError, match=r"not monotone: the polynomial of order 5 falls between"):
        fit_polynomial(readings, loads, 5)


def test_a_power_that_falls_is_refused() -> None:
    with pytest.raises(DataError, match="not monotone: the loads go with reading"):
        fit_power(LOADS[::-1], LOADS)


@pytest.mark.parametrize(
    ("kind", "needed", "what"),
    [("polynomial", 6, "a polynomial of order 5"), ("isotonic", 3, "the fit isotonic"),
     ("sums", 3, "the fit sums"), ("power", 3, "the fit power")],
)  # fmt: skip
def test_too_few_loads_are_refused(kind: str, needed: int, what: str) -> None:
    points = points_of(seen_of(LOADS**0.8))
    few = points[: needed - 1]
    match = f"too few loads: {what} needs {needed} different ones, got {needed - 1}"
    with pytest.raises(DataError, match=match):
        calibrated(few, kind)  # type: ignore[arg-type]
    seen = seen_of(LOADS**0.8)[:needed]
    assert calibrated(points[:needed], kind, observations=seen).up_to > 0  # type: ignore[arg-type]


def test_quality_says_how_far_the_fit_is_off() -> None:
    points = points_of(seen_of(LOADS**0.5 * np.array([1, 1, 1, 1.1, 1, 1, 1, 1])))
    made = calibrated(points, "power")
    off = 100 * (fitted_g(made.fit, points) / LOADS - 1)
    assert made.quality.rms_percent == pytest.approx(np.sqrt((off**2).mean()))
    assert made.quality.largest_percent == pytest.approx(abs(off).max())
    assert 10.0 < made.quality.largest_percent < 20.0
    assert made.quality.r_squared < 1.0


def test_pooled_readings_end_the_range_where_they_stop_rising() -> None:
    readings = np.array([1.0, 2, 3, 4, 5, 6, 7.2, 7.0])
    made = calibrated(points_of(seen_of(readings)), "isotonic")
    assert made.up_to == pytest.approx(7.1)
    assert made.grams_of(np.array([7.1])).load_g[0] == pytest.approx(525.0)
