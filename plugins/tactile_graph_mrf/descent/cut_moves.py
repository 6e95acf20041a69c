"""``Cuts``: the moves of `graph_cuts`, each a minimum cut: by PyMaxflow, but for swaps."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tactile_graph.errors import DataError, without
from tactile_graph_mrf.descent.swap_moves import Bonds, swap_cycle
from tactile_graph_mrf.energy.layout import layout
from tactile_graph_mrf.energy.potentials import Unary
from tactile_graph_mrf.energy.problem import Problem

Labels = NDArray[np.int64]
Costs = NDArray[np.float64]
ALLOWANCE = 1e-9
"""Relative breach of submodularity that is put down to rounding."""


class Cuts:
    """Cycles of moves over a problem.

    Parameters
    ----------
    problem : Problem
    moves : str
        ``auto``, ``expansion``, ``swap`` or ``jump``.

    Raises
    ------
    DataError
        If PyMaxflow is not installed; swaps do without.
    ValueError
        If the moves are not submodular for the problem's smoothness.
    """

    def __init__(self, problem: Problem, moves: str) -> None:
        self.problem = problem
        rho = problem.pairwise.smooth
        if problem.model.lines == "explicit":
            rho = np.minimum(rho, problem.model.line_price)
        self.rho = rho
        fit = {"jump": _convex(rho), "expansion": _metric(rho), "swap": bool(rho[0] <= rho.min())}
        if moves == "auto":
            moves = next(name for name, fits in fit.items() if fits)
        if not fit[moves]:
            fitting = " or ".join(name for name, fits in fit.items() if fits)
            lines = ", with lines" if problem.model.lines != "none" else ""
            raise ValueError(
                f"moves: {moves!r} is not submodular for smoothness {problem.model.smoothness!r}"
                f"{lines}, so a cut would not find its best move; take {fitting}"
            )
        self.moves = moves
        if moves != "swap":
            self._graph = _maxflow()
        self.index = np.flatnonzero(problem.in_field)
        self.ends, self.weights = _pairs(problem)

    def start(self) -> Labels:
        """Return the observations; for swaps, which bring in no label of theirs, a flat field."""
        labels = self.problem.start()
        if self.moves == "swap":
            labels[...] = int(np.median(labels.ravel()[self.index]))
        return labels

    def cycle(self, labels: Labels) -> Labels:
        """Return the labels after each move was tried once; none raises the energy."""
        flat = labels.ravel().copy()
        if self.moves == "swap":
            self._swap(flat)
            return flat.reshape(labels.shape)
        for target in getattr(self, f"_{self.moves}s")(flat):
            self._move(flat, target)
        return flat.reshape(labels.shape)

    def _expansions(self, flat: Labels) -> Iterator[Labels]:
        for alpha in range(self.problem.n_levels):
            yield np.full(flat.shape, alpha)

    def _swap(self, flat: Labels) -> None:
        """Trade labels that are there for one another, and for those beside them."""
        p = self.problem
        in_field, curvature, centre, table, row = p.unary
        unary = Unary(in_field.ravel(), curvature.ravel(), centre.ravel(), table, row.ravel())
        swap_cycle.call(unary, Bonds(self.rho, p.pairwise.weights), layout(p), flat)

    def _jumps(self, flat: Labels) -> Iterator[Labels]:
        size = 1 << (self.problem.n_levels - 1).bit_length()
        while size:
            yield flat + size
            yield flat - size
            size //= 2

    def _move(self, flat: Labels, target: Labels) -> None:
        """Give those cells their label of ``target`` that together lower the energy most."""
        top = self.problem.n_levels - 1
        free = (target != flat) & self.problem.in_field.ravel()
        free &= (target >= 0) & (target <= top) if self.moves != "jump" else True
        if not free.any():
            return
        cells = np.flatnonzero(free)
        node = np.full(flat.shape, -1)
        node[cells] = np.arange(len(cells))
        stay, go = self._own(cells, flat[cells]), self._own(cells, target[cells])
        a, b = self.ends
        touched = free[a] | free[b]
        a, b, weights = a[touched], b[touched], self.weights[touched]
        xa, xb, ya, yb = flat[a], flat[b], target[a], target[b]
        ya, yb = np.where(free[a], ya, xa), np.where(free[b], yb, xb)
        both = free[a] & free[b]
        rho = self._between
        for one, other, mine, new, fixed in ((a, b, xa, ya, xb), (b, a, xb, yb, xa)):
            lone = free[one] & ~free[other]
            np.add.at(stay, node[one[lone]], weights[lone] * rho(mine[lone], fixed[lone]))
            np.add.at(go, node[one[lone]], weights[lone] * rho(new[lone], fixed[lone]))
        a, b, weights = node[a[both]], node[b[both]], weights[both]
        xa, xb, ya, yb = xa[both], xb[both], ya[both], yb[both]
        A, B = weights * rho(xa, xb), weights * rho(xa, yb)
        C, D = weights * rho(ya, xb), weights * rho(ya, yb)
        # Kolmogorov and Zabih (2004): A + (C - A) x_a + (D - C) x_b + (B + C - A - D) (1-x_a) x_b
        np.add.at(go, a, C - A)
        np.add.at(go, b, D - C)
        gain = self._cut(stay, go, a, b, np.maximum(B + C - A - D, 0.0))
        goes = cells[gain]
        goes = goes[(target[goes] >= 0) & (target[goes] <= top)]
        moved = flat.copy()
        moved[goes] = target[goes]
        if self._change(flat, moved) < 0.0:
            flat[:] = moved

    def _own(self, cells: Labels, labels: Labels) -> Costs:
        own = self.problem.unary
        within = np.clip(labels, 0, self.problem.n_levels - 1)
        square = (within - own.centre.ravel()[cells]) ** 2
        table = own.table[own.row.ravel()[cells], within]
        costs = own.curvature.ravel()[cells] * square + table
        # Off the scale is dearer than anything a cut could save.
        return np.asarray(costs + np.where(within == labels, 0.0, self._forbidding))

    @property
    def _forbidding(self) -> float:
        return 1e3 * (float(self.rho.max()) + float(self.problem.unary.table.max()) + 1.0) + 1e9

    def _between(self, x: Labels, y: Labels) -> Costs:
        d = np.abs(x - y)
        top = len(self.rho) - 1
        beyond = np.maximum(d - top, 0)
        # Convex beyond the table too: else jumps off the scale would not be submodular.
        rise = self.rho[-1] - self.rho[-2]
        return np.asarray(self.rho[np.minimum(d, top)] + beyond * rise)

    def _change(self, before: Labels, after: Labels) -> float:
        a, b = self.ends
        moved = np.flatnonzero(before != after)
        if not len(moved):
            return 0.0
        own = self._own(moved, after[moved]) - self._own(moved, before[moved])
        bonds = self._between(after[a], after[b]) - self._between(before[a], before[b])
        return float(own.sum() + (self.weights * bonds).sum())

    def _cut(self, stay: Costs, go: Costs, a: Labels, b: Labels, bond: Costs) -> NDArray[np.bool_]:
        """Return which nodes go, of all choices the cheapest."""
        graph = self._graph(len(stay), len(a))
        nodes = graph.add_nodes(len(stay))
        least = np.minimum(stay, go)
        # The source's side stays: whoever is cut from the source pays to go, and the reverse.
        graph.add_grid_tedges(nodes, go - least, stay - least)
        if len(a):
            graph.add_edges(a, b, bond, np.zeros(len(bond)))
        graph.maxflow()
        return np.asarray(graph.get_grid_segments(nodes))


def _pairs(problem: Problem) -> tuple[tuple[Labels, Labels], Costs]:
    """Return both ends of each pair clique as flat indices, and its weight."""
    rows, columns = problem.shape
    index = np.arange(rows * columns).reshape(rows, columns)
    ends, weights = [], []
    pairwise, on = problem.pairwise, problem.in_field
    for (di, dj), weight in zip(pairwise.offsets.tolist(), pairwise.weights.tolist(), strict=True):
        if di >= rows or abs(dj) >= columns:
            continue
        a = np.s_[: rows - di, max(-dj, 0) : columns - max(dj, 0)]
        b = np.s_[di:, max(dj, 0) : columns - max(-dj, 0)]
        both = on[a] & on[b]
        ends.append((index[a][both], index[b][both]))
        weights.append(np.full(int(both.sum()), weight))
    first = np.concatenate([np.zeros(0, np.int64), *(a for a, _ in ends)])
    second = np.concatenate([np.zeros(0, np.int64), *(b for _, b in ends)])
    return (first, second), np.concatenate([np.zeros(0), *weights])


def _convex(rho: Costs) -> bool:
    return bool((np.diff(rho, 2) >= -ALLOWANCE * max(float(rho.max()), 1e-300)).all())


def _metric(rho: Costs) -> bool:
    """Return whether rho(a + b) <= rho(a) + rho(b), of all a and b on the scale."""
    d = np.arange(len(rho))
    a, b = np.meshgrid(d, d)
    on = a + b < len(rho)
    a, b = a[on], b[on]
    slack = rho[a] + rho[b] - rho[a + b]
    falls = (np.diff(rho) < 0).any()
    return not falls and bool((slack >= -ALLOWANCE * max(float(rho.max()), 1e-300)).all())


def _maxflow() -> Callable[..., Any]:
    try:
        import maxflow
    except ImportError as error:
        missing = 'needs PyMaxflow: pip install "tactile-graph[graphcut]", or take restore'
        raise DataError("graph_cuts", without("maxflow", error, missing)) from error
    return maxflow.Graph[float]  # type: ignore[no-any-return]
