"""Step ``restore``: the lowest energy within the time of a frame."""

from __future__ import annotations

from dataclasses import replace
from typing import Annotated

import numpy as np
from annotated_types import Ge, Le
from numpy.typing import NDArray

from tactile_graph.wires import Image, Mask
from tactile_graph_mrf.descent.graduate import Relaxation, graduated, influence, rounded
from tactile_graph_mrf.descent.polish import polish
from tactile_graph_mrf.descent.region_moves import fuse
from tactile_graph_mrf.energy.line_field import Restored, no_lines
from tactile_graph_mrf.energy.model import Model
from tactile_graph_mrf.energy.problem import Problem, prepare
from tactile_graph_mrf.energy.state import State, minimised
from tactile_graph_mrf.energy.total import energy

SCHEDULES = ((30, 1.13, 24), (80, 1.05, 48), (200, 1.02, 100))
"""Graduations, growth and most sweeps of each effort."""
STIFFNESSES = (1.4, 0.7)
"""Of further graduations, whose ends are fused: one more with each effort."""
OVER = 1.6
"""Over-relaxation."""
STILL = 5e-4
"""Share of the range: cells beside which none moves by as much rest."""


def restore(
    image: Image,
    region: Mask | None = None,
    expected: Image | None = None,
    *,
    model: Model = Model(),  # noqa: B008 -- frozen
    effort: Annotated[int, Ge(1), Le(3)] = 1,
    n_rounds: Annotated[int, Ge(0), Le(1000)] = 8,
) -> Restored:
    """Restore an image by graduated non-convexity, then by moves that lower the energy.

    Every round raises and lowers by one level the sets of cells for which that is best, gives
    each row, then each column, the best combination of proposals for its cells (the present
    label, those beside it, the neighbours', the datum, a local mean), with the other rows held,
    and then each cell and line its best state; none raises the energy. It ends where none lowers
    it. Deterministic. Chains are moved in neighbourhoods of order 1 and 2.

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
    effort : int
        1, 2 or 3: ever slower graduations, and with 2 or 3 as many of them, each of another
        stiffness, fused.
    n_rounds : int
        Rounds of moves at most.

    Returns
    -------
    Restored
        The trace starts at the energy of the graduation; it never rises.

    Raises
    ------
    DataError
        If region or expected load have another shape than the image.
    Degenerate
        If no cell holds a value.

    Notes
    -----
    Blake and Zisserman (1987) for the start; regions are jump moves (V. Kolmogorov and
    A. Shioura 2009, DOI 10.1016/j.disopt.2009.04.006); rows and columns fusion moves
    (V. Lempitsky et al. 2010, DOI 10.1109/TPAMI.2009.143) by dynamic programming.
    """

    def lowered(problem: Problem) -> tuple[State, list[float]]:
        state, trace = _descended(problem, effort, 1.0, n_rounds)
        for stiffness in STIFFNESSES[: effort - 1 if n_rounds else 0]:
            other, _ = _descended(problem, effort, stiffness, n_rounds)
            if energy(problem, *other) < trace[-1]:
                state, other = other, state
                trace.append(energy(problem, *state))
            if fuse(problem, state, other.labels):
                trace += polish(problem, state, n_rounds)
        return state, trace

    return minimised(prepare(model, image, region, expected), lowered)


def _descended(
    problem: Problem, effort: int, stiffness: float, n_rounds: int
) -> tuple[State, list[float]]:
    """Return the end of a graduation, of a smoothness so many times the model's, and of moves."""
    steps, growth, sweeps = SCHEDULES[effort - 1]
    path = replace(problem.model, lambda_d=min(stiffness * problem.model.lambda_d, 1e12))
    bends = influence(path, steps, growth)
    levels = graduated(problem, bends, Relaxation(sweeps, OVER, STILL))[-1]
    states = (rounded(problem, levels), _flat(problem, levels))
    start = [energy(problem, *state) for state in states]
    state = states[0] if start[0] <= start[1] else states[1]
    return state, [min(start), *(polish(problem, state, n_rounds) if n_rounds else ())]


def _flat(problem: Problem, levels: NDArray[np.float64]) -> State:
    """Return one label everywhere: the best there is where smoothness outweighs all data."""
    on, unary = problem.in_field, problem.unary
    mass = unary.curvature[on]
    mean = np.average(unary.centre[on], weights=mass) if mass.any() else np.median(levels[on])
    label = int(np.clip(np.rint(mean), 0, problem.n_levels - 1))
    return State(np.where(on, label, 0), *no_lines(problem.shape))
