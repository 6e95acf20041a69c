"""Which elements hang together."""

import numpy as np
import pytest

from tactile_graph_likelihood.geometry.pieces import components
from tactile_graph_likelihood.large_pads.coarse import largest_piece
from tactile_graph_likelihood.single.density.element_terms import OFF, ON, UNKNOWN

pytestmark = pytest.mark.usefixtures("plain_kernels")


def test_components_reach_over_corners_and_as_far_as_asked():
    on = np.zeros((5, 5), bool)
    on[0, 0] = on[1, 1] = on[1, 3] = on[4, 4] = True
    assert components.call(on, 1).max() == 3
    assert components.call(on, 2).max() == 2
    assert components.call(on, 3).max() == 1
    assert ((components.call(on, 1) > 0) == on).all()


def test_the_largest_piece_is_that_of_most_touched_elements_joined_by_what_is_unknown():
    states = np.full((6, 8), OFF, np.uint8)
    states[0, :3] = ON
    states[4, [0, 1, 3, 4]] = ON
    states[2, 4:] = UNKNOWN
    assert (largest_piece.call(states, 1)[4] == OFF).all()
    states[4, 2] = UNKNOWN
    found = largest_piece.call(states, 1)
    assert (found[0] == OFF).all()
    assert (found[1:] == states[1:]).all()
