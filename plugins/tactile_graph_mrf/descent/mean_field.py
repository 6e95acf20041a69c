"""Step ``mean_field``: deterministic annealing, the mean field of each temperature in turn."""

from __future__ import annotations

from typing import Annotated

import numpy as np
from annotated_types import Ge, Gt, Le, Lt
from numpy.typing import NDArray

from tactile_graph.errors import Degenerate
from tactile_graph.wires import Image, Mask
from tactile_graph_mrf.descent.mean_sweep import Chances, mean_sweep
from tactile_graph_mrf.descent.modes import settle
from tactile_graph_mrf.energy.line_field import Restored, no_lines
from tactile_graph_mrf.energy.model import Model
from tactile_graph_mrf.energy.problem import Problem, prepare
from tactile_graph_mrf.energy.state import State, minimised
from tactile_graph_mrf.energy.total import energy

MOST = 40_000_000
"""Numbers a table of distributions may hold: cells times levels."""


def mean_field(
    image: Image,
    region: Mask | None = None,
    expected: Image | None = None,
    *,
    model: Model = Model(),  # noqa: B008 -- frozen
    temperature: Annotated[float, Ge(1e-6), Le(1e12)] = 10_000.0,
    cooling: Annotated[float, Gt(0), Lt(1)] = 0.8,
    coldest: Annotated[float, Ge(1e-6), Le(1e12)] = 1.0,
    n_sweeps: Annotated[int, Ge(1), Le(10_000)] = 3,
    tolerance: Annotated[float, Gt(0), Lt(1)] = 1e-3,
    finish: bool = True,
) -> Restored:
    """Restore an image by deterministic annealing: the energy's mean replaces its samples.

    At each temperature independent distributions of cells and lines are brought to least free
    energy, mean energy - T entropy, by sweeps; as T falls they harden into labels and lines.
    ``marginal`` lines are summed out at temperature 0. What the thesis proposes for speed
    (sections 5.5.2 and 6.1.4). Deterministic.

    Parameters
    ----------
    image : Image
        As recorded; cells that are invalid or not finite are inferred from their neighbours.
    region : Mask, optional
        Restore these cells only, as if the pad ended there.
    expected : Image, optional
        Expected load, which counts by the model's ``lambda_prior``.
    model : Model
        What is minimised.
    temperature : float
        The first, in squared levels.
    cooling : float
        Factor from one temperature to the next.
    coldest : float
        No temperature is below it.
    n_sweeps : int
        Sweeps at a temperature at most.
    tolerance : float
        Change of all probabilities below which a temperature is done with.
    finish : bool
        Whether to end by iterated conditional modes.

    Returns
    -------
    Restored
        The trace holds the energy of the likeliest labels and lines after each sweep.

    Raises
    ------
    DataError
        If region or expected load have another shape than the image.
    Degenerate
        If no cell holds a value, or the distributions of so many cells would not fit.
    ValueError
        If lines are explicit in a neighbourhood above order 1.

    Notes
    -----
    D. Miller and K. Rose 1994 (thesis section 5.5.2), K. Rose 1998, DOI 10.1109/5.726788; with a
    line field D. Geiger and F. Girosi 1991, DOI 10.1109/34.134040.
    """
    if model.lines == "explicit" and model.order > 1:
        raise ValueError(
            f"model: explicit lines need order 1 in mean_field, got order {model.order}; "
            "take order 1, or lines none or marginal"
        )

    def hardened(problem: Problem) -> tuple[State, list[float]]:
        _require_room(problem)
        mean = MeanField(problem)
        trace: list[float] = []
        now = temperature
        while now > coldest or not trace:
            for _ in range(n_sweeps):
                moved = mean.sweep(max(now, coldest))
                trace.append(energy(problem, *mean.likeliest()))
                if moved < tolerance:
                    break
            now *= cooling
        state = mean.likeliest()
        return state, [*trace, *(settle(problem, state, 200) if finish else ())]

    return minimised(prepare(model, image, region, expected), hardened)


def _require_room(problem: Problem) -> None:
    if problem.in_field.size * problem.n_levels > MOST:
        raise Degenerate(
            f"mean_field keeps a chance of each of {problem.n_levels} levels for each of "
            f"{problem.in_field.size} cells, at most {MOST} in all; take fewer levels or a crop"
        )


class MeanField:
    """Distributions of each cell and line; start even.

    Parameters
    ----------
    problem : Problem
    """

    def __init__(self, problem: Problem) -> None:
        self.problem = problem
        shape = (*problem.shape, problem.n_levels)
        d = np.abs(np.subtract.outer(np.arange(shape[2]), np.arange(shape[2])))
        smooth = problem.pairwise.smooth
        felt = np.broadcast_to(smooth[d].mean(axis=0), shape).copy()
        across, down = (lines.astype(np.float64) for lines in no_lines(problem.shape))
        self.chances = Chances(np.full(shape, 1.0 / problem.n_levels), felt, across, down)
        self._visits = np.argwhere(problem.in_field), _sites(problem)
        self._reach = int(np.flatnonzero(smooth != smooth[-1]).max(initial=-1)) + 1

    def sweep(self, temperature: float) -> float:
        """Visit every cell and line once; return the largest change of a distribution."""
        potentials = self.problem.potentials
        fixed = potentials, self._reach, *self._visits
        return float(mean_sweep.call(*fixed, temperature, self.chances))

    def likeliest(self) -> State:
        """Return the likeliest label of each cell, and the lines that are likelier on."""
        labels = np.where(self.problem.in_field, self.chances.cells.argmax(axis=2), 0)
        return State(labels, self.chances.across > 0.5, self.chances.down > 0.5)

    def free_energy(self, temperature: float) -> float:
        """Return mean energy - T entropy, which no `sweep` at that temperature raises."""
        p = self.problem
        on = p.in_field
        own = float((self.chances.cells * p.own_costs())[on].sum())
        pairwise = p.pairwise
        steps = zip(pairwise.offsets.tolist(), pairwise.weights.tolist(), strict=True)
        bonds = sum(weight * self._bonds(*step) for step, weight in steps)
        return float(own + bonds + self._line_energy() - temperature * self._entropy())

    def _bonds(self, di: int, dj: int) -> float:
        rows, columns = self.problem.shape
        a = np.s_[: rows - di, max(-dj, 0) : columns - max(dj, 0)]
        b = np.s_[di:, max(dj, 0) : columns - max(-dj, 0)]
        both = self.problem.in_field[a] & self.problem.in_field[b]
        cells, felt, across, down = self.chances
        whole = {(0, 1): 1.0 - down, (1, 0): 1.0 - across}.get((di, dj), np.ones(1))
        costs = (cells[a] * felt[b]).sum(axis=2) * whole
        return float(costs[both].sum())

    def _line_energy(self) -> float:
        p, (_, _, across, down) = self.problem.line_cliques, self.chances
        total = p.one * (across.sum() + down.sum())
        total += p.parallel * (across[:-1] * across[1:]).sum()
        total += p.parallel * (down[:, :-1] * down[:, 1:]).sum()
        on = self.problem.in_field
        complete = on[:-1, :-1] & on[:-1, 1:] & on[1:, :-1] & on[1:, 1:]
        around = down[:-1], down[1:], across[:, :-1], across[:, 1:]
        for code in range(16):
            share = np.ones(complete.shape)
            for k, line in enumerate(around):
                share = share * (line if code >> k & 1 else 1.0 - line)
            total += float(p.pattern[code] * share[complete].sum())
        return float(total)

    def _entropy(self) -> float:
        cells = self.chances.cells[self.problem.in_field]
        both = np.concatenate([self.chances.across.ravel(), self.chances.down.ravel()])
        return float(_plogp(cells) + _plogp(both) + _plogp(1.0 - both))


def _sites(problem: Problem) -> NDArray[np.int64]:
    """Return (1 if vertical, row, column) of each line site; none unless lines are explicit."""
    if problem.model.lines != "explicit":
        return np.zeros((0, 3), np.int64)
    across, down = (np.argwhere(sites) for sites in problem.sites)
    kinds = np.repeat([0, 1], [len(across), len(down)])
    return np.ascontiguousarray(np.column_stack([kinds, np.concatenate([across, down])]))


def _plogp(chance: NDArray[np.float64]) -> float:
    """Return the sum of -p log p."""
    return float(-(chance * np.log(np.where(chance > 0.0, chance, 1.0))).sum())
