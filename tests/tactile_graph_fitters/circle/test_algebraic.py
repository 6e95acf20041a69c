"""The algebraic fits in closed form against the same fits by singular values."""

import numpy as np
import pytest

import references_fitters as references
from helpers_circles import arc_xy, three
from tactile_graph.wires import Circle, Points
from tactile_graph_fitters.circle.algebraic import moments
from tactile_graph_fitters.circle.fit_circle_hyper import fit_circle_hyper
from tactile_graph_fitters.circle.fit_circle_kasa import fit_circle_kasa
from tactile_graph_fitters.circle.fit_circle_taubin import fit_circle_taubin

HUNDRED = Circle(3.0, -7.0, 100.0)


def centred(xy):
    mean = xy.mean(axis=0)
    p = xy - mean
    return p, (p**2).sum(axis=1), mean


def from_parabola(a, b, c, d, mean):
    x, y = -b / (2 * a), -c / (2 * a)
    return np.array([x + mean[0], y + mean[1], np.sqrt(x**2 + y**2 - d / a)])


def kasa_peer(xy):
    p, z, mean = centred(xy)
    (b, c, d), *_ = np.linalg.lstsq(np.column_stack([p, np.ones(len(p))]), z, rcond=None)
    return from_parabola(1.0, -b, -c, -d, mean)


def taubin_peer(xy):
    p, z, mean = centred(xy)
    zm = z.mean()
    rows = np.column_stack([(z - zm) / (2 * np.sqrt(zm)), p])
    a, b, c = np.linalg.svd(rows)[2][2]
    a /= 2 * np.sqrt(zm)
    return from_parabola(a, b, c, -zm * a, mean)


def hyper_peer(xy):
    """Generalised eigenvalues: moments M against the hyper constraint H, least positive one."""
    p, z, mean = centred(xy)
    rows = np.column_stack([z, p, np.ones(len(p))])
    m = rows.T @ rows / len(p)
    zm = z.mean()
    h = np.array([[8 * zm, 0, 0, 2], [0, 1, 0, 0], [0, 0, 1, 0], [2.0, 0, 0, 0]])
    values, vectors = np.linalg.eig(np.linalg.solve(h, m))
    values = np.where(values.real > 0, values.real, np.inf)
    return from_parabola(*vectors[:, np.argmin(values)].real, mean)


PAIRS = [
    (fit_circle_kasa, kasa_peer),
    (fit_circle_taubin, taubin_peer),
    (fit_circle_hyper, hyper_peer),
]


@pytest.mark.parametrize(("fit", "peer"), PAIRS)
@pytest.mark.parametrize("degrees", [30, 60, 90, 180, 270, 360])
def test_agrees_with_the_fit_by_matrix_decomposition(fit, peer, degrees):
    rng = np.random.default_rng(7)
    for _ in range(20):
        xy = arc_xy(HUNDRED, degrees, int(rng.integers(8, 60)), 2.0, rng, rng.uniform(0, 360))
        assert three(fit(Points(xy))) == pytest.approx(peer(xy), rel=1e-6, abs=1e-4)


@pytest.mark.parametrize(("fit", "peer"), PAIRS)
@pytest.mark.parametrize("degrees", [0.1, 1, 5, 60, 360])
def test_exact_arcs_give_their_circle_back(fit, peer, degrees):
    got = fit(Points(arc_xy(HUNDRED, degrees, 25, start_deg=10.0)))
    allowed = 100.0 * 2e-14 / np.radians(degrees / 2) ** 2
    assert three(got) == pytest.approx(three(HUNDRED), abs=allowed)
    assert got.iterations == 0


@pytest.mark.slow  # much is fitted
def test_hyper_has_less_bias_than_taubin_and_taubin_than_kasa():
    """On long runs of noisy half circles, the mean radius tells."""
    rng = np.random.default_rng(8)
    arcs = [Points(arc_xy(HUNDRED, 120, 100, 4.0, rng)) for _ in range(800)]
    kasa, taubin, hyper = (
        abs(np.mean([fit(a).radius_cm for a in arcs]) - 100.0) for fit, _ in PAIRS
    )
    assert hyper < taubin < kasa


@pytest.mark.slow  # much is compiled
def test_moments_are_those_of_the_reference():
    uv = np.random.default_rng(9).normal(size=(2, 31))
    uv -= uv.mean(axis=1, keepdims=True)
    expected = pytest.approx(references.moments(uv), rel=1e-12)
    assert moments.loops(uv) == expected
    assert moments.compiled(uv) == expected
