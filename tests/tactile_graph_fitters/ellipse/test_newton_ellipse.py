"""Newton's method on ellipse and nearest points together: its equations and when it declines."""

import math

import numpy as np
import pytest

import references_fitters as references
from helpers_ellipses import drawn, oval
from tactile_graph_fitters.ellipse import fit_ellipse
from tactile_graph_fitters.ellipse.direct_ellipse import direct_shape, ellipse_frame
from tactile_graph_fitters.ellipse.ellipse_equations import reduced
from tactile_graph_fitters.ellipse.fit_ellipse import _lengthened, _settled, refined
from tactile_graph_fitters.ellipse.nearest_on_ellipse import distances
from tactile_graph_fitters.ellipse.newton_ellipse import (
    _as_axes,
    as_matrix,
    newton,
    solved,
    turned_feet,
)


def axes_of(m_uu, m_uv, m_vv):
    """Half axes and the first one's angle of the ellipse of a symmetric matrix."""
    (b, a), vectors = np.linalg.eigh([[m_uu, m_uv], [m_uv, m_vv]])
    return a, b, math.atan2(vectors[1, 1], vectors[0, 1])


def squares(uv, ellipse):
    """Half the sum of squared distances, the nearest points found anew."""
    off = distances.loops(uv, *ellipse[:2], *axes_of(*ellipse[2:]))
    return 0.5 * float(off @ off)


def at_nearest(uv, ellipse):
    """Cosine and sine that lead to the nearest points by M, found by brute force and Newton."""
    m = np.array([[ellipse[2], ellipse[3]], [ellipse[3], ellipse[4]]])
    found = []
    for point in uv.T - ellipse[:2]:
        t = np.linspace(0, 2 * np.pi, 721)
        at = t[np.hypot(*(m @ [np.cos(t), np.sin(t)] - point[:, None])).argmin()]
        for _ in range(30):
            q, along = m @ [math.cos(at), math.sin(at)], m @ [-math.sin(at), math.cos(at)]
            at -= ((q - point) @ along) / (along @ along - (q - point) @ q)
        found.append((math.cos(at), math.sin(at)))
    return np.ascontiguousarray(np.array(found).T)


def equations(uv, ellipse, cs, of=references.reduced):
    rows, normal, slope = np.empty((7, uv.shape[1])), np.empty((5, 5)), np.empty(5)
    total = of(uv, np.asarray(ellipse), cs, rows, normal, slope)
    return total, rows, np.tril(normal), slope


SHAPES = [(0.05, -0.1, 1.0, 0.1, 0.6), (0.0, 0.02, 0.8, 0.0, 0.8), (0.3, 0.0, 0.4, -0.3, 1.2)]


@pytest.mark.parametrize("ellipse", SHAPES)
def test_slope_and_second_derivatives_are_those_of_the_squared_distances(ellipse):
    """By differences, the nearest points found anew for each: the elimination is exact."""
    rng = np.random.default_rng(5)
    t = rng.uniform(0, 2 * np.pi, 25)
    uv = np.array([[1.0, 0.1], [0.1, 0.6]]) @ [np.cos(t), np.sin(t)] + rng.normal(0, 0.1, (2, 25))
    total, _, normal, slope = equations(uv, ellipse, at_nearest(uv, ellipse))
    assert 0.5 * total == pytest.approx(squares(uv, ellipse), rel=1e-12)
    step = 1e-5 * np.eye(5)
    high, low = ([squares(uv, ellipse + s * e) for e in step] for s in (1, -1))
    assert slope == pytest.approx(np.subtract(high, low) / 2e-5, abs=1e-7)
    for k, e in enumerate(step):
        up, down = (
            equations(uv, ellipse + s * e, at_nearest(uv, ellipse + s * e))[3] for s in (1, -1)
        )
        expected = (up - down)[k:] / 2e-5
        assert normal[k:, k] == pytest.approx(expected, abs=1e-4)


@pytest.mark.usefixtures("plain_kernels")
def test_away_from_the_nearest_points_a_step_brings_both_nearer():
    rng = np.random.default_rng(7)
    xy = oval(rng, 40, noise=0.02)
    _, uv, _ = ellipse_frame.loops(xy)
    _, u, v, a, b, angle = direct_shape.loops(uv)
    p = np.array([u, v, a, b, angle])
    best, rounds = newton.loops(uv, p.copy(), 12)
    assert 0 < rounds <= 5
    assert best <= 2.0 * squares(uv, [u, v, *as_matrix.loops(a, b, angle)])


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["outline", "arc", "flat", "cells", "blob", "grid"])
def test_equations_and_their_twin_agree_on_thousands_of_point_sets(kind):
    for seed in range(350):
        rng = np.random.default_rng(seed)
        _, uv, _ = ellipse_frame.compiled(drawn(kind, seed))
        if uv.shape[1] == 0:
            continue
        ellipse = np.array(
            [*rng.normal(0, 0.1, 2), 1.0, rng.uniform(-0.3, 0.3), rng.uniform(0.2, 1)]
        )
        cs = uv + 0.01
        cs /= np.hypot(*cs)
        one = equations(uv, ellipse, cs, references.reduced)
        for of in (reduced.loops, reduced.compiled):
            two = equations(uv, ellipse, cs, of)
            assert one[0] == pytest.approx(two[0], rel=1e-12)
            if one[0] < np.inf:
                for left, right in zip(one[1:], two[1:], strict=True):
                    assert left == pytest.approx(right, rel=1e-9, abs=1e-11 * np.abs(right).max())


def test_symmetric_equations_are_solved_or_declined():
    rng = np.random.default_rng(2)
    root = rng.normal(size=(5, 5))
    normal, slope, step = root @ root.T, rng.normal(size=5), np.empty(5)
    assert solved.loops(normal.copy(), slope, 1e-12, step)
    assert normal @ step == pytest.approx(-slope)
    normal[2, 2] = -1.0
    assert not solved.loops(normal, slope, 1e-12, step)


@pytest.mark.slow
@pytest.mark.usefixtures("plain_kernels")
@pytest.mark.parametrize(
    ("kind", "seeds"),
    [*((k, range(8)) for k in ("outline", "exact", "flat", "cells")), ("broken", (3702, 5801))],
)
def test_it_ends_where_the_longer_search_does(kind, seeds, monkeypatch):
    """Newton's method declines to take part: the damped search alone comes to the same ellipse.

    From the start of the broken ones larger steps would lead to minima that are less deep.
    """
    found = {}
    sets = [drawn(kind, seed) for seed in seeds]
    for name, way in (("both", newton), ("damped", lambda uv, p, rounds: (0.0, 0))):
        monkeypatch.setattr(fit_ellipse, "newton", way)
        for seed, xy in enumerate(sets):
            _, uv, _ = ellipse_frame.loops(xy)
            p = np.array(direct_shape.loops(uv)[1:])
            rms, _ = refined.loops(uv, p, fit_ellipse.STEP)
            found[name, seed] = [rms, p[0], p[1], *sorted(np.abs(p[2:4]))]
    for seed in range(len(sets)):
        assert found["both", seed] == pytest.approx(found["damped", seed], abs=1e-7)


@pytest.mark.usefixtures("plain_kernels")
def test_it_leaves_the_start_where_it_leads_nowhere():
    t = np.linspace(-1.0, 1.0, 21)
    uv = np.stack([t, t * t - 0.4])
    p = np.array([0.0, 3.0, 1.0, 3.4, 0.1])
    before = p.copy()
    assert newton.loops(uv, p, 12) == (0.0, 0)
    assert (p == before).all()


@pytest.mark.usefixtures("plain_kernels")
def test_a_circle_has_a_direction_to_be_flattened_in():
    """As axes and angle it would not: at a circle the angle has no slope."""
    t = np.linspace(0, 2 * np.pi, 24, endpoint=False)
    uv = np.stack([1.01 * np.cos(t), 0.99 * np.sin(t)])
    turn = np.array([[math.cos(0.8), -math.sin(0.8)], [math.sin(0.8), math.cos(0.8)]])
    p = np.array([0.0, 0.0, 1.0, 1.0, 0.0])
    total, rounds = newton.loops(turn @ uv, p, 12)
    assert 0 < rounds <= 5
    assert total < 1e-25
    assert p == pytest.approx([0.0, 0.0, 1.01, 0.99, 0.8], abs=1e-12)


@pytest.mark.parametrize(("side", "fits"), [(1.0, True), (-1.0, False)])
def test_a_place_across_the_ellipse_is_not_taken_for_the_nearest(side, fits):
    cs = np.array([[0.6, -0.6, 0.0], [0.8, 0.8, side]])
    uv = np.array([[2.0], [1.0]]) * cs * 1.01
    uv[1, 2] = 0.3
    p = np.zeros(5)
    total = _as_axes.loops(uv, np.array([0.0, 0.0, 2.0, 0.0, 1.0]), cs, p, np.inf)
    assert (total < np.inf) == fits
    assert (p[2:4] == ([2.0, 1.0] if fits else [0.0, 0.0])).all()


@pytest.mark.parametrize("p", [(-20.0, 3.0, 20.5, 2.0, -0.1), (1.0, 15.0, 2.0, 15.5, 0.05)])
def test_a_leap_keeps_the_end_at_the_points_and_its_curvature(p):
    p, trial = np.array(p), np.empty(5)
    _lengthened.loops(p, trial)

    def end(q):
        """The end of the longer axis that is nearer to the middle, and the radius there."""
        turn = q[4] + (0.0 if q[2] > q[3] else 0.5 * math.pi)
        along = max(q[2:4]) * np.array([math.cos(turn), math.sin(turn)])
        ends = [q[:2] + along, q[:2] - along]
        return *min(ends, key=lambda e: math.hypot(*e)), min(q[2:4]) ** 2 / max(q[2:4])

    assert end(trial) == pytest.approx(end(p))
    assert max(trial[2:4]) == 2.0 * max(p[2:4])


@pytest.mark.slow
def test_where_a_parabola_fits_as_well_it_gives_up_soon():
    """Points between two branches: each step led on by little, for 200 rounds."""
    rng = np.random.default_rng(0)
    found = []
    for seed in range(12):
        _, uv, _ = ellipse_frame.loops(drawn("hyperbola", seed) + 1e-3 * rng.normal())
        p = np.array(direct_shape.loops(uv)[1:])
        found.append(refined(uv, p, fit_ellipse.STEP)[1])
    assert max(found) < 0
    assert np.median(found) > -60


def test_a_foot_turns_by_its_own_slope_and_what_the_steps_take_off():
    rng = np.random.default_rng(4)
    angle, rows, step = rng.uniform(0, 6, 9), rng.normal(0, 0.2, (7, 9)), rng.normal(0, 0.2, 5)
    cs = np.array([np.cos(angle), np.sin(angle)])
    turned_feet.loops(cs, rows, step)
    half = -0.5 * (rows[5] * (step @ rows[:5]) + rows[6])
    wanted = angle + 2.0 * np.arctan(half)
    np.testing.assert_allclose(cs, [np.cos(wanted), np.sin(wanted)], atol=1e-12)


@pytest.mark.usefixtures("plain_kernels")
@pytest.mark.parametrize("noise", [0.0, 0.02])
def test_from_beside_the_minimum_the_last_steps_lead_to_it(noise):
    t = np.linspace(0.2, 5.0, 30)
    uv = np.stack([1.2 * np.cos(t), 0.7 * np.sin(t)])
    uv += noise * np.random.default_rng(5).normal(size=uv.shape)
    least = np.array([0.0, 0.0, 1.2, 0.7, 0.0])
    refined.loops(uv, least, 1e-12)
    beside = least + 1e-8 * np.array([1.0, -1.0, 0.5, 1.0, -0.5])
    total = _settled.loops(uv, beside, np.inf)
    assert beside == pytest.approx(least, abs=1e-12)
    off = distances.loops(uv, *least)
    assert total == pytest.approx(float(off @ off), rel=1e-12, abs=1e-24)
