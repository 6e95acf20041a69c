"""What `describe` says of an object: known shapes, any place, turn and unit, refusals."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy import ndimage

from helpers_classifiers import digital_disc, image_and_mask
from tactile_graph.errors import DataError, Degenerate
from tactile_graph_classifiers.measuring import load_spread, outline
from tactile_graph_classifiers.measuring.describe import NAMES, Describe
from tactile_graph_classifiers.measuring.features import FeaturesOf

TURNS_WITH_IT = {"moment_xx_cm2", "moment_yy_cm2", "moment_xy_cm2"}
IN_THE_IMAGES_UNIT = {"weight", "load_mean", "load_sd", "peak"}


def described(on, values=None, **more):
    found = Describe()(*image_and_mask(on, values, **more)).measurements
    return dict(zip(found.names, found.values.tolist(), strict=True))


def lopsided() -> tuple[np.ndarray, np.ndarray]:
    """Return a footprint of two parts, one with a hole, and an uneven load on it."""
    on = np.zeros((20, 24), dtype=bool)
    on[3:12, 4:9] = True
    on[6:8, 6] = False
    on[10:12, 12:17] = True
    y, x = np.indices(on.shape)
    return on, np.where(on, 5.0 + x + 0.5 * y * x % 7, 0.0)


def test_a_disc_is_solid_round_and_of_one_part():
    found = described(digital_disc(20.0), pitch=(0.5, 0.5))
    assert found["solidity"] == pytest.approx(1.0, abs=0.04)
    assert found["length_cm"] == pytest.approx(20.0, rel=0.04)
    assert found["breadth_cm"] == pytest.approx(20.0, rel=0.03)
    assert (found["parts"], found["largest_part"], found["filled_share"]) == (1.0, 1.0, 1.0)
    assert found["inscribed_cm"] == pytest.approx(10.0, rel=0.06)
    assert found["gyration_cm"] == pytest.approx(10.0 / math.sqrt(2.0), rel=0.01)
    assert found["moment_22"] == pytest.approx(4.0 / 3.0, rel=0.01)  # of r^4 over (r^2 / 2)^2
    assert max(found[f"moment_{n}"] for n in ("20", "30", "21", "31", "50", "60")) < 0.01


def test_an_even_load_is_borne_by_the_whole_area():
    found = described(np.ones((6, 8), dtype=bool), pitch=(2.0, 1.0))
    assert found["bearing_cm2"] == pytest.approx(96.0)
    assert (found["load_quantile_5"], found["peak_over_mean"]) == (1.0, 1.0)
    assert (found["core_cm2"], found["core_load"]) == (96.0, pytest.approx(1.0))
    assert found["load_gyration_cm"] == pytest.approx(math.sqrt((16.0**2 + 6.0**2) / 12.0))
    assert found["steepness_cm"] == pytest.approx(2.0 * (16.0 + 6.0) / 48.0)


def test_two_feet_are_two_parts_of_half_the_area_each():
    on = np.zeros((9, 20), dtype=bool)
    on[3:6, 2:5] = on[3:6, 15:18] = True
    found = described(on)
    assert (found["parts"], found["largest_part"]) == (2.0, 0.5)
    assert found["solidity"] == pytest.approx(18.0 / 48.0)
    assert found["length_cm"] == pytest.approx(math.hypot(16.0, 3.0), rel=1e-2)


def test_the_core_is_where_readings_are_large():
    values = np.where(digital_disc(4.0, 24), 10.0, 1.0)
    found = described(digital_disc(10.0, 24), values)
    assert found["core_cm2"] == np.count_nonzero(digital_disc(4.0, 24))
    assert found["core_length_cm"] < 0.5 * found["length_cm"]


@pytest.mark.parametrize("change", ["move", "turn", "mirror"])
def test_a_move_a_turn_or_a_mirror_changes_nothing(change):
    on, values = lopsided()
    move = {"move": lambda a: np.roll(a, (5, 6), (0, 1)), "turn": np.rot90, "mirror": np.fliplr}
    first, second = described(on, values), described(move[change](on), move[change](values))
    for name in set(NAMES) - TURNS_WITH_IT:
        assert second[name] == pytest.approx(first[name], rel=1e-6, abs=1e-9), name


def test_the_unit_changes_only_what_is_in_it():
    on, values = lopsided()
    first, second = described(on, values), described(on, 1e-30 * values)
    for name in set(NAMES) - TURNS_WITH_IT:
        factor = 1e-30 if name in IN_THE_IMAGES_UNIT else 1.0
        assert second[name] == pytest.approx(factor * first[name], rel=1e-6, abs=0), name


def test_it_says_all_that_features_says():
    image, mask = image_and_mask(*lopsided())
    measured, first = Describe()(image, mask), FeaturesOf()(image, mask).measurements
    assert measured.measurements.names[: len(first.names)] == first.names
    assert measured.measurements.values[: len(first.names)].tolist() == first.values.tolist()
    assert measured.weight == pytest.approx(image.values.sum())
    assert measured.measurements.quantity == "gram"
    assert [*measured.summary()] == ["weight", "area_cm2", "axis_ratio", "solidity"]
    assert measured.summary()["solidity"] == measured.solidity < 1.0


def test_a_moment_that_is_0_for_symmetry_is_0_and_no_rounding():
    found = described(np.ones((6, 6), dtype=bool))
    assert [found[f"moment_{n}"] for n in ("20", "30", "21", "31", "50", "60")] == [0.0] * 6


def test_a_single_cell_has_finite_numbers():
    on = np.zeros((3, 3), dtype=bool)
    on[1, 1] = True
    found = described(on)
    assert np.isfinite(list(found.values())).all()
    assert found["solidity"] == pytest.approx(1.0)


def test_cells_that_are_not_valid_bear_nothing():
    on = np.ones((3, 4), dtype=bool)
    valid = on.copy()
    valid[0, 0] = False
    values = np.ones((3, 4))
    values[0, 0] = np.nan
    found = described(on, values, valid=valid)
    assert (found["weight"], found["core_cm2"]) == (11.0, 11.0)


def test_what_cannot_be_measured_is_refused_as_by_features():
    empty = np.zeros((3, 3), dtype=bool)
    with pytest.raises(Degenerate, match="the footprint is empty"):
        described(empty)
    with pytest.raises(Degenerate, match="there is no weight to measure"):
        described(~empty, np.zeros((3, 3)))
    with pytest.raises(DataError, match="no finite number"):
        described(~empty, np.full((3, 3), np.nan))


@pytest.mark.parametrize("n", [1, 2, 3, 20, 501])
def test_quantiles_are_those_of_numpy(n):
    values = np.random.default_rng(n).normal(size=n).round(1)
    shares = [0.0, 0.05, 0.25, 0.5, 0.75, 0.9, 0.95, 1.0]
    np.testing.assert_array_equal(outline.quantiles(values, shares), np.quantile(values, shares))


def test_a_border_holes_and_moments_are_those_of_numpy_and_scipy():
    rng = np.random.default_rng(3)
    on = rng.random((14, 11)) < 0.6
    np.testing.assert_array_equal(outline.bordered(on), np.pad(on, 1))
    filled = described(on)["filled_share"]
    assert filled == np.count_nonzero(on) / np.count_nonzero(ndimage.binary_fill_holes(on))
    z, shares = rng.normal(size=30) + 1j * rng.normal(size=30), rng.dirichlet(np.ones(30))
    wanted = [abs((shares * z**p * z.conj() ** q).sum()) for p, q in outline.ORDERS]
    np.testing.assert_allclose(outline.moments(z, shares), wanted, rtol=1e-12)


def test_how_far_an_image_was_moved_is_found_once_for_images_of_a_size():
    load_spread._rings.cache_clear()
    on, values = lopsided()
    for factor in (1.0, 2.0):
        described(on, factor * values)
    assert load_spread._rings.cache_info().misses == 1
