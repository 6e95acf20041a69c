"""Each reading against its own object as learned without it: what acceptance is learned from."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from tactile_graph_classifiers.database.known import Known

Array = NDArray[np.float64]
FEWEST = 3
"""Readings an object needs so that two are left when one is taken out."""


class LeftOut(NamedTuple):
    """One object's readings, and its statistics without each of them.

    Parameters
    ----------
    object : int
        Its number among the known.
    readings : ndarray, shape (n, F)
    means : ndarray, shape (n, F)
    scatters : ndarray, shape (n, F, F)
    n_left : int
        Readings behind each of these statistics.
    """

    object: int
    readings: Array
    means: Array
    scatters: Array
    n_left: int


def left_out(known: Known) -> Iterator[LeftOut]:
    """Yield the objects that have enough readings to leave one out.

    Parameters
    ----------
    known : Known
    """
    for k, it in enumerate(known.objects):
        n = len(it.readings)
        if n < FEWEST:
            continue
        off = it.readings - it.statistics.mean
        means = it.statistics.mean - off / (n - 1)
        taken = off[:, :, None] * off[:, None, :] * (n / (n - 1))
        yield LeftOut(k, it.readings, means, it.statistics.scatter - taken, n - 1)


def largest_accepted(ratios: Array, confidence: float) -> float:
    """Return the ratio that a further reading of a known object stays within.

    Parameters
    ----------
    ratios : ndarray, shape (N,)
        Squared distance of each reading to its own object learned without it, over the squared
        distance to be expected.
    confidence : float
        Share of further readings that are to be accepted.

    Notes
    -----
    With readings enough this is an order statistic, which holds whatever their distribution
    (split conformal prediction: Vovk, Gammerman and Shafer, 2005, doi:10.1007/b106715). With
    fewer than 1 / (1 - confidence) it is the largest one, and at least what an exponential
    distribution, the one of two normal features, would give.
    """
    rank = math.ceil((ratios.size + 1) * confidence)
    if rank <= ratios.size:
        return float(np.partition(ratios, rank - 1)[rank - 1])
    return max(float(ratios.max(initial=0.0)), -math.log(1.0 - confidence))
