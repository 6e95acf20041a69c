"""Loops of the partition against plain numpy, on small uneven footprints."""

from __future__ import annotations

import numpy as np
import pytest

from helpers_modes import plainly
from tactile_graph_filters.parting.basin_groups import best_pair, best_three, surveyed
from tactile_graph_filters.parting.basins import _basins_plain, basins, taps_of
from tactile_graph_filters.parting.filled_hull import _misfit_plain, misfit
from tactile_graph_filters.parting.joined_basins import (
    _boxes,
    _cost_plain,
    _cuts_plain,
    _joined_plain,
    _near,
    joined,
)
from tactile_graph_filters.parting.partition import Partition

pytestmark = pytest.mark.usefixtures("plain_kernels")

COUNT = 5


def scattered(seed: int, shape: tuple[int, int] = (6, 7)) -> Partition:
    """Groups 1 to 5 around as many cells, a third of the cells off, a tenth of them not known."""
    rng = np.random.default_rng(seed)
    rows, columns = np.indices(shape)
    middles = rng.random((COUNT, 2)) * shape
    far = [(rows - y) ** 2 + (columns - x) ** 2 for y, x in middles]
    owner = 1 + np.argmin(far, axis=0)
    owner[rng.random(shape) < 0.33] = 0
    for group, (y, x) in enumerate(middles.astype(int), 1):
        owner[y, x] = group
    values = np.where(owner > 0, 0.05 + rng.random(shape), 0.0)
    return Partition(owner.astype(np.int32), values, rng.random(shape) < 0.9)


def rules_of(cells: Partition, hold: float = 0.6) -> np.ndarray:
    return np.array([0.3, 0.5, 8.0, hold, 0.5 * np.median(cells.values[cells.owner > 0])])


@pytest.mark.parametrize("half", [0.0, 0.4])
@pytest.mark.parametrize("seed", range(4))
def test_the_survey_says_where_groups_lie_and_what_they_share(seed: int, half: float) -> None:
    cells = scattered(seed)
    groups = plainly(surveyed)(cells.owner, COUNT, cells.values, half)
    wanted = _cuts_plain(cells.owner, COUNT, cells.values, half)
    np.testing.assert_allclose(groups.cuts, wanted, atol=1e-12)
    last_row, last_column, first_row, first_column = _boxes(cells.owner, COUNT)
    for a in np.unique(cells.owner[cells.owner > 0]).tolist():
        box = [-first_row[a], last_row[a], -first_column[a], last_column[a]]
        assert groups.box[a].tolist() == box
        for i, row in enumerate(cells.owner == a):
            at = np.flatnonzero(row)
            assert groups.right[a, i] == (at[-1] if at.size else -1)
            assert groups.left[a, i] == (at[0] if at.size else cells.owner.shape[1])
    assert groups.alive.tolist() == [True] * (COUNT + 1)
    assert groups.cost.tolist() == [0.0] * (COUNT + 1)
    assert groups.union.shape == wanted.shape
    assert groups.left.shape == groups.right.shape == (COUNT + 1, cells.owner.shape[0])
    assert np.isnan(groups.union).all()


@pytest.mark.slow
@pytest.mark.parametrize("hold", [0.0, 0.6, 3.0])
@pytest.mark.parametrize("seed", range(6))
def test_loops_join_the_same_groups_at_the_same_energy(seed: int, hold: float) -> None:
    cells = scattered(seed)
    rules = rules_of(cells, hold)
    one, other = cells.owner.copy(), cells.owner.copy()
    wanted = _joined_plain(one, COUNT, cells.values, cells.known, rules)
    found = plainly(joined)(other, COUNT, cells.values, cells.known, rules)
    assert found == pytest.approx(wanted, abs=1e-9)
    np.testing.assert_array_equal(other, one)


def two_columns(gap: int) -> Partition:
    """Two bars of 2 by 4 cells with so many empty columns between them, none of which is known."""
    owner = np.zeros((4, 4 + gap), np.int32)
    owner[:, :2], owner[:, -2:] = 1, 2
    return Partition(owner, (owner > 0) * 1.0, owner > 0)


@pytest.mark.parametrize("is_turned", [False, True])
@pytest.mark.parametrize(("gap", "pair"), [(0, (1, 2)), (2, (1, 2)), (3, (0, 0))])
def test_only_groups_within_reach_are_joined(
    gap: int, pair: tuple[int, int], is_turned: bool
) -> None:
    cells = two_columns(gap)
    if is_turned:
        cells = Partition(*(np.ascontiguousarray(part.T) for part in cells))
    rules = rules_of(cells)
    groups = plainly(surveyed)(cells.owner, 2, cells.values, rules[4])
    groups.cost[1:] = 50.0
    assert plainly(best_pair)(cells, groups, rules) == pair
    assert _near(_boxes(cells.owner, 2), [1, 2]) == ([pair] if pair[0] else [])
    groups.alive[2] = False
    assert plainly(best_pair)(cells, groups, rules) == (0, 0)


@pytest.mark.parametrize("seed", range(4))
def test_of_all_chains_of_three_that_which_gains_most_is_found(seed: int) -> None:
    cells = scattered(seed)
    rules = rules_of(cells)
    groups = plainly(surveyed)(cells.owner, COUNT, cells.values, rules[4])
    groups.cost[1:] = np.random.default_rng(seed).random(COUNT) * 4.0
    cuts, gains = groups.cuts, {}
    for b in range(1, COUNT + 1):
        for a in range(1, COUNT + 1):
            for c in range(a + 1, COUNT + 1):
                if b not in (a, c) and cuts[a, b] > 0 and cuts[b, c] > 0:
                    whole = _cost_plain(cells.owner, (a, b, c), cells.values, cells.known, rules)
                    gain = rules[3] * (cuts[a, b] + cuts[a, c] + cuts[b, c])
                    gains[a, b, c] = gain + groups.cost[[a, b, c]].sum() - whole
    found = plainly(best_three)(cells, groups, rules)
    assert max(gains.values()) > 0
    assert gains[found] == pytest.approx(max(gains.values()), abs=1e-9)


@pytest.mark.parametrize("seed", range(8))
@pytest.mark.parametrize("named", [(1, 1, 1), (2, 5, 2), (1, 3, 4)])
def test_loops_of_the_misfit_count_what_the_plain_code_does(named: tuple, seed: int) -> None:
    cells = scattered(seed)
    mine = np.isin(cells.owner, named)
    some = mine.any(axis=1)
    left = np.where(some, mine.argmax(axis=1), 0)
    right = np.where(some, mine.shape[1] - 1 - mine[:, ::-1].argmax(axis=1), -1)
    for usual_cells in (0.0, 8.0, 60.0):
        rules = np.array([0.3, 0.7, usual_cells, 0.6, 0.0])
        told = (*cells, np.array(named, np.int32), left, right, rules)
        assert misfit.loops(*told) == pytest.approx(_misfit_plain(*told), abs=1e-9)


@pytest.mark.parametrize("sigma", [0.3, 0.9])
@pytest.mark.parametrize("seed", range(5))
def test_loops_cut_the_same_basins(seed: int, sigma: float) -> None:
    rng = np.random.default_rng(seed)
    on = rng.random((6, 8)) < 0.8
    for values in (np.where(on, rng.random(on.shape), 0.0), on.astype(float), np.zeros(on.shape)):
        one, other = np.empty(on.shape, np.int32), np.empty(on.shape, np.int32)
        count = _basins_plain(values, on, taps_of(sigma), one)
        assert basins.loops(values, on, taps_of(sigma), other) == count
        np.testing.assert_array_equal(other, one)


def test_groups_that_do_not_touch_make_no_chain() -> None:
    for numbers in ((1, 2, 0, 3), (3, 1, 0, 2), (2, 0, 3, 1), (1, 0, 2, 0)):
        owner = np.repeat(np.array([numbers], np.int32), 4, axis=0)
        cells = Partition(owner, (owner > 0) * 1.0, owner > 0)
        groups = plainly(surveyed)(owner, 3, cells.values, 0.5)
        groups.cost[1:] = 50.0
        assert plainly(best_three)(cells, groups, rules_of(cells)) == (0, 0, 0)
