"""The direct ellipse in one unknown: beside the eigenproblem it solves, and plain by compiled."""

import math

import numpy as np
import pytest

from helpers_ellipses import DEGENERATE, WELL, anywhere, drawn, oval
from helpers_modes import answered_by, held
from tactile_graph.errors import Degenerate
from tactile_graph.wires import Points
from tactile_graph_fitters.circle.principal_axes import OK, into_frame
from tactile_graph_fitters.ellipse.direct_ellipse import (
    FEW_PLACES,
    FLAT,
    FLATTEST,
    OTHER_CONIC,
    direct_fit,
    direct_shape,
    ellipse_frame,
    least_bend,
    quadratics,
)
from tactile_graph_fitters.ellipse.fit_ellipse import geometric_fit
from tactile_graph_fitters.ellipse.fit_ellipse_direct import fit_ellipse_direct


def by_eigenvectors(uv):
    """Centre and half axes by Halíř and Flusser's eigenproblem of a 3 by 3 matrix."""
    u, v = uv
    quadratic, linear = np.stack([u * u, u * v, v * v]), np.stack([u, v, np.ones_like(u)])
    back = -np.linalg.solve(linear @ linear.T, linear @ quadratic.T)
    m = quadratic @ quadratic.T + quadratic @ linear.T @ back
    _, vectors = np.linalg.eig(np.stack([0.5 * m[2], -m[1], 0.5 * m[0]]))
    bent = np.real(4 * vectors[0] * vectors[2] - vectors[1] ** 2)
    a, b, c = np.real(vectors[:, bent.argmax()])
    d, e, f = back @ (a, b, c)
    form = np.array([[a, b / 2], [b / 2, c]])
    centre = -0.5 * np.linalg.solve(form, (d, e))
    level = centre @ form @ centre - f
    return [*centre, *np.sort(np.sqrt(level / np.linalg.eigvalsh(form)))[::-1]]


@pytest.mark.slow
@pytest.mark.parametrize("kind", [k for k in WELL if k != "far"])
def test_it_is_the_eigenvector_of_halir_and_flusser(kind):
    for seed in range(60):
        status, uv, _ = into_frame.reference(drawn(kind, seed))
        assert status == OK
        status, u, v, first, second, _ = direct_shape.loops(uv)
        assert status == OK
        expected = by_eigenvectors(uv)
        assert [u, v, first, second] == pytest.approx(expected, rel=1e-9, abs=1e-9 * first)


@pytest.mark.slow
@pytest.mark.parametrize("kind", [*WELL, *DEGENERATE])
def test_plain_and_compiled_agree_on_thousands_of_point_sets(kind):
    """Degenerate ones too: whether there is an ellipse, and which; never anything but a number."""
    sets = [drawn(kind, seed) for seed in range(150)]
    with answered_by("plain"):
        plain = [direct_fit.loops(xy) for xy in sets]
    for xy, one in zip(sets, plain, strict=True):
        two = direct_fit.compiled(xy)
        assert one[0] == two[0]
        assert np.isfinite(two).all()
        if kind in WELL and one[0] == OK:
            assert one[1:5] == pytest.approx(two[1:5], rel=1e-9, abs=1e-9 * one[3])


@pytest.mark.slow
@pytest.mark.parametrize(
    ("kind", "n"), [(k, 40) for k in WELL if k != "blob"] + [(k, 3) for k in ("blob", *DEGENERATE)]
)
def test_the_nearest_ellipse_plain_and_compiled(kind, n):
    sets = [drawn(kind, seed) for seed in range(n)]
    with answered_by("plain"):
        plain = [geometric_fit.loops(xy) for xy in sets]
    for xy, one in zip(sets, plain, strict=True):
        two = geometric_fit.compiled(xy)
        assert one[0] == two[0]
        assert np.isfinite(two).all()
        if kind in WELL and one[0] == OK:
            assert one[1:5] == pytest.approx(two[1:5], rel=1e-9, abs=1e-9 * one[3])


@pytest.mark.parametrize("form", ["loops", "compiled"])
def test_what_it_asks_of_the_points_is_what_a_regression_says(form):
    rng = np.random.default_rng(3)
    uv = into_frame.reference(oval(rng, 30, noise=0.3))[1]
    scales, _, (cos, sin, ww, rr), (zz, on_w, on_r, off) = getattr(quadratics, form)(uv)
    u, v = uv / np.array(scales)[:, None]
    linear = np.stack([np.ones_like(u), u, v], axis=1)
    z, w, r = (
        q - linear @ np.linalg.lstsq(linear, q)[0]
        for q in (0.5 * (u * u + v * v), 0.5 * (u * u - v * v), u * v)
    )
    w, r = w * cos + r * sin, r * cos - w * sin
    assert np.mean(w * r) == pytest.approx(0.0, abs=1e-12)
    found, rest, *_ = np.linalg.lstsq(np.stack([w, r], axis=1), z)
    assert (on_w, on_r) == pytest.approx(tuple(found))
    assert (zz, ww, rr) == pytest.approx((np.mean(z * z), np.mean(w * w), np.mean(r * r)))
    assert off == pytest.approx(rest[0] / len(z))


@pytest.mark.parametrize("on", [(0.1, 0.3), (0.9, 0.42), (1.7, 0.2), (-3.0, 2.0), (0.0, -1.0)])
@pytest.mark.parametrize("off", [0.0, 1e-9, 0.1, 2.0])
def test_the_multiplier_is_a_root_and_leaves_an_ellipse(on, off):
    """off = lambda (1 - on_w by_w - on_r by_r), with lambda from either of by_w and by_r."""
    ww, rr = 0.7, 0.2
    zz = off + on[0] ** 2 * ww + on[1] ** 2 * rr
    by_w, by_r = least_bend.loops(ww, rr, zz, *on, off)
    assert by_w * by_w + by_r * by_r <= 1.0
    if by_w != on[0]:
        value = ww * (on[0] / by_w - 1.0)
        assert value * (1.0 - on[0] * by_w - on[1] * by_r) == pytest.approx(off, abs=1e-12)
        assert by_r == pytest.approx(on[1] * rr / (rr + value))
    else:
        assert off == 0.0 or on[0] == 0.0


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["parabola", "parallel lines"])
def test_what_is_on_the_edge_of_the_ellipses_is_none(kind):
    """Rounding decided: half of them came out as ellipses of kilometres."""
    for seed in range(200):
        with pytest.raises(Degenerate, match="no ellipse is near them, but another conic"):
            fit_ellipse_direct(Points(drawn(kind, seed)))


def test_points_at_four_places_but_for_rounding_are_refused():
    rng = np.random.default_rng(8)
    corners = np.array([[0.0, 0], [1, 0.1], [1.2, 1], [0, 1]])
    for _ in range(50):
        xy = corners[rng.integers(0, 4, 30)]
        xy += np.spacing(1.0) * rng.integers(-1, 2, xy.shape)
        status = direct_fit(held(xy))[0]
        assert status in (FEW_PLACES, OTHER_CONIC)


def test_a_line_of_many_points_and_one_beside_it_has_no_ellipse():
    for seed in range(50):
        rng = np.random.default_rng(seed)
        u = rng.uniform(-2, 2, 9)
        xy = anywhere(rng, u, np.where(np.arange(9) == 4, 1.0, 0.0))
        assert direct_fit(held(xy))[0] != OK


@pytest.mark.parametrize("power", [-4, -5, -7])
def test_it_is_flat_from_a_millionth_on(power):
    rng = np.random.default_rng(1)
    xy = oval(rng, 40, ratio=(0.5, 0.6))
    xy = (xy - xy.mean(axis=0)) * (1.0, 10.0**power)
    found = direct_fit(xy)
    assert found[0] == (FLAT if 10.0**power < FLATTEST else OK)


@pytest.mark.slow
@pytest.mark.parametrize("n", [5, 10, 100, 10_000])
@pytest.mark.parametrize(("offset", "scale"), [(0.0, 1.0), (1e6, 1.0), (0.0, 1e-200), (3.0, 1e200)])
def test_few_points_and_many_far_away_and_of_any_size(n, offset, scale):
    rng = np.random.default_rng(n)
    t = 2 * np.pi * (np.arange(n) + 0.3 * rng.random(n)) / n
    xy = np.column_stack([3.0 * np.cos(t), 2.0 * np.sin(t)]) + offset
    got = fit_ellipse_direct(Points(xy * scale))
    allowed = 1e-12 * max(1.0, 1e3 * offset / 1e3)
    assert got.x_cm / scale == pytest.approx(offset, abs=allowed)
    assert got.semi_major_cm / scale == pytest.approx(3.0, abs=allowed)
    assert got.semi_minor_cm / scale == pytest.approx(2.0, abs=allowed)
    assert math.remainder(got.angle_rad, math.pi) == pytest.approx(0.0, abs=allowed)


@pytest.mark.parametrize("same", [[0], [0, 1, 1, 0], [3, 4, 5, 6]])
def test_five_places_are_needed_however_often_each_is_met(same):
    rng = np.random.default_rng(6)
    xy = oval(rng, 8)
    few = np.vstack([xy[:4][np.array(same) % 4], xy[:4], xy[:4]])
    assert ellipse_frame.loops(few)[0] == FEW_PLACES
    assert ellipse_frame.loops(np.vstack([few, xy[4:5]]))[0] == OK
