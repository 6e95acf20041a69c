"""Annealing: the temperature of each sweep, and the sweeps over a prepared problem."""

from __future__ import annotations

from typing import Literal

import numpy as np
from numpy.typing import NDArray

from tactile_graph_mrf.energy.layout import layout
from tactile_graph_mrf.energy.problem import Problem
from tactile_graph_mrf.energy.state import State, sites_of
from tactile_graph_mrf.samplers.sweep import anneal

Schedule = Literal["geometric", "logarithmic", "linear"]

BLOCK = 1 << 20
"""Uniform numbers drawn at once at most, unless one sweep takes more."""


def temperatures(
    kind: Schedule, first: float, cooling: float, n_sweeps: int
) -> NDArray[np.float64]:
    """Return the temperature of each sweep, falling from ``first``, shape (n_sweeps,).

    Parameters
    ----------
    kind : str
        ``geometric``: T <- cooling T, as in section 5.2.3; ``logarithmic``: first log 2 /
        log(1 + k), for which Geman and Geman (1984, theorem B) prove convergence if ``first``
        is high enough; ``linear``: even steps to 0, which the last sweep is the first not to reach.
    first : float
    cooling : float
        For ``geometric`` only.
    n_sweeps : int

    Returns
    -------
    ndarray of float64
    """
    k = np.arange(n_sweeps, dtype=np.float64)
    if kind == "geometric":
        # Below this the sweeps are at temperature 0 to the last bit, and 1 / T stays finite.
        return np.maximum(first * cooling**k, 1e-200)
    if kind == "logarithmic":
        return np.asarray(first * np.log(2.0) / np.log(2.0 + k))
    return np.asarray(first * (1.0 - k / n_sweeps))


def annealed(
    problem: Problem, state: State, betas: NDArray[np.float64], rng: np.random.Generator
) -> list[float]:
    """Sweep at each inverse temperature in turn; write into ``state``, return the energies.

    Stops early when nothing can change any more; ``betas`` must be finite and not fall. Numbers
    are drawn block by block, in the order of the visits.
    """
    tables = layout(problem)
    visits = len(tables.cells) + len(tables.sites)
    per_block = max(1, BLOCK // max(visits, 1))
    sites = sites_of(state)
    trace: list[float] = []
    for start in range(0, len(betas), per_block):
        block = np.ascontiguousarray(betas[start : start + per_block])
        uniforms = rng.random((len(block), visits))
        energies = np.empty(len(block))
        fixed = problem.potentials, problem.gaussian, tables
        done, frozen = anneal.call(*fixed, block, uniforms, sites, energies)
        trace += energies[:done].tolist()
        if frozen:
            break
    state.across[...], state.down[...] = sites.across, sites.down
    return trace
