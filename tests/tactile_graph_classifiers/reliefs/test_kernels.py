"""What a relief reads: its derivatives, and that a press is found again."""

from __future__ import annotations

import numpy as np
import pytest

from helpers_reliefs import BOX, SHAPE, as_presses, bowl, even_pad
from tactile_graph_classifiers.reliefs.kernels import (
    NODES,
    cells_of,
    chord,
    cost_of_all,
    expected,
    fitted,
    foremost_of,
    loads,
    solved,
    touching_radius,
)

PRESS = np.array([10.2, 6.1, 0.4, 0.7, 0.02, -0.01])


def load_of(press, box, taps, soft, wanted):
    return loads(bowl(), foremost_of(bowl()), press, box, *SHAPE, taps, soft, wanted)


def test_a_press_touches_nowhere_outside_its_radius():
    depth = bowl()
    foremost = foremost_of(depth)
    at = (np.arange(61) - 30) / NODES
    v, u = np.meshgrid(at, at, indexing="ij")
    for deep, lean_u, lean_v in ((0.1, 0.0, 0.0), (0.4, 0.05, 0.0), (0.7, -0.1, 0.2), (9.0, 0, 0)):
        touched = deep - depth - lean_u * u - lean_v * v > -0.03
        press = np.array([0.0, 0.0, 0.0, deep, lean_u, lean_v])
        radius = touching_radius(foremost, press, 0.03)
        assert np.hypot(u, v)[touched].max() + 1.0 / NODES < radius
        assert radius < np.hypot(u, v)[touched].max() + 4.0


@pytest.mark.parametrize("off", [0.0, 1.3, -2.9, 3.1])
def test_points_of_a_circle_are_within_its_chord(off):
    x = (np.arange(5, 65) + 0.5) / 3
    first, last = chord(10.2, off, 3.0, 5, 60)
    within = np.flatnonzero((x - 10.2) ** 2 + off**2 < 9.0)
    if not within.size:
        assert first == last
        return
    assert first <= within[0] <= first + 3
    assert last - 3 <= within[-1] + 1 <= last


@pytest.mark.slow  # machine code is made for it
def test_a_load_s_derivatives_are_those_of_its_differences():
    taps = even_pad().taps
    by = load_of(PRESS, BOX, taps, 0.05, True)
    for k in range(6):
        step = np.eye(6)[k] * 1e-4
        high, low = (load_of(PRESS + s, BOX, taps, 0.05, False)[0]
                     for s in (step, -step))  # fmt: skip
        np.testing.assert_allclose(by[k + 1], (high - low) / 2e-4, atol=0.02)


@pytest.mark.slow  # machine code is made for it
def test_the_load_is_the_volume_pressed():
    press = np.array([10.2, 6.1, 0.4, 0.4, 0.0, 0.0])
    load = load_of(press, BOX, even_pad().taps, 1e-3, False)[0]
    # a paraboloid: half its height times its base, an ellipse
    assert load.sum() == pytest.approx(0.5 * 0.4 * np.pi * np.sqrt(4.0 * 2.0), rel=0.04)


@pytest.mark.slow  # machine code is made for it
def test_a_load_at_the_edge_of_the_box_is_that_of_a_larger_box():
    taps = even_pad().taps
    whole = load_of(PRESS, np.array([0, 0, *SHAPE]), taps, 0.05, False)[0]
    part = load_of(PRESS, np.array([4, 8, 4, 5]), taps, 0.05, False)[0]
    np.testing.assert_allclose(part, whole[4:8, 8:13], rtol=1e-12)


def test_a_point_counts_for_the_cells_whose_taps_reach_it():
    reach, n_taps = 5, 13
    for point in range(-5, 40):
        first, last = cells_of(point, 2, 7, reach)
        reached = [c for c in range(7) if 0 <= point - (2 + c) * 3 + reach < n_taps]
        assert list(range(first, last)) == reached


@pytest.mark.slow  # machine code is made for it
def test_the_cost_s_gradient_is_that_of_its_differences():
    pad, depth = even_pad(), bowl()
    law = pad.numbers(0.05)
    seen = expected(depth, PRESS + 0.01, BOX, pad.gains, pad.taps, law)
    values = np.zeros((1, *SHAPE))
    values[0, :, 2:18] = seen
    weights, boxes = np.ones((1, *SHAPE)), BOX[None]
    by_node, by_number = np.zeros(depth.shape), np.zeros((1, 6))

    def cost(relief, press):
        return cost_of_all(relief, press[None], values, weights, boxes, pad.gains, pad.taps, law,
                           by_node, by_number)  # fmt: skip

    cost(depth, PRESS)
    told_by, told_by_number = by_node.copy(), by_number[0].copy()
    for at in ((30, 30), (33, 27), (26, 35)):
        changed = depth.copy()
        changed[at] += 1e-4
        high = cost(changed, PRESS)
        changed[at] -= 2e-4
        assert told_by[at] == pytest.approx((high - cost(changed, PRESS)) / 2e-4, rel=1e-2,
                                            abs=1e-6)  # fmt: skip
    for k in range(6):
        step = np.eye(6)[k] * 1e-4
        slope = (cost(depth, PRESS + step) - cost(depth, PRESS - step)) / 2e-4
        assert told_by_number[k] == pytest.approx(slope, rel=0.05, abs=0.01)


@pytest.mark.slow  # machine code is made for it
def test_a_press_is_found_again_from_a_cell_beside():
    pad = even_pad()
    true = np.array([10.2, 6.1, 0.4, 0.7, 0.0, 0.0])
    law = pad.numbers(0.03)
    values = np.zeros(SHAPE)
    values[:, 2:18] = expected(bowl(), true, BOX, pad.gains, pad.taps, law)
    weights = pad.weights(as_presses(values[None], BOX[None], [[10.0, 6.0]]))[0]
    start = true + np.array([0.8, -0.7, 0.3, 0.2, 0.0, 0.0])
    misfit, found = fitted(bowl(), start, values, weights, BOX, pad.gains, pad.taps, law, 30)
    assert misfit < 1.0
    np.testing.assert_allclose(found[:4], true[:4], atol=0.05)


def test_equations_are_solved_and_no_wrong_step_is_taken_where_they_cannot_be():
    rng = np.random.default_rng(0)
    half = rng.standard_normal((6, 6))
    A, b = half @ half.T + np.eye(6), rng.standard_normal(6)
    np.testing.assert_allclose(solved(np.tril(A), b), np.linalg.solve(A, b))
    np.testing.assert_array_equal(solved(-A, b), np.zeros(6))
