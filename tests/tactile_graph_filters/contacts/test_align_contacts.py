import math

import pytest

from helpers_filters import drawn, image_of
from tactile_graph_filters.contacts.align_contacts import AlignContacts
from tactile_graph_filters.contacts.contacts import contacts

ONES = contacts(image_of([[1.0, 2.0], [0.0, 4.0]]), drawn("##\n.#")).contacts


def test_by_default_nothing_moves():
    one = AlignContacts()(ONES).contacts[0]
    assert (one.x_cm, one.y_cm) == (ONES[0].x_cm, ONES[0].y_cm)


def test_a_quarter_turn_and_a_shift_move_both_centres_and_nothing_else():
    one = AlignContacts(shift_cm=(10.0, 20.0), matrix=((0.0, -1.0), (1.0, 0.0)))(ONES).contacts[0]
    was = ONES[0]
    assert (one.x_cm, one.y_cm) == pytest.approx((10 - was.y_cm, 20 + was.x_cm))
    assert (one.centroid_x_cm, one.centroid_y_cm) == pytest.approx(
        (10 - was.centroid_y_cm, 20 + was.centroid_x_cm)
    )
    assert (one.area_cm2, one.load, one.box) == (was.area_cm2, was.load, was.box)


def test_areas_grow_by_where_the_contact_was_and_no_centre_moves():
    was = ONES[0]
    x, y = was.x_cm, was.y_cm
    log_area = (0.1, 0.2, -0.3, 0.04, 0.05, -0.06)
    growth = 0.1 + 0.2 * x - 0.3 * y + 0.04 * x**2 + 0.05 * x * y - 0.06 * y**2
    one = AlignContacts(log_area=log_area)(ONES).contacts[0]
    assert one.area_cm2 == pytest.approx(math.exp(growth) * was.area_cm2)
    assert (one.x_cm, one.y_cm) == (x, y)


def test_no_contacts_stay_none():
    assert AlignContacts()([]) == ((), 0)


def test_a_matrix_that_flattens_is_refused():
    with pytest.raises(ValueError, match="must not turn the pad into a line"):
        AlignContacts(matrix=((1.0, 2.0), (2.0, 4.0)))


@pytest.mark.parametrize("bad", [math.nan, math.inf])
def test_what_is_not_finite_is_refused(bad):
    with pytest.raises(ValueError, match="must be finite"):
        AlignContacts(shift_cm=(bad, 0.0))
    with pytest.raises(ValueError, match="must be finite"):
        AlignContacts(log_area=(0.0, 0.0, 0.0, 0.0, 0.0, bad))
