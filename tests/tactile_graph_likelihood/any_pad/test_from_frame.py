"""What the fit of an outline says of the pad."""

import numpy as np
import pytest

from tactile_graph_likelihood.any_pad.from_frame import is_partly_hidden
from tactile_graph_likelihood.geometry.outlines import DISC, RECTANGLE
from tactile_graph_likelihood.single.readings import Readings

PAD = Readings(
    np.array([0.0, 0.0, 1.3, 1.0, 0.0, 0.0]), np.zeros((16, 16)), np.zeros((16, 16), np.uint8), 9
)


@pytest.mark.parametrize(("x", "hidden"), [(10.0, False), (4.6, False), (4.0, True), (17.0, True)])
def test_an_outline_is_hidden_from_half_a_pitch_beyond_the_edge(x: float, hidden: bool) -> None:
    rectangle = np.array([x, 10.0, 5.0, 2.0, 0.0, 4.0])
    assert is_partly_hidden(RECTANGLE, PAD, rectangle) == hidden


def test_a_disc_tells_by_its_rim_where_it_ends() -> None:
    assert not is_partly_hidden(DISC, PAD, np.array([1.0, 10.0, 5.0, 4.0]))
