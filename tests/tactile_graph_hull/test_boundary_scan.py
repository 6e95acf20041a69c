"""The four-scan boundary, as points and as a mask."""

import numpy as np
import pytest

from helpers_modes import held
from tactile_graph.wires import Mask, packed_mask
from tactile_graph_hull.boundary_mask import boundary_mask
from tactile_graph_hull.boundary_scan import (
    boundary_scan,
    scanned_centres,
    scanned_packed,
    scanned_rows,
)
from tactile_graph_hull.mask_points import mask_points

DRAWN = """
..........
..######..
.##....##.
.##.##.##.
.########.
...####...
....#.....
"""
EXPECTED = """
..........
..######..
.#......#.
.#......#.
.##....##.
...#.##...
....#.....
"""


def drawn(text):
    return np.array([[c == "#" for c in line] for line in text.split()])


def slowly(values):
    """The definition, cell by cell."""
    seen = np.zeros(values.shape, dtype=bool)
    for r, row in enumerate(values):
        on = [c for c, v in enumerate(row) if v]
        if on:
            seen[r, on[0]] = seen[r, on[-1]] = True
    for c, column in enumerate(values.T):
        on = [r for r, v in enumerate(column) if v]
        if on:
            seen[on[0], c] = seen[on[-1], c] = True
    return seen


def test_footprint_with_a_hole_and_a_tail_has_its_outermost_cells():
    mask = Mask(drawn(DRAWN))
    assert np.array_equal(boundary_mask(mask).values, drawn(EXPECTED))
    assert np.array_equal(boundary_scan(mask).xy_cm, mask_points(Mask(drawn(EXPECTED))).xy_cm)


def test_points_are_cell_centres_in_cm_by_rising_x_then_y():
    mask = Mask(drawn(DRAWN), (0.65, 0.7), (1.5, -2.0))
    xy = boundary_scan(mask).xy_cm
    rows, columns = np.nonzero(drawn(EXPECTED))
    assert set(map(tuple, xy)) == set(zip(mask.x_cm[columns], mask.y_cm[rows], strict=True))
    assert xy.tolist() == sorted(xy.tolist())
    assert len(np.unique(xy, axis=0)) == len(xy)


@pytest.mark.parametrize("shape", [(1, 1), (1, 9), (9, 1), (16, 16), (32, 32), (33, 40), (5, 70)])
def test_random_masks_have_the_cells_the_definition_says(shape):
    rng = np.random.default_rng(sum(shape))
    for density in (0.0, 0.03, 0.2, 0.5, 0.9, 1.0):
        mask = Mask(rng.random(shape) < density, (1.3, 1.3))
        seen = slowly(mask.values)
        assert np.array_equal(boundary_mask(mask).values, seen)
        expected = mask_points(Mask(seen, (1.3, 1.3))).xy_cm
        assert np.array_equal(boundary_scan(mask).xy_cm, expected)


@pytest.mark.slow  # much is compiled
@pytest.mark.parametrize("kernel", [scanned_centres, scanned_rows], ids=["cells", "rows as words"])
def test_kernel_and_its_twin_agree_bit_by_bit(kernel):
    rng = np.random.default_rng(12)
    for _ in range(500):
        values = held(rng.random(rng.integers(1, 65, 2)) < rng.random() ** 2)
        args = (values, 0.65, 0.7, 0.1, 0.2)
        assert kernel.compiled(*args).tobytes() == kernel.reference(*args).tobytes()


def test_one_pixel_two_pixels_empty_and_full():
    values = np.zeros((16, 16), dtype=bool)
    assert boundary_scan(Mask(values.copy())).xy_cm.shape == (0, 2)
    values[3, 5] = True
    assert boundary_scan(Mask(values.copy())).xy_cm.tolist() == [[5.5, 3.5]]
    values[3, 6] = True
    assert boundary_scan(Mask(values.copy())).xy_cm.tolist() == [[5.5, 3.5], [6.5, 3.5]]
    assert boundary_scan(Mask(np.ones((16, 16), dtype=bool))).count == 60


def test_single_scans_are_the_parts_of_figure_4_12():
    mask = Mask(drawn(DRAWN))
    parts = [boundary_mask(mask, scans=(s,)).values for s in ("left", "right", "top", "bottom")]
    assert [p.sum() for p in parts] == [6, 6, 8, 8]
    assert np.array_equal(np.logical_or.reduce(parts), boundary_mask(mask).values)
    assert parts[0].sum(axis=1).max() == parts[2].sum(axis=0).max() == 1


def test_masks_of_other_memory_layouts_are_taken():
    values = drawn(DRAWN)
    expected = boundary_scan(Mask(values.copy())).xy_cm
    assert np.array_equal(boundary_scan(Mask(np.asfortranarray(values))).xy_cm, expected)
    mirrored = boundary_scan(Mask(values[:, ::-1])).xy_cm
    assert sorted((10 - mirrored[:, 0]).tolist()) == pytest.approx(expected[:, 0].tolist())


@pytest.mark.parametrize("by", ["reference", "compiled"])
@pytest.mark.parametrize("grid", [((0.65, 0.7), (1.5, -2.0)), ((1, 2), (0, 0))])
@pytest.mark.parametrize("columns", [1, 30, 64])
def test_packed_rows_have_the_boundary_of_their_cells(columns, grid, by):
    values = np.random.default_rng(columns).random((20, columns)) < 0.3
    words = np.array([sum(int(on) << c for c, on in enumerate(row)) for row in values], np.uint64)
    mask = packed_mask(words, columns, *grid, int(values.sum()))
    expected = boundary_scan(Mask(values, *grid)).xy_cm
    given = (held(words), columns, *map(float, (*grid[0], *grid[1])))
    np.testing.assert_array_equal(boundary_scan(mask).xy_cm, expected)
    np.testing.assert_array_equal(getattr(scanned_packed, by)(*given), expected)
