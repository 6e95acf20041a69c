"""`lower_bound`: an energy below which no restoration is, by tree-reweighted messages."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tactile_graph.compiled import compiled_as_is
from tactile_graph.errors import Degenerate
from tactile_graph_mrf.energy.line_field import no_lines
from tactile_graph_mrf.energy.problem import Problem
from tactile_graph_mrf.energy.state import State, nothing
from tactile_graph_mrf.energy.total import energy

MOST = 10_000_000
"""Numbers a table of messages of one direction may hold: cells times levels."""


class Bounded(NamedTuple):
    """What no energy is below, and the best labels the messages led to."""

    bound: float
    state: State
    energy: float


class Grid(NamedTuple):
    """A field of order 1 without lines.

    Parameters
    ----------
    in_field : ndarray of bool, shape (rows, columns)
    costs : ndarray of float64, shape (rows, columns, L)
        Of each label of each cell by itself.
    smooth : ndarray of float64, shape (L,)
        Of a difference; it must not fall, and be the same from ``reach`` on.
    weights : ndarray of float64, shape (2,)
        Of pairs in a row, and in a column.
    reach : int
    """

    in_field: NDArray[np.bool_]
    costs: NDArray[np.float64]
    smooth: NDArray[np.float64]
    weights: NDArray[np.float64]
    reach: int


@compiled_as_is
def offer(costs: Any, price: float, out: Any) -> None:
    """Lower each of ``out`` to ``costs`` and the price, if that is less; all begin at 0.

    So the compiler sees that it may do several at once.
    """
    for y in range(len(out)):
        out[y] = min(out[y], costs[y] + price)


@compiled_as_is
def passed(costs: Any, smooth: Any, weight: float, reach: int, out: Any) -> None:
    """Write the least over x of costs[x] + weight smooth[|x - y|] for each y; see `Grid`."""
    n = len(costs)
    out[:] = costs.min() + weight * smooth[min(reach, n - 1)]
    for d in range(min(reach, n)):
        price = weight * smooth[d]
        offer(costs[d:], price, out[: n - d])
        offer(costs[: n - d], price, out[d:])


@compiled_as_is
def trw_sweep(grid: Grid, forth: bool, messages: Any, labels: Any) -> None:
    """Pass messages over the grid once, to and fro; on the way forth write labels.

    ``messages`` (4, rows, columns, L) come into a cell from left, above, right and below. Each
    cell lies on two chains, its row and its column, and gives each half of what it holds.
    """
    in_field, unary, smooth, weights, reach = grid
    rows, columns, n = unary.shape
    held, out, costs = np.empty(n), np.empty(n), np.empty(n)
    for s in range(rows * columns):
        t = s if forth else rows * columns - 1 - s
        i, j = t // columns, t % columns
        if not in_field[i, j]:
            continue
        held[:] = unary[i, j]
        for k in range(4):
            held += messages[k, i, j]
        if forth:
            costs[:] = unary[i, j] + messages[2, i, j] + messages[3, i, j]
            if j > 0 and in_field[i, j - 1]:
                for x in range(n):
                    costs[x] += weights[0] * smooth[abs(x - labels[i, j - 1])]
            if i > 0 and in_field[i - 1, j]:
                for x in range(n):
                    costs[x] += weights[1] * smooth[abs(x - labels[i - 1, j])]
            labels[i, j] = np.argmin(costs)
        for k in range(2):
            step = 1 if forth else -1
            a, b = (i, j + step) if k == 0 else (i + step, j)
            if a < 0 or b < 0 or a >= rows or b >= columns or not in_field[a, b]:
                continue
            back = k + 2 if forth else k
            costs[:] = 0.5 * held - messages[back, i, j]
            passed(costs, smooth, weights[k], reach, out)
            messages[k if forth else k + 2, a, b] = out - out.min()


@compiled_as_is
def chain_bound(grid: Grid, messages: Any) -> float:
    """Return the sum over rows and columns of the least energy of each by itself.

    The cells' costs are split between row and column as the messages say; whatever the split,
    no labelling of the whole costs less than the chains do apart.
    """
    in_field, unary, smooth, weights, reach = grid
    rows, columns, n = unary.shape
    held, out = np.empty(n), np.empty(n)
    bound = 0.0
    for k in range(2):
        for chain in range(rows if k == 0 else columns):
            out[:] = 0.0
            before = False
            for s in range(columns if k == 0 else rows):
                i, j = (chain, s) if k == 0 else (s, chain)
                if not in_field[i, j]:
                    bound += out.min()
                    out[:] = 0.0
                    before = False
                    continue
                if before:
                    costs = out.copy()
                    passed(costs, smooth, weights[k], reach, out)
                held[:] = unary[i, j]
                for q in range(4):
                    held += messages[q, i, j]
                out += 0.5 * held - messages[k, i, j] - messages[k + 2, i, j]
                before = True
            bound += out.min()
    return bound


def lower_bound(problem: Problem, n_sweeps: int = 50) -> Bounded:
    """Return an energy below which none can be, and the best labels found on the way.

    Parameters
    ----------
    problem : Problem
        Of order 1, lines ``none`` or ``marginal``, smoothness that never falls.
    n_sweeps : int
        Sweeps to and fro; the bound rises with them.

    Returns
    -------
    Bounded

    Raises
    ------
    ValueError
        If order or lines are others.
    Degenerate
        If the messages would not fit.

    Notes
    -----
    V. Kolmogorov, "Convergent tree-reweighted message passing" (2006), DOI
    10.1109/TPAMI.2006.200, with rows and columns for trees; the bound given is recomputed from
    the split that the messages define, so that no rounding in them can make it too high.
    """
    model = problem.model
    if model.order != 1 or model.lines == "explicit":
        raise ValueError(
            "a bound needs order 1 and lines none or marginal, "
            f"got order {model.order} and lines {model.lines}"
        )
    if problem.in_field.size * model.n_levels > MOST:
        raise Degenerate(
            f"messages of {problem.in_field.size} cells and {model.n_levels} levels would not fit: "
            f"at most {MOST} numbers; take fewer levels or a crop"
        )
    if problem.idle:
        state = nothing(problem)
        return Bounded(energy(problem, *state), state, energy(problem, *state))
    unary = problem.own_costs() * problem.in_field[..., None]
    smooth, weights = problem.pairwise.smooth, problem.pairwise.weights
    reach = int(np.flatnonzero(smooth != smooth[-1]).max(initial=-1)) + 1
    grid = Grid(problem.in_field, unary, smooth, weights, reach)
    messages: NDArray[np.float64] = np.zeros((4, *unary.shape))
    labels = np.zeros(problem.shape, np.int64)
    bound, least, best = -np.inf, np.inf, labels
    for _ in range(n_sweeps):
        trw_sweep.call(grid, True, messages, labels)
        reached = energy(problem, labels)
        if reached < least:
            least, best = reached, labels.copy()
        trw_sweep.call(grid, False, messages, labels)
    bound = float(chain_bound.call(grid, messages))
    return Bounded(bound, State(best, *no_lines(problem.shape)), least)
