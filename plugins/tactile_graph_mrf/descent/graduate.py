"""Levels of a graduated, ever less convex energy, followed by over-relaxation."""

from __future__ import annotations

import math
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tactile_graph.compiled import compiled_as_is
from tactile_graph_mrf.energy.model import Model
from tactile_graph_mrf.energy.potentials import Potentials, smoothness_costs
from tactile_graph_mrf.energy.problem import Problem
from tactile_graph_mrf.energy.state import State, with_lines
from tactile_graph_mrf.energy.total import total

CONVEX = 0.25
"""Concavity that unit data terms and four neighbours just outweigh (Blake and Zisserman 1987)."""


@lru_cache(maxsize=32)
def influence(model: Model, steps: int, growth: float) -> NDArray[np.float64]:
    """Return rho_c'(d) / 2 d of the graduated smoothness, shape (steps, L + 1).

    ``rho_c`` is the largest function below rho whose concavity nowhere exceeds c: the convex hull
    of ``rho + c d² / 2`` less ``c d² / 2``. For a truncated parabola that is Blake and Zisserman's
    g*; it serves any rho. Row k has c = growth^k / 4.
    """
    rho = smoothness_costs(model.smoothness, model.n_levels, model.truncation) * model.lambda_d
    if model.lines != "none":
        rho = np.minimum(rho, model.line_price)
    d = np.arange(model.n_levels, dtype=np.float64)
    out = np.zeros((steps, model.n_levels + 1))
    for k in range(steps):
        bend = 0.5 * CONVEX * growth**k * d * d
        slope = np.gradient(_hull(rho + bend) - bend)
        out[k, 1:-1] = np.maximum(slope[1:] / (2.0 * d[1:]), 0.0)
        out[k, 0], out[k, -1] = out[k, 1], out[k, -2]
    out.setflags(write=False)
    return out


def _hull(costs: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the convex hull from below of equally spaced values."""
    kept: list[int] = []
    y = costs.tolist()
    for b in range(len(y)):
        while len(kept) > 1:
            o, a = kept[-2], kept[-1]
            if (y[a] - y[o]) * (b - o) <= (y[b] - y[o]) * (a - o):
                break
            kept.pop()
        kept.append(b)
    return np.interp(np.arange(len(y)), kept, costs[kept])


class Relaxation(NamedTuple):
    """How a graduation is followed.

    Parameters
    ----------
    sweeps : int
        At most, at each graduation.
    over : float
        How many times the way to its minimum each cell goes, 1 to 2.
    still : float
        A cell rests while none beside it moves by this share of the range.
    """

    sweeps: int
    over: float
    still: float = 1e-6


def graduated(
    problem: Problem, influences: NDArray[np.float64], relaxation: Relaxation
) -> NDArray[np.float64]:
    """Return levels, not whole, after each graduation, shape (steps, rows, columns)."""
    levels = problem.observed.copy()
    if not problem.has_data.all():
        levels[~problem.has_data] = levels[problem.has_data].mean()
    out = np.empty((len(influences), *problem.shape))
    relax.call(problem.potentials, problem.observed, influences, relaxation, levels, out)
    return out


def rounded(problem: Problem, levels: NDArray[np.float64]) -> State:
    """Return the whole labels nearest to ``levels``, with those lines on that pay."""
    labels = np.rint(levels).astype(np.int64)
    labels[~problem.in_field] = 0
    return with_lines(problem, labels)


def rounded_energies(problem: Problem, stages: NDArray[np.float64]) -> list[float]:
    """Return the energy of what `rounded` makes of each of several levels."""
    explicit = problem.model.lines == "explicit"
    price = problem.model.line_price if explicit else math.inf
    found: list[float] = round_all.call(problem.potentials, float(price), stages).tolist()
    return found


@compiled_as_is
def round_all(potentials: Potentials, price: float, stages: Any) -> NDArray[np.float64]:
    """Return the energy of each of ``stages``, rounded, with lines on where a step is dearer."""
    in_field, bare = potentials.unary.in_field, potentials.pairwise.bare
    n_stages, rows, columns = stages.shape
    labels = np.zeros((rows, columns), np.int64)
    across = np.zeros((max(rows - 1, 0), columns), np.bool_)
    down = np.zeros((rows, max(columns - 1, 0)), np.bool_)
    energies = np.empty(n_stages)
    for k in range(n_stages):
        for i in range(rows):
            for j in range(columns):
                if not in_field[i, j]:
                    continue
                labels[i, j] = int(np.rint(stages[k, i, j]))
                if i > 0 and in_field[i - 1, j]:
                    across[i - 1, j] = bare[abs(labels[i, j] - labels[i - 1, j])] > price
                if j > 0 and in_field[i, j - 1]:
                    down[i, j - 1] = bare[abs(labels[i, j] - labels[i, j - 1])] > price
        energies[k] = total(potentials, labels, across, down)
    return energies


@compiled_as_is
def relax(
    potentials: Potentials, observed: Any, influences: Any, relaxation: Relaxation, levels: Any,
    out: Any,
) -> None:  # fmt: skip
    """Write into ``out`` the levels after the sweeps with each row of ``influences``."""
    awake = np.empty(levels.shape, np.bool_)
    for k in range(len(influences)):
        awake[:] = potentials.unary.in_field
        for _ in range(relaxation.sweeps):
            if not relax_once(potentials, observed, influences[k], relaxation, levels, awake):
                break
        out[k] = levels


@compiled_as_is
def relax_once(
    potentials: Potentials, observed: Any, bends: Any, relaxation: Relaxation, levels: Any,
    awake: Any,
) -> bool:  # fmt: skip
    """Move each cell that is awake; return whether any went so far as to wake those beside it.

    It goes ``over`` times the way to the minimum of the parabola that touches its conditional
    energy from above (half-quadratic majorisation). Cells are visited by colours, of which no two
    are neighbours.
    """
    in_field, curvature, centre, table, row = potentials.unary
    offsets, weights = potentials.pairwise.offsets, potentials.pairwise.weights
    rows, columns = levels.shape
    top = table.shape[1] - 1
    over, still = relaxation.over, relaxation.still * top
    nearest_only = len(weights) == 2
    n_colours, rise, run = (2, 1, 2) if nearest_only else (9, 3, 3)
    stirred = False
    for c in range(n_colours):
        for i in range(0 if nearest_only else c // 3, rows, rise):
            for j in range((i + c) % 2 if nearest_only else c % 3, columns, run):
                if not awake[i, j]:
                    continue
                awake[i, j] = False
                x = levels[i, j]
                mass, goal = curvature[i, j], observed[i, j]
                if mass > 0:
                    goal = centre[i, j]
                if row[i, j] > 0:
                    away = abs(x - observed[i, j])
                    at = min(max(int(np.rint(x)), 1), top - 1) if top > 1 else 0
                    slope = table[row[i, j], min(at + 1, top)] - table[row[i, j], max(at - 1, 0)]
                    mass += abs(0.5 * slope) / (2.0 * (1.0 if away < 1.0 else away))
                pull = mass * (goal - x)
                for q in range(len(weights)):
                    for sign in (1, -1):
                        m, n = i + sign * offsets[q, 0], j + sign * offsets[q, 1]
                        if 0 <= m < rows and 0 <= n < columns and in_field[m, n]:
                            step = levels[m, n] - x
                            d = min(abs(step), top)
                            whole = int(d)
                            low, high = bends[whole], bends[whole + 1]
                            w = weights[q] * (low + (d - whole) * (high - low))
                            pull += w * step
                            mass += w
                if mass > 0:
                    after = min(max(x + over * pull / mass, 0.0), top)
                    levels[i, j] = after
                    if abs(after - x) >= still:
                        stirred = awake[i, j] = True
                        wake_beside(in_field, offsets, i, j, awake)
    return stirred


@compiled_as_is
def wake_beside(in_field: Any, offsets: Any, i: int, j: int, awake: Any) -> None:
    """Wake the cells in one clique with cell (i, j)."""
    rows, columns = in_field.shape
    for q in range(len(offsets)):
        for sign in (1, -1):
            m, n = i + sign * offsets[q, 0], j + sign * offsets[q, 1]
            if 0 <= m < rows and 0 <= n < columns and in_field[m, n]:
                awake[m, n] = True
