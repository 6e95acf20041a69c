"""Lines around a cell: each side by its bit, costs as of the whole field, the best of all boxes."""

from __future__ import annotations

from itertools import product

import numpy as np
import pytest

from helpers_modes import plainly
from helpers_mrf import patterns, tiny
from tactile_graph.wires import Image, Mask
from tactile_graph_mrf.descent.box_moves import lines_around, move_boxes, set_sides
from tactile_graph_mrf.energy.model import Model
from tactile_graph_mrf.energy.problem import Problem, prepare
from tactile_graph_mrf.energy.state import State
from tactile_graph_mrf.energy.total import energy

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


ON = np.ones((4, 4), bool)
ON[3, 0] = ON[0, 2] = False


def uneven(seed: int, region: np.ndarray | None = None, **settings: object) -> Problem:
    """A field of 4 x 4 cells of which no two states cost the same."""
    costs = {"end": 0.53, "straight": 0.31, "corner": 0.47, "tee": 0.71, "cross": 0.97}
    told = {"lambda_l": 2.9, "parallel": 0.61, "one": 0.17, "sigma": 1.3, **costs, **settings}
    image = Image(np.random.default_rng(seed).normal(size=(4, 4)))
    where = None if region is None else Mask(region)
    return prepare(Model(n_levels=9, lambda_d=0.83, **told), image, where)


def littered(problem: Problem, seed: int) -> State:
    """Labels near the data but for a few, and lines at three sites of ten."""
    rng = np.random.default_rng(seed)
    labels = np.clip(problem.start() + rng.integers(-2, 3, problem.shape), 0, 8)
    across, down = (sites & (rng.random(sites.shape) < 0.3) for sites in problem.sites)
    return State(np.where(problem.in_field, labels, 0), across, down)


def sides(cell: tuple[int, int], problem: Problem) -> list[tuple[int, tuple[int, int], tuple]]:
    """Which line field, its place and the neighbour, for each side of a cell that has a site."""
    i, j = cell
    every = [
        *((0, (i - 1, j), (i - 1, j)), (0, (i, j), (i + 1, j))),
        *((1, (i, j - 1), (i, j - 1)), (1, (i, j), (i, j + 1))),
    ]
    field = problem.in_field
    return [s for s in every if min(s[2]) >= 0 and max(s[2]) < 4 and field[s[2]]]


def best_box(problem: Problem, state: State, cell: tuple[int, int]) -> None:
    """Try every box of a cell on the energy of the whole field, and take the best."""
    around = sides(cell, problem)
    fields = state.across, state.down
    if not any(fields[kind][at] for kind, at, _ in around):
        return
    curvature, centre = problem.unary.curvature[cell], problem.unary.centre[cell]
    mass = max(curvature, 1e-9)
    found = []
    for lines in product((False, True), repeat=len(around)):
        for (kind, at, _), on in zip(around, lines, strict=True):
            fields[kind][at] = on
        free = [
            state.labels[other] for (*_, other), on in zip(around, lines, strict=True) if not on
        ]
        bend = problem.pairwise.smooth[1]
        pulled = mass * (centre if curvature > 0 else problem.observed[cell]) + bend * sum(free)
        rounded = [pulled / (mass + bend * len(free)), problem.observed[cell]]
        labels = [state.labels[cell], *(state.labels[other] for *_, other in around)]
        labels += np.clip(np.rint(rounded), 0, 8).astype(int).tolist()
        kept = state.labels[cell]
        for x in labels:
            state.labels[cell] = x
            found.append((energy(problem, *state), lines, int(x)))
        state.labels[cell] = kept
    _, lines, state.labels[cell] = min(found)
    for (kind, at, _), on in zip(around, lines, strict=True):
        fields[kind][at] = on


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize(
    "settings",
    [
        {"smoothness": "quadratic"},
        {"smoothness": "truncated_quadratic", "truncation": 2.5, "region": ON},
        {"smoothness": "quadratic", "noise": "student_t"},
    ],
    ids=["quadratic", "a region", "heavy tails"],
)
def test_each_cell_beside_a_line_gets_the_best_of_all_its_boxes(settings: dict, seed: int) -> None:
    problem = uneven(seed, **settings)
    found, wanted = littered(problem, seed), littered(problem, seed)
    before = energy(problem, *wanted)
    n_changed = 0
    for i, j in np.argwhere(problem.in_field).tolist():
        was = [part.copy() for part in wanted]
        best_box(problem, wanted, (i, j))
        n_changed += any((a != b).any() for a, b in zip(was, wanted, strict=True))
    assert plainly(move_boxes)(problem.potentials, problem.observed, found) == n_changed > 2
    assert energy(problem, *found) == pytest.approx(energy(problem, *wanted), abs=1e-9)
    assert energy(problem, *found) < before
    for a, b in zip(found, wanted, strict=True):
        np.testing.assert_array_equal(a, b)


def test_a_cell_beside_no_line_is_left_as_it_is() -> None:
    problem = uneven(0)
    state = littered(problem, 0)
    state.across[:], state.down[:] = False, False
    labels = state.labels.copy()
    assert plainly(move_boxes)(problem.potentials, problem.observed, state) == 0
    np.testing.assert_array_equal(state.labels, labels)
