"""Step ``gibbs``: simulated annealing with the Gibbs sampler (thesis section 5.2.3)."""

from __future__ import annotations

from typing import Annotated, Literal

import numpy as np
from annotated_types import Ge, Gt, Le

from tactile_graph.wires import Image, Mask
from tactile_graph_mrf.energy.line_field import Restored
from tactile_graph_mrf.energy.model import Model
from tactile_graph_mrf.energy.problem import Problem, prepare
from tactile_graph_mrf.energy.state import State, minimised, observed_state, random_state
from tactile_graph_mrf.samplers.annealing import Schedule, annealed, temperatures


def gibbs(
    image: Image,
    region: Mask | None = None,
    expected: Image | None = None,
    *,
    rng: np.random.Generator,
    model: Model = Model(),  # noqa: B008 -- frozen
    temperature: Annotated[float, Ge(1e-6), Le(1e12)] = 5.0,
    cooling: Annotated[float, Gt(0), Le(1)] = 0.9,
    n_sweeps: Annotated[int, Ge(1), Le(1_000_000)] = 110,
    schedule: Schedule = "geometric",
    energy_scale: Annotated[float, Ge(1e-12), Le(1e12)] = 1.0,
    start: Literal["random", "observed"] = "random",
) -> Restored:
    """Restore an image, and the lines in it, by annealing with the Gibbs sampler.

    A sweep visits each cell and each line site once and draws its state from its conditional
    distribution given all others (Eq. 5.9, 5.10, 5.19), at the sweep's temperature; it ends at
    the state of the last sweep. A constant image or an empty region is given back as it is, and
    annealing ends once nothing can change.

    Parameters
    ----------
    image : Image
        As recorded; cells that are invalid or not finite are inferred from their neighbours.
    region : Mask, optional
        Restore these cells only, as if the pad ended there.
    expected : Image, optional
        Expected load, which counts by the model's ``lambda_prior``.
    rng : numpy.random.Generator
    model : Model
        What is minimised.
    temperature : float
        Of the first sweep; 5 in the thesis.
    cooling : float
        Factor from one sweep's temperature to the next for the geometric schedule.
    n_sweeps : int
        110 in the thesis.
    schedule : str
        ``geometric`` (the thesis'), ``logarithmic`` or ``linear``.
    energy_scale : float
        Factor on the energy, which is in squared levels: P is in proportion to
        exp(-energy_scale U / T). At 1, T = 5 is so cold on 200 levels that a start is frozen in;
        1 / 200² counts in squares of the image's range.
    start : str
        X(0): ``random`` (the thesis') or ``observed``.

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
    Geman and Geman (1984), DOI 10.1109/TPAMI.1984.4767596. The draws are exact to the rounding
    of a cumulative sum.
    """

    def sampled(problem: Problem) -> tuple[State, list[float]]:
        state = random_state(problem, rng) if start == "random" else observed_state(problem)
        betas = energy_scale / temperatures(schedule, temperature, cooling, n_sweeps)
        return state, annealed(problem, state, betas, rng)

    return minimised(prepare(model, image, region, expected), sampled)
