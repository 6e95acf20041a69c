"""Step ``gnc``: graduated non-convexity, from a convex energy to the true one."""

from __future__ import annotations

from typing import Annotated

from annotated_types import Ge, Gt, Le

from tactile_graph.wires import Image, Mask
from tactile_graph_mrf.descent.graduate import (
    Relaxation,
    graduated,
    influence,
    rounded,
    rounded_energies,
)
from tactile_graph_mrf.energy.line_field import Restored
from tactile_graph_mrf.energy.model import Model
from tactile_graph_mrf.energy.problem import Problem, prepare
from tactile_graph_mrf.energy.state import State, minimised


def gnc(
    image: Image,
    region: Mask | None = None,
    expected: Image | None = None,
    *,
    model: Model = Model(),  # noqa: B008 -- frozen
    n_steps: Annotated[int, Ge(1), Le(200)] = 20,
    growth: Annotated[float, Gt(1), Le(100)] = 1.5,
    n_sweeps: Annotated[int, Ge(1), Le(100_000)] = 20,
    over: Annotated[float, Gt(0), Le(1.95)] = 1.5,
) -> Restored:
    """Restore an image by following the minimum of a convex energy while it turns into the true.

    Each graduation allows the smoothness ``growth`` times the concavity of the one before and
    starts where that one ended; the best of their roundings to labels is given. Deterministic.
    What is followed is the energy with each line at the price of a straight one (Eq. 5.21 with
    the lines minimised out); explicit lines are then those that pay. Their energy is the
    model's, but they are not adapted to one another: ``restore`` does that.

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
    n_steps : int
        Graduations.
    growth : float
        Factor on the concavity allowed from one graduation to the next.
    n_sweeps : int
        Sweeps of each graduation.
    over : float
        Over-relaxation.

    Returns
    -------
    Restored
        The trace holds the energy at the end of each graduation, rounded to labels.

    Raises
    ------
    DataError
        If region or expected load have another shape than the image.
    Degenerate
        If no cell holds a value.

    Notes
    -----
    A. Blake and A. Zisserman, "Visual Reconstruction" (1987), chapter 7; its g* is generalised to
    any smoothness by a convex hull (`tactile_graph_mrf.descent.graduate.influence`).
    """

    def followed(problem: Problem) -> tuple[State, list[float]]:
        path = influence(model, n_steps, growth)
        stages = graduated(problem, path, Relaxation(n_sweeps, over))
        trace = rounded_energies(problem, stages)
        return rounded(problem, stages[trace.index(min(trace))]), trace

    return minimised(prepare(model, image, region, expected), followed)
