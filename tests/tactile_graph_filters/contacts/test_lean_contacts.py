"""Step ``lean_contacts``: what hovers on one side no longer draws the centre along."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from helpers_filters import drawn, image_of
from tactile_graph.errors import RuleError
from tactile_graph.wires import Image
from tactile_graph_filters.contacts.contacts import contacts
from tactile_graph_filters.contacts.lean_contacts import lean_contacts
from tactile_graph_filters.contacts.sharpen_contacts import sharpen_contacts

CELL_CM, SHAPE = 0.5, (30, 36)


def finger(x, y, direction_rad, peak=400.0):
    """Return a fingertip at (x, y) in cells, and low readings of the finger behind it."""
    i, j = np.mgrid[: SHAPE[0], : SHAPE[1]] + 0.5
    values = np.zeros(SHAPE)
    for behind, height in ((0.0, 1.0), (2.5, 0.25), (4.0, 0.12)):
        at_x, at_y = x + behind * np.cos(direction_rad), y + behind * np.sin(direction_rad)
        values += height * np.exp(-((j - at_x) ** 2 + (i - at_y) ** 2) / (2 * 1.5**2))
    return peak * values


def contacts_in(values):
    image = Image(values, (CELL_CM, CELL_CM), (0.0, 0.0), "raw")
    return image, contacts(image, image.mask(values > 100.0), margin=1).contacts


def off_cells(contact, x, y):
    return np.array([contact.x_cm, contact.y_cm]) / CELL_CM - (x, y)


@settings(max_examples=25, deadline=None)
@given(st.floats(12, 24), st.floats(12, 18), st.floats(0, 6.2), st.floats(250, 900))
def test_a_finger_behind_its_tip_draws_the_centre_less_from_wherever_it_comes(x, y, angle, peak):
    image, found = contacts_in(finger(x, y, angle, peak))
    sharp = sharpen_contacts(found).contacts
    before = np.hypot(*off_cells(sharp[0], x, y))
    after = np.hypot(*off_cells(lean_contacts(image, sharp).contacts[0], x, y))
    assert before > 0.15
    assert after < 0.8 * before


def test_the_way_is_the_third_moment_over_the_second():
    """Weights 3 and 1, three cells apart: their centre lies at 0.75 of them."""
    values = np.zeros((5, 8))
    values[2, 2], values[2, 5] = 3.0, 1.0
    image = Image(values, (CELL_CM, 2.0), (10.0, 20.0), "raw")
    (one,) = contacts(image, image.mask(values > 2.0)).contacts
    third = 3 * -(0.75**3) + 2.25**3
    second = 3 * 0.75**2 + 2.25**2
    (moved,) = lean_contacts(image, [one], lean=0.4).contacts
    assert moved.x_cm - one.x_cm == pytest.approx(-0.4 * CELL_CM * third / second)
    assert moved.centroid_x_cm - one.centroid_x_cm == pytest.approx(moved.x_cm - one.x_cm)
    assert moved.y_cm == pytest.approx(one.y_cm)
    assert (moved.area_cm2, moved.load, moved.box) == (one.area_cm2, one.load, one.box)


def test_what_is_symmetric_does_not_move_and_lean_0_moves_nothing():
    i, j = np.mgrid[:21, :21] - 10.0
    image, found = contacts_in(400.0 * np.exp(-(i * i + 2 * j * j) / 12.0))
    same = lean_contacts(image, found).contacts[0]
    assert (same.x_cm, same.y_cm) == pytest.approx((found[0].x_cm, found[0].y_cm))
    image, found = contacts_in(finger(18.0, 15.0, 1.0))
    same = lean_contacts(image, found, lean=0.0).contacts[0]
    assert (same.x_cm, same.y_cm) == (found[0].x_cm, found[0].y_cm)


def test_a_tail_belongs_to_the_nearest_contact_and_only_within_reach():
    """Two cells in contact, and one low reading: two cells beside the left one, five from it."""
    image = image_of([[0, 9, 0, 1, 0, 0, 0, 0, 9, 0]])
    left, right = contacts(image, drawn(".#......#.")).contacts
    near = lean_contacts(image, [left, right], lean=1.0).contacts
    assert near[0].x_cm < left.x_cm - 0.1
    assert near[1].x_cm == pytest.approx(right.x_cm)
    far = lean_contacts(image, [left, right], lean=1.0, reach_cells=1.5).contacts
    assert far[0].x_cm == pytest.approx(left.x_cm)


def test_strength_does_not_matter_nor_cells_that_are_not_known():
    values = finger(17.3, 14.6, 2.0)
    image, found = contacts_in(values)
    once = lean_contacts(image, found).contacts[0]
    stronger = Image(7.0 * values, image.pitch_cm, image.origin_cm, "raw")
    again = lean_contacts(stronger, found).contacts[0]
    assert (again.x_cm, again.y_cm) == pytest.approx((once.x_cm, once.y_cm))
    holed, valid = values.copy(), np.ones(SHAPE, bool)
    holed[14, 20], valid[14, 20] = np.nan, False
    one = lean_contacts(Image(holed, image.pitch_cm, image.origin_cm, "raw", valid), found)
    assert np.isfinite(one.contacts[0].x_cm)
    two = lean_contacts(Image(holed, image.pitch_cm, image.origin_cm, "raw"), found)
    assert two.contacts[0].x_cm == one.contacts[0].x_cm


def test_no_contacts_and_contacts_without_load_stay_as_they_are():
    image = image_of([[0.0, -1.0]])
    assert lean_contacts(image, []) == ((), 0)
    flat = contacts(image, drawn("##")).contacts
    assert lean_contacts(image, flat).contacts[0].x_cm == flat[0].x_cm


def test_an_image_too_small_for_the_contacts_is_refused():
    _, found = contacts_in(finger(17.0, 14.0, 0.0))
    with pytest.raises(RuleError, match=r"reaches over the image of \(3, 4\)"):
        lean_contacts(image_of(np.zeros((3, 4))), found)


def test_both_centres_move_the_same_way_down_the_pad():
    values = np.zeros((8, 5))
    values[2, 2], values[5, 2] = 3.0, 1.0
    image = Image(values, (CELL_CM, CELL_CM), (0.0, 0.0), "raw")
    (one,) = contacts(image, image.mask(values > 2.0)).contacts
    (moved,) = lean_contacts(image, [one], lean=0.4).contacts
    assert moved.y_cm < one.y_cm
    assert moved.centroid_y_cm - one.centroid_y_cm == pytest.approx(moved.y_cm - one.y_cm)
