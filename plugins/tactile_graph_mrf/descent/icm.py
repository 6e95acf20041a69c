"""Step ``icm``: iterated conditional modes, the nearest minimum of the energy."""

from __future__ import annotations

from typing import Annotated

from annotated_types import Ge, Le

from tactile_graph.wires import Image, Mask
from tactile_graph_mrf.descent.modes import settle
from tactile_graph_mrf.energy.line_field import Restored
from tactile_graph_mrf.energy.model import Model
from tactile_graph_mrf.energy.problem import Problem, prepare
from tactile_graph_mrf.energy.state import State, minimised, observed_state


def icm(
    image: Image,
    region: Mask | None = None,
    expected: Image | None = None,
    *,
    model: Model = Model(),  # noqa: B008 -- frozen
    n_sweeps: Annotated[int, Ge(1), Le(1_000_000)] = 200,
) -> Restored:
    """Restore an image by giving each cell and line its best state in turn until none changes.

    Starts at the observations. No sweep raises the energy; what is reached is a minimum with
    regard to changes of a single cell or line, and seldom the least one.

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
    n_sweeps : int
        Sweeps at most.

    Returns
    -------
    Restored

    Raises
    ------
    DataError
        If region or expected load have another shape than the image.
    Degenerate
        If no cell holds a value.

    Notes
    -----
    J. Besag, "On the statistical analysis of dirty pictures" (1986), DOI
    10.1111/j.2517-6161.1986.tb01412.x.
    """

    def settled(problem: Problem) -> tuple[State, list[float]]:
        state = observed_state(problem)
        return state, settle(problem, state, n_sweeps)

    return minimised(prepare(model, image, region, expected), settled)
