"""Presses of an object laid on each other by their pictures: where learning a relief begins."""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from tactile_graph_classifiers.reliefs.presses import Presses
from tactile_graph_classifiers.reliefs.relief import (
    TURNS,
    Relief,
    alike,
    nodes_of,
    picture_of,
    radius_of,
)

Array = NDArray[np.float64]
CUT, WIDER = 0.75, 1.3
"""How much more is kept than one press shows, where the edge cuts more than this share of them."""
SHARPER = (8, 8, 4, 4)
"""To which power likeness counts, turn by turn."""
ODD = 0.7
"""Of the logarithm: a press whose sum is off the usual one by more is no good beginning."""


class Laid(NamedTuple):
    """Presses laid on each other.

    Parameters
    ----------
    poses : ndarray, shape (n, 3)
        x, y and turn.
    picture : ndarray, shape (N, N)
        Their mean, each divided by its sum.
    """

    poses: Array
    picture: Array


def laid(presses: Presses, place: int) -> Laid:
    """Return presses laid on the fullest one, or on a lesser (``place`` 1, 2, …)."""
    sums = presses.totals()
    n = len(sums)
    highest = presses.values.max(axis=(1, 2))[:, None, None]
    area = (presses.values > 0.05 * highest).sum(axis=(1, 2))
    odd = np.abs(np.log(sums / np.median(sums))) > ODD
    fullness = area * np.where(odd, 0.5, 1.0) * np.where(presses.cut(), 0.1, 1.0)
    first = int(np.argsort(-fullness)[min(place, n - 1)])
    wider = WIDER if presses.cut().mean() > CUT else 1.0
    n_nodes = nodes_of(radius_of(presses) * wider)
    poses = np.column_stack([presses.centres, np.zeros(n)])
    picture = picture_of(presses, poses, n_nodes, (np.arange(n) == first).astype(float))
    for sharp in SHARPER:
        best = np.zeros(n)
        for k in range(n):
            found = alike(picture, presses, k)
            t = int(np.argmax(found[:, 0]))
            best[k], poses[k] = found[t, 0], (*found[t, 1:], TURNS[t])
        picture = picture_of(presses, poses, n_nodes, np.maximum(best, 0.01) ** sharp)
    return Laid(poses, picture)


def begun(presses: Presses, place: int, soft: float) -> Relief:
    """Return a relief to begin with: the depth that the mean reading of all presses leaves.

    Parameters
    ----------
    presses : Presses
    place : int
        The how manieth fullest press the others are laid on.
    soft : float
        Depth, of the usual one, over which touching begins.
    """
    poses, picture = laid(presses, place)
    sums = presses.totals()
    load = picture * np.median(sums)
    usual = float(np.quantile(load[load > 0.3 * load.max()], 0.8))
    deep = usual * (1.0 + 0.7 * np.clip(np.log(sums / np.median(sums)), -1.0, 1.0))
    n = len(sums)
    return Relief(depth_of(load, usual), np.column_stack([poses, deep, np.zeros((n, 2))]), usual,
                  soft * usual, np.zeros(n), picture, np.zeros(2))  # fmt: skip


def begun_from(whole: Relief, presses: Presses, which: NDArray[np.bool_], soft: float) -> Relief:
    """Return a relief to begin with, of some of the presses that another was learned from.

    Nothing is kept of the other presses but how deep a usual one goes.

    Parameters
    ----------
    whole : Relief
    presses : Presses
        Those chosen.
    which : ndarray of bool, shape (n,)
        Which of the relief's they are.
    soft : float
    """
    each = whole.misfits[which] / presses.n_cells()
    trust = np.where(each <= 1.6 * np.quantile(each, 0.2), 1.0, 1e-3)
    picture = picture_of(presses, whole.presses[which], len(whole.depth), trust)
    load = picture * np.median(presses.totals())
    return replace(
        whole,
        depth=depth_of(load, whole.usual),
        presses=whole.presses[which].copy(),
        soft=soft * whole.usual,
        misfits=whole.misfits[which].copy(),
        picture=picture,
    )


def depth_of(load: Array, usual: float) -> Array:
    """Return the depth of a relief that a load of the usual depth leaves, shape (N, N)."""
    depth, low = usual - load, load < 0.15 * load.max()
    depth[low] += 0.5 * usual * (1.0 - load[low] / (0.15 * load.max()))
    return np.asarray(depth)
