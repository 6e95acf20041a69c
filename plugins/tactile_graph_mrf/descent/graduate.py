"""The kernel of `gnc`: labels of a graduated, ever less convex energy by over-relaxation."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from tactile_graph.compiled import compiled_as_is, compiled_twin_of
from tactile_graph_mrf.energy.line_field import no_lines
from tactile_graph_mrf.energy.model import Model, Problem
from tactile_graph_mrf.energy.potentials import smoothness_costs
from tactile_graph_mrf.samplers.annealing import State
from tactile_graph_mrf.samplers.visits import fit_for

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


def colours(order: int) -> int:
    """Return the number of classes of cells of which no two are neighbours."""
    return 2 if order == 1 else 9


def graduated(
    problem: Problem,
    influences: NDArray[np.float64],
    sweeps: int,
    over: float,
    still: float = 1e-6,
) -> NDArray[np.float64]:
    """Return levels, not whole, after each graduation, shape (steps, rows, columns).

    At most ``sweeps`` at each graduation, each cell going ``over`` times the way to its minimum
    (1 to 2). A cell rests while none beside it moves by the share ``still`` of the range.
    """
    p = problem
    levels = p.observed.copy()
    if not p.has_data.all():
        levels[~p.has_data] = levels[p.has_data].mean()
    out = np.empty((len(influences), *p.shape))
    kernel = fit_for(relax, out.size * sweeps // 20)
    kernel(
        *(p.in_field, p.curvature, p.centre, p.table, p.row, p.observed, influences, p.offsets),
        *(p.weights, colours(p.model.order), sweeps, over, still * (p.n_levels - 1), levels, out),
    )
    return out


def settled(problem: Problem, levels: NDArray[np.float64]) -> State:
    """Return the whole labels nearest to ``levels``, with those lines on that pay."""
    labels = np.rint(levels).astype(np.int64)
    labels[~problem.in_field] = 0
    across, down = no_lines(problem.shape)
    if problem.model.lines == "explicit":
        across, down = problem.lines_of(labels)
    return State(labels, across, down)


def _relax_plain(
    in_field: NDArray[np.bool_],
    curvature: NDArray[np.float64],
    centre: NDArray[np.float64],
    table: NDArray[np.float64],
    row: NDArray[np.int64],
    observed: NDArray[np.float64],
    influences: NDArray[np.float64],
    offsets: NDArray[np.int64],
    weights: NDArray[np.float64],
    n_colours: int,
    sweeps: int,
    over: float,
    still: float,
    levels: NDArray[np.float64],
    out: NDArray[np.float64],
) -> None:
    """Write into ``out`` the levels after the sweeps with each row of ``influences``.

    Each cell goes ``over`` times the way to the minimum of the parabola that touches its
    conditional energy from above (half-quadratic majorisation), colour by colour.
    """
    rows, columns = levels.shape
    i, j = np.indices(levels.shape)
    colour = (i + j) % 2 if n_colours == 2 else i % 3 * 3 + j % 3
    inside = np.pad(in_field, 2)
    top = table.shape[1] - 1
    for k, influence_k in enumerate(influences):
        awake = in_field.copy()
        for c in [c for _ in range(sweeps) for c in range(n_colours)]:
            if awake.any():
                own = curvature + _own_weight(levels, observed, table, row)
                pull, mass = own * (np.where(curvature > 0, centre, observed) - levels), own
                padded = np.pad(levels, 2)
                for (di, dj), weight in zip(offsets.tolist(), weights.tolist(), strict=True):
                    for m, n in ((2 + di, 2 + dj), (2 - di, 2 - dj)):
                        window = np.s_[m : m + rows, n : n + columns]
                        step = padded[window] - levels
                        bend = weight * _bent(influence_k, np.abs(step))
                        w = np.where(inside[window], bend, 0.0)
                        pull, mass = pull + w * step, mass + w
                visited = awake & (colour == c)
                moved = visited & (mass > 0)
                np.divide(over * pull, mass, out=pull, where=moved)
                after = np.where(moved, np.clip(levels + pull, 0.0, top), levels)
                far = np.pad(np.abs(after - levels) >= still, 2)
                levels[...] = after
                awake[visited] = False
                for di, dj in [(0, 0), *offsets.tolist(), *(-offsets).tolist()]:
                    awake |= far[2 + di : 2 + di + rows, 2 + dj : 2 + dj + columns]
                awake &= in_field
        out[k] = levels


def _bent(influence: NDArray[np.float64], d: NDArray[np.float64]) -> NDArray[np.float64]:
    d = np.minimum(d, len(influence) - 2)
    whole = d.astype(np.int64)
    low, high = influence[whole], influence[whole + 1]
    return np.asarray(low + (d - whole) * (high - low))


def _own_weight(
    levels: NDArray[np.float64],
    observed: NDArray[np.float64],
    table: NDArray[np.float64],
    row: NDArray[np.int64],
) -> NDArray[np.float64]:
    top = table.shape[1] - 1
    x = np.clip(np.rint(levels), 1, top - 1).astype(np.int64) if top > 1 else row * 0
    away = levels - observed
    slope = 0.5 * (table[row, np.minimum(x + 1, top)] - table[row, np.maximum(x - 1, 0)])
    near = np.abs(away) < 1.0
    return np.where(row > 0, np.abs(slope) / (2.0 * np.where(near, 1.0, np.abs(away))), 0.0)


@compiled_twin_of(_relax_plain)
def relax(  # type: ignore[no-untyped-def]
    in_field, curvature, centre, table, row, observed, influences, offsets, weights,
    n_colours, sweeps, over, still, levels, out,
):  # fmt: skip
    """Write into ``out`` the levels after the sweeps with each row of ``influences``."""
    awake = np.empty(levels.shape, np.bool_)
    for k in range(len(influences)):
        awake[:] = in_field
        for _ in range(sweeps):
            stirred = False
            for c in range(n_colours):
                if relax_colour(
                    in_field, curvature, centre, table, row, observed, influences[k], offsets,
                    weights, n_colours, c, over, still, levels, awake,
                ):  # fmt: skip
                    stirred = True
            if not stirred:
                break
        out[k] = levels


@compiled_as_is
def relax_colour(  # type: ignore[no-untyped-def]
    in_field, curvature, centre, table, row, observed, bends, offsets, weights, n_colours, c, over,
    still, levels, awake,
):  # fmt: skip
    """Move the cells of one colour that are awake; return whether any went as far as ``still``.

    A cell sleeps until one beside it does so.
    """
    rows, columns = levels.shape
    top = table.shape[1] - 1
    rise, run = (1, 2) if n_colours == 2 else (3, 3)
    stirred = False
    for i in range(0 if n_colours == 2 else c // 3, rows, rise):
        for j in range((i + c) % 2 if n_colours == 2 else c % 3, columns, run):
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
def wake_beside(in_field, offsets, i, j, awake):  # type: ignore[no-untyped-def]
    """Wake the cells in one clique with cell (i, j)."""
    rows, columns = in_field.shape
    for q in range(len(offsets)):
        for sign in (1, -1):
            m, n = i + sign * offsets[q, 0], j + sign * offsets[q, 1]
            if 0 <= m < rows and 0 <= n < columns and in_field[m, n]:
                awake[m, n] = True
