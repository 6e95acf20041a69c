"""References of 50 digits: exact where fractions say what is right, and their slopes as found."""

from fractions import Fraction

import numpy as np
import pytest
from mpmath import mp, mpf

from tactile_graph_pads.circuits import Divider, Floating
from tactile_graph_stress.references import circles, ellipses
from tactile_graph_stress.references.axis import main_axis
from tactile_graph_stress.references.exact_hull import hull_error
from tactile_graph_stress.references.network import conductances, readings
from tactile_graph_stress.references.stationary import solve

FIVE = [(3, 4), (4, 3), (5, 0), (4, -3), (-3, 4), (-4, -3), (0, -5)]
ON_CIRCLE = np.array([(x + 1, y + 2) for x, y in FIVE], dtype=np.float64)
ON_ELLIPSE = np.array([(2 * x + 1, y + 2) for x, y in FIVE], dtype=np.float64)
OFF = ON_CIRCLE + np.array([[0.25, 0], [0, 0.125], [0, 0], [0.5, 0], [0, 0], [0, 0.25], [0, 0]])
CIRCLES = [circles.KASA, circles.TAUBIN, circles.HYPER, circles.GEOMETRIC]


@pytest.mark.parametrize("fit", CIRCLES)
def test_points_on_a_circle_give_it_to_50_digits(fit):
    found = solve(fit, ON_CIRCLE, [[1.1, 1.8, 5.2]])
    with mp.workdps(60):
        off = [abs(a - b) for a, b in zip(found.shape, (1, 2, 5), strict=True)]
        assert max(off) < mpf(10) ** -49


@pytest.mark.parametrize("fit", [ellipses.GEOMETRIC, ellipses.DIRECT])
def test_points_on_an_ellipse_give_it_to_50_digits(fit):
    found = solve(fit, ON_ELLIPSE, [[1.1, 1.9, 10.2, 4.9, 0.01]])
    with mp.workdps(60):
        off = [abs(a - b) for a, b in zip(found.shape, (1, 2, 10, 5, 0), strict=True)]
        assert max(off) < mpf(10) ** -49


@pytest.mark.parametrize("fit", [circles.KASA, circles.TAUBIN, circles.HYPER, ellipses.DIRECT])
def test_sums_taken_once_give_the_equations_that_each_point_has_a_part_of(fit):
    n_unknowns = {circles.KASA: 3, ellipses.DIRECT: 7}.get(fit, 4)
    with mp.workdps(60):
        points = [(mpf(x), mpf(y)) for x, y in OFF.tolist()]
        a = [mpf(k + 2) / 7 for k in range(n_unknowns)]
        parts = [fit.term(a, x, y, len(points)) for x, y in points]
        expected = [sum(column) for column in zip(*parts, strict=True)]
        found = fit.summed(points)(a)
        assert max(abs(p - q) for p, q in zip(found, expected, strict=True)) < mpf(10) ** -54
    assert all(expected)


def test_kasa_is_what_fractions_give():
    rows = [(Fraction(x), Fraction(y), Fraction(1)) for x, y in OFF.tolist()]
    right = [-(x * x + y * y) for x, y, _ in rows]
    a = [[sum(r[i] * r[k] for r in rows) for k in range(3)] for i in range(3)]
    b = [sum(r[i] * v for r, v in zip(rows, right, strict=True)) for i in range(3)]
    for k in range(3):
        for i in range(k + 1, 3):
            share = a[i][k] / a[k][k]
            a[i] = [p - share * q for p, q in zip(a[i], a[k], strict=True)]
            b[i] -= share * b[k]
    e = b[1] - a[1][2] * b[2] / a[2][2]
    y = -(e / a[1][1]) / 2
    found = solve(circles.KASA, OFF, [[0.0, 0.0, 1.0]])
    with mp.workdps(60):
        assert abs(found.shape[1] - mpf(y.numerator) / y.denominator) < mpf(10) ** -48


@pytest.mark.slow
@pytest.mark.parametrize(
    "fit",
    [
        pytest.param(f, marks=[pytest.mark.slow] if i in (1, 2) else [])
        for i, f in enumerate(CIRCLES)
    ],
)
def test_the_slopes_are_those_of_the_answer(fit):
    start = [[1.0, 2.0, 5.0]]
    plain = solve(fit, OFF, start)
    sums = np.zeros(3)
    for i in range(len(OFF)):
        for k in range(2):
            moved = OFF.copy()
            moved[i, k] += 2.0**-20
            there = solve(fit, moved, start)
            sums += [
                abs(float(a - b)) * 2**20 for a, b in zip(there.shape, plain.shape, strict=True)
            ]
    assert plain.moves == pytest.approx(sums, rel=1e-4)


def test_of_several_roots_the_best_is_given():
    """The constrained fits' equations hold for each of their eigenvalues."""
    starts = [[-20.0, 2.0, 18.0], [9.0, 9.0, 1.0], [1.0, 2.0, 50.0], [1.0, 2.0, 5.0]]
    found = [solve(circles.TAUBIN, OFF, [start]) for start in starts]
    radii = [float(f.shape[2]) for f in found if f is not None]
    assert max(radii) > 1.5 * radii[-1]
    assert float(solve(circles.TAUBIN, OFF, starts).shape[2]) == pytest.approx(radii[-1], rel=1e-15)


def test_the_axis_of_points_on_a_line_is_the_line():
    t = np.arange(5.0)
    found = main_axis(np.column_stack([3.0 * t, 4.0 * t]))
    with mp.workdps(60):
        assert abs(mp.tan(found.shape[2]) - mpf(4) / 3) < mpf(10) ** -45
    assert main_axis(np.array([[1.0, 0.0], [-1.0, 0.0], [0.0, 1.0], [0.0, -1.0]])) is None


SQUARE = np.array([[0.0, 0.0], [0.0, 1.0], [1.0, 1.0], [1.0, 0.0]])


def test_the_right_hull_has_no_error_and_a_wrong_one_is_told():
    inner = np.vstack([SQUARE, [[0.5, 0.5]]])
    assert hull_error(inner, SQUARE) == (0.0, "")
    assert hull_error(inner, SQUARE[:3])[0] == pytest.approx(0.5**0.5, rel=1e-15)
    assert hull_error(inner, SQUARE[::-1])[1] == "not strictly convex, or clockwise"
    assert hull_error(inner, SQUARE * (1.5, 1.0))[1] == ("a corner is none of the points")


def test_the_last_bit_of_a_hull_counts():
    out = np.vstack([SQUARE, [[0.5, -(2.0**-60)]]])
    assert hull_error(out, SQUARE) == (2.0**-60, "")


@pytest.mark.parametrize("circuit", [Divider(), Floating(), Divider(driver_ohm=60.0)])
def test_readings_of_conductances_lead_back_to_them(circuit):
    siemens = np.array([[1e-4, 2e-5], [3e-6, 1e-3]])
    volts = readings(circuit, siemens)
    right = conductances(circuit, volts, 1.5 * siemens)
    found = np.array([[float(v) for v in row] for row in right.siemens])
    assert found == pytest.approx(siemens, rel=1e-15 * right.condition)
    assert volts == pytest.approx(5.0 * circuit.ratio(siemens), rel=1e-13)
    assert right.condition > 1.0
