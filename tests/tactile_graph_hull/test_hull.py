"""Four hull algorithms, one answer."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from scipy.spatial import ConvexHull

from helpers_hulls import KINDS, exact_hull, random_set
from helpers_modes import answered_by
from tactile_graph.errors import Degenerate
from tactile_graph.wires import Points
from tactile_graph_hull.hull import chain_corners, hull
from tactile_graph_hull.hull_beneath_beyond import beneath_beyond_corners, hull_beneath_beyond
from tactile_graph_hull.hull_graham import graham_corners, hull_graham
from tactile_graph_hull.hull_qhull import hull_qhull

pytestmark = pytest.mark.usefixtures("warm_kernels")

ALL_HULLS = [hull, hull_graham, hull_beneath_beyond, hull_qhull]
OTHERS = ALL_HULLS[1:]
KERNELS = [chain_corners, graham_corners, beneath_beyond_corners]


@pytest.mark.slow
@pytest.mark.parametrize("n_sets", [100, pytest.param(10_000, marks=pytest.mark.slow)])
def test_all_hulls_agree_on_random_sets(n_sets):
    """Lattice and float sets, collinear and duplicate points, exact and thinned of rounding."""
    rng = np.random.default_rng(1)
    for k in range(n_sets):
        points = Points(random_set(rng, k % KINDS))
        ulps = 0.0 if k % 2 else 8.0
        expected = hull(points, rounding_ulps=ulps).xy_cm
        for other in OTHERS:
            got = other(points, rounding_ulps=ulps).xy_cm
            assert np.array_equal(got, expected), (other.__name__, k, ulps, points.xy_cm)


@pytest.mark.parametrize("kind", range(KINDS))
def test_exact_hull_is_that_of_fractions(kind):
    rng = np.random.default_rng(100 + kind)
    for _ in range(25):
        xy = random_set(rng, kind)
        assert np.array_equal(hull(Points(xy), rounding_ulps=0.0).xy_cm, exact_hull(xy))


@pytest.mark.slow  # much is compiled
@pytest.mark.parametrize("kernel", KERNELS, ids=lambda k: k.__name__)
def test_kernels_and_their_twins_agree(kernel):
    rng = np.random.default_rng(2)
    sets = [Points(random_set(rng, k % KINDS)).xy_cm for k in range(180)]
    with answered_by("plain"):
        expected = [[kernel.reference(xy, ulps) for ulps in (0.0, 8.0)] for xy in sets]
    for xy, pair in zip(sets, expected, strict=True):
        for ulps, corners in zip((0.0, 8.0), pair, strict=True):
            assert np.array_equal(kernel.compiled(xy, ulps), corners)


@pytest.mark.parametrize("find", ALL_HULLS)
def test_square_runs_counter_clockwise_as_seen_from_lowest_x_then_lowest_y(find):
    """From the upper left corner down: y runs down."""
    xy = np.array([[1.0, 1], [0, 0], [1, 0], [0, 1], [0.5, 0.5], [0.5, 0], [0, 0], [-0.0, 0.5]])
    corners = find(Points(xy))
    assert corners.xy_cm.tolist() == [[0, 0], [0, 1], [1, 1], [1, 0]]
    assert corners.area_cm2 == 1.0


@pytest.mark.parametrize("find", ALL_HULLS)
@pytest.mark.parametrize(
    ("xy", "corners"),
    [
        ([[2.0, 3.0]], [[2, 3]]),
        ([[2.0, 3.0]] * 4, [[2, 3]]),
        ([[5.0, 3.0], [2.0, 3.0]], [[2, 3], [5, 3]]),
        ([[1.0, 5.0], [1.0, 2.0], [1.0, 9.0], [1.0, 2.0]], [[1, 2], [1, 9]]),
        ([[3.0, 3.0], [1.0, 1.0], [2.0, 2.0]], [[1, 1], [3, 3]]),
    ],
)
def test_points_in_one_place_or_line_give_one_or_two_corners(find, xy, corners):
    assert find(Points(np.array(xy))).xy_cm.tolist() == corners


@pytest.mark.parametrize("find", ALL_HULLS)
def test_no_points_are_degenerate(find):
    with pytest.raises(Degenerate, match="0 points: a hull needs at least one"):
        find(Points(np.empty((0, 2))))


@pytest.mark.parametrize("find", ALL_HULLS)
@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf])
def test_points_that_are_not_finite_are_degenerate(find, bad):
    xy = np.array([[0.0, 0], [1, 0], [bad, 1], [0, bad]])
    with pytest.raises(Degenerate, match="2 of 4 points are not finite: no hull"):
        find(Points(xy))


@pytest.mark.parametrize("find", ALL_HULLS)
@pytest.mark.parametrize("size", [5e-324, 1e-310, 1e-160, 1e-30, 1e30, 1e160, 1.7e308 / 5])
def test_sizes_to_the_edge_of_numbers_keep_their_corners(find, size):
    xy = np.array([[0.0, 0], [2, 1], [4, 2], [5, 0], [4, -2], [2, -1], [3, 0]])
    expected = np.array([[0.0, 0], [4, 2], [5, 0], [4, -2]])
    assert np.array_equal(find(Points(xy * size)).xy_cm, expected * size)


@pytest.mark.parametrize("find", ALL_HULLS)
def test_wildly_mixed_sizes_agree(find):
    rng = np.random.default_rng(3)
    for _ in range(40):
        xy = rng.standard_normal((12, 2)) * 10.0 ** rng.uniform(-300, 300, (12, 2))
        got, expected = find(Points(xy)).xy_cm, hull(Points(xy)).xy_cm
        assert np.array_equal(got, expected)
        assert np.abs(got).max() == np.abs(xy).max()


@pytest.mark.parametrize("find", ALL_HULLS)
def test_cells_in_a_slanting_line_are_in_one_line_despite_rounding(find):
    """0.65 cm cells: exactly, some of them stick out of the line by 1e-15 cm."""
    i = np.arange(30)
    xy = np.column_stack([0.1 + (i + 0.5) * 0.65, 0.2 + (2 * i + 0.5) * 0.65])
    xy = np.vstack([xy, [[19.0, 0.3]]])
    assert find(Points(xy)).count == 3
    assert find(Points(xy), rounding_ulps=0.0).count > 3


def test_thinned_hull_still_holds_all_points():
    rng = np.random.default_rng(4)
    for k in range(200):
        xy = random_set(rng, k % KINDS)
        corners = hull(Points(xy)).xy_cm
        if len(corners) < 3:
            continue
        edges = np.roll(corners, -1, axis=0) - corners
        offset = xy[:, None] - corners
        beyond = edges[:, 0] * offset[..., 1] - edges[:, 1] * offset[..., 0]
        allowed = 16 * 2.0**-52 * np.abs(xy).max()
        assert (beyond / np.hypot(*edges.T)).max() <= allowed


def test_dense_circle_far_out_keeps_its_shape():
    """Corners closer than rounding are thinned, but no run of them is cut short."""
    angle = np.linspace(0, 2 * np.pi, 20_000)
    xy = np.column_stack([np.cos(angle), np.sin(angle)]) + 1e6
    corners = hull(Points(xy))
    assert 100 < corners.count < 20_000
    assert corners.area_cm2 == pytest.approx(math.pi, rel=1e-6)


@pytest.mark.slow
@settings(max_examples=60, deadline=None)
@given(xy=arrays(np.float64, st.tuples(st.integers(1, 25), st.just(2)), elements=st.floats(-9, 9)))
def test_any_floats_agree_and_order_does_not_matter(xy):
    expected = hull(Points(xy.copy())).xy_cm
    shuffled = np.random.default_rng(len(xy)).permutation(xy)
    for find in ALL_HULLS:
        assert np.array_equal(find(Points(shuffled.copy())).xy_cm, expected)


@pytest.mark.parametrize("find", ALL_HULLS)
def test_hull_of_a_hull_is_itself(find):
    xy = np.random.default_rng(6).normal(size=(300, 2))
    corners = find(Points(xy))
    assert np.array_equal(find(corners.points).xy_cm, corners.xy_cm)
    assert corners.area_cm2 == pytest.approx(ConvexHull(xy).volume, rel=1e-13)


@pytest.mark.parametrize("find", ALL_HULLS)
def test_other_memory_layouts_are_taken_and_inputs_stay(find):
    xy = np.random.default_rng(7).normal(size=(50, 2))
    kept = xy.copy()
    expected = find(Points(xy)).xy_cm
    assert np.array_equal(find(Points(np.asfortranarray(kept))).xy_cm, expected)
    assert np.array_equal(find(Points(np.repeat(kept, 2, axis=0)[::2])).xy_cm, expected)
    assert np.array_equal(xy, kept)


@pytest.mark.slow  # many points
@pytest.mark.parametrize("find", ALL_HULLS)
def test_hundred_thousand_points_agree(find):
    xy = np.random.default_rng(8).normal(size=(100_000, 2))
    expected = exact_hull(xy[ConvexHull(xy).vertices])
    assert np.array_equal(find(Points(xy)).xy_cm, expected)
