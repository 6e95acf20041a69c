"""Step ``posterior``: what the data leave open, from samples of the Gibbs sampler."""

from __future__ import annotations

from typing import Annotated, NamedTuple

import numpy as np
from annotated_types import Ge, Gt, Le
from numpy.typing import NDArray

from tactile_graph.wires import Image, Mask
from tactile_graph_mrf.energy.layout import layout
from tactile_graph_mrf.energy.line_field import LineField, no_lines
from tactile_graph_mrf.energy.model import Model
from tactile_graph_mrf.energy.problem import Problem, prepare
from tactile_graph_mrf.energy.state import State, observed_state, sites_of
from tactile_graph_mrf.samplers.annealing import BLOCK, annealed
from tactile_graph_mrf.samplers.effective_size import effective_size
from tactile_graph_mrf.samplers.sample import Sums, sample

N_PROBES = 256
"""Cells, spread over the field, whose samples are kept to tell the effective sample size."""


class Posterior(NamedTuple):
    """Mean, spread and line probabilities of the images the data allow.

    ``mean`` and ``deviation`` are in the unit of the image. The probabilities are of the lines
    of `LineField` ``lines``, which holds those above one half. ``effective_samples`` is how many
    independent samples are worth the ``samples`` taken, for the worst of the energy and up to
    256 cells: the mean of a cell is known to deviation / sqrt(effective_samples).
    """

    mean: Image
    deviation: Image
    lines: LineField
    horizontal_probability: NDArray[np.float64]
    vertical_probability: NDArray[np.float64]
    effective_samples: float
    samples: int
    trace: tuple[float, ...]


def posterior(
    image: Image,
    region: Mask | None = None,
    expected: Image | None = None,
    *,
    rng: np.random.Generator,
    model: Model = Model(),  # noqa: B008 -- frozen
    temperature: Annotated[float, Ge(1e-6), Le(1e12)] = 1.0,
    energy_scale: Annotated[float, Gt(0), Le(1e12)] | None = None,
    n_burn: Annotated[int, Ge(0), Le(1_000_000)] = 200,
    n_samples: Annotated[int, Ge(2), Le(100_000)] = 500,
    n_between: Annotated[int, Ge(1), Le(1000)] = 1,
) -> Posterior:
    """Return mean, standard deviation and line probabilities by sampling at one temperature.

    Starts at the observations. A constant image or an empty region is not swept: it has no
    spread and no lines.

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
        Its ``sigma`` matters here even if the noise is Gaussian.
    temperature : float
        T of Eq. 5.4; 1 for the posterior itself.
    energy_scale : float, optional
        Factor on the energy; 1 / (2 sigma²) if not given, which makes the data term the
        likelihood of Eq. 5.14.
    n_burn : int
        Sweeps before the first sample.
    n_samples : int
        Samples that are drawn.
    n_between : int
        Sweeps from one sample to the next.

    Returns
    -------
    Posterior

    Raises
    ------
    DataError
        If region or expected load have another shape than the image.
    Degenerate
        If no cell holds a value.

    Notes
    -----
    Sections 5.1.2 and 5.2.3; effective sample size after C. J. Geyer (1992), DOI
    10.1214/ss/1177011137, with the initial monotone sequence.
    """
    problem = prepare(model, image, region, expected)
    if problem.idle:
        return _certain(problem)
    scale = 0.5 / model.sigma**2 if energy_scale is None else energy_scale
    beta = scale / temperature
    state = observed_state(problem)
    if n_burn:
        annealed(problem, state, np.full(n_burn, beta), rng)
    return _sampled(problem, state, beta, rng, n_samples, n_between)


def _certain(problem: Problem) -> Posterior:
    image = problem.restored(np.zeros(problem.shape, np.int64))
    across, down = no_lines(problem.shape)
    spread = image.with_values(np.zeros(problem.shape))
    lines = LineField.of(image, across, down)
    return Posterior(image, spread, lines, np.zeros(across.shape), np.zeros(down.shape), 0.0, 0, ())


def _sampled(
    problem: Problem,
    state: State,
    beta: float,
    rng: np.random.Generator,
    n_samples: int,
    n_between: int,
) -> Posterior:
    tables = layout(problem)
    visits = len(tables.cells) + len(tables.sites)
    sites = sites_of(state)
    sums = Sums(
        problem.start(),
        np.zeros(problem.shape),
        np.zeros(problem.shape),
        np.zeros(sites.lines.shape),
        tables.cells[:: max(1, -(-len(tables.cells) // N_PROBES))].copy(),
    )
    seen = np.empty((n_samples, len(sums.probes) + 1))
    per_block = max(1, BLOCK // max(visits * n_between, 1))
    for start in range(0, n_samples, per_block):
        part = seen[start : start + per_block]
        uniforms = rng.random((len(part), n_between, visits))
        fixed = problem.potentials, problem.gaussian, tables
        sample.call(*fixed, beta, uniforms, sites, sums, part)
    return _summed(problem, sums, seen)


def _summed(problem: Problem, sums: Sums, seen: NDArray[np.float64]) -> Posterior:
    n_samples = len(seen)
    mean = sums.labels / n_samples
    probability: NDArray[np.float64] = sums.on / n_samples
    spread = np.sqrt(np.maximum(sums.squares / n_samples - mean**2, 0.0)) * problem.step
    across, down = no_lines(problem.shape)
    n = across.size
    h, v = probability[:n].reshape(across.shape), probability[n:].reshape(down.shape)
    image = problem.restored(mean + sums.origin)
    return Posterior(
        image,
        image.with_values(np.where(problem.in_field, spread, 0.0)),
        LineField.of(image, h > 0.5, v > 0.5),
        h,
        v,
        effective_size(seen),
        n_samples,
        tuple(seen[:, -1].tolist()),
    )
