"""Contacts of numbered cells: their centres in centimetres, their order and what is left out."""

from __future__ import annotations

import numpy as np
import pytest

from tactile_graph.wires import Image
from tactile_graph_filters.contacts.labelled import contacts_of

LABELS = [[0, 7, 7, 0, 0], [0, 7, 0, 0, 2], [0, 0, 0, 2, 2]]
READINGS = [[9.0, 1.0, 4.0, 0, 0], [0, 3.0, 0, 0, -5.0], [0, 0, 0, 2.0, 6.0]]


def found(readings: list, **settings: int):
    image = Image(np.array(readings, float), pitch_cm=(0.5, 2.0), origin_cm=(10.0, -3.0))
    return contacts_of(np.array(LABELS, np.int32), image, **settings).contacts


def test_centres_are_weighed_by_load_and_not_where_they_are_centroids() -> None:
    one, other = found(READINGS)
    assert (one.number, other.number) == (1, 2)
    assert one.x_cm == pytest.approx(10 + 0.5 * ((1 + 8 + 3) / 8 + 0.5))
    assert one.y_cm == pytest.approx(-3 + 2.0 * (3 / 8 + 0.5))
    assert one.centroid_x_cm == pytest.approx(10 + 0.5 * (4 / 3 + 0.5))
    assert one.centroid_y_cm == pytest.approx(-3 + 2.0 * (1 / 3 + 0.5))
    assert (one.load, one.peak, one.n_cells, one.area_cm2) == (8.0, 4.0, 3, 3.0)
    assert other.x_cm == pytest.approx(10 + 0.5 * ((3 * 2 + 4 * 6) / 8 + 0.5))
    assert other.y_cm == pytest.approx(-3 + 2.0 * 2.5)
    assert (other.load, other.box) == (3.0, (1, 3, 3, 5))


def test_without_load_the_centre_is_the_centroid() -> None:
    for one in found((-np.ones((3, 5))).tolist()):
        assert (one.x_cm, one.y_cm) == (one.centroid_x_cm, one.centroid_y_cm)


@pytest.mark.parametrize(("min_cells", "count"), [(3, 2), (4, 0)])
def test_smaller_ones_are_left_out(min_cells: int, count: int) -> None:
    assert len(found(READINGS, min_cells=min_cells)) == count


def test_a_margin_widens_the_box_within_the_image() -> None:
    assert [one.box for one in found(READINGS, margin=1)] == [(0, 3, 0, 4), (0, 3, 2, 5)]
