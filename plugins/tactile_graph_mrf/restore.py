"""Step ``restore``: the lowest energy within the time of a frame."""

from __future__ import annotations

from typing import Annotated

import numpy as np
from annotated_types import Ge, Le
from numpy.typing import NDArray

from tactile_graph.wires import Image, Mask
from tactile_graph_mrf.annealing import State, outcome, unswept
from tactile_graph_mrf.fuse import polish
from tactile_graph_mrf.graduate import graduated, influence, settled
from tactile_graph_mrf.line_field import Restored, no_lines
from tactile_graph_mrf.model import Model, Problem, energy

SCHEDULES = ((10, 2.0, 6), (20, 1.5, 12), (40, 1.2, 40))
"""Graduations, growth and sweeps of each effort."""


def restore(
    image: Image,
    region: Mask | None = None,
    expected: Image | None = None,
    *,
    model: Model = Model(),  # noqa: B008 -- frozen
    effort: Annotated[int, Ge(1), Le(3)] = 1,
    n_rounds: Annotated[int, Ge(0), Le(1000)] = 8,
) -> Restored:
    """Restore an image by graduated non-convexity, then by exact moves of rows and columns.

    Every round gives each row, then each column, the best combination of proposals for its cells
    (the present label, those beside it, the neighbours', the datum, a local mean), with the other
    rows held, and then each cell and line its best state; none raises the energy. It ends
    where none lowers it. Deterministic. Chains are moved in neighbourhoods of order 1 and 2.

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
        1, 2 or 3: ever slower graduations, about 1, 2 and 10 ms on 16 by 16 cells.
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
    Blake and Zisserman (1987) for the start; the moves are fusion moves (V. Lempitsky et al. 2010,
    DOI 10.1109/TPAMI.2009.143) solved along chains by dynamic programming.
    """
    problem = model.prepare(image, region, expected)
    if problem.idle:
        return unswept(problem)
    steps, growth, sweeps = SCHEDULES[effort - 1]
    levels = graduated(problem, influence(model, steps, growth), sweeps, 1.5)[-1]
    states = (settled(problem, levels), _flat(problem, levels))
    start = [energy(problem, *state) for state in states]
    state = states[0] if start[0] <= start[1] else states[1]
    trace = [min(start), *(polish(problem, state, n_rounds) if n_rounds else ())]
    return outcome(problem, state, trace)


def _flat(problem: Problem, levels: NDArray[np.float64]) -> State:
    """Return one label everywhere: the best there is where smoothness outweighs all data."""
    on = problem.in_field
    mass = problem.curvature[on]
    mean = np.average(problem.centre[on], weights=mass) if mass.any() else np.median(levels[on])
    label = int(np.clip(np.rint(mean), 0, problem.n_levels - 1))
    return State(np.where(on, label, 0), *no_lines(problem.shape))
