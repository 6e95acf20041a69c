"""What hangs together among a few touched elements."""

import numpy as np
import pytest

from tactile_graph.wires import Image
from tactile_graph_likelihood.any_pad.locate import LocateDisc, LocateEllipse
from tactile_graph_likelihood.any_pad.observation.clump import clump_of, is_in_parts
from tactile_graph_likelihood.single.changed import changed
from tactile_graph_likelihood.single.density.element_terms import ON, UNKNOWN
from tactile_graph_likelihood.single.readings import Readings


def readings(*touched: tuple[int, int], load: float = 0.0) -> Readings:
    states, logs = np.zeros((9, 9), np.uint8), np.zeros((9, 9))
    for place in touched:
        states[place], logs[place] = ON, load
    grid = np.array([0.0, 0.0, 1.3, 1.0, 0.0, 0.0])
    return Readings(grid, logs, states, len(touched))


def test_what_lies_apart_from_the_largest_clump_says_nothing():
    its = readings((1, 1), (1, 2), (2, 1), (6, 6), (6, 8), (8, 1))
    its.logs[8, 1] = 5.0  # a stray that bears more than the clump
    found = clump_of(its)
    assert found.touched == 3
    assert [tuple(p) for p in np.argwhere(found.states == ON)] == [(1, 1), (1, 2), (2, 1)]
    assert [tuple(p) for p in np.argwhere(found.states == UNKNOWN)] == [(6, 6), (6, 8), (8, 1)]
    assert np.count_nonzero(its.states == ON) == 6, "what came is not written into"


@pytest.mark.parametrize("touched", [[(4, 4)], [(0, 0), (2, 2), (4, 4), (6, 4)]])
def test_what_hangs_together_over_single_voids_is_one_clump(touched):
    assert clump_of(readings(*touched)) is None


def test_a_chain_is_one_clump_in_whatever_order_it_is_met():
    ring = [(0, 0), (0, 8), (2, 0), (2, 8), (4, 2), (4, 4), (4, 6), (3, 8)]
    assert clump_of(readings(*ring, (8, 0))).touched == len(ring)


def test_two_contacts_are_parts_and_neither_strays_nor_a_dead_row_make_any():
    block = [(r, c) for r in range(3) for c in range(4)]
    other = [(r + 6, c + 3) for r, c in block]
    assert is_in_parts(readings(*block, *other))
    assert is_in_parts(readings(*block, *other[:6]))
    assert not is_in_parts(readings(*block, *other[:5]))
    assert not is_in_parts(readings(*block, (6, 0), (6, 8), (8, 4), (8, 8), (0, 8), (3, 8)))
    assert not is_in_parts(readings(*block, *((r + 4, c) for r, c in block)))


@pytest.mark.slow
def test_an_ellipse_over_two_contacts_does_not_fit():
    rng, values = np.random.default_rng(3), np.zeros((16, 16))
    values[2:6, 5:9] = values[9:13, 5:9] = 60.0
    image = Image(values * np.exp(0.2 * rng.standard_normal(values.shape)), (1.3, 1.3))
    found = LocateEllipse()(image).posterior
    assert found.in_parts
    assert not found.fits
    assert changed(found, in_parts=False).fits, "nothing else tells it"
    values[9:13, 5:9] = 0.0
    one = LocateEllipse()(image.with_values(np.where(values > 0.0, image.values, 0.0))).posterior
    assert not one.in_parts
    assert one.fits


@pytest.mark.usefixtures("plain_kernels")
@pytest.mark.slow
def test_two_strays_do_not_lead_away_from_a_fingertip():
    values = np.zeros((16, 16))
    values[9:12, 5:8] = [[0.0, 33.0, 0.0], [37.0, 57.0, 16.0], [40.0, 45.0, 0.0]]
    values[1, 8] = values[4, 13] = 4.0
    found = LocateDisc()(Image(values, (1.3, 1.3), (-0.15, -0.15), "gram"))
    assert found.x_cm == pytest.approx(7.6, abs=0.4)
    assert found.y_cm == pytest.approx(13.4, abs=0.4)
    assert found.radius_cm < 2.2
