"""What the fit of an outline says of the pad."""

import numpy as np
import pytest

from tactile_graph_likelihood.any_pad.pad_effects.from_frame import evened_by_foam, is_partly_hidden
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


def test_readings_that_scatter_less_than_told_speak_for_foam() -> None:
    """A round face leaves gains as they are; foam evens out what presses unevenly."""
    found = [evened_by_foam(log_sigma, log_sigma, 80) for log_sigma in (-0.3, -0.15, 0.0)]
    assert found == sorted(found, reverse=True)
    assert found[0] > 4.0
    assert found[-1] < 0.25
    assert found[0] > evened_by_foam(-0.3, -0.3, 8) > 1.0  # few readings say less


def test_on_a_pad_of_far_other_gains_scatter_says_little_of_foam() -> None:
    assert 1.0 / 12.0 < evened_by_foam(-0.9, -0.9, 80) < 12.0
    assert 1.0 / 12.0 < evened_by_foam(0.6, 0.6, 80) < 12.0
    assert 0.0 < evened_by_foam(9.0, -9.0, 0) < 1e9
