"""The benchmark of learned reliefs: its derivatives, that presses are found again, what is told."""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import pytest

FOLDER = Path(__file__).parents[2] / "benchmarks"
sys.path.insert(0, str(FOLDER))
import learned_reliefs  # noqa: E402
from learned_reliefs import Reads, Relief, Seen, extend, told  # noqa: E402
from pressed_objects import STRIP, Pad, Thing, box, disc  # noqa: E402
from pressed_reliefs import NODES, cost_of_all, expected, fitted, loads  # noqa: E402

SHAPE = (12, 20)
BOX = np.array([0, 2, 12, 16])


@pytest.fixture
def bowl():
    """Return an elliptic bowl, 0.1 of full scale deep a cell from its middle."""
    at = (np.arange(61) - 30) / NODES
    v, u = np.meshgrid(at, at, indexing="ij")
    return 0.1 * u**2 + 0.2 * v**2


@pytest.fixture
def reads():
    """Return an even pad, whose readings vary by little."""
    return Reads(STRIP, np.ones(SHAPE), 0.99, np.array([1e-6, 1e-4, 1e-4]))


@pytest.mark.slow  # machine code is made for it
def test_a_load_s_derivatives_are_those_of_its_differences(bowl, reads):
    press = np.array([10.2, 6.1, 0.4, 0.7, 0.02, -0.01])
    by = loads(bowl, press, BOX, SHAPE, reads.taps, 0.05, True)
    for k in range(6):
        step = np.eye(6)[k] * 1e-4
        high, low = (loads(bowl, press + s, BOX, SHAPE, reads.taps, 0.05, False)[0]
                     for s in (step, -step))  # fmt: skip
        np.testing.assert_allclose(by[k + 1], (high - low) / 2e-4, atol=0.02)


@pytest.mark.slow  # machine code is made for it
def test_the_load_is_the_volume_pressed(bowl, reads):
    press = np.array([10.2, 6.1, 0.4, 0.4, 0.0, 0.0])
    load = loads(bowl, press, BOX, SHAPE, reads.taps, 1e-3, False)[0]
    # a paraboloid: half its height times its base, an ellipse
    assert load.sum() == pytest.approx(0.5 * 0.4 * np.pi * np.sqrt(4.0 * 2.0), rel=0.04)


@pytest.mark.slow  # machine code is made for it
def test_the_cost_s_gradient_is_that_of_its_differences(bowl, reads):
    press = np.array([[10.2, 6.1, 0.4, 0.7, 0.02, -0.01]])
    law = reads.law(0.05)
    seen = expected(bowl, press[0] + 0.01, BOX, reads.gains, reads.taps, law)
    values = np.zeros((1, *SHAPE))
    values[0, :, 2:18] = seen
    weights, boxes = np.ones((1, *SHAPE)), BOX[None]
    by_node, by_number = np.zeros(bowl.shape), np.zeros((1, 6))

    def cost(relief):
        return cost_of_all(relief, press, values, weights, boxes, reads.gains, reads.taps, law,
                           by_node, by_number)  # fmt: skip

    cost(bowl)
    told_by = by_node.copy()
    for at in ((30, 30), (33, 27), (26, 35)):
        changed = bowl.copy()
        changed[at] += 1e-4
        high = cost(changed)
        changed[at] -= 2e-4
        assert told_by[at] == pytest.approx((high - cost(changed)) / 2e-4, rel=1e-2, abs=1e-6)


@pytest.mark.slow  # machine code is made for it
def test_a_press_is_found_again_from_a_cell_beside(bowl, reads):
    true = np.array([10.2, 6.1, 0.4, 0.7, 0.0, 0.0])
    law = reads.law(0.03)
    values = np.zeros(SHAPE)
    values[:, 2:18] = expected(bowl, true, BOX, reads.gains, reads.taps, law)
    weights = reads.weights(values[None])[0]
    start = true + np.array([0.8, -0.7, 0.3, 0.2, 0.0, 0.0])
    misfit, found = fitted(bowl, start, values, weights, BOX, reads.gains, reads.taps, law, 30)
    assert misfit < 1.0
    np.testing.assert_allclose(found[:4], true[:4], atol=0.05)


def test_a_relief_goes_on_as_it_rises_and_never_touches(bowl):
    press = np.array([[10.0, 6.0, 0.0, 0.4, 0.0, 0.0]])
    unlearned = np.where(bowl < 0.4, bowl, 0.45)
    relief = Relief(unlearned, press, 0.4, 0.01, np.ones(1), bowl, np.zeros(2))
    seen = Seen(np.zeros((1, *SHAPE)), np.array([[0, 0, *SHAPE]]), press[:, :2])
    extend(relief, seen)
    touched = bowl < 0.39
    np.testing.assert_array_equal(relief.depth[touched], bowl[touched])
    beyond = relief.depth[30, 36:41]  # from 2 to 3.3 cells
    assert (np.diff(beyond) > 0.0).all()
    assert beyond[-1] > 0.6
    assert relief.depth[~touched].min() >= 0.39


def test_presses_that_fit_badly_tell_of_no_place(bowl):
    presses = np.array([[10.0, 6.0, 0.0, deep, 0.0, 0.0] for deep in (0.4, 0.4, 0.4, 9.0)])
    relief = Relief(bowl, presses, 0.4, 0.01, np.array([1.0, 1.0, 1.0, 50.0]), bowl, np.zeros(2))
    boxes = np.array([[2, 5, 8, 10]] * 4)
    below = learned_reliefs.deepest(relief, Seen(np.zeros((4, *SHAPE)), boxes, presses[:, :2]))
    assert below.max() == 0.4
    assert below[30, 30 + 4 * NODES] == 0.4
    assert below[30, 30 + 6 * NODES] == -np.inf  # beside the box


def test_still_cells_have_their_misfit_by_themselves():
    values = np.zeros((1, *SHAPE))
    values[0, 4:6, 4:8] = 0.5
    values[0, 0, :] = 0.01
    seen = Seen(values, np.array([[0, 0, *SHAPE]]), np.array([[6.0, 5.0]]))
    misfits, n_felt = learned_reliefs.still(seen, np.full(values.shape, 200.0**2))
    assert misfits[0] == pytest.approx(20 * 2.0**2)
    assert n_felt[0] == 8


def test_strangers_are_found_where_no_more_than_a_share_are_lost():
    known = np.full((2, 20, 2), 5.0)
    known[0, :, 0] = known[1, :, 1] = 1.0
    text = told(known, np.full((4, 2), 0.5))
    assert "nearest is right 100.0 %" in text
    assert "lost 100.0 100.0 100.0 100.0 100.0 %" in text
    assert text.endswith("foreign   0.0   0.0   0.0   0.0   0.0 %")


@pytest.mark.slow
def test_one_object_is_learned_and_told_from_another():
    pad = Pad(STRIP, np.random.default_rng(5))
    things = [Thing("disc", disc(1.1), 0.4), Thing("box", box(3.0, 1.5), 0.4)]
    shown = [np.array([pad.press(t).image.values for _ in range(12)], float) for t in things]
    reliefs, reads = learned_reliefs.learn_all(shown, STRIP, lambda _: None, rounds=1)
    for k, thing in enumerate(things):
        more = np.array([pad.press(thing).image.values for _ in range(3)], float)
        far = learned_reliefs.distances(reliefs, reads, Seen.of(more, STRIP.full_scale))
        assert (far.argmin(axis=1) == k).all()
        assert (far[:, 1 - k] > 3.0 * far[:, k]).all()


@pytest.mark.slow
def test_a_small_object_that_reads_full_scale_is_learned():
    pad = Pad(STRIP, np.random.default_rng(6))
    coin = Thing("coin", disc(0.8), 0.6)
    shown = np.array([pad.press(coin).image.values for _ in range(12)], float)
    seen = Seen.of(shown, STRIP.full_scale)
    assert np.median(seen.values.max(axis=(1, 2))) > 0.99
    reads = Reads(STRIP, np.ones(shown.shape[1:]), 0.98, np.array([0.0015, 0.1, 0.02]) ** 2)
    relief = learned_reliefs.learned(seen, reads)
    assert np.median(relief.misfits / seen.cells()) < 2.0
