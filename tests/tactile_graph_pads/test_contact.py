"""Weight comes down on elements, and none of it is lost or made."""

import numpy as np
import pytest

from tactile_graph.wires import Circle, Ellipse, Polygon, Rectangle
from tactile_graph_pads.contact import Contact, Grain, spread
from tactile_graph_pads.coverage.coverage import coverage_cm2
from tactile_graph_pads.geometry import Geometry

PAD = Geometry()
DISC = Circle(9.7, 10.4, 5.1)
SHAPES = [
    DISC,
    Rectangle(10.0, 10.0, 14.0, 3.0, 0.4),
    Ellipse(9.0, 11.0, 6.0, 3.0, -0.7),
    Polygon(np.array([[4.0, 4.0], [12.0, 5.0], [7.0, 13.0]])),
]


@pytest.fixture
def gains():
    rng = np.random.default_rng(0)
    return np.exp(0.5 * rng.standard_normal((16, 16))) * (rng.random((16, 16)) > 0.1)


@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize(
    "contact", [Contact(), Contact(foam_cm=1.0), Contact(sand=(Grain(7, 7, 0.5),))]
)
def test_the_elements_bear_the_whole_weight(shape, contact, gains):
    load = contact.load_g(shape, 1860.0, PAD, gains, (0.3, -0.2))
    assert load.sum() == pytest.approx(1860.0)
    assert (load >= 0.0).all()


def test_an_even_pad_shares_by_covered_area():
    covered = coverage_cm2(DISC, PAD)
    load = Contact().load_g(DISC, 1000.0, PAD)
    np.testing.assert_allclose(load, 1000.0 * covered / covered.sum())


def test_without_cardboard_what_lies_over_the_gaps_is_lost():
    covered = coverage_cm2(DISC, PAD)
    load = Contact(cardboard=False).load_g(DISC, 1000.0, PAD)
    np.testing.assert_allclose(load, 1000.0 / DISC.area_cm2 * covered)
    assert load.sum() == pytest.approx(1000.0 / 1.69, rel=0.05)


def test_voids_bear_nothing_and_the_rest_bears_it_for_them(gains):
    load = Contact().load_g(DISC, 1000.0, PAD, gains)
    assert (load[gains == 0.0] == 0.0).all()
    assert load.sum() == pytest.approx(1000.0)


@pytest.mark.parametrize("shape", [Circle(0.0, 10.0, 3.0), Polygon(np.array(
    [[-3.0, 7.0], [3.0, 7.0], [3.0, 13.0], [-3.0, 13.0]]))])  # fmt: skip
def test_half_an_object_over_the_edge_leaves_about_half_its_weight(shape):
    load = Contact().load_g(shape, 1000.0, PAD)
    assert load.sum() == pytest.approx(525.0, abs=10.0)


def test_an_object_off_the_pad_or_on_voids_only_loads_nothing():
    assert (Contact().load_g(Circle(-9.0, 10.0, 3.0), 1000.0, PAD) == 0.0).all()
    assert (Contact().load_g(DISC, 1000.0, PAD, np.zeros((16, 16))) == 0.0).all()
    assert (Contact().load_g(Circle(1.15, 1.15, 0.1), 1000.0, PAD, 1.0, (1.0, 1.0)) == 0.0).all()


def test_a_grain_of_sand_takes_its_share_where_the_object_covers_it():
    on, off = Contact(sand=(Grain(7, 7, 0.9),)), Contact(sand=(Grain(0, 0, 0.9),))
    load = on.load_g(DISC, 1000.0, PAD)
    assert load[7, 7] > 900.0
    assert load.sum() == pytest.approx(1000.0)
    assert (off.load_g(DISC, 1000.0, PAD) == Contact().load_g(DISC, 1000.0, PAD)).all()


def test_foam_evens_the_load_and_blurs_the_outline(gains):
    hard = Contact().load_g(DISC, 1860.0, PAD, gains)
    soft = Contact(foam_cm=1.3).load_g(DISC, 1860.0, PAD, gains)
    assert soft.max() < 0.6 * hard.max()
    assert (soft > 1.0).sum() > (hard > 1.0).sum()


def test_foam_spreads_one_element_evenly_to_all_sides_and_keeps_what_is_at_the_edge():
    load = np.zeros((16, 16))
    load[8, 8], load[0, 3] = 100.0, 50.0
    out = spread(load, PAD, 1.0)
    assert out.sum() == pytest.approx(150.0)
    assert out[8, 7] == pytest.approx(out[9, 8])
    assert out[8, 8] > out[8, 9] > out[9, 9] > 0.0
    np.testing.assert_allclose(spread(load, PAD, 1e-3), load, atol=1e-12)


def test_a_weight_stacked_off_centre_moves_the_centre_of_pressure_there():
    x, y = np.meshgrid(PAD.x_cm, PAD.y_cm)

    def centre(load):
        return np.array([(load * x).sum(), (load * y).sum()]) / load.sum()

    even = Contact().load_g(DISC, 1000.0, PAD)
    tilted = Contact().load_g(DISC, 1000.0, PAD, 1.0, (0.4, -0.3))
    np.testing.assert_allclose(centre(tilted) - centre(even), [0.4, -0.3], atol=1e-9)


def test_a_stack_at_the_rim_lifts_the_other_side_off():
    load = Contact().load_g(DISC, 1000.0, PAD, 1.0, (3.5, 0.0))
    assert load[8, 4] == 0.0
    assert load[8, 10] > 0.0
    assert load.sum() == pytest.approx(1000.0)


def test_an_object_on_one_row_of_elements_does_not_tilt_across_it():
    slab = Rectangle(10.0, 10.9, 12.0, 0.5, 0.0)
    load = Contact().load_g(slab, 100.0, PAD, 1.0, (0.5, 0.2))
    assert load.sum() == pytest.approx(100.0)
    assert (np.count_nonzero(load, axis=1) > 0).sum() == 1
