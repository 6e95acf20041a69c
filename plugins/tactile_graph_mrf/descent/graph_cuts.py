"""Step ``graph_cuts``: moves of any number of cells at once by minimum cuts."""

from __future__ import annotations

from typing import Annotated, Literal

import numpy as np
from annotated_types import Ge, Le
from numpy.typing import NDArray

from tactile_graph.wires import Image, Mask
from tactile_graph_mrf.descent.cut_moves import Cuts
from tactile_graph_mrf.descent.modes import settle
from tactile_graph_mrf.energy.line_field import Restored
from tactile_graph_mrf.energy.model import Model
from tactile_graph_mrf.energy.problem import Problem, prepare
from tactile_graph_mrf.energy.state import State, minimised, with_lines
from tactile_graph_mrf.energy.total import energy


def graph_cuts(
    image: Image,
    region: Mask | None = None,
    expected: Image | None = None,
    *,
    model: Model = Model(),  # noqa: B008 -- frozen
    moves: Literal["auto", "expansion", "swap", "jump"] = "auto",
    n_cycles: Annotated[int, Ge(1), Le(10_000)] = 20,
) -> Restored:
    """Restore an image by minimum cuts, each the best of all ways to make one kind of move.

    ``expansion`` gives any cells the label alpha; it needs a smoothness that obeys the triangle
    inequality (absolute differences, truncated or not). ``swap`` lets cells of two labels trade
    them, which any smoothness allows that is least for equal labels. ``jump`` raises or lowers
    any cells by a power of two; it needs convex smoothness, and with a Gaussian or Laplace data
    term its end is the least energy there is. ``auto`` takes jump or expansion where they are
    submodular, else swap. Explicit lines are cut at the price of a straight one and then
    adapted to one another by iterated conditional modes. Deterministic.

    A cycle of swaps tries up to L² / 2 pairs of labels, each a cut of a few cells only, which are
    compiled here and need no PyMaxflow; the others move all cells at once by its cuts.

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
    moves : str
        What a cut may change: any cell's label to one and the same (``expansion``), two labels for
        one another (``swap``), or labels by a power of two up or down (``jump``); ``auto`` takes
        jumps, else expansions, else swaps, as the model's smoothness allows.
    n_cycles : int
        Times that all moves are tried, at most; it ends once none helps.

    Returns
    -------
    Restored
        The trace holds the energy at the start and after each cycle.

    Raises
    ------
    DataError
        If region or expected load have another shape than the image, or PyMaxflow is missing.
    Degenerate
        If no cell holds a value.
    ValueError
        If the moves asked for are not submodular for this smoothness.

    Notes
    -----
    Y. Boykov, O. Veksler, R. Zabih 2001, DOI 10.1109/34.969114; jumps: V. Kolmogorov and
    A. Shioura 2009, DOI 10.1016/j.disopt.2009.04.006; which costs can be cut: V. Kolmogorov and
    R. Zabih 2004, DOI 10.1109/TPAMI.2004.1262177.
    """
    problem = prepare(model, image, region, expected)
    cuts = Cuts(problem, moves)
    return minimised(problem, lambda _: _cut(cuts, n_cycles))


def _cut(cuts: Cuts, n_cycles: int) -> tuple[State, list[float]]:
    problem = cuts.problem
    labels = np.where(problem.in_field, cuts.start(), 0)
    trace = [_energy(problem, labels)]
    for _ in range(n_cycles):
        labels = cuts.cycle(labels)
        trace.append(_energy(problem, labels))
        if not trace[-1] < trace[-2]:
            break
    state = with_lines(problem, labels)
    if problem.model.lines == "explicit":
        trace += settle(problem, state, 100)
    return state, trace


def _energy(problem: Problem, labels: NDArray[np.int64]) -> float:
    """Return the energy with those lines on that pay by themselves."""
    return energy(problem, *with_lines(problem, labels))
