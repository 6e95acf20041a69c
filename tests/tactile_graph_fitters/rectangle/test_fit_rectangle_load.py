"""The rectangle under which a footprint and its load are most likely."""

import math

import numpy as np
import pytest
from hypothesis import given, settings

import references_fitters as references
from helpers_modes import compiled, plainly
from helpers_rectangles import covered, off_rad, seeds
from tactile_graph.errors import Degenerate, RuleError
from tactile_graph.wires import Image, Mask, Rectangle
from tactile_graph_fitters.rectangle.fit_rectangle_load import FitRectangleLoad
from tactile_graph_fitters.rectangle.rectangle_likelihood import OFF, ON, UNKNOWN, cost

PITCH, ORIGIN = 1.3, (-0.15, -0.15)


def reading(truth, rng=None, sigma=0.0, voids=0.0, shows=0.16):
    """Mask and image of a pad: exact coverage of each cell times a lognormal gain, or nothing."""
    fine = covered(truth, (320, 320), PITCH / 20, ORIGIN).values
    load = fine.reshape(16, 20, 16, 20).mean(axis=(1, 3)) * 50.0
    if rng is not None:
        load = load * np.exp(sigma * rng.standard_normal((16, 16)))
        load[rng.random((16, 16)) < voids] = 0.0
    load[load < shows * 50.0] = 0.0
    image = Image(load, (PITCH, PITCH), ORIGIN, "gram")
    return image.mask(load > 0.0), image


def some_truth(rng):
    length = rng.uniform(9.0, 15.0)
    return Rectangle(
        float(rng.uniform(9.0, 11.0)),
        float(rng.uniform(9.0, 11.0)),
        float(length),
        float(length * rng.uniform(0.3, 0.6)),
        float(rng.uniform(-1.5, 1.5)),
    )


def test_an_even_load_gives_the_rectangle_within_a_tenth_of_a_cell():
    rng = np.random.default_rng(0)
    for _ in range(12):
        truth = some_truth(rng)
        got = FitRectangleLoad()(*reading(truth))
        off = np.array(
            [
                got.x_cm - truth.x_cm,
                got.y_cm - truth.y_cm,
                got.length_cm - truth.length_cm,
                got.breadth_cm - truth.breadth_cm,
            ]
        )
        assert np.abs(off).max() < 0.3
        assert off_rad(got.angle_rad, truth.angle_rad) < math.radians(2)


def errors(rng, n, use_load):
    rows = []
    for _ in range(n):
        truth = some_truth(rng)
        mask, image = reading(truth, rng, 0.5, 0.16)
        got = FitRectangleLoad()(mask, image if use_load else None)
        rows.append(
            (
                math.degrees(off_rad(got.angle_rad, truth.angle_rad)),
                abs(got.length_cm - truth.length_cm),
                abs(got.breadth_cm - truth.breadth_cm),
            )
        )
    return np.mean(rows, axis=0)


@pytest.mark.slow
def test_bumps_and_voids_cost_little_and_the_load_helps():
    with_load = errors(np.random.default_rng(1), 40, True)
    without = errors(np.random.default_rng(1), 40, False)
    assert with_load[0] < 1.3
    assert with_load[1:].max() < 0.4
    assert (with_load < 0.9 * without).all()


def test_is_in_pad_coordinates():
    truth = Rectangle(10.0, 9.0, 13.0, 5.0, 0.4)
    mask, image = reading(truth)
    here = FitRectangleLoad()(mask, image)
    moved = (ORIGIN[0] + 100.0, ORIGIN[1] + 50.0)
    there = FitRectangleLoad()(
        Mask(mask.values, mask.pitch_cm, moved), Image(image.values, image.pitch_cm, moved)
    )
    assert there.x_cm - 100.0 == pytest.approx(here.x_cm, abs=1e-6)
    assert there.y_cm - 50.0 == pytest.approx(here.y_cm, abs=1e-6)
    assert there.length_cm == pytest.approx(here.length_cm, abs=1e-6)


def test_units_of_the_load_do_not_matter_and_a_power_is_undone():
    mask, image = reading(some_truth(np.random.default_rng(3)), np.random.default_rng(3), 0.5, 0.1)
    here = FitRectangleLoad()(mask, image)
    volts = image.with_values(1e-3 * image.values**1.5)
    there = FitRectangleLoad(load_power=1.5)(mask, volts)
    assert there.length_cm == pytest.approx(here.length_cm, abs=1e-6)
    assert there.angle_rad == pytest.approx(here.angle_rad, abs=1e-6)


def test_a_square_on_its_corner_is_found_from_several_angles_and_declared_ambiguous():
    truth = Rectangle(10.2, 10.1, 9.0, 9.0, math.radians(45))
    got = FitRectangleLoad()(*reading(truth))
    assert got.ambiguous
    assert (got.length_cm, got.breadth_cm) == pytest.approx((9.0, 9.0), abs=0.5)


def test_invalid_cells_say_nothing_either_way():
    truth = Rectangle(10.0, 10.0, 13.0, 7.8, 0.0)
    mask, image = reading(truth)
    broken = np.ones((16, 16), bool)
    broken[:, 5] = False
    holed = Image(np.where(broken, image.values, 0.0), image.pitch_cm, ORIGIN, "gram", broken)
    got = FitRectangleLoad()(Mask(mask.values & broken, mask.pitch_cm, ORIGIN), holed)
    whole = FitRectangleLoad()(mask, image)
    assert got.breadth_cm == pytest.approx(whole.breadth_cm, abs=0.1)
    assert got.length_cm == pytest.approx(whole.length_cm, abs=0.3)


@pytest.mark.parametrize(
    ("cells", "words"),
    [
        ([], "no cell is on: no rectangle fits"),
        ([(3, 3)], "1 cell: a rectangle needs at least 3 that are not in one line"),
        ([(3, 3), (4, 4), (5, 5)], "3 cells: a rectangle needs at least 3 .* one line"),
    ],
)
def test_says_why_there_is_no_rectangle(cells, words):
    values = np.zeros((16, 16), bool)
    for cell in cells:
        values[cell] = True
    with pytest.raises(Degenerate, match=words):
        FitRectangleLoad()(Mask(values))


def test_a_footprint_without_load_is_refused_in_words():
    values = np.zeros((8, 8), bool)
    values[2:5, 2:6] = True
    with pytest.raises(Degenerate, match="none of 12 cells that are on bears a load"):
        FitRectangleLoad()(Mask(values), Image(np.zeros((8, 8))))


def test_a_footprint_without_a_valid_reading_is_not_called_one_without_load():
    cells = np.zeros((8, 8), np.bool_)
    cells[2:6, 2:5] = True
    image = Image(np.zeros((8, 8)), valid=~cells)
    with pytest.raises(Degenerate, match="none of 12 cells that are on has a valid reading"):
        FitRectangleLoad()(Mask(cells), image)


def test_image_and_mask_must_be_of_one_grid():
    with pytest.raises(RuleError, match=r"same shape, got \(4, 4\) and \(5, 5\)"):
        FitRectangleLoad()(Mask(np.ones((5, 5), bool)), Image(np.ones((4, 4))))


def case(seed):
    rng = np.random.default_rng(seed)
    states = rng.choice(np.array([OFF, ON, UNKNOWN], np.uint8), (9, 11), p=[0.4, 0.5, 0.1])
    logs = rng.normal(0, 0.5, (9, 11))
    p = np.array([7.1, 5.9, 4.2, 2.3, rng.uniform(-1.5, 1.5)])
    xs, ys = 0.65 + 1.3 * np.arange(11), 0.65 + 1.3 * np.arange(9)
    law = np.array([0.5, 0.17, 1.8, 1e-3, 1.2, float(seed % 2)])
    return p, logs, states, xs, ys, law


@pytest.mark.parametrize("by", [plainly, compiled])
@settings(max_examples=30, deadline=None)
@given(seed=seeds)
def test_the_cost_is_that_of_the_reference(by, seed):
    slope, expected_slope = np.empty(5), np.empty(5)
    arguments = case(seed)
    expected = references.cost(*arguments, expected_slope)
    assert by(cost)(*arguments, slope) == pytest.approx(expected, rel=1e-10)
    np.testing.assert_allclose(slope, expected_slope, rtol=1e-9, atol=1e-9)


@pytest.mark.parametrize("seed", range(6))
def test_the_slope_is_that_of_the_cost(seed):
    p, *rest = case(seed)
    slope, other = np.empty(5), np.empty(5)
    cost.loops(p, *rest, slope)
    for k in range(5):
        step = np.zeros(5)
        step[k] = 1e-6
        high, low = (cost.loops(p + s, *rest, other) for s in (step, -step))
        assert slope[k] == pytest.approx((high - low) / 2e-6, abs=2e-4)


def test_whole_numbers_of_eight_bits_give_what_the_same_as_floats_do():
    rng = np.random.default_rng(5)
    mask, image = reading(some_truth(rng), rng, 0.3)
    counts = np.minimum(np.round(2.0 * image.values), 255.0)
    found = [FitRectangleLoad()(mask, image.with_values(counts.astype(k))) for k in ("f8", "u1")]
    assert found[0] == found[1]
