"""Relief and presses of an object fitted together, from coarse to fine."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize

from tactile_graph_classifiers.reliefs.kernels import cost_of_all
from tactile_graph_classifiers.reliefs.pad_reading import PadReading
from tactile_graph_classifiers.reliefs.presses import MARGIN, Presses
from tactile_graph_classifiers.reliefs.relief import Relief

Array = NDArray[np.float64]
STIFF = 0.3
"""What a kink of the relief costs."""
SMALL = 0.05
"""Kinks smaller than this cost by their square."""
COARSER = (2, 4, 8)


def scales(n_nodes: int) -> list[Array]:
    """Return interpolations from coarser grids, shape (nodes, m): descents go in large steps."""
    out = []
    for step in COARSER:
        at = np.arange(n_nodes) / step
        whole = at.astype(int)
        up = np.zeros((n_nodes, (n_nodes + step - 1) // step + 1))
        up[np.arange(n_nodes), whole] += 1.0 - (at - whole)
        up[np.arange(n_nodes), np.minimum(whole + 1, up.shape[1] - 1)] += at - whole
        out.append(up * math.sqrt(step) / 1.4)
    return out


def kinks(depth: Array) -> tuple[float, Array]:
    """Return what the kinks of a relief cost, and the gradient."""
    cost, gradient = 0.0, np.zeros_like(depth)
    for x, out in ((depth, gradient), (depth.T, gradient.T)):
        second = np.diff(x, 2, axis=0)
        size = np.sqrt(second**2 + SMALL**2)
        cost += STIFF * float((size - SMALL).sum())
        pull = STIFF * second / size
        out[:-2] += pull
        out[1:-1] -= 2.0 * pull
        out[2:] += pull
    return cost, gradient


def descend(
    relief: Relief, presses: Presses, weights: Array, pad: PadReading, n_steps: int
) -> None:
    """Fit relief and presses together by so many steps of L-BFGS, in place."""
    n_nodes, usual = len(relief.depth), relief.usual
    sizes = np.hypot(*(presses.boxes[:, 2:] - 2 * MARGIN).T)
    radius = max(2.0, float(np.median(sizes)) / 2.8)
    unit = 0.3 * np.array([1, 1, 1 / radius, usual, usual / radius, usual / radius])
    ups, base, begun = scales(n_nodes), relief.presses, relief.depth / usual
    ends = np.cumsum([n_nodes**2, *(up.shape[1] ** 2 for up in ups)])
    by_node, by_number = np.zeros((n_nodes, n_nodes)), np.zeros(base.shape)
    taps, law = pad.taps, pad.numbers(relief.soft)

    def depth(x: Array) -> Array:
        out = begun + x[: ends[0]].reshape(begun.shape)
        for up, a, b in zip(ups, ends, ends[1:], strict=False):
            out += up @ x[a:b].reshape(up.shape[1], -1) @ up.T
        return out

    def pressed(x: Array) -> Array:
        return np.asarray(x[ends[-1] :].reshape(base.shape) * unit + base)

    def cost(x: Array) -> tuple[float, Array]:
        now = depth(x)
        total = cost_of_all(now * usual, pressed(x), presses.values, weights, presses.boxes,
                            pad.gains, taps, law, by_node, by_number)  # fmt: skip
        more, gradient = kinks(now)
        gradient += by_node * usual
        parts = [gradient.ravel(), *((up.T @ gradient @ up).ravel() for up in ups)]
        return total + more, np.concatenate([*parts, (by_number * unit).ravel()])

    x = minimize(cost, np.zeros(ends[-1] + base.size), jac=True, method="L-BFGS-B",
                 options={"maxiter": n_steps, "maxcor": 20}).x  # fmt: skip
    relief.depth, relief.presses = depth(x) * usual, pressed(x)
