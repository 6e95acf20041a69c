"""The disc that would bear a load evenly: how near, and how it says that the load is not even."""

import math

import numpy as np
import pytest

from tactile_graph.errors import DataError, Degenerate, RuleError
from tactile_graph.wires import Circle, Image, Rectangle
from tactile_graph_fitters.circle.even_load import NOT_SETTLED, OK, Readings, even_disc
from tactile_graph_fitters.circle.fit_circle_load import FitCircleLoad, _why
from tactile_graph_pads.coverage.coverage import coverage_cm2
from tactile_graph_pads.geometry import Geometry

pytestmark = pytest.mark.usefixtures("warm_kernels")

PITCH, ORIGIN = 1.3, (-0.15, -0.15)
GEOMETRY = Geometry(16, 16, 1.0, 0.3)


def loaded(shape, rng=None, sigma=0.0, full=50.0, least=5.0, valid=None):
    """A pad's loads: exact coverage times a lognormal gain; nothing below what shows."""
    grams = full * coverage_cm2(shape, GEOMETRY)
    if rng is not None:
        grams = grams * np.exp(sigma * rng.standard_normal(grams.shape))
    grams[grams < least] = 0.0
    if valid is not None:
        grams[~valid] = 0.0
    return Image(grams, (PITCH, PITCH), ORIGIN, "gram", valid)


def some_disc(rng):
    radius = rng.uniform(3.0, 7.0)
    x, y = rng.uniform(radius, 20.5 - radius, 2)
    return Circle(float(x), float(y), float(radius))


def off(found, truth):
    centre = math.hypot(found.x_cm - truth.x_cm, found.y_cm - truth.y_cm)
    return max(centre, abs(found.radius_cm - truth.radius_cm))


@pytest.mark.slow
def test_an_even_load_gives_the_disc_to_a_hundredth_of_an_element():
    rng = np.random.default_rng(0)
    for _ in range(30):
        truth = some_disc(rng)
        found = FitCircleLoad()(loaded(truth))
        assert off(found, truth) < 1e-3
        assert found.full_load == pytest.approx(50.0, rel=1e-3)
        assert found.uneven < 5e-3


@pytest.mark.slow  # much is compiled
def test_lightly_covered_elements_that_do_not_show_are_no_sign_of_a_smaller_disc():
    """A quarter of a load is needed to show: left out, the radius would come out too small."""
    rng = np.random.default_rng(1)
    discs = [some_disc(rng) for _ in range(20)]
    signed = [
        FitCircleLoad(shows_from=12.5)(loaded(d, least=12.5)).radius_cm - d.radius_cm for d in discs
    ]
    assert abs(np.mean(signed)) < 2e-3
    blind = [FitCircleLoad(shows_from=0.0)(loaded(d, least=12.5)) for d in discs]
    assert np.mean([f.radius_cm - d.radius_cm for f, d in zip(blind, discs, strict=True)]) < -5e-3


@pytest.mark.slow
def test_its_standard_deviations_are_those_of_its_errors():
    rng = np.random.default_rng(2)
    centre, radius = [], []
    for _ in range(200):
        truth = some_disc(rng)
        found = FitCircleLoad()(loaded(truth, rng, sigma=0.05))
        assert 0.02 < found.uneven < 0.08
        centre.append(math.hypot(found.x_cm - truth.x_cm, found.y_cm - truth.y_cm)
                      / found.centre_std_cm)  # fmt: skip
        radius.append((found.radius_cm - truth.radius_cm) / found.radius_std_cm)
    assert 0.85 < np.sqrt(np.mean(np.square(centre))) < 1.2
    assert 0.85 < np.std(radius) < 1.2


@pytest.mark.slow  # takes seconds
@pytest.mark.parametrize("kind", ["uneven", "square", "ring", "two"])
def test_what_bears_no_even_disc_says_so(kind):
    rng = np.random.default_rng(3)
    disc = Circle(10.0, 9.5, 5.0)
    if kind == "uneven":
        image = loaded(disc, rng, sigma=0.5)
    elif kind == "square":
        image = loaded(Rectangle(10.0, 9.5, 9.0, 9.0, 0.3))
    else:
        other = Circle(10.0, 9.5, 2.5) if kind == "ring" else Circle(16.0, 16.0, 3.0)
        sign = -1.0 if kind == "ring" else 1.0
        values = loaded(disc).values + sign * loaded(other).values
        image = Image(np.maximum(values, 0.0), (PITCH, PITCH), ORIGIN, "gram")
    try:
        assert FitCircleLoad()(image).uneven > 0.2
    except Degenerate:
        assert kind in ("ring", "two")


@pytest.mark.slow
def test_invalid_elements_say_nothing():
    rng = np.random.default_rng(4)
    truth = Circle(10.0, 9.0, 5.0)
    valid = rng.random((16, 16)) > 0.2
    found = FitCircleLoad()(loaded(truth, valid=valid))
    assert off(found, truth) < 5e-3
    assert found.n_cells < FitCircleLoad()(loaded(truth)).n_cells


@pytest.mark.slow
def test_a_disc_half_beyond_the_rim_is_found():
    truth = Circle(10.0, 1.0, 4.0)
    assert off(FitCircleLoad()(loaded(truth)), truth) < 2e-3


@pytest.mark.parametrize("factor", [1e-6, 1e6])
def test_the_unit_of_load_does_not_matter(factor):
    truth = Circle(9.0, 9.0, 4.0)
    image = loaded(truth)
    scaled = Image(factor * image.values, (PITCH, PITCH), ORIGIN, "raw")
    found = FitCircleLoad(shows_from=5.0 * factor)(scaled)
    assert off(found, truth) < 1e-3
    assert found.full_load == pytest.approx(50.0 * factor, rel=1e-3)


def test_where_no_disc_is_to_be_had_it_says_why():
    empty = Image(np.zeros((16, 16)), (PITCH, PITCH), ORIGIN, "gram")
    with pytest.raises(Degenerate, match="0 elements bear a load: a disc needs at least 4"):
        FitCircleLoad()(empty)
    few = np.zeros((16, 16))
    few[3, 4] = 70.0
    with pytest.raises(Degenerate, match="1 element bears a load"):
        FitCircleLoad()(Image(few, (PITCH, PITCH), ORIGIN, "gram"))
    block = np.pad(np.full((2, 2), 40.0), 1)
    alone = Image(block, (PITCH, PITCH), ORIGIN, "gram", block > 0.0)
    with pytest.raises(Degenerate, match="4 elements bear a load, which leaves the disc open"):
        FitCircleLoad()(alone)
    assert _why(NOT_SETTLED, 5) == "no even disc found within 20 rounds"


def test_wrong_images_are_refused():
    values = np.ones((4, 4))
    with pytest.raises(RuleError, match=r"square cells, got a pitch of 1 by 2 cm"):
        FitCircleLoad()(Image(values, (1.0, 2.0), quantity="gram"))
    with pytest.raises(RuleError, match=r"gap_cm: must be below the pitch of 0\.2 cm, got 0\.3"):
        FitCircleLoad()(Image(values, (0.2, 0.2), quantity="gram"))
    with pytest.raises(DataError, match="NaN or infinity"):
        FitCircleLoad()(Image(np.full((4, 4), np.nan), quantity="gram"))


@pytest.mark.slow  # much is compiled
@pytest.mark.usefixtures("plain_kernels")
@pytest.mark.parametrize("sigma", [0.0, 0.5])
def test_the_compiled_kernel_finds_the_same(sigma):
    rng = np.random.default_rng(5)
    grid = np.array([0.0, 0.0, 1.3, 1.0])
    for _ in range(5):
        loads = np.array(loaded(some_disc(rng), rng, sigma).values)
        usable = np.ones(loads.shape, np.bool_)
        readings = Readings(loads, usable, grid, 5.0)
        plain, compiled = even_disc.reference(readings), even_disc.compiled(readings)
        assert compiled[0] == plain[0]
        if plain[0] == OK:
            assert compiled[1:8] == pytest.approx(plain[1:8], rel=1e-6, abs=1e-7)


@pytest.mark.parametrize("most", [1e306, 1.7e308])
def test_loads_too_large_for_their_moments_are_refused_without_a_warning(most):
    image = loaded(Circle(10.0, 10.0, 5.0))
    huge = Image(
        image.values * (most / image.values.max()), image.pitch_cm, image.origin_cm, "gram"
    )
    with pytest.raises(Degenerate, match="too large for their moments"):
        FitCircleLoad()(huge)
