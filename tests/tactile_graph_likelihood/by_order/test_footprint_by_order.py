"""Touch and order alone: probabilities of orders, and answers that no monotone law changes."""

import math
from dataclasses import replace
from itertools import permutations

import numpy as np
import pytest

from helpers_likelihood import GRID, NOISE, drawn, made
from tactile_graph import load
from tactile_graph.errors import Degenerate
from tactile_graph.wires import Circle, Image, Mask, Rectangle
from tactile_graph_likelihood.by_order.footprint_by_order import FootprintByOrder
from tactile_graph_likelihood.by_order.goodness_of_fit import order_moments, touch_moments
from tactile_graph_likelihood.by_order.hazards import (
    hazard,
    hazard_parts,
    hazards,
    hazards_at,
)
from tactile_graph_likelihood.by_order.likelihood import log_order, order_of

pytestmark = pytest.mark.usefixtures("warm_kernels")

SHARES = np.array([0.1, 0.4, 0.7, 1.0])
SIGMA, T = 0.5, 2.5
TABLE = hazards(1e-6, 0.16, SIGMA)


def distinct(n):
    return np.arange(1, n + 1)


def log_of(shares, ends, t=T):
    return log_order.call(shares, ends, SIGMA, t, TABLE, np.empty(len(shares)))


def test_the_rate_is_the_normal_one_until_only_strays_are_left():
    for x in (-2.0, -0.31, 0.0, 1.7, 3.0):
        tail = 0.5 * math.erfc(x * math.sqrt(0.5))
        normal = math.exp(-0.5 * x * x) / math.sqrt(2.0 * math.pi) / tail
        assert hazard.call(TABLE, x) == pytest.approx(normal, rel=1e-3)
    assert hazard.call(TABLE, -7.0) > 1e-8
    assert hazard.call(TABLE, 12.0) < 1.0 < hazard.call(TABLE, 3.0)


def test_rates_at_a_sigma_are_those_of_its_own_table():
    parts = hazard_parts(1e-3, 0.16)
    for sigma in (0.05, 0.48, 1.2):
        own = hazards(1e-3, 0.16, sigma)
        assert hazards_at.reference(parts, sigma) == pytest.approx(own)
        assert hazards_at.reference(own[None], 0.7) == pytest.approx(own, abs=0.0)


@pytest.mark.slow
@pytest.mark.parametrize("t", [8.0, T, 1.5])
def test_orders_are_about_as_likely_as_lognormal_loads_make_them(t):
    rng = np.random.default_rng(1)
    loads = SHARES * np.exp(SIGMA * rng.standard_normal((200_000, 4)))
    found = np.argsort(loads[(loads > math.exp(-t)).all(axis=1)], axis=1)
    away = 0.0
    for order in permutations(range(4)):
        share = (found == order).all(axis=1).mean()
        stated = math.exp(log_of(SHARES[list(order)], distinct(4), t)) / 24.0
        away += share * math.log(share / stated) if share > 0.0 else 0.0
        if share > 0.1:
            assert stated == pytest.approx(share, rel=0.12)
    assert away < 0.015  # nats; 1.3 to 1.9 are what the order tells at all


def test_all_orders_sum_to_one():
    logs = [log_of(SHARES[list(o)], distinct(4)) for o in permutations(range(4))]
    assert np.exp(logs).mean() == pytest.approx(1.0)
    assert np.std(logs) > 1.0


def test_elements_not_covered_and_readings_all_alike_tell_nothing():
    with_stray = np.array([0.1, 0.0, 0.4, 0.7, 0.0, 1.0])
    alone = log_of(SHARES, distinct(4))
    assert log_of(with_stray, distinct(6)) == pytest.approx(alone)
    assert log_of(SHARES, np.full(4, 4)) == 0.0


def test_a_tie_is_about_as_likely_as_the_orders_it_hides():
    shares = np.array([0.2, 0.5, 0.6, 0.9, 1.0, 1.0, 1.0, 1.0])
    tied = log_of(shares, np.array([3, 3, 3, 4, 5, 6, 7, 8]))
    ways = [[*o, *range(3, 8)] for o in permutations(range(3))]
    each = [math.exp(log_of(shares[way], distinct(8))) for way in ways]
    assert math.exp(tied) == pytest.approx(np.mean(each), rel=0.06)


def test_kernel_is_its_reference():
    shares, ends = np.array([0.2, 0.0, 0.5, 0.5, 1.0]), np.array([1, 3, 3, 4, 5])
    levels = np.empty((2, 5))
    found = log_order.call(shares, ends, SIGMA, T, TABLE, levels[0])
    assert found == pytest.approx(log_order.reference(shares, ends, SIGMA, T, TABLE, levels[1]))
    assert levels[0] == pytest.approx(levels[1])
    assert (np.diff(levels[0]) >= 0.0).all()


@pytest.mark.slow
def test_what_is_surprising_is_measured_against_what_is_to_be_expected():
    rng, off = np.random.default_rng(2), []
    shares = np.concatenate([rng.uniform(0.05, 1.0, 25), np.ones(25)])
    for _ in range(300):
        loads = shares * np.exp(SIGMA * rng.standard_normal(50))
        on = loads > math.exp(-T)
        along = shares[on][np.argsort(loads[on])]
        levels = np.empty(len(along))
        log_order.call(along, distinct(len(along)), SIGMA, T, TABLE, levels)
        got, mean, var = order_moments.call(along, distinct(len(along)), SIGMA, TABLE, levels)
        off.append((got - mean) / math.sqrt(var))
    assert np.mean(off) == pytest.approx(0.0, abs=0.25)
    assert np.std(off) == pytest.approx(1.0, abs=0.2)


def test_what_is_touched_has_the_moments_of_its_chances():
    noise, states = NOISE.vector(1.3), np.array([[1, 0, 2]], np.uint8)
    share = np.array([[1.0]])
    own = 0.84 * 0.5 * math.erfc(-1.0 / 0.48 * math.sqrt(0.5))
    inside, outside = 1e-3 + (1.0 - 1e-3) * own, 1e-3
    got, mean, var = touch_moments.call(share, 1.0, (0, 0, 1, 1), states, noise)
    assert got == pytest.approx(math.log(inside) + math.log(1.0 - outside))
    two = ((inside, 1.0 - inside), (outside, 1.0 - outside))
    assert mean == pytest.approx(sum(c * math.log(c) for pair in two for c in pair))
    squares = sum(a * b * math.log(a / b) ** 2 for a, b in two)
    assert var == pytest.approx(squares)


def test_touched_elements_are_ranked():
    logs, states = np.array([[3.0, 1.0], [0.0, 1.0]]), np.array([[1, 1], [0, 1]], np.uint8)
    order, ends = order_of(logs, states)
    assert order.tolist() == [[0, 1], [1, 1], [0, 0]]
    assert ends.tolist() == [2, 2, 3]


@pytest.mark.slow
@pytest.mark.parametrize(
    ("shape", "true"),
    [("disc", Circle(10.0, 9.5, 5.5)), ("rectangle", Rectangle(10.0, 9.5, 13.0, 6.0, 0.4))],
)
def test_no_monotone_law_changes_the_answer_and_it_is_near(shape, true):
    step = made(FootprintByOrder, shape=shape, on_pad="whole")
    off = []
    for seed in range(5):
        image = drawn(true, 60.0, np.random.default_rng(seed))
        plain = step(image)
        bent = step(image.with_values(np.sqrt(image.values) / (1.0 + np.sqrt(image.values)), "raw"))
        assert (plain.x_cm, plain.y_cm) == pytest.approx((bent.x_cm, bent.y_cm), abs=1e-12)
        assert plain.posterior.covariance == pytest.approx(bent.posterior.covariance)
        off.append(np.hypot(plain.x_cm - 10.0, plain.y_cm - 9.5))
    assert np.mean(off) < 0.2


@pytest.mark.slow
@pytest.mark.parametrize("masked", [False, True])
def test_readings_that_differ_by_next_to_nothing_keep_their_order(masked):
    """Next to 1 a reading of 1e-20 is nothing; neighbouring numbers have one logarithm."""
    step = made(FootprintByOrder, on_pad="whole")
    image = drawn(Circle(10.0, 9.5, 5.5), 60.0, np.random.default_rng(3))
    touched = image.values > 0.0
    mask = (Mask(touched, image.pitch_cm, image.origin_cm),) if masked else ()
    ranks = np.argsort(np.argsort(image.values, axis=None)).reshape(image.shape) + 1.0
    plain = step(image, *mask)
    for bent in (1e-20 * image.values, 1e-15 * (1.0 + ranks * 2.0**-52)):
        found = step(image.with_values(np.where(touched, bent, 0.0), "raw"), *mask)
        assert (found.x_cm, found.y_cm, found.radius_cm) == (
            plain.x_cm, plain.y_cm, plain.radius_cm,
        )  # fmt: skip


@pytest.mark.slow
def test_touch_alone_still_locates_and_order_adds():
    step, sharp, blunt = made(FootprintByOrder, on_pad="whole"), [], []
    for seed in range(8):
        image = drawn(Circle(10.0, 9.5, 5.5), 60.0, np.random.default_rng(seed))
        touch = image.with_values((image.values > 0).astype(float), "raw")
        for found, to in ((step(image), sharp), (step(touch), blunt)):
            to.append((np.hypot(found.x_cm - 10.0, found.y_cm - 9.5), found.centre_std_cm))
    assert np.mean(sharp, axis=0)[0] < np.mean(blunt, axis=0)[0] < 0.4
    assert np.mean(sharp, axis=0)[1] < np.mean(blunt, axis=0)[1]


@pytest.mark.slow
def test_a_mask_says_what_is_touched_even_of_readings_below_zero():
    image = drawn(Circle(10.0, 9.5, 5.5), 60.0, np.random.default_rng(3))
    mask = Mask(image.values > 0.0, image.pitch_cm, image.origin_cm)
    step = made(FootprintByOrder, on_pad="whole")
    lowered = image.with_values(image.values - 1000.0, "raw")
    assert step(lowered, mask).x_cm == pytest.approx(step(image).x_cm, abs=1e-12)
    with pytest.raises(Degenerate, match="no element is touched"):
        step(lowered, Mask(np.zeros((16, 16), bool), image.pitch_cm, image.origin_cm))


@pytest.mark.slow
def test_elements_of_another_pitch_have_a_gap_of_their_own_size():
    """A told gap of 0.3 cm would leave no element of a fine pad."""
    step, found = made(FootprintByOrder), []
    values = drawn(Circle(10.0, 9.5, 4.0), 60.0, np.random.default_rng(0)).values
    for pitch in (2.5, 0.25):
        its = step(Image(values, (pitch, pitch), (0.0, 0.0), "raw"))
        found.append(np.array((its.x_cm, its.y_cm, its.radius_cm)) / pitch)
    assert found[1] == pytest.approx(found[0], rel=1e-6)
    assert found[1] == pytest.approx(np.array((10.15, 9.65, 4.0)) / 1.3, abs=0.25)


def test_nothing_touched_has_no_answer():
    with pytest.raises(Degenerate, match="no element bears a load"):
        made(FootprintByOrder)(Image(np.zeros((16, 16)), (1.3, 1.3), (-0.15, -0.15), "raw"))


def frames(n, seed, **scene):
    source = load("circle-by-order").with_source("simulate", scene="discs", frames=n, **scene)
    return list(source.frames(seed))


def seen(step, frame):
    touched = Mask(frame.image.values >= 0.01, frame.image.pitch_cm, frame.image.origin_cm)
    return step(frame.image, touched)


@pytest.mark.slow
def test_its_region_holds_the_truth_and_designed_frames_fit():
    step = made(FootprintByOrder, on_pad="whole")
    rows = []
    for frame in frames(100, 61):
        found, true = seen(step, frame), frame.truth[0].shape
        rows.append((found.posterior.contains(true), found.fits, found.radius_cm - true.radius_cm))
    held, fits, off = np.mean(rows, axis=0)
    assert 0.83 <= held <= 0.97
    assert fits >= 0.97
    assert abs(off) < 0.03


@pytest.mark.slow
def test_volts_are_freed_of_the_circuit_that_shadows_elements():
    step, decouple = made(FootprintByOrder, on_pad="whole"), load("circle-likelihood")
    run = decouple.runner(only=["siemens"])
    (frame,) = frames(1, 3)
    touched = Mask(frame.image.values >= 0.01, frame.image.pitch_cm, frame.image.origin_cm)
    by_siemens = step(run(frame)["siemens"], touched)
    assert seen(step, frame).posterior.mean == pytest.approx(by_siemens.posterior.mean)
    as_they_are = step(frame.image.with_values(frame.image.values, "raw"), touched)
    assert as_they_are.radius_cm != pytest.approx(by_siemens.radius_cm, abs=1e-3)


@pytest.mark.slow
def test_impossible_volts_say_nothing():
    (frame,) = frames(1, 3)
    step, volts = made(FootprintByOrder, on_pad="whole"), frame.image.values.copy()
    volts[:, 8] = 1.0
    found = seen(step, replace(frame, image=frame.image.with_values(volts)))
    true = frame.truth[0].shape
    assert np.hypot(found.x_cm - true.x_cm, found.y_cm - true.y_cm) < 0.4
    with pytest.raises(Degenerate, match="no element is touched"):
        step(Image(np.ones((16, 16)), (1.3, 1.3), (-0.15, -0.15), "volt"))


def disturbed(kind, rng):
    """Return a disc's loads that break one promise of the model."""
    image = drawn(Circle(10.0, 9.5, 6.5), 60.0, rng)
    loads, (y, x) = image.values.copy(), np.mgrid[0:16, 0:16] * GRID[2] + 0.5
    if kind == "leans":
        loads *= np.exp(0.35 * (x - 10.0))
    elif kind == "strays":
        loads[0, ::3] = 80.0
    elif kind == "bumps":
        loads *= np.exp(1.2 * np.sin(0.6 * x) * np.sin(0.6 * y))
    return image.with_values(loads)


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["leans", "strays", "bumps"])
def test_what_neither_touch_nor_order_explains_is_flagged(kind):
    step = made(FootprintByOrder, on_pad="whole")
    found = [step(disturbed(kind, np.random.default_rng(seed))) for seed in range(6)]
    assert sum(not f.fits for f in found) >= 5
    plain = [step(disturbed("", np.random.default_rng(seed))) for seed in range(6)]
    assert all(f.fits for f in plain)


@pytest.mark.slow
@pytest.mark.parametrize("sigma", [0.05, 0.12])
def test_a_pad_more_even_than_told_does_not_make_outlines_small(sigma):
    step, rows = made(FootprintByOrder, on_pad="whole"), []
    for seed in range(12):
        rng = np.random.default_rng(seed)
        true = Circle(*rng.uniform(8.0, 12.0, 2), rng.uniform(3.5, 6.0))
        found = step(drawn(true, 60.0, rng, sigma=sigma, voids=0.0))
        rows.append((found.radius_cm - true.radius_cm, found.posterior.contains(true), found.fits))
    off, held, fits = np.mean(rows, axis=0)
    assert abs(off) < 0.08
    assert held >= 0.75
    assert fits == 1.0


@pytest.mark.slow
@pytest.mark.parametrize("sigma", [0.48, 0.9])
def test_sigma_is_not_estimated_on_a_pad_at_least_as_uneven_as_told(sigma):
    step, rng = made(FootprintByOrder, on_pad="whole"), np.random.default_rng(0)
    found = [step(drawn(Circle(10.0, 9.5, 5.5), 60.0, rng, sigma=sigma)) for _ in range(10)]
    assert sum(len(f.posterior.mean) == 4 for f in found) >= 8
