"""Outlines as each kind that they may be: of the same area, and of which the likeliest is taken."""

import math

import numpy as np
import pytest

from helpers_joint import problem_of_discs
from tactile_graph_likelihood.geometry.outlines import (
    DISC,
    ELLIPSE,
    RECTANGLE,
    REGULAR,
    unknowns,
    unpacked,
)
from tactile_graph_likelihood.several.joint.joint_posterior import Outlines, add_outline
from tactile_graph_likelihood.several.joint.kinds import (
    TRIES,
    TURNS,
    allowed,
    area,
    begun_like,
    draw,
    fits_of_kinds,
    settled_as,
)
from tactile_graph_likelihood.several.joint.maximise_jointly import settle
from tactile_graph_likelihood.single.density.element_terms import OFF, ON

pytestmark = pytest.mark.usefixtures("plain_kernels")

KINDS = (DISC, 0), (ELLIPSE, 0), (RECTANGLE, 0)
FOUR = (*KINDS, (REGULAR, 3))
DISC_THERE = (DISC, 0, [9.1, 8.3, 2.9, 4.5])
BOX_THERE = (RECTANGLE, 0, [9.1, 8.3, 4.1, 1.7, 0.4, 4.5])


def only(kind, corners, numbers):
    point = np.zeros((1, 6))
    point[0, : len(numbers)] = numbers
    return Outlines(np.array([kind]), np.array([corners]), point)


def problem_of(kind, corners, numbers):
    """Return the problem of one outline on an even pad without voids."""
    bare = problem_of_discs()
    there = bare._replace(load=0.0 * bare.load, share=0.0 * bare.share)
    add_outline.call(there, only(kind, corners, numbers), 0)
    on = there.load > 5.0
    states = np.where(on, ON, OFF).astype(np.uint8)
    return bare._replace(logs=np.log(np.where(on, there.load, 1.0)), states=states)


def sketch_of_it(numbers):
    """Return a sketch somewhat off an outline's place and sizes, shape (1, 6)."""
    x, y, a = numbers[:3]
    b, angle = (a, 0.0) if len(numbers) == 4 else numbers[3:5]
    return np.array([[x + 0.4, y - 0.3, math.log(0.9 * a), math.log(1.1 * b), angle, numbers[-1]]])


@pytest.mark.parametrize("own", [
    only(DISC, 0, [8.0, 7.0, 2.5, 4.2]),
    only(ELLIPSE, 0, [8.0, 7.0, 2.6, 2.4, 0.3, 4.2]),
    only(RECTANGLE, 0, [8.0, 7.0, 2.6, 2.4, 0.3, 4.2]),
    only(REGULAR, 3, [8.0, 7.0, 3.2, 0.3, 4.2]),
])  # fmt: skip
@pytest.mark.parametrize("kind", FOUR)
def test_an_outline_of_another_kind_has_about_the_same_area_place_and_load(own, kind):
    was = unpacked(int(own.kinds[0]), int(own.corners[0]), own.points[0])
    rows = np.full((TURNS, 6), np.nan)
    count = begun_like.call(*kind, int(own.kinds[0]), int(own.corners[0]), own.points[0], rows)
    assert count == (TURNS if kind[0] == REGULAR else 1)
    assert np.isnan(rows[count:]).all()
    for row in rows[:count]:
        found = unpacked(*kind, row)
        assert found.area_cm2 == pytest.approx(was.area_cm2, rel=0.06)
        assert area.call(*kind, row) == pytest.approx(found.area_cm2, rel=1e-12)
        assert (row[:2] == [8.0, 7.0]).all()
        assert row[unknowns.call(*kind)] == 4.2


def test_other_starts_lie_around_the_first_and_have_its_load():
    around = allowed(FOUR).around
    assert around.shape == (4, TRIES, 6)
    assert (np.abs(around[:, :, :2]).max(axis=(1, 2)) > 0.2).all()
    assert (around[1:3, :, 5] == 0.0).all()
    assert around.mean(axis=1) == pytest.approx(0.0, abs=1e-12)


@pytest.mark.parametrize("there", [DISC_THERE, BOX_THERE], ids=["disc", "rectangle"])
def test_a_sketch_becomes_the_kind_that_is_there(there):
    problem, may_be = problem_of(*there), allowed(KINDS)
    points, which = sketch_of_it(there[2]), np.empty(1, np.int64)
    log = draw.call(problem, may_be, points, which, -math.inf)
    assert KINDS[which[0]] == there[:2]
    n = len(there[2])
    assert points[0, :2] == pytest.approx(there[2][:2], abs=0.05)
    assert area.call(*KINDS[which[0]], points[0]) == pytest.approx(
        area.call(*there[:2], np.array([*there[2], 0.0, 0.0])), rel=0.03
    )
    assert points[0, n - 1] == pytest.approx(4.5, abs=0.05)
    one = only(*KINDS[which[0]], points[0, :n])
    assert log == pytest.approx(settle.call(problem, one, 0, 0, 0.1, np.empty((6, 6))), abs=0.05)


@pytest.mark.slow
def test_where_the_first_kind_explains_too_little_no_other_is_tried():
    problem, may_be = problem_of(*BOX_THERE), allowed(KINDS)
    points, which = sketch_of_it(BOX_THERE[2]), np.empty(1, np.int64)
    points[0, 2:4] = math.log(2.5)  # as if round
    least = draw.call(problem, may_be, points.copy(), which, math.inf)
    first = which[0]
    assert draw.call(problem, may_be, points.copy(), which, least + 1e-6) == least
    assert which[0] == first
    assert draw.call(problem, may_be, points.copy(), which, least - 1e-6) >= least


@pytest.mark.slow
def test_each_of_two_is_drawn_beside_the_other():
    problem, may_be = problem_of_discs(3), allowed(KINDS)
    points = np.array([
        [6.2, 5.8, math.log(2.5), math.log(2.5), 0.0, 4.5],
        [11.1, 6.5, math.log(2.5), math.log(2.5), 0.0, 4.5],
    ])  # fmt: skip
    which = np.empty(2, np.int64)
    log = draw.call(problem, may_be, points, which, -math.inf)
    both = Outlines(may_be.kinds[which], may_be.corners[which], points.copy())
    again = settle.call(problem, both, 0, 8, 0.1, np.empty((12, 12)))
    assert again == pytest.approx(log, abs=0.2)
    assert np.hypot(*(points[:, :2] - [[6.0, 6.0], [11.4, 6.2]]).T).max() < 0.6
    assert np.abs(problem.load).max() == 0.0


def test_fits_of_kinds_are_each_at_their_mode_and_the_true_one_is_likeliest():
    problem, may_be = problem_of(*BOX_THERE), allowed(FOUR)
    own, found, logs = only(*BOX_THERE), np.empty((4, 6)), np.empty(4)
    fits_of_kinds.call(problem, may_be, own, found, logs)
    assert logs.argmax() == 2
    assert found[2, :6] == pytest.approx(BOX_THERE[2], abs=0.05)
    point = np.empty(6)
    assert settled_as.call(problem, may_be, 0, own, False, point) == logs[0]
    assert (point == found[0]).all()
    assert settled_as.call(problem, may_be, 0, own, True, point) >= logs[0] - 0.1
    assert (own.points[0] == BOX_THERE[2]).all()
