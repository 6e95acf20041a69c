"""Each move of the graph cuts against all sets of cells that could have gone."""

from __future__ import annotations

from itertools import product

import numpy as np
import pytest

from helpers_mrf import label_energies, tiny
from tactile_graph_mrf.descent.cut_moves import Cuts
from tactile_graph_mrf.energy.problem import Problem

pytestmark = pytest.mark.usefixtures("plain_kernels")

JUMP = {"smoothness": "quadratic", "lines": "none"}
EXPANSION = {"smoothness": "truncated_absolute", "lines": "none"}


def best_set(problem: Problem, flat: np.ndarray, target: np.ndarray) -> float:
    """The least energy of all sets of cells that go to a target on the scale."""
    free = np.flatnonzero((target != flat) & (target >= 0) & (target < problem.n_levels))
    every = np.array(list(product((False, True), repeat=len(free))))
    states = np.repeat(flat[None], len(every), axis=0)
    states[:, free] = np.where(every, target[free], flat[free])
    return float(label_energies(problem, states).min())


@pytest.mark.parametrize("order", [1, 2, 3])
@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize(
    ("moves", "settings"), [("jump", JUMP), ("expansion", EXPANSION)], ids=["jump", "expansion"]
)
def test_a_move_is_the_best_of_all_sets(moves: str, settings: dict, seed: int, order: int) -> None:
    pytest.importorskip("maxflow")
    problem = tiny(3, 3, n_levels=5, order=order, lambda_d=1.4, **settings)
    cuts = Cuts(problem, moves)
    start = np.random.default_rng(seed).integers(0, 5, 9)
    shifts = [start + s for s in (-4, -2, -1, 1, 2, 4)]
    n_lower = 0
    for target in shifts if moves == "jump" else [np.full(9, k) for k in range(5)]:
        flat = start.copy()
        cuts._move(flat, target)
        assert ((flat == start) | (flat == target)).all()
        found, before = label_energies(problem, np.stack([flat, start])).tolist()
        assert found == pytest.approx(best_set(problem, start, target), abs=1e-9)
        n_lower += found < before
    assert n_lower > 2


def test_swaps_start_flat_at_the_median_of_the_data() -> None:
    problem = tiny(3, 4, n_levels=7)
    start = Cuts(problem, "swap").start()
    np.testing.assert_array_equal(start, int(np.median(problem.observed)))
