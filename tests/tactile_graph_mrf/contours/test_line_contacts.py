"""Objects told apart by the lines between them."""

from __future__ import annotations

import numpy as np
import pytest

from tactile_graph.errors import DataError, RuleError
from tactile_graph.wires import Image, Mask
from tactile_graph_filters.contacts.contacts import Contact
from tactile_graph_mrf.contours.line_contacts import LineContacts, bridged, gathered, with_voids_of
from tactile_graph_mrf.contours.line_regions import line_regions
from tactile_graph_mrf.contours.regions import Regions
from tactile_graph_mrf.energy.line_field import LineField


def lined(values: np.ndarray) -> tuple[Image, Regions]:
    image = Image(values, (1.3, 1.3), (-0.15, -0.15))
    lines = LineField.of(image, np.diff(values, axis=0) != 0, np.diff(values, axis=1) != 0)
    return image, line_regions(image, lines)


def two_discs(apart: float) -> np.ndarray:
    """Two discs of radius 2.6 cells, side by side, coarsely covered."""
    y, x = np.indices((160, 160)) / 10 + 0.05
    on = np.hypot(x - 5.0, y - 8.0) < 2.6
    on |= np.hypot(x - 10.2 - apart, y - 8.0) < 2.6
    return np.round(on.reshape(16, 10, 16, 10).mean(axis=(1, 3)), 1)


@pytest.mark.parametrize("apart", [0.0, 0.5, 2.0])
def test_discs_that_touch_or_not_are_two(apart: float) -> None:
    found = LineContacts()(*lined(two_discs(apart)))
    assert found.count == 2
    assert all(isinstance(c, Contact) for c in found.contacts)
    left, right = sorted(c.x_cm for c in found.contacts)
    assert left == pytest.approx(-0.15 + 1.3 * 5.0, abs=0.35)
    assert right == pytest.approx(-0.15 + 1.3 * (10.2 + apart), abs=0.35)


def test_discs_that_touch_without_a_line_between_them_are_two_unless_a_cut_is_dear() -> None:
    values = two_discs(0.3)
    on = values > 0
    regions = Regions(on + np.int32(1), np.array([False, False, True]), Mask(on.copy()))
    assert LineContacts(hold=0.5)(Image(values), regions).count == 2
    assert LineContacts(hold=1.0)(Image(values), regions).count == 1


def test_one_object_with_a_step_and_a_void_within_is_one() -> None:
    values = np.zeros((12, 12))
    values[2:9, 2:9] = 1.0
    values[2:9, 6:9] = 1.6
    values[5, 4] = 0.0
    found = LineContacts()(*lined(values))
    assert [c.n_cells for c in found.contacts] == [49]
    assert found.contacts[0].mask.count == 49


def test_a_missing_element_at_the_edge_is_bridged() -> None:
    values = np.zeros((12, 12))
    values[3:9, 3:9] = 1.0
    values[3, 5] = 0.0
    assert LineContacts()(*lined(values)).contacts[0].n_cells == 36
    assert LineContacts(bridge_cells=0)(*lined(values)).contacts[0].n_cells == 35


def test_an_empty_field_has_no_contacts_and_small_ones_do_not_count() -> None:
    assert LineContacts()(*lined(np.zeros((5, 5)))).count == 0
    values = np.zeros((8, 8))
    values[2:4, 2:4] = 1.0
    assert LineContacts(min_cells=4)(*lined(values)).count == 1
    assert LineContacts(min_cells=5)(*lined(values)).count == 0


def test_what_is_not_finite_within_an_object_is_refused_unless_marked_as_invalid() -> None:
    values = np.zeros((8, 8))
    values[2:6, 2:6] = 1.0
    _, regions = lined(values)
    broken = values.copy()
    broken[3, 3] = np.inf
    with pytest.raises(DataError, match="finite wherever an object lies"):
        LineContacts()(Image(broken), regions)
    found = LineContacts()(Image(broken.copy(), valid=np.isfinite(broken)), regions)
    assert found.contacts[0].n_cells == 16
    assert found.contacts[0].load == 15.0
    with pytest.raises(RuleError, match="shape"):
        LineContacts()(Image(np.zeros((3, 3))), regions)


def test_regions_are_gathered_whole_and_voids_go_to_a_neighbour() -> None:
    owner = np.array([[1, 0, 0, 2], [1, 0, 2, 2]], np.int32)
    mask = np.array([[True, True, False, True], [True, True, True, True]])
    assert with_voids_of(owner, mask).tolist() == [[1, 1, 0, 2], [1, 2, 2, 2]]
    labels = np.array([[1, 2, 2, 3], [1, 2, 3, 3]], np.int32)
    basin = np.array([[1, 1, 2, 2], [1, 2, 2, 2]], np.int32)
    assert gathered(labels, basin).tolist() == [[1, 2, 2, 2], [1, 2, 2, 2]]


def test_only_gaps_between_cells_of_one_owner_are_bridged() -> None:
    owner = np.array([[1, 0, 1, 0, 2, 0, 0, 2]], np.int32)
    assert bridged(owner, 1).tolist() == [[1, 1, 1, 0, 2, 0, 0, 2]]
    assert bridged(owner, 2).tolist() == [[1, 1, 1, 0, 2, 2, 2, 2]]
    assert bridged(owner.T, 2).T.tolist() == bridged(owner, 2).tolist()
    assert bridged(np.array([[1, 2, 1]], np.int32), 1).tolist() == [[1, 2, 1]]
    assert bridged(owner, 1_000_000).tolist() == bridged(owner, 8).tolist()
