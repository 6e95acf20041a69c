import math
import re

import numpy as np
import pytest

import references_filters as references
from helpers_filters import ORIGIN, PITCH, image_of, random_mask
from tactile_graph.errors import DataError, Degenerate, RuleError
from tactile_graph.wires import Image, Mask
from tactile_graph_filters.readings.force import Force
from tactile_graph_filters.readings.load import (
    Load,
    LoadOf,
    counts_cells_at_rest,
    measure,
    measure_within,
)


def test_total_area_peak_and_centre_of_pressure():
    found = LoadOf()(image_of([[0.0, 1.0], [0.0, 3.0]]))
    assert (found.loaded, found.total, found.peak) == (True, 4.0, 3.0)
    assert found.contact_area_cm2 == pytest.approx(2 * PITCH[0] * PITCH[1])
    assert found.x_cm == pytest.approx(ORIGIN[0] + 1.5 * PITCH[0])
    assert found.y_cm == pytest.approx(ORIGIN[1] + 1.25 * PITCH[1])


def test_a_load_made_by_hand_leaves_nothing_out():
    assert Load(True, 4.0, None, 2.0, 3.0, 1.0, 1.0).n_left_out == 0


def test_force_is_given_where_the_unit_has_one():
    values = [[100.0, 900.0]]
    assert LoadOf()(image_of(values, "gram")).force_n == pytest.approx(9.80665)
    assert LoadOf()(image_of(values, "kilopascal")).force_n == pytest.approx(
        1000e3 * PITCH[0] * PITCH[1] * 1e-4
    )
    assert LoadOf()(image_of(values, "counts")).force_n is None


def test_an_unloaded_pad_has_no_centre_and_is_no_error():
    found = LoadOf()(image_of(np.zeros((3, 3)), "gram"))
    assert found == (False, 0.0, 0.0, 0.0, 0.0, None, None, 0)


def test_cells_at_or_below_above_count_for_nothing():
    found = LoadOf(above=1.0)(image_of([[1.0, 0.5, -4.0, 2.0]]))
    assert (found.total, found.peak) == (2.0, 2.0)
    assert found.contact_area_cm2 == pytest.approx(PITCH[0] * PITCH[1])


def test_invalid_cells_count_for_nothing():
    found = LoadOf(above=-1.0)(image_of([[0.0, 2.0]], valid=[[False, True]]))
    assert found.contact_area_cm2 == pytest.approx(PITCH[0] * PITCH[1])
    assert found.total == 2.0
    assert found.n_left_out == 1


def test_cells_beyond_a_calibration_are_counted_as_left_out():
    grams = Force(curve=[(1.0, 100.0)])(image_of([[0.5, 1.5, 0.0]], "volt"))
    found = LoadOf()(grams)
    assert (found.total, found.n_left_out) == (50.0, 1)


def test_only_negative_readings_are_no_load():
    found = LoadOf(above=-10.0)(image_of([[-3.0, -2.0]]))
    assert (found.loaded, found.peak, found.x_cm) == (False, -2.0, None)


@pytest.mark.parametrize("bad", [math.nan, math.inf])
def test_what_is_no_number_is_refused(bad):
    with pytest.raises(DataError, match="row 0, column 0: must be a number"):
        LoadOf()(image_of([[bad, 1.0]]))


@pytest.mark.slow
@pytest.mark.parametrize("above", [0.0, -5.0, 0.7, 9.0])
def test_it_measures_as_the_reference_does(above):
    pytest.importorskip("numba")
    values = np.random.default_rng(0).normal(size=(16, 12))
    usable = random_mask(0, (16, 12)).values
    expected = pytest.approx(references.measure(values, usable, above))
    assert measure.loops(values, usable, above) == expected
    assert measure.compiled(values, usable, above) == expected


def test_where_no_cell_is_valid_the_load_is_not_known_instead_of_0():
    with pytest.raises(Degenerate, match="no cell of the image is valid, so its load is not known"):
        LoadOf()(image_of([[0.0, 0.0]], valid=[[False, False]]))


def pressed(rest: float, noise: float = 1e-3) -> Image:
    values = rest + noise * np.random.default_rng(0).standard_normal((16, 16))
    values[4:8, 4:8] += 1.0
    return image_of(values, "volt")


@pytest.mark.parametrize(
    ("image", "words"),
    [
        (pressed(0.0), "8.% of the contact area is of cells that do not stand out of the others"),
        (
            pressed(0.1),
            "58% of the total is of cells that do not stand out of the others, below 0.",
        ),
        (pressed(0.0, noise=0.05), "2.% of the total is of cells"),
        (image_of(np.full((16, 16), 0.1)), ""),
        (image_of(np.random.default_rng(0).normal(80.0, 6.0, (16, 16))), ""),
        (image_of(np.zeros((16, 16))), ""),
        (image_of(np.eye(16)), ""),
    ],
)
def test_a_total_of_what_untouched_cells_read_says_so(image, words):
    told = counts_cells_at_rest(image, LoadOf()(image))
    assert bool(told) == bool(words)
    assert re.match(words, told)


def test_noise_around_zero_adds_nothing_to_a_footprint_s_load():
    image = pressed(0.0, noise=0.05)
    footprint = image.mask(image.values > 0.5)
    found, alone = LoadOf()(image, footprint), LoadOf()(image)
    cell_cm2 = PITCH[0] * PITCH[1]
    assert found.contact_area_cm2 == pytest.approx(16 * cell_cm2)
    assert alone.contact_area_cm2 > 100 * cell_cm2
    assert found.total == pytest.approx(image.values.sum())
    assert alone.total == pytest.approx(image.values[image.values > 0].sum())
    assert found.x_cm == pytest.approx(ORIGIN[0] + 6.0 * PITCH[0], abs=0.05)
    assert (found.loaded, found.peak) == (alone.loaded, alone.peak)
    assert counts_cells_at_rest(image, found) == ""


@pytest.mark.parametrize("shape", [(16, 16), (5, 12), (64, 64), (4, 4)])
def test_noise_around_zero_loads_nothing_though_it_sums_up_to_something(shape):
    rng = np.random.default_rng(0)
    for _ in range(50):
        values = rng.normal(0.0, 1.0, shape)
        of_noise = LoadOf()(Image(values.copy()), Mask(np.zeros(shape, dtype=bool)))
        assert not of_noise.loaded
        assert of_noise.x_cm is None
        values[1:3, 1:3] += 20.0
        on = np.zeros(shape, dtype=bool)
        on[1:3, 1:3] = True
        assert LoadOf()(Image(values.copy()), Mask(on.copy())).loaded
    # What lies on the whole pad leaves no footprint, and is a load all the same.
    assert LoadOf()(Image(values + 1.0), Mask(~on & on)).loaded


def test_what_noise_sums_up_to_is_of_the_valid_cells_alone():
    shape, loaded = (16, 16), 0
    valid = np.zeros(shape, dtype=bool)
    valid[:4] = True
    for seed in range(400):
        noise = np.random.default_rng(seed).normal(0.0, 1.0, shape)
        loaded += LoadOf()(Image(noise, valid=valid), Mask(np.zeros(shape, dtype=bool))).loaded
    assert loaded <= 1


def test_an_empty_mat_that_cuts_off_its_noise_at_zero_tells_that_no_cell_stands_out():
    noise = np.random.default_rng(0).normal(0.0, 1.0, (48, 18))
    empty = Image(noise.clip(min=0.0), quantity="kilopascal")
    assert "no cell stands out" in counts_cells_at_rest(empty, LoadOf()(empty))
    covered = Image(20.0 + noise, quantity="kilopascal")
    assert not counts_cells_at_rest(covered, LoadOf()(covered))


def test_a_footprint_changes_nothing_where_no_cell_reads_less_than_zero():
    """But the area, which is its own: makers of pads print the sum of all cells."""
    image = image_of([[0.0, 0.1, 3.0], [0.2, 0.0, 5.0]])
    found, alone = LoadOf()(image, image.mask(image.values > 1.0)), LoadOf()(image)
    cell_cm2 = PITCH[0] * PITCH[1]
    assert (found.contact_area_cm2, alone.contact_area_cm2) == (2 * cell_cm2, 4 * cell_cm2)
    assert found._replace(contact_area_cm2=0.0) == alone._replace(contact_area_cm2=0.0)


def test_of_a_pad_that_rests_above_zero_area_and_centre_are_the_footprint_s_and_the_total_is_told():
    image = pressed(0.1)
    found, alone = LoadOf()(image, image.mask(image.values > 0.5)), LoadOf()(image)
    assert found.contact_area_cm2 == pytest.approx(16 * PITCH[0] * PITCH[1])
    assert found.x_cm == pytest.approx(ORIGIN[0] + 6.0 * PITCH[0], abs=0.01)
    assert alone.x_cm == pytest.approx(ORIGIN[0] + 7.23 * PITCH[0], abs=0.01)
    assert found.total == alone.total == pytest.approx(image.values.sum())
    told = counts_cells_at_rest(image, found)
    assert told.startswith(
        "58% of the total is of cells that do not stand out of the others, below"
    )
    assert "centre" not in told
    assert "draws the centre along" in counts_cells_at_rest(image, alone)


@pytest.mark.parametrize("rest", [-2.0, 0.0, 1.0, 3.0, 6.0, 40.0])
def test_the_centre_of_what_lies_still_does_not_hang_on_single_cells_that_read_nothing(rest):
    rng, y, x = np.random.default_rng(0), *np.mgrid[:16, :16]
    on = np.hypot(x - 3.0, y - 7.0) < 2.3
    found = []
    for _ in range(40):
        values = np.clip(np.round(rng.normal(rest, 2.0, (16, 16)) + 100.0 * on), 0.0, None)
        its = LoadOf()(Image(values), Mask(on.copy()))
        assert its.loaded
        found.append((its.x_cm, its.y_cm))
    assert np.std(found, axis=0).max() < 0.15
    if rest > 2.0:
        np.testing.assert_allclose(np.mean(found, axis=0), (3.5, 7.5), atol=0.1)


def test_one_cell_more_that_reads_a_count_moves_the_centre_by_little():
    y, x = np.mgrid[:16, :16]
    on = np.hypot(x - 3.0, y - 7.0) < 2.1
    others, found = np.argwhere(~on), []
    np.random.default_rng(0).shuffle(others)
    values = 60.0 * on
    for i, j in others:
        values[i, j] = 1.0
        found.append(LoadOf()(Image(values.copy()), Mask(on.copy())).x_cm)
    assert np.abs(np.diff(found)).max() < 0.06
    assert found[-1] == pytest.approx(3.5)


def test_a_broken_cell_is_on_no_footprint_and_beside_none():
    values, valid = np.full((3, 3), 0.1), np.ones((3, 3), bool)
    values[1, :] = 0.0, 5.0, 5.0
    valid[1, 0] = valid[1, 2] = False
    image = image_of(values, valid=valid)
    found = LoadOf()(image, image.mask(values >= 5.0))
    assert found.contact_area_cm2 == pytest.approx(PITCH[0] * PITCH[1])
    assert found.x_cm == pytest.approx(ORIGIN[0] + 1.5 * PITCH[0])


@pytest.mark.slow
@pytest.mark.parametrize("above", [0.0, -5.0, 0.7, 9.0])
def test_within_a_footprint_it_measures_as_the_reference_does(above):
    pytest.importorskip("numba")
    values = np.random.default_rng(0).normal(size=(16, 12))
    usable, on = (random_mask(seed, (16, 12)).values for seed in (0, 1))
    n, total, _, x, y, _ = references.measure(values, usable & on, above)
    beside = values[usable & ~on]
    whole = references.measure(values, usable, above)
    its = n, total, x, y, beside.size, (beside > 0.0).sum()
    expected = pytest.approx((*whole, *its))
    assert measure_within.loops(values, usable, on, above) == expected
    assert measure_within.compiled(values, usable, on, above) == expected


def test_without_a_footprint_s_cell_the_area_is_0():
    image = image_of([[-1.0, 2.0], [-2.0, -1.5]])
    found = LoadOf()(image, image.mask(image.values > 9.0))
    assert (found.total, found.contact_area_cm2) == (-2.5, 0.0)
    assert (found.loaded, found.x_cm, found.y_cm) == (False, None, None)


def test_a_footprint_of_another_shape_is_refused():
    image = image_of(np.eye(3))
    with pytest.raises(RuleError, match="mask"):
        LoadOf()(image, image_of(np.eye(2)).mask(np.eye(2) > 0.5))


def test_nothing_is_said_where_such_cells_are_left_out():
    image = pressed(0.1)
    assert counts_cells_at_rest(image, LoadOf(above=0.5)(image)) == ""
