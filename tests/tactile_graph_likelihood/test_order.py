"""Touch and order alone: probabilities of orders, and answers that no monotone law changes."""

import math
from itertools import permutations

import numpy as np
import pytest

from helpers_likelihood import drawn
from tactile_graph.compiled import have_compiler, warm_up
from tactile_graph.errors import Degenerate
from tactile_graph.wires import Circle, Image, Mask, Rectangle
from tactile_graph_likelihood.footprint_by_order import FootprintByOrder
from tactile_graph_likelihood.order_likelihood import log_order, ranked

SHARES = np.array([0.1, 0.4, 0.7, 1.0])


@pytest.fixture(autouse=True, scope="module")
def compiled():
    if have_compiler():
        warm_up()


def distinct(n):
    return np.arange(1, n + 1)


def test_orders_are_as_likely_as_weibull_loads_make_them():
    shape, rng = 1.7, np.random.default_rng(1)
    loads = SHARES * rng.weibull(shape, (200_000, 4))
    found = np.argsort(loads, axis=1)
    for order in ([0, 1, 2, 3], [1, 0, 3, 2], [3, 2, 1, 0]):
        share = (found == order).all(axis=1).mean()
        log = log_order.call(SHARES[order], distinct(4), shape)
        assert math.exp(log) / 24.0 == pytest.approx(share, rel=0.05, abs=2e-4)


def test_all_orders_sum_to_one():
    logs = [log_order.call(SHARES[list(o)], distinct(4), 2.5) for o in permutations(range(4))]
    assert np.exp(logs).mean() == pytest.approx(1.0)
    assert np.std(logs) > 1.0


def test_elements_not_covered_and_readings_all_alike_tell_nothing():
    with_stray = np.array([0.1, 0.0, 0.4, 0.7, 0.0, 1.0])
    alone = log_order.call(SHARES, distinct(4), 2.0)
    assert log_order.call(with_stray, distinct(6), 2.0) == pytest.approx(alone)
    assert log_order.call(SHARES, np.full(4, 4), 2.0) == 0.0


def test_a_tie_is_as_likely_as_the_orders_it_hides():
    tied = log_order.call(SHARES, np.array([2, 2, 3, 4]), 2.0)
    one = log_order.call(SHARES, distinct(4), 2.0)
    other = log_order.call(SHARES[[1, 0, 2, 3]], distinct(4), 2.0)
    assert math.exp(tied) == pytest.approx(0.5 * (math.exp(one) + math.exp(other)), rel=1e-3)


def test_kernel_is_its_reference():
    shares, ends = np.array([0.2, 0.0, 0.5, 0.5, 1.0]), np.array([1, 3, 3, 4, 5])
    assert log_order.call(shares, ends, 2.2) == pytest.approx(
        log_order.reference(shares, ends, 2.2)
    )


def test_touched_elements_are_ranked():
    logs, states = np.array([[3.0, 1.0], [0.0, 1.0]]), np.array([[1, 1], [0, 1]], np.uint8)
    order, ends = ranked(logs, states)
    assert order.tolist() == [[0, 1], [1, 1], [0, 0]]
    assert ends.tolist() == [2, 2, 3]


@pytest.mark.parametrize(
    ("shape", "true"),
    [("disc", Circle(10.0, 9.5, 5.5)), ("rectangle", Rectangle(10.0, 9.5, 13.0, 6.0, 0.4))],
)
def test_no_monotone_law_changes_the_answer_and_it_is_near(shape, true):
    step = FootprintByOrder(shape=shape, on_pad="whole")
    off = []
    for seed in range(5):
        image = drawn(true, 60.0, np.random.default_rng(seed))
        plain = step(image)
        bent = step(image.with_values(np.sqrt(image.values) / (1.0 + np.sqrt(image.values)), "raw"))
        assert (plain.x_cm, plain.y_cm) == pytest.approx((bent.x_cm, bent.y_cm), abs=1e-12)
        assert plain.posterior.covariance == pytest.approx(bent.posterior.covariance)
        off.append(np.hypot(plain.x_cm - 10.0, plain.y_cm - 9.5))
    assert np.mean(off) < 0.2


def test_touch_alone_still_locates_and_order_adds():
    step, sharp, blunt = FootprintByOrder(on_pad="whole"), [], []
    for seed in range(8):
        image = drawn(Circle(10.0, 9.5, 5.5), 60.0, np.random.default_rng(seed))
        touch = image.with_values((image.values > 0).astype(float), "raw")
        for found, to in ((step(image), sharp), (step(touch), blunt)):
            to.append((np.hypot(found.x_cm - 10.0, found.y_cm - 9.5), found.centre_std_cm))
    assert np.mean(sharp, axis=0)[0] < np.mean(blunt, axis=0)[0] < 0.4
    assert np.mean(sharp, axis=0)[1] < np.mean(blunt, axis=0)[1]


def test_a_mask_says_what_is_touched_even_of_readings_below_zero():
    image = drawn(Circle(10.0, 9.5, 5.5), 60.0, np.random.default_rng(3))
    mask = Mask(image.values > 0.0, image.pitch_cm, image.origin_cm)
    step = FootprintByOrder(on_pad="whole")
    lowered = image.with_values(image.values - 1000.0, "raw")
    assert step(lowered, mask).x_cm == pytest.approx(step(image).x_cm, abs=1e-12)
    with pytest.raises(Degenerate, match="no element is touched"):
        step(lowered, Mask(np.zeros((16, 16), bool), image.pitch_cm, image.origin_cm))


def test_nothing_touched_has_no_answer():
    with pytest.raises(Degenerate, match="no element bears a load"):
        FootprintByOrder()(Image(np.zeros((16, 16)), (1.3, 1.3), (-0.15, -0.15), "raw"))
