"""The frame circles are fitted in."""

import numpy as np
import pytest

import references_fitters as references
from helpers_modes import compiled, plainly
from tactile_graph.wires import Points
from tactile_graph_fitters.circle.principal_axes import (
    ALL_EQUAL,
    NOT_FINITE,
    OK,
    OUT_OF_RANGE,
    TOO_FEW,
    bounds,
    into_frame,
    turned,
)

SETS = {
    OK: np.random.default_rng(3).normal(size=(17, 2)) * (3.0, 0.5) + (100.0, -7.0),
    TOO_FEW: np.ones((2, 2)),
    NOT_FINITE: np.array([[0.0, 1.0], [np.inf, 1.0], [np.nan, 2.0]]),
    OUT_OF_RANGE: np.array([[0.0, 1e160], [1.0, 1.0], [5.0, 2.0]]),
    ALL_EQUAL: np.full((4, 2), -2.5),
}
SETS = {status: Points(xy).xy_cm for status, xy in SETS.items()}  # read-only, as in a step


def test_points_come_centred_scaled_along_their_main_axis_and_back():
    xy = SETS[OK]
    status, uv, (x, y, scale, cos, sin) = into_frame(xy)
    assert status == OK
    assert uv.mean(axis=1) == pytest.approx([0.0, 0.0], abs=1e-15)
    assert uv[0] @ uv[1] == pytest.approx(0.0, abs=1e-14)
    assert uv[0].std() > uv[1].std()
    back = [x + scale * (uv[0] * cos - uv[1] * sin), y + scale * (uv[0] * sin + uv[1] * cos)]
    assert np.column_stack(back) == pytest.approx(xy, abs=1e-13)


@pytest.mark.parametrize("status", SETS)
def test_status_says_what_is_wrong(status):
    assert into_frame(SETS[status])[0] == status


@pytest.mark.parametrize("by", [plainly, compiled])
@pytest.mark.parametrize("status", SETS)
def test_bounds_are_those_of_the_reference(status, by):
    expected = pytest.approx(references.bounds(SETS[status]))
    assert by(bounds)(SETS[status]) == expected


@pytest.mark.parametrize("by", [plainly, compiled])
def test_points_are_turned_as_by_the_reference(by):
    expected = references.turned(SETS[OK], 99.0, -7.0, 5.0)
    got = by(turned)(SETS[OK], 99.0, -7.0, 5.0)
    assert got[0] == pytest.approx(expected[0], abs=1e-13)
    assert got[1:] == pytest.approx(expected[1:], abs=1e-13)
