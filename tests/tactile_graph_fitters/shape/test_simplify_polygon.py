"""Polygons of few corners from hulls of many."""

import numpy as np
import pytest

from helpers_modes import plainly
from tactile_graph.errors import Degenerate
from tactile_graph.wires import Points, Polygon
from tactile_graph_fitters.shape.simplify_polygon import SimplifyPolygon, _outer, _size, thinned
from tactile_graph_hull.hull import hull


def regular(n, radius=5.0, turn=0.2):
    t = turn + 2 * np.pi * np.arange(n) / n
    return np.column_stack([3 + radius * np.cos(t), 4 - radius * np.sin(t)])


def with_points_on_sides(corners, n, rng=None, noise=0.0):
    parts = np.linspace(0, 1, n, endpoint=False)[:, None]
    ends = np.roll(corners, -1, axis=0)
    xy = np.vstack([a * (1 - parts) + b * parts for a, b in zip(corners, ends, strict=True)])
    return xy if rng is None else xy + rng.normal(0, noise, xy.shape)


def worst_corner(found, corners):
    return max(np.hypot(*(found - c).T).min() for c in corners)


@pytest.mark.parametrize("n", [3, 4, 5, 6])
@pytest.mark.parametrize("refine", [True, False])
def test_a_polygon_with_more_points_on_its_sides_is_itself_again(n, refine):
    corners = regular(n)
    got = SimplifyPolygon(corners=n, refine=refine)(Polygon(with_points_on_sides(corners, 7)))
    assert got.count == n
    assert worst_corner(got.xy_cm, corners) < 1e-9


def test_refining_brings_the_corners_of_a_noisy_pentagon_nearer():
    rng = np.random.default_rng(0)
    corners = regular(5)
    off = {True: [], False: []}
    for _ in range(20):
        noisy = Polygon(with_points_on_sides(corners, 12, rng, 0.15))
        for refine, found in off.items():
            found.append(
                worst_corner(SimplifyPolygon(corners=5, refine=refine)(noisy).xy_cm, corners)
            )
    assert np.mean(off[True]) < 0.7 * np.mean(off[False])


def test_a_tolerance_decides_how_many_corners_stay():
    octagon = Polygon(with_points_on_sides(regular(8), 5))
    assert SimplifyPolygon(tolerance_cm=0.01)(octagon).count == 8
    assert SimplifyPolygon(tolerance_cm=4.0)(octagon).count < 8


def test_the_way_round_is_kept():
    corners = regular(5)
    one = SimplifyPolygon(corners=5)(Polygon(with_points_on_sides(corners, 4)))
    two = SimplifyPolygon(corners=5)(Polygon(with_points_on_sides(corners, 4)[::-1].copy()))
    assert one._moments()[0] == pytest.approx(-two._moments()[0])


def test_few_corners_are_refused_in_words():
    with pytest.raises(Degenerate, match="the polygon has 3 corners, fewer than the 5"):
        SimplifyPolygon(corners=5)(Polygon(regular(3)))


@pytest.mark.parametrize(
    ("settings", "got"), [({}, "neither"), ({"corners": 4, "tolerance_cm": 1.0}, "both")]
)
def test_exactly_one_of_the_two_settings_is_needed(settings, got):
    with pytest.raises(ValueError, match=f"exactly one of corners and tolerance_cm .* got {got}"):
        SimplifyPolygon(**settings)


def one_after_the_other(xy, least, tolerance):
    """Take away the corner of the smallest triangle, the innermost of equals, found anew."""
    outer = plainly(_outer)(xy, np.arange(len(xy)), len(xy))
    kept = list(range(len(xy)))
    while len(kept) > least:
        best = (np.inf, -1)
        for k, b in enumerate(kept):
            p, q, r = xy[kept[k - 1]], xy[b], xy[kept[(k + 1) % len(kept)]]
            side = r - p
            twice = abs(side[0] * (q[1] - p[1]) - side[1] * (q[0] - p[0]))
            size = np.hypot(*side)
            if tolerance >= 0 and size > 0 and twice / size > tolerance:
                continue
            best = min(best, (_size.loops(twice, outer[b]), k))
        if best[1] < 0:
            break
        del kept[best[1]]
    return kept


@pytest.mark.parametrize("tolerance", [-1.0, 0.0, 0.3, 50.0])
@pytest.mark.parametrize("whole", [True, False], ids=["many equal triangles", "none equal"])
def test_corners_go_as_if_each_was_looked_for_among_all(tolerance, whole):
    rng = np.random.default_rng(5)
    for n in (3, 4, 5, 16, 33, 60):
        xy = rng.integers(0, 4, (n, 2)).astype(float) if whole else rng.normal(size=(n, 2))
        for least in (3, n // 2 + 2):
            kept = np.arange(n)
            left = plainly(thinned)(xy, kept, n, min(least, n), tolerance)
            assert kept[:left].tolist() == one_after_the_other(xy, min(least, n), tolerance)


HELD = {
    "mirrored": lambda xy: xy * [-1.0, 1.0] + [16.0, 0.0],
    "half turn": lambda xy: 16.0 - xy,
    "transposed": lambda xy: xy[:, ::-1],
    "from another corner": lambda xy: np.roll(xy, 3, axis=0),
    "finer": lambda xy: 0.13 * xy,
}


@pytest.mark.parametrize("held", HELD.values(), ids=HELD)
def test_which_of_equal_triangles_goes_does_not_depend_on_how_the_pad_is_held(held):
    y, x = np.mgrid[:16, :16]
    for seed in range(8):
        cx, cy, radius = np.random.default_rng(seed).uniform((7, 7, 5), (8, 8, 6))
        on = np.hypot(x - cx, y - cy) < radius
        xy = hull(Points(np.column_stack([x[on], y[on]]) + 0.0)).xy_cm
        for count in (3, 5):
            usual, got = (
                SimplifyPolygon(corners=count, refine=False)(Polygon(corners.copy())).xy_cm
                for corners in (xy, held(xy))
            )
            sizes = [np.sort(np.hypot(*(c - np.roll(c, 1, axis=0)).T)) for c in (held(usual), got)]
            assert sizes[0] == pytest.approx(sizes[1])
