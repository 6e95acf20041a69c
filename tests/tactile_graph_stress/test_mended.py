"""What the stress found once and must not come back."""

import math

import numpy as np
import pytest

from helpers_stress import subject_of
from tactile_graph import Image, Mask, Points
from tactile_graph_stress import measure, scenes
from tactile_graph_stress.references.known import reference_of
from tactile_graph_stress.trial import Trial

pytestmark = pytest.mark.slow


def came(name, given, settings=None, feed=""):
    return Trial(subject_of(name, feed)).run(given, settings)


def image(values):
    return Image(np.array(values, dtype=np.float64), quantity="volt")


RNG = np.random.default_rng(5)
ROUND = scenes.noisy(scenes.arc(300.0), RNG)
OVAL = scenes.noisy(scenes.ellipse(), RNG)
HUGE = np.where(np.arange(64).reshape(8, 8) % 2 == 0, 1.7e308, -1.7e308)
LARGE = np.linspace(0.5, 1.0, 64).reshape(8, 8) * 1.7e308


@pytest.mark.parametrize("flat", [1e-3, 1e-6])
def test_the_circle_of_nearly_straight_points_keeps_its_digits(flat):
    """It stopped where the sum of squares looked flat: 6 % off at a millionth."""
    xy = (ROUND - ROUND.mean(axis=0)) * (1.0, flat)
    value = came("fit_circle", Points(xy)).value
    right = reference_of("fit_circle")(xy, value)
    assert measure.against_reference(value, xy, right).units < 100.0


def test_the_thesis_iteration_does_not_settle_on_a_saddle():
    """Nearly straight points: it gave a circle about their middle."""
    x = np.linspace(-1.0, 1.0, 12)
    xy = np.vstack([np.column_stack([x, x * 0.0 + side]) for side in (-1e-9, 1e-9)])
    assert "a straight line fits as well" in came("fit_circle_thesis", Points(xy)).gave_up


def test_the_nearest_ellipse_is_the_same_in_any_order():
    """A damped step was taken for a small one: 1e-11 of its size from the minimum."""
    for _ in range(4):
        xy = RNG.permutation(OVAL)
        value = came("fit_ellipse", Points(xy)).value
        right = reference_of("fit_ellipse")(xy, value)
        assert measure.against_reference(value, xy, right).units < 10.0


@pytest.mark.parametrize("name", ["fit_ellipse", "fit_ellipse_direct"])
@pytest.mark.parametrize("power", [-1000, 900])
def test_an_ellipse_may_be_of_any_size(name, power):
    """It said that such points were on one line."""
    plain = came(name, Points(OVAL.copy())).value
    scaled = came(name, Points(np.ldexp(OVAL, power))).value
    assert scaled.semi_major_cm == math.ldexp(plain.semi_major_cm, power)
    assert "distinct" in came(name, Points(np.full((3, 2), 1e308))).gave_up


def test_a_swept_ellipse_is_reckoned_in_doubles():
    narrow = OVAL.astype(np.float32)
    got, want = (came("ellipse_sweep", Points(xy)).value for xy in (narrow, narrow.astype(float)))
    assert got == want


@pytest.mark.parametrize("power", [-1030, 1015])
def test_a_smallest_rectangle_may_be_of_any_size(power):
    plain = came("min_area_rectangle", Points(OVAL.copy())).value
    scaled = came("min_area_rectangle", Points(np.ldexp(OVAL, power))).value
    assert scaled.length_cm == pytest.approx(math.ldexp(plain.length_cm, power), rel=1e-10)


@pytest.mark.parametrize("scale", [1e-150, 1e150])
def test_the_robust_axis_minds_no_pitch(scale):
    plain, scaled = (
        came("orientation_robust", Mask(scenes.blob(), (p, p))).value for p in (1.0, scale)
    )
    assert scaled.angle_rad == pytest.approx(plain.angle_rad, abs=1e-14)
    assert scaled.x_cm == pytest.approx(plain.x_cm * scale, rel=1e-14)


@pytest.mark.parametrize("name", ["icm", "gnc", "restore", "trw"])
def test_a_range_beyond_the_numbers_is_restored(name):
    """Labels came out of the range of their tables, which ended the process."""
    found = came(name, image(HUGE))
    assert found.broke == ""
    assert np.abs(found.value.image.values).max() <= 1.7e308


@pytest.mark.parametrize("name", ["sobel", "digital_gradient", "partial_differences"])
def test_gradients_refuse_what_has_none(name):
    values = np.ones((5, 5))
    values[2, 3] = np.nan
    assert "row 2, column 3: must be a number" in came(name, image(values)).gave_up
    assert "differ by more than a number can hold" in came(name, image(HUGE)).gave_up


@pytest.mark.parametrize("name", ["mask", "inpaint", "subdivide_image", "crop"])
def test_steps_that_hand_values_on_hand_on_no_nan(name):
    values = np.ones((5, 5))
    values[2, 3] = -np.inf
    assert "row 2, column 3: must be a number" in came(name, image(values)).gave_up


@pytest.mark.parametrize("name", ["load", "low_pass", "contacts", "split_contacts", "features"])
def test_sums_beyond_the_numbers_are_refused(name):
    assert came(name, image(LARGE)).gave_up


@pytest.mark.parametrize("name", ["heavier_side", "threshold_otsu", "threshold_valley", "force"])
def test_what_needs_no_such_sum_answers(name):
    found = came(name, image(HUGE))
    assert found.broke == ""


def test_subnormal_readings_are_split():
    assert came("split_contacts", image(scenes.load(RNG) * 1e-318)).broke == ""


def test_a_floating_pads_faintest_readings_are_decoupled():
    settings = {"pad": {"circuit": {"kind": "floating", "bias_ohm": 33e3}}}
    faint, plain = (
        came("decouple", image(np.full((3, 3), v)), settings).value for v in (1e-299, 1e-9)
    )
    assert faint.values / 1e-290 == pytest.approx(plain.values, rel=1e-6)


def test_a_dividers_impossible_sums_are_invalid():
    found = came("decouple", image(np.full((4, 4), 1e308)))
    assert not found.value.valid.any()


@pytest.mark.parametrize("pitch", [1e-100, 1e78, 1e140])
def test_a_masks_orientation_is_the_same_at_any_pitch(pitch):
    on = np.array([[1, 1, 0], [1, 1, 1]], dtype=np.bool_)
    sized, plain = (
        came("orientation", Mask(on, (p, 1.3 * p), (0.0, 0.0)), feed="mask").value
        for p in (pitch, 1.0)
    )
    assert sized.elongation == pytest.approx(plain.elongation, rel=1e-12)
    assert sized.angle_rad == pytest.approx(plain.angle_rad, rel=1e-12)
