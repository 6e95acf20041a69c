import itertools

import numpy as np
import pytest

from helpers_modes import answered_by, plainly
from helpers_restorers import square, tiny, tiny_model
from tactile_graph.wires import Image
from tactile_graph_mrf.descent.box_moves import move_boxes
from tactile_graph_mrf.descent.chain_moves import PROPOSALS, Chain, move_chains, propose
from tactile_graph_mrf.descent.grid_cut import Graph, cut_grid
from tactile_graph_mrf.descent.polish import polish
from tactile_graph_mrf.descent.region_moves import fuse, shift_regions
from tactile_graph_mrf.descent.restore import restore
from tactile_graph_mrf.energy.layout import layout
from tactile_graph_mrf.energy.line_field import no_lines
from tactile_graph_mrf.energy.model import Model
from tactile_graph_mrf.energy.problem import prepare
from tactile_graph_mrf.energy.state import State, sites_of
from tactile_graph_mrf.energy.total import energy


def moved(problem, labels, lines, along_rows, kernel):
    labels = labels.copy()
    kernel(problem.potentials, problem.observed, State(labels, *lines), along_rows)
    return labels


def test_a_row_gets_the_best_combination_of_its_proposals():
    """Against all combinations of the proposals of one row of three cells."""
    problem = prepare(tiny_model(smoothness="truncated_quadratic"), tiny(5))
    labels = np.array([[0, 3, 1], [2, 2, 0], [3, 1, 3]])
    offered, kinds = np.empty((3, PROPOSALS), np.int64), np.empty(3, np.int64)
    chain = Chain(0, True, offered, kinds, np.empty(offered.shape), np.zeros(offered.shape, int))
    plainly(propose)(problem.potentials, problem.observed, labels, chain)
    each = [offered[j, : kinds[j]].tolist() for j in range(3)]
    assert all(len(set(x)) == len(x) > 1 and x[0] == labels[0, j] for j, x in enumerate(each))
    least = np.inf
    for row in itertools.product(*each):
        tried = labels.copy()
        tried[0] = row
        least = min(least, energy(problem, tried))
    after = labels.copy()
    after[0] = moved(problem, labels, no_lines((3, 3)), True, plainly(move_chains))[0]
    assert energy(problem, after) == pytest.approx(least)


@pytest.mark.parametrize("along_rows", [True, False])
def test_chain_moves_never_raise_the_energy(along_rows):
    rng = np.random.default_rng(3)
    model = Model(n_levels=30, order=2, lambda_l=60.0)
    problem = prepare(model, square(20.0, 8))
    for _ in range(5):
        labels = rng.integers(0, 30, (8, 8))
        lines = tuple(rng.random(x.shape) < 0.3 for x in no_lines((8, 8)))
        after = moved(problem, labels, lines, along_rows, plainly(move_chains))
        assert energy(problem, after, *lines) <= energy(problem, labels, *lines) + 1e-9


@pytest.mark.slow
def test_boxes_of_lines_only_open_and_close_where_that_pays():
    rng = np.random.default_rng(4)
    problem = prepare(Model(n_levels=30, lambda_l=60.0), square(20.0, 8))
    for _ in range(5):
        lines = (rng.random(x.shape) < 0.5 for x in no_lines((8, 8)))
        state = State(rng.integers(0, 30, (8, 8)), *lines)
        before = energy(problem, *state)
        assert plainly(move_boxes)(problem.potentials, problem.observed, state) > 0
        assert energy(problem, *state) < before


def best_shift(problem, labels, target):
    """The least energy of all ways to take some cells from ``target``."""
    least = np.inf
    for goes in itertools.product((False, True), repeat=labels.size):
        tried = np.where(np.reshape(goes, labels.shape), target, labels)
        if tried.min() >= 0 and tried.max() < problem.n_levels:
            least = min(least, energy(problem, tried))
    return least


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize("order", [1, 2, 3])
def test_a_shift_is_the_best_of_all_sets_of_cells_where_smoothness_is_convex(seed, order):
    rng = np.random.default_rng(seed)
    problem = prepare(
        Model(n_levels=9, lines="none", order=order, lambda_d=0.9),
        Image(rng.integers(0, 9, (3, 3)).astype(float)),
    )
    labels = rng.integers(0, 9, (3, 3))
    state = State(labels.copy(), *no_lines((3, 3)))
    plainly(shift_regions)(problem.potentials, layout(problem), sites_of(state))
    now = energy(problem, *state)
    for step in (1, -1):
        assert best_shift(problem, state.labels, state.labels + step) >= now - 1e-9
    other = np.clip(labels + rng.integers(0, 3), 0, 8)  # as convex as a shift but at the top
    fused = State(labels.copy(), *no_lines((3, 3)))
    fuse(problem, fused, other)
    assert energy(problem, *fused) == pytest.approx(best_shift(problem, labels, other))


@pytest.mark.slow  # much is compiled
@pytest.mark.parametrize("lines", ["none", "explicit", "marginal"])
def test_fusing_and_shifting_only_lower_the_energy(lines):
    """Fused plain and compiled; shifts compiled are a part of what polishes."""
    rng = np.random.default_rng(8)
    model = Model(n_levels=30, lines=lines, lambda_l=60.0, smoothness="truncated_quadratic",
                  truncation=6.0)  # fmt: skip
    problem = prepare(model, square(20.0, 8))
    sites = (x & (rng.random(x.shape) < 0.3) for x in problem.sites)
    drawn = no_lines((8, 8)) if lines != "explicit" else sites
    start = State(rng.integers(0, 30, (8, 8)), *drawn)
    other = rng.integers(0, 30, (8, 8))
    ends = []
    for mode in ("plain", "compiled"):
        with answered_by(mode):
            state = State(*(x.copy() for x in start))
            reached = [energy(problem, *state)]
            assert fuse(problem, state, other) > 0
            reached.append(energy(problem, *state))
            ends.append(state)
    assert all(np.array_equal(a, b) for a, b in zip(*ends, strict=True))
    assert plainly(shift_regions)(problem.potentials, layout(problem), sites_of(state)) > 0
    reached.append(energy(problem, *state))
    assert reached[2] < reached[1] < reached[0]


@pytest.mark.slow  # all kinds of moves are compiled
@pytest.mark.parametrize("lines", ["none", "explicit", "marginal"])
@pytest.mark.parametrize("order", [1, 2, 3])
def test_polishing_tells_the_energy_it_ends_with_and_agrees_compiled(lines, order):
    """All kinds of moves in loops, and as one machine code."""
    rng = np.random.default_rng(9)
    model = Model(n_levels=30, lines=lines, order=order, lambda_l=60.0)
    problem = prepare(model, square(20.0, 8))
    drawn = no_lines((8, 8))
    if lines == "explicit":
        drawn = tuple(x & (rng.random(x.shape) < 0.3) for x in problem.sites)
    start = State(rng.integers(0, 30, (8, 8)), *drawn)
    ends, traces = [], []
    for mode in ("plain", "compiled"):
        ends.append(State(*(x.copy() for x in start)))
        with answered_by(mode):
            traces.append(polish(problem, ends[-1], 3))
        assert traces[-1][-1] == energy(problem, *ends[-1]) < energy(problem, *start)
        assert all(b <= a for a, b in itertools.pairwise(traces[-1]))
    assert traces[0] == traces[1]
    assert all(np.array_equal(a, b) for a, b in zip(*ends, strict=True))


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(8))
def test_a_cut_of_a_grid_is_the_least_of_all_cuts(seed):
    rng = np.random.default_rng(seed)
    rows, columns = 3, 4
    near = np.full((12, 4), -1)
    cap = np.zeros((12, 4))
    for i, j in np.ndindex(rows, columns):
        for q, (m, n) in enumerate(((i, j + 1), (i, j - 1), (i + 1, j), (i - 1, j))):
            if 0 <= m < rows and 0 <= n < columns:
                near[i * columns + j, q] = m * columns + n
                cap[i * columns + j, q] = rng.random() * (rng.random() < 0.8)
    gain = rng.normal(size=12)

    def cost(goes):  # of going against staying: pairs parted, gains not taken, losses taken
        parted = sum(
            cap[i, q]
            for i in range(12)
            for q in range(4)
            if near[i, q] >= 0 and goes[i] and not goes[near[i, q]]
        )
        return parted + gain[~goes & (gain > 0)].sum() - gain[goes & (gain < 0)].sum()

    least = min(cost(np.array(g)) for g in itertools.product((False, True), repeat=12))
    goes = np.zeros(12, np.bool_)
    full = cap.copy()
    count = plainly(cut_grid)(
        Graph(near, full, np.maximum(gain, 0.0), np.maximum(-gain, 0.0)), goes
    )
    assert count == goes.sum()
    assert cost(goes) == pytest.approx(least)


@pytest.mark.slow
def test_more_effort_is_allowed_and_stays_near():
    model = Model(lines="marginal")
    reached = [restore(square(40.0), model=model, effort=effort).energy for effort in (1, 2, 3)]
    assert max(reached) <= 1.002 * min(reached)


@pytest.mark.slow
def test_without_rounds_the_graduation_is_given():
    restored = restore(square(), model=Model(lines="marginal"), n_rounds=0)
    assert restored.sweeps == 1
