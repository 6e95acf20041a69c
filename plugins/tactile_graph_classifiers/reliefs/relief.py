"""``Relief``: an object as it presses, and the fit of presses to it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tactile_graph_classifiers.reliefs.kernels import (
    HUBER,
    NODES,
    add_picture,
    expected,
    fitted,
    likeness,
)
from tactile_graph_classifiers.reliefs.pad_reading import PadReading
from tactile_graph_classifiers.reliefs.presses import NOTHING, Presses

Array = NDArray[np.float64]
Fit = tuple[float, Array]
"""The misfit of a press, and the press."""
TURNS = 2.0 * math.pi * np.arange(60) / 60
LARGE, LEANING = 300, np.arange(-6.0, 6.1, 1.5)
"""Cells of a large press, and how far off the middle of what it touches it may lie."""
STARTS, FOLLOWED = 6, 2
"""Turns begun with, and how many of them are followed."""
FIRST_STEPS, STEPS = 4, 20
"""Of each turn begun with, and of those that are followed."""


@dataclass(eq=False)
class Relief:
    """A learned object.

    Parameters
    ----------
    depth : ndarray, shape (N, N)
        Behind the foremost point, at the nodes of a grid around the middle.
    presses : ndarray, shape (n, 6)
        Those it was learned from.
    usual, soft : float
        Depth of a usual press, and over which touching begins.
    misfits : ndarray, shape (n,)
        Of all cells of each press.
    picture : ndarray, shape (N, N)
        Mean of what was read, each press divided by its sum.
    deep : ndarray, shape (2,)
        Depth of a press by the logarithm of its sum: at 0, and slope.
    """

    depth: Array
    presses: Array
    usual: float
    soft: float
    misfits: Array
    picture: Array
    deep: Array

    def trust(self, presses: Presses) -> Array:
        """Return what presses count while their relief is learned: little where they fit badly."""
        each = self.misfits / presses.n_cells()
        return np.where(each <= 3.0 * np.quantile(each, 0.3), 1.0, 0.02)

    def off_a_cell(self, presses: Presses) -> float:
        """Return the mean misfit of a cell."""
        return float(np.mean(self.misfits / presses.n_cells()))

    def start(self, x: float, y: float, turn: float, total: float) -> Array:
        """Return a press to begin with."""
        return np.array([x, y, turn, self.deep @ [1.0, math.log(total)], 0.0, 0.0])


def shifts(box: NDArray[np.int64], shape: tuple[int, ...]) -> Array:
    """Return by how much a press may be off its centre: far if the pad's edge cuts it."""
    large = min(shape) > 20
    ends = (box[:2] == 0) | (box[:2] + box[2:] == shape)
    if ends.any() and large:
        return np.arange(-5.0, 5.1, 1.0)
    return np.arange(-2.0, 2.1, 1.0) if ends.any() or large else np.arange(-1.5, 1.6, 0.75)


def alike(picture: Array, presses: Presses, k: int, off: Array | None = None) -> Array:
    """Return for each of `TURNS` the correlation of a press with a picture, and where.

    Parameters
    ----------
    picture : ndarray, shape (N, N)
    presses : Presses
    k : int
        Which of them.
    off : ndarray, optional
        By how much it may be off its centre, along each axis; by its box if not given.
    """
    box, values = presses.boxes[k], np.maximum(presses.values[k], 0.0)
    stride = 2 if box[2] * box[3] > LARGE else 1
    off = shifts(box, values.shape) if off is None else off
    found: Array = likeness(picture, values, box, TURNS, off, presses.centres[k], stride)
    return found


def picture_of(presses: Presses, poses: Array, n_nodes: int, trust: Array) -> Array:
    """Return the mean of presses laid on each other."""
    total, weight = np.zeros((n_nodes, n_nodes)), np.zeros((n_nodes, n_nodes))
    sums = presses.totals()
    for k, pose in enumerate(poses):
        values = np.maximum(presses.values[k], 0.0) / sums[k]
        add_picture(total, weight, values, pose, float(trust[k]))
    return np.asarray(total / np.maximum(weight, 1e-9))


def starts(relief: Relief, presses: Presses, k: int, n: int = STARTS) -> list[Array]:
    """Return presses to begin with: turns about which the pictures are most alike.

    A large object that leans touches far off its middle: half as many begin as far off as that.
    """
    total = float(np.maximum(presses.values[k], 0.0).sum())
    far = [alike(relief.picture, presses, k)]
    if presses.n_cells()[k] > LARGE:
        far.append(alike(relief.picture, presses, k, LEANING))
    out = []
    for found, most in zip(far, (n, n // 2), strict=False):
        score = found[:, 0]
        peaks = np.flatnonzero((score >= np.roll(score, 1)) & (score >= np.roll(score, -1)))
        out += [
            relief.start(found[t, 1], found[t, 2], TURNS[t], total)
            for t in peaks[np.argsort(-score[peaks])][:most]
        ]
    return out


def everywhere(relief: Relief, presses: Presses, k: int) -> list[Array]:
    """Return presses at every turn and place near the centre."""
    x, y = presses.centres[k]
    total = float(np.maximum(presses.values[k], 0.0).sum())
    return [
        relief.start(x + dx, y + dy, turn, total)
        for turn in TURNS[::3]
        for dx in (-3.0, 0.0, 3.0)
        for dy in (-3.0, 0.0, 3.0)
    ]


def stepped(
    relief: Relief, press: Array, presses: Presses, k: int, weights: Array, pad: PadReading, n: int
) -> Fit:
    """Return the misfit of a press after n steps, and the press."""
    found: Fit = fitted(relief.depth, press, presses.values[k], weights[k], presses.boxes[k],
                        pad.gains, pad.taps, pad.numbers(relief.soft), n)  # fmt: skip
    return found


def begun_with(
    relief: Relief, begun: Sequence[Array], presses: Presses, k: int, weights: Array,
    pad: PadReading,
) -> list[Fit]:  # fmt: skip
    """Return what comes of presses begun with after a few steps, the best first."""
    first = [stepped(relief, one, presses, k, weights, pad, FIRST_STEPS) for one in begun]
    return sorted(first, key=lambda fit: fit[0])


def followed(
    relief: Relief, first: Sequence[Fit], presses: Presses, k: int, weights: Array, pad: PadReading
) -> Fit:
    """Return the least misfit of the best of them after all steps."""
    fits = [stepped(relief, press, presses, k, weights, pad, STEPS)
            for _, press in first[:FOLLOWED]]  # fmt: skip
    return min(fits, key=lambda fit: fit[0])


def read_as(relief: Relief, press: Array, box: NDArray[np.int64], pad: PadReading) -> Array:
    """Return what the cells of a box read of a press."""
    out: Array = expected(relief.depth, press, box, pad.gains, pad.taps, pad.numbers(relief.soft))
    return out


def still(presses: Presses, weights: Array) -> tuple[Array, Array]:
    """Return the misfit of each press's cells that read nothing, if so expected; how many read.

    The former is the same of every object, and hangs on how far the zeros have drifted.
    """
    misfits, n_felt = np.zeros(len(presses.values)), np.zeros(len(presses.values))
    for k, (i, j, m, n) in enumerate(presses.boxes):
        box = np.s_[k, i : i + m, j : j + n]
        nothing = presses.values[box] < NOTHING
        off = (np.abs(presses.values[box]) * np.sqrt(weights[box]))[nothing]
        misfits[k] = np.where(off > HUBER, HUBER * (2.0 * off - HUBER), off**2).sum()
        n_felt[k] = np.count_nonzero(~nothing)
    return misfits, n_felt


def radius_of(presses: Presses) -> float:
    """Return a radius in cells that holds what presses show."""
    return float(1.05 * np.hypot(presses.boxes[:, 2], presses.boxes[:, 3]).max() / 2.0 + 1.5)


def nodes_of(radius: float) -> int:
    """Return how many nodes a relief of a radius in cells has along each side."""
    return 2 * math.ceil(radius * NODES) + 1
