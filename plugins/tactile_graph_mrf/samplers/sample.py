"""The kernel of `posterior`: sweeps at one temperature and the sums of what they visit."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tactile_graph.compiled import compiled_as_is
from tactile_graph_mrf.energy.conditionals import difference_costs
from tactile_graph_mrf.energy.layout import Layout
from tactile_graph_mrf.energy.potentials import Pairwise, Potentials
from tactile_graph_mrf.energy.state import Sites
from tactile_graph_mrf.energy.total import total
from tactile_graph_mrf.samplers.sweep import sweep_cells, sweep_lines


class Sums(NamedTuple):
    """What samples add up to.

    Parameters
    ----------
    origin : ndarray of int64, shape (rows, columns)
        Taken off the labels, so that little is lost in the sums of squares.
    labels, squares : ndarray of float64, shape (rows, columns)
        Of the labels less ``origin``.
    on : ndarray of float64, shape (M,)
        Of the lines, as `Layout` counts them, or of their probabilities.
    probes : ndarray of int64, shape (P,)
        Cells whose labels are kept.
    """

    origin: NDArray[np.int64]
    labels: NDArray[np.float64]
    squares: NDArray[np.float64]
    on: NDArray[np.float64]
    probes: NDArray[np.int64]


@compiled_as_is
def sample(
    potentials: Potentials, gaussian: bool, layout: Layout, beta: float, uniforms: Any,
    state: Sites, sums: Sums, seen: Any,
) -> None:  # fmt: skip
    """Take a sample after each group of sweeps in ``uniforms`` (samples, sweeps, visits).

    Adds to ``sums``; writes the labels of the probes and the energy into ``seen``
    (samples, probes + 1).
    """
    pairwise, in_field = potentials.pairwise, potentials.unary.in_field
    labels, lines, across, down, _ = state
    origin, label_sums, squares, on, probes = sums
    costs = np.empty((len(pairwise.weights), 2 * len(pairwise.bare) - 1))
    difference_costs(pairwise, beta, costs)
    n = len(layout.cells)
    flat = labels.reshape(-1)
    for t in range(uniforms.shape[0]):
        for s in range(uniforms.shape[1]):
            sweep_cells(potentials, costs, gaussian, layout, beta, uniforms[t, s, :n], state)
            sweep_lines(potentials, costs, layout.sites, beta, uniforms[t, s, n:], state)
        for i in range(labels.shape[0]):
            for j in range(labels.shape[1]):
                off = labels[i, j] - origin[i, j]
                label_sums[i, j] += off
                squares[i, j] += off * off
        if pairwise.price >= 0.0:
            add_chances(pairwise, beta, in_field, labels, on)
        else:
            for k in range(len(lines)):
                on[k] += lines[k]
        for q in range(len(probes)):
            seen[t, q] = flat[probes[q]]
        seen[t, len(probes)] = total(potentials, labels, across, down)


@compiled_as_is
def add_chances(pairwise: Pairwise, beta: float, in_field: Any, labels: Any, on: Any) -> None:
    """Add to ``on`` the probability of each line that is summed out, given the labels.

    It is 1 / (1 + exp(beta (price - rho))), which spares the noise of drawing the line.
    """
    price, bare = pairwise.price, pairwise.bare
    rows, columns = labels.shape
    n_across = (rows - 1) * columns
    for i in range(rows):
        for j in range(columns):
            for way in range(2):
                m, n = (i + 1, j) if way == 0 else (i, j + 1)
                if m >= rows or n >= columns or not (in_field[i, j] and in_field[m, n]):
                    continue
                height = beta * (price - bare[abs(labels[i, j] - labels[m, n])])
                k = i * columns + j if way == 0 else n_across + i * (columns - 1) + j
                if height > 0.0:
                    chance = math.exp(-height)
                    on[k] += chance / (1.0 + chance)
                else:
                    on[k] += 1.0 / (1.0 + math.exp(height))
