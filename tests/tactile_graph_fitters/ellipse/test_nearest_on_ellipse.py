"""The nearest points of an ellipse, all at once: plain beside twin, and beside one at a time."""

import math

import numpy as np
import pytest

from tactile_graph_fitters.ellipse import nearest_on_ellipse
from tactile_graph_fitters.ellipse.nearest_on_ellipse import distances, feet, nearest


def clouds():
    """Half axes, and points near, within, far from and on the axes of their ellipse."""
    for seed in range(200):
        rng = np.random.default_rng(seed)
        a = 10.0 ** rng.uniform(-3, 3)
        b = a * (1.0 if seed % 10 == 0 else 10.0 ** rng.uniform(-3, 3))
        t, spread = rng.uniform(0, 2 * np.pi, 30), 10.0 ** rng.uniform(-12, 1)
        xy = np.stack([a * np.cos(t), b * np.sin(t)]) * (1 + spread * rng.normal(size=30))
        xy[:, 20:24] *= 1e-3 * rng.random(4)
        xy[0, 24:26] = xy[1, 26:28] = 0.0
        xy[:, 28] = 0.0
        yield xy, a, b


@pytest.mark.slow
def test_all_at_once_are_as_one_at_a_time():
    for xy, a, b in clouds():
        c, s = feet.reference(xy, a, b)
        expected = [nearest.loops(a, b, x, y) for x, y in xy.T.tolist()]
        got = np.hypot(a * c - xy[0], b * s - xy[1])
        want = [math.hypot(fx - x, fy - y) for (fx, fy), (x, y) in zip(expected, xy.T, strict=True)]
        assert got == pytest.approx(want, abs=1e-12 * (a + b))
        assert c * c + s * s == pytest.approx(np.ones(30), abs=1e-7)


@pytest.mark.slow  # much is compiled
def test_the_twin_finds_places_as_near():
    for xy, a, b in clouds():
        one, two = feet.reference(xy, a, b), feet.compiled(xy, a, b)
        near = [np.hypot(a * c - xy[0], b * s - xy[1]) for c, s in (one, two)]
        assert near[1] == pytest.approx(near[0], abs=1e-12 * (a + b))


@pytest.mark.slow
def test_the_twin_looks_again_where_it_went_wrong():
    """Within the evolute the first guess is on the far side of a ridge for many points."""
    x, y = np.meshgrid(np.linspace(-1.2, 1.2, 61), np.linspace(-0.3, 0.3, 31))
    xy = np.stack([x.ravel(), y.ravel()])
    got = feet.compiled(xy, 1.0, 0.1)
    t = np.linspace(0, 2 * np.pi, 2001)
    least = np.hypot(np.cos(t) - xy[0][:, None], 0.1 * np.sin(t) - xy[1][:, None]).min(axis=1)
    assert (np.hypot(got[0] - xy[0], 0.1 * got[1] - xy[1]) <= least + 1e-12).all()


@pytest.mark.usefixtures("plain_kernels")
def test_of_points_near_an_ellipse_none_is_looked_at_on_its_own(monkeypatch):
    t = np.linspace(0.0, 2.0 * np.pi, 50)
    xy = np.stack([3.0 * np.cos(t), 2.0 * np.sin(t)]) * (1.0 + 0.1 * np.cos(7.0 * t))
    monkeypatch.setattr(nearest_on_ellipse, "nearest", None)
    c, s = feet.loops(xy, 3.0, 2.0)
    (x, y) = xy
    assert (x - 3.0 * c) * 3.0 * s == pytest.approx((y - 2.0 * s) * 2.0 * c, abs=1e-13)


@pytest.mark.parametrize("angle", [0.0, 0.7, -2.0])
def test_distances_are_signed_and_turn_with_the_ellipse(angle):
    cos, sin = math.cos(angle), math.sin(angle)
    given = np.array([[6.0, 0.0], [4.0, 0.0], [0.0, 2.5], [0.0, 1.0], [5.0, 0.0]]).T
    uv = np.array([[cos, -sin], [sin, cos]]) @ given + [[1.0], [-2.0]]
    off = distances.loops(uv, 1.0, -2.0, 5.0, 2.0, angle)
    inner = -math.hypot(4.0 - 5.0 * (c := 20.0 / 21.0), 2.0 * math.sqrt(1 - c * c))
    assert off == pytest.approx([1.0, inner, 0.5, -1.0, 0.0], abs=1e-12)
