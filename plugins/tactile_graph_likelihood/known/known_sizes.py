"""A belief about an outline's sizes alone, as a model takes it, and what it is worth."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from tactile_graph_likelihood.geometry.outlines import Values, sizes, unknowns
from tactile_graph_likelihood.single.model import Model
from tactile_graph_likelihood.single.readings import Readings


class KnownSizes(NamedTuple):
    """Sizes of an object that was seen before, or is stated.

    ``mean`` holds radius, half axes or half sides in cm, the longer first; ``covariance`` in cm2.
    """

    mean: Values
    covariance: Values

    def belief(self, model: Model) -> tuple[Values, Values]:
        """Return mean and precision of a normal belief about all of an outline's numbers.

        The prior of a size falls as 1 / size; the mean is moved so that belief times prior has
        the mean that was given.
        """
        n, first = len(self.mean), unknowns.call(model.kind, model.corners)
        mean, precision = np.zeros(first), np.zeros((first, first))
        mean[2 : 2 + n] = self.mean + self.covariance @ (1.0 / self.mean)
        precision[2 : 2 + n, 2 : 2 + n] = np.linalg.inv(self.covariance)
        return mean, precision

    def log_share(self, model: Model, readings: Readings) -> float:
        """Return the logarithm of the integral of belief times the prior of the sizes.

        What the evidence under the belief must be divided by to be that of a proper prior: the
        integral, and 2 where the longer of two sizes has a name, for the prior takes both orders.
        The readings tell the range of sizes where the model does not.
        """
        smallest, largest = model.range_cm(readings)
        span = math.log(largest / smallest)
        n = len(self.mean)
        sign, log_det = np.linalg.slogdet(2.0 * math.pi * self.covariance)
        assert sign > 0
        moved = self.covariance @ (1.0 / self.mean)
        tilt = -0.5 * float(moved @ np.linalg.solve(self.covariance, moved))
        total = 0.5 * float(log_det) - float(np.log(self.mean * span).sum()) + tilt
        return total + (math.log(2.0) if n == 2 else 0.0)


def sizes_of(kind: int, mean: Values, covariance: Values) -> KnownSizes:
    """Return the sizes within an outline's mean and covariance, the longer first."""
    n = sizes.call(kind)
    at = np.arange(2, 2 + n)
    if n == 2 and mean[3] > mean[2]:
        at = at[::-1]
    return KnownSizes(mean[at], covariance[np.ix_(at, at)])
