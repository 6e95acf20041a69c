"""What docs/errata.md says of the thesis' equations, worked out again, and what the code does."""

from __future__ import annotations

import math
import re
from pathlib import Path

import numpy as np
import pytest

from tactile_graph import Image, Mask, Points, load
from tactile_graph_classifiers.distances.minimum_distance import MinimumDistance
from tactile_graph_classifiers.measuring.measurements import Measurements
from tactile_graph_filters.images.low_pass import LowPass
from tactile_graph_filters.morphology.and_compare import and_compare
from tactile_graph_filters.morphology.dilate import Dilate
from tactile_graph_filters.morphology.erode import Erode
from tactile_graph_filters.morphology.open import Open
from tactile_graph_fitters.circle.fit_circle_thesis import fit_circle_thesis
from tactile_graph_fitters.ellipse.fit_ellipse_origin import fit_ellipse_origin
from tactile_graph_fitters.ellipse.nearest_on_ellipse import nearest
from tactile_graph_fitters.orientation.orientation import Orientation
from tactile_graph_fitters.orientation.rotate_points import rotate_points
from tactile_graph_mrf.energy.model import Model
from tactile_graph_mrf.energy.problem import prepare
from tactile_graph_mrf.energy.total import energy
from tactile_graph_pads.circuits import Divider, Feedback
from tactile_graph_pads.pad import load_pad

PAGE = Path(__file__).parents[2] / "docs" / "errata.md"
pytestmark = pytest.mark.skipif(not PAGE.is_file(), reason="the docs are not beside the tests")


def row(place: str) -> str:
    """Return the page's row that begins with a place."""
    return next(t for t in PAGE.read_text("utf-8").splitlines() if t.startswith(f"| {place} |"))


def test_two_loads_of_the_thesis_make_the_exponent() -> None:
    exponent = -math.log(80.0 / 1.0) / math.log(2000.0 / 100.0)
    law = load_pad("thesis").law
    assert f"exponent of {exponent:.2f}".replace("-", "−") in row("2.1.1, 2.3.2")
    assert law.resistance_at(2000.0) / law.resistance_at(100.0) == pytest.approx(1 / 80, rel=1e-3)


def test_the_converter_of_2_2_2_and_the_divider_of_its_results() -> None:
    siemens = np.zeros((16, 1))
    siemens[0, 0] = 1.0 / 80e3
    lone, volts = siemens.copy(), {}
    for circuit in (Divider(bias_ohm=33e3), Feedback(bias_ohm=33e3)):
        siemens[1:9] = 0.0
        volts[circuit.kind] = [5.0 * circuit.ratio(lone)[0, 0]]
        siemens[1:9] = 1.0 / 80e3
        volts[circuit.kind].append(5.0 * circuit.ratio(siemens)[0, 0])
    assert volts["feedback"] == pytest.approx([2.0625, 2.0625])
    assert volts["divider"] == pytest.approx([1.46, 0.438], rel=1e-2)
    for value in ("2.06 V", "1.46 V", "165 V"):
        assert value in row("2.2.2, 2.3.1")
    assert 5.0 * 33e3 / 1e3 == 165.0


def test_an_opening_takes_the_turned_element() -> None:
    corner = [[0, 0, 0], [0, 1, 1], [0, 1, 0]]
    values = np.zeros((9, 9), np.bool_)
    values[2:6, 3:7] = True
    mask = Mask(values)
    as_printed = Dilate(element=corner)(Erode(element=corner)(mask))
    assert not (as_printed.values <= values).all()  # an opening never adds anything
    assert (Open(element=corner)(mask).values <= values).all()


def points_about_a_circle() -> tuple[np.ndarray, np.ndarray]:
    rng = np.random.default_rng(0)
    angle = rng.uniform(0.0, 2.0 * math.pi, 40)
    radius = 5.0 + 0.3 * rng.normal(size=40)
    return 3.0 + radius * np.cos(angle), 7.0 + radius * np.sin(angle)


def test_b_8_and_b_9_are_zero_at_the_answer_and_b_10_only_with_its_1_over_n() -> None:
    x, y = points_about_a_circle()
    n = len(x)
    found = fit_circle_thesis(Points(np.column_stack([x, y])), tolerance=1e-13)
    d = np.hypot(x - found.x_cm, y - found.y_cm)
    for centre, along in ((found.x_cm, x), (found.y_cm, y)):
        b8 = n * centre - along.sum() - centre * found.radius_cm * (1 / d).sum()
        assert b8 + found.radius_cm * (along / d).sum() == pytest.approx(0.0, abs=1e-9)
    assert found.radius_cm - d.sum() / n == pytest.approx(0.0, abs=1e-9)
    assert abs(found.radius_cm - d.sum()) > 30.0 * found.radius_cm
    assert "factor 1/n" in row("eq. B.10")


def test_b_8_solved_for_the_centre_divides_by_0_on_a_perfect_circle() -> None:
    angle = np.linspace(0.0, 6.0, 12)
    d = np.hypot(4.0 * np.cos(angle), 4.0 * np.sin(angle))
    assert len(d) - 4.0 * (1.0 / d).sum() == pytest.approx(0.0, abs=1e-12)


@pytest.mark.parametrize(("a", "b", "told"), [(8.0, 3.5, "1.4"), (7.0, 1.5, "2.4")])
def test_radial_distances_are_longer_by_a_factor_however_near(
    a: float, b: float, told: str
) -> None:
    t = np.linspace(0.01, math.pi / 2 - 0.01, 400)
    x, y = 1.00001 * a * np.cos(t), 1.00001 * b * np.sin(t)
    r, cos, sin = np.hypot(x, y), x / np.hypot(x, y), y / np.hypot(x, y)
    radial = np.abs(r - 1.0 / np.sqrt(cos**2 / a**2 + sin**2 / b**2))
    on = [nearest(a, b, float(p), float(q)) for p, q in zip(x, y, strict=True)]
    normal = np.array([math.hypot(p - u, q - v) for p, q, (u, v) in zip(x, y, on, strict=True)])
    factor = (a * a + b * b) / (2.0 * a * b)
    assert (radial / normal).max() == pytest.approx(factor, rel=1e-3)
    assert f"{factor:.1f}" == told
    assert told in row("D")


def test_d_8_is_the_polar_distance_which_the_y_axis_has_too() -> None:
    a, b, x, y = 5.0, 2.0, 3.0, -2.5
    root = math.sqrt(a * a * b * b / (b * b + a * a * y * y / (x * x)))
    d_8 = min((s * root - x) ** 2 + (s * y / x * root - y) ** 2 for s in (1, -1))
    r = math.hypot(x, y)
    polar = r - 1.0 / math.sqrt((x / r) ** 2 / a**2 + (y / r) ** 2 / b**2)
    assert d_8 == pytest.approx(polar**2, rel=1e-12)
    on_axes = Points(np.array([[5.0, 0.0], [-5.0, 0.0], [0.0, 2.0], [0.0, -2.0]]))
    found = fit_ellipse_origin(on_axes, Orientation(0.0, 0.0, 0.0, 0.6, 0.0, False))
    assert (found.semi_major_cm, found.semi_minor_cm) == pytest.approx((5.0, 2.0), rel=1e-6)
    assert x * x * b * b + y * y * a * a != 1.0  # D.3: its right side is a² b²


def test_a_lone_point_in_the_corner_is_gone_above_a_quarter_only() -> None:
    on = np.zeros((16, 16), bool)
    on[0, 0] = True
    corner, edge = Mask(on), np.ones((16, 16), bool)
    edge[:, 8:] = False
    smooth = load("rectangle-1").nodes["smooth"].settings
    low_pass = LowPass(size=smooth["size"])
    assert not and_compare(corner, low_pass(corner), level=0.2501).values.any()
    assert and_compare(corner, low_pass(corner), level=0.25).values.any()
    kept = and_compare(Mask(edge), low_pass(Mask(edge)), level=1.0 / 3.0).values
    np.testing.assert_array_equal(kept, edge)
    assert "more than 1/4" in row("4.3.3")


def test_4_6_as_printed_lays_the_axis_along_x_where_y_runs_down() -> None:
    theta = math.radians(30.0)
    up = np.array([math.cos(theta), -math.sin(theta)])  # 30 degrees anticlockwise as seen
    printed = np.array([[math.cos(theta), -math.sin(theta)], [math.sin(theta), math.cos(theta)]])
    assert printed @ up == pytest.approx([1.0, 0.0])
    axis = Orientation(theta, 0.0, 0.0, 0.5, 0.0, False)
    assert rotate_points(Points(up[None, :]), axis).xy_cm[0] == pytest.approx([1.0, 0.0])


def known_objects() -> dict[str, object]:
    readings = {"low": [[9.0, 10.0], [11.0, 10.5], [10.0, 9.0]],
                "high": [[29.0, 20.0], [31.0, 21.0], [30.0, 19.0]]}  # fmt: skip
    return {
        "format": "tactile-graph objects", "version": 1, "quantity": "gram",
        "pipeline": "features", "features": ["weight", "area_cm2"],
        "objects": [{"name": n, "shape": "disc", "readings": r} for n, r in readings.items()],
    }  # fmt: skip


@pytest.mark.parametrize("over", ["variance", "deviation"])
def test_the_distance_is_the_root_of_4_8(over: str) -> None:
    step = MinimumDistance(database=known_objects(), over=over, reject=False)  # type: ignore[arg-type]
    got = step(Measurements(("weight", "area_cm2"), np.array([12.0, 11.0]), "gram"))
    read = np.array([[9.0, 10.0], [11.0, 10.5], [10.0, 9.0]])
    scale = read.var(axis=0, ddof=1) ** (1.0 if over == "variance" else 0.5)
    terms = ((np.array([12.0, 11.0]) - read.mean(axis=0)) / scale) ** 2
    assert got.name == "low"
    assert got.distance == pytest.approx(math.sqrt(terms.sum()))


def test_5_9_is_the_same_with_the_whole_energy_as_with_the_cliques_at_the_cell() -> None:
    labels, s, temperature = np.array([[1, 3], [0, 2]]), (0, 0), 2.0

    def whole(v: int) -> float:
        x = labels.copy()
        x[s] = v
        return float((np.diff(x, axis=0) ** 2).sum() + (np.diff(x, axis=1) ** 2).sum())

    def local(v: int) -> float:
        return float((v - labels[0, 1]) ** 2 + (v - labels[1, 0]) ** 2)

    one, other = (np.exp([-u(v) / temperature for v in range(4)]) for u in (whole, local))
    assert one / one.sum() == pytest.approx(other / other.sum())
    assert one / other.sum() != pytest.approx(other / other.sum())  # as printed: mixed


def test_a_difference_counts_once_and_not_where_the_line_is_on() -> None:
    problem = prepare(Model(n_levels=10, lambda_d=3.0, lambda_l=0.0), Image(np.array([[0.0, 9.0]])))
    labels = np.array([[0, 9]])
    across, down = (np.zeros(sites.shape, np.bool_) for sites in problem.sites)
    assert energy(problem, labels, across, down) == pytest.approx(3.0 * 81.0)
    assert energy(problem, labels, across | True, down | True) == pytest.approx(0.0)


def test_energies_are_2_sigma_squared_times_minus_the_log_of_the_posterior() -> None:
    sigma, image = 4.0, Image(np.array([[0.0, 9.0, 5.0]]))
    problem = prepare(Model(n_levels=10, lambda_d=0.0, sigma=sigma), image)
    a, b = np.array([[0, 9, 5]]), np.array([[1, 7, 5]])
    log_ratio = -((b - a) ** 2).sum() / (2.0 * sigma**2)
    assert energy(problem, b) - energy(problem, a) == pytest.approx(-2.0 * sigma**2 * log_ratio)


def test_every_cost_is_finite_so_that_every_image_has_a_probability_above_0() -> None:
    problem = prepare(Model(n_levels=20), Image(np.arange(20.0).reshape(4, 5)))
    _, pairwise, lines = problem.potentials
    costs = (problem.own_costs(), pairwise.smooth, pairwise.bare, lines.pattern)
    assert all(np.isfinite(each).all() for each in costs)


def test_rows_have_three_cells_and_places_come_once_in_their_section() -> None:
    sections = re.split(r"^## ", PAGE.read_text("utf-8"), flags=re.M)[1:]
    for section in sections:
        rows = [t for t in section.splitlines() if t.startswith("| ") and t[2:7] != "place"]
        cells = [[c.strip() for c in re.split(r"(?<!\\)\|", t)[1:-1]] for t in rows]
        assert all(len(c) == 3 and all(c) for c in cells), section[:30]
        assert len({tuple(c[:2]) for c in cells}) == len(cells)
