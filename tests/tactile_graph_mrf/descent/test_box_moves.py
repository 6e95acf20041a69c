"""Lines around a cell: each side is set by its bit, and they cost what the whole field does."""

from __future__ import annotations

from itertools import product

import numpy as np
import pytest

from helpers_modes import plainly
from helpers_mrf import patterns, tiny
from tactile_graph_mrf.descent.box_moves import lines_around, set_sides

pytestmark = pytest.mark.usefixtures("plain_kernels")


@pytest.mark.parametrize(("sites", "code"), list(product(range(16), (0, 1, 2, 4, 8, 15))))
def test_a_side_is_set_by_its_bit_where_there_is_a_site(sites: int, code: int) -> None:
    over, left = np.ones((3, 2), bool), np.ones((2, 3), bool)
    set_sides(over, left, 0, 1, sites, code)
    wanted_over, wanted_left = np.ones((3, 2), bool), np.ones((2, 3), bool)
    for bit, (grid, at) in enumerate(
        ((wanted_over, (0, 1)), (wanted_over, (1, 1)), (wanted_left, (0, 1)), (wanted_left, (0, 2)))
    ):
        if sites >> bit & 1:
            grid[at] = bool(code >> bit & 1)
    np.testing.assert_array_equal(over, wanted_over)
    np.testing.assert_array_equal(left, wanted_left)


@pytest.mark.parametrize("cell", [(0, 0), (1, 2), (3, 3), (2, 0)])
def test_lines_around_a_cell_change_as_the_whole_field_does(cell: tuple[int, int]) -> None:
    problem = tiny(4, 4, end=2.7, straight=0.9, corner=1.3, tee=2.1, cross=3.3, parallel=1.7)
    rng = np.random.default_rng(2)
    over, left = np.zeros((5, 4), bool), np.zeros((4, 5), bool)
    over[1:-1], left[:, 1:-1] = rng.random((3, 4)) < 0.5, rng.random((4, 3)) < 0.5
    i, j = cell
    sites = sum(1 << k for k, on in enumerate((i > 0, i < 3, j > 0, j < 3)) if on)
    around = plainly(lines_around)
    pattern, parallel, one = problem.potentials.lines
    found, wanted = [], []
    for code in range(16):
        set_sides(over, left, i, j, sites, code)
        found.append(around(pattern, parallel, one, problem.in_field, over, left, i, j))
        wanted.append(problem.model.lambda_l * patterns(problem, over[1:-1], left[:, 1:-1]))
    np.testing.assert_allclose(np.diff(found), np.diff(wanted), atol=1e-12)
