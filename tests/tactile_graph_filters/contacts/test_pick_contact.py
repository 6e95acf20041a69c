"""The largest contact, or the nth, by itself; with fewer there is none, which is no failure."""

from __future__ import annotations

import numpy as np
import pytest

from tactile_graph import Frame, Skip, loads
from tactile_graph.wires import Image, Mask
from tactile_graph_filters.contacts.contacts import contacts
from tactile_graph_filters.contacts.pick_contact import pick_contact

VALUES = np.array([[1.0, 1.0, 1.0, 0.0, 9.0], [0.0] * 5, [5.0, 0.0, 2.0, 2.0, 0.0]])
FOUND = list(contacts(Image(VALUES), Mask(VALUES > 0)).contacts)


@pytest.mark.parametrize(
    ("by", "loads"),
    [("load", [9, 5, 4, 3]), ("area_cm2", [3, 4, 9, 5]), ("peak", [9, 5, 4, 3])],
)
def test_contacts_are_ranked_the_largest_first(by: str, loads: list[int]) -> None:
    assert [pick_contact(FOUND, rank=k, by=by).load for k in (1, 2, 3, 4)] == loads  # type: ignore[arg-type]


def test_by_number_they_stay_in_order() -> None:
    assert [pick_contact(FOUND, rank=k, by="number") for k in (1, 2, 3, 4)] == FOUND


def test_without_so_many_it_skips_and_what_follows_too() -> None:
    with pytest.raises(Skip, match="there are 4 contacts, none of rank 5"):
        pick_contact(FOUND, rank=5)
    text = """
pipeline: p
nodes:
  footprint: {step: threshold, in: frame, with: {level: auto}}
  all: {step: contacts, in: [frame, footprint]}
  second: {step: pick_contact, in: all.contacts, with: {rank: 2}}
  boundary: {step: boundary_scan, in: second}
outputs: [boundary]
"""
    one = np.zeros((8, 8))
    one[2:5, 2:5] = 1.0
    result = loads(text).run(Frame.of(one, 1.0))
    assert (result.outcome("boundary").origin, result.failures) == ("second", [])
    one[6, 6] = 0.5
    assert len(loads(text).run(Frame.of(one, 1.0))["boundary"].xy_cm) == 1
