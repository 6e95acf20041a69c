import itertools

import numpy as np
import pytest

from helpers_restorers import square, tiny, tiny_model
from tactile_graph_mrf.annealing import State
from tactile_graph_mrf.box_moves import move_boxes
from tactile_graph_mrf.fuse import PROPOSALS, move_chains, propose
from tactile_graph_mrf.line_field import no_lines
from tactile_graph_mrf.model import Model, energy
from tactile_graph_mrf.restore import restore


def moved(problem, labels, lines, along_rows, kernel):
    p = problem
    own = p.curvature, p.centre, p.table, p.row
    labels = labels.copy()
    field = p.in_field, own, p.smooth, p.offsets, p.weights, p.observed
    kernel(*field, *lines, labels, along_rows)
    return labels


def test_a_row_gets_the_best_combination_of_its_proposals():
    """Against all combinations of the proposals of one row of three cells."""
    problem = tiny_model(smoothness="truncated_quadratic").prepare(tiny(5))
    labels = np.array([[0, 3, 1], [2, 2, 0], [3, 1, 3]])
    own = problem.curvature, problem.centre, problem.table, problem.row
    offered = np.empty((3, PROPOSALS), np.int64)
    for j in range(3):
        propose.reference(
            problem.in_field, own, problem.smooth, problem.observed, labels, 0, j, offered[j]
        )
    least = np.inf
    for row in itertools.product(*map(set, offered.tolist())):
        tried = labels.copy()
        tried[0] = row
        least = min(least, energy(problem, tried))
    after = labels.copy()
    after[0] = moved(problem, labels, no_lines((3, 3)), True, move_chains.reference)[0]
    assert energy(problem, after) == pytest.approx(least)


@pytest.mark.parametrize("along_rows", [True, False])
def test_chain_moves_never_raise_the_energy_and_agree_compiled(along_rows):
    pytest.importorskip("numba")
    rng = np.random.default_rng(3)
    model = Model(n_levels=30, order=2, lambda_l=60.0)
    problem = model.prepare(square(20.0, 8))
    for _ in range(5):
        labels = rng.integers(0, 30, (8, 8))
        lines = tuple(rng.random(x.shape) < 0.3 for x in no_lines((8, 8)))
        one = moved(problem, labels, lines, along_rows, move_chains.reference)
        two = moved(problem, labels, lines, along_rows, move_chains.compiled)
        assert np.array_equal(one, two)
        assert energy(problem, one, *lines) <= energy(problem, labels, *lines) + 1e-9


def test_boxes_of_lines_only_open_and_close_where_that_pays():
    pytest.importorskip("numba")
    rng = np.random.default_rng(4)
    problem = Model(n_levels=30, lambda_l=60.0).prepare(square(20.0, 8))
    p = problem
    own = p.in_field, p.curvature, p.centre, p.table, p.row, p.smooth, p.weights
    for _ in range(5):
        lines = (rng.random(x.shape) < 0.5 for x in no_lines((8, 8)))
        state = State(rng.integers(0, 30, (8, 8)), *lines)
        same = State(*(x.copy() for x in state))
        before = energy(problem, *state)
        assert move_boxes.reference(*own, p.pattern, p.parallel, p.one, p.observed, *state) > 0
        move_boxes.compiled(*own, p.pattern, p.parallel, p.one, p.observed, *same)
        assert energy(problem, *state) < before
        assert all(np.array_equal(a, b) for a, b in zip(state, same, strict=True))


def test_more_effort_is_allowed_and_stays_near():
    model = Model(lines="marginal")
    reached = [restore(square(40.0), model=model, effort=effort).energy for effort in (1, 2, 3)]
    assert max(reached) <= 1.002 * min(reached)


def test_without_rounds_the_graduation_is_given():
    restored = restore(square(), model=Model(lines="marginal"), n_rounds=0)
    assert restored.sweeps == 1
