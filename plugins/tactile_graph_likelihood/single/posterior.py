"""``Posterior``: what a frame says about an outline, with its uncertainty."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np

from tactile_graph.wires import Shape
from tactile_graph_likelihood.geometry.outlines import (
    Values,
    packed,
    period,
    sizes,
    unknowns,
    unpacked,
)

UNLIKELY = -3.0
ALIKE = 3.0
CERTAIN = 0.9


def normal_reach(n: int, points: float) -> float:
    """Return the squared distance within which 90 % of a normal distribution of n numbers lies.

    Distance is by a mean and covariance that come from so many points (Hotelling's T squared).
    """
    from scipy.special import fdtri

    points = max(points, n + 2.0)
    scale = n * (points - 1.0) * (points + 1.0) / (points * (points - n))
    return scale * float(fdtri(n, points - n, CERTAIN))


@dataclass(frozen=True, eq=False)
class Posterior:
    """What a frame says about an outline: its kind's numbers, in the order of `outlines`.

    Parameters
    ----------
    kind, corners : int
        Kind of outline, as in `outlines`.
    mean : ndarray, shape (K,)
        Posterior mean of the outline's numbers, of the logarithm of a covered element's load and
        of what was estimated of the noise. The angle of a rectangle or ellipse is that of the
        first size, which need not be the longer.
    covariance : ndarray, shape (K, K)
    points, weights : ndarray, shape (N, K) and (N,)
        The weighted points they come from; weights sum to 1.
    most_likely : ndarray, shape (K,)
        The point with the largest posterior density.
    log_evidence : float
        Logarithm of the frame's likelihood under this kind of outline, over that of a bare pad.
    equal_points : float
        How many equally weighted points the weights are worth.
    surprise, neighbours, lean, fall : float
        As in `GoodnessOfFit`.
    pressures : dict of str to float
        How likely the pressure is even, leaning, falling to the rim, or spread by foam, of what
        was looked at.
    """

    kind: int
    corners: int
    mean: Values
    covariance: Values
    points: Values
    weights: Values
    most_likely: Values
    log_evidence: float
    equal_points: float
    surprise: float
    neighbours: float
    lean: float = 0.0
    fall: float = 0.0
    pressures: Mapping[str, float] = field(default_factory=lambda: {"even": 1.0})

    def summary(self) -> dict[str, Any]:
        """Return what lines a frame tell of it: its single numbers; the shape has the rest."""
        numbers = "log_evidence", "equal_points", "surprise", "neighbours", "lean", "fall"
        names = "kind", "corners", *numbers, "pressures"
        return {name: getattr(self, name) for name in names}

    @property
    def fits(self) -> bool:
        """Whether the frame looks like the model's: no great surprise, no pattern left over."""
        return self.surprise > UNLIKELY and self.alike < ALIKE

    @property
    def alike(self) -> float:
        """The largest of the residuals' patterns: neighbours alike, a lean, a fall or a rise."""
        return max(self.neighbours, self.lean, math.sqrt(2.0) * abs(self.fall) - 1.0)

    @cached_property
    def reach(self) -> float:
        """Squared Mahalanobis distance within which 90 % of the posterior lies.

        That of the weighted points, but no less than that of a normal distribution: the points
        nearest the mean made the mean, so by themselves they promise too much.
        """
        n = unknowns.call(self.kind, self.corners)
        return max(self._reach_of_points(n), normal_reach(n, self.independent_points))

    @property
    def independent_points(self) -> float:
        """How many points, each by itself, would tell the covariance as well."""
        return self.equal_points

    def _reach_of_points(self, n: int) -> float:
        """Return the squared distance within which 90 % of the weighted points lie."""
        distances = self._squared(self.points[:, :n])
        order = np.argsort(distances)
        passed = np.cumsum(self.weights[order])
        at = min(int(np.searchsorted(passed, CERTAIN)), len(order) - 1)
        return float(distances[order][at])

    def _squared(self, outlines: Values) -> Values:
        n = unknowns.call(self.kind, self.corners)
        off = outlines - self.mean[:n]
        return np.asarray((off * np.linalg.solve(self.covariance[:n, :n], off.T).T).sum(axis=1))

    def contains(self, shape: Shape) -> bool:
        """Return whether a shape of this kind lies in the 90 % region."""
        return bool(self._squared(self.numbers(shape)[None])[0] <= self.reach)

    def numbers(self, shape: Shape) -> Values:
        """Return a shape's numbers, of its equal descriptions the one nearest the mean."""
        kind, _, p = packed(shape)
        if kind != self.kind and not (self.corners == getattr(shape, "count", -1)):
            raise ValueError(f"a {type(shape).__name__} is not of this posterior's kind")
        turn = period.call(self.kind, self.corners)
        if turn > 0.0 and sizes.call(kind) == 2:
            quarters = round((self.mean[4] - p[4]) / turn)
            p[4] += quarters * turn
            if quarters % 2:
                p[2], p[3] = p[3], p[2]
        return p

    @property
    def most_likely_shape(self) -> Shape:
        """The outline with the largest posterior density."""
        return unpacked(self.kind, self.corners, self.most_likely)

    def std(self, k: int) -> float:
        """Return the posterior standard deviation of one of the outline's numbers."""
        return math.sqrt(max(float(self.covariance[k, k]), 0.0))

    @property
    def centre_std_cm(self) -> float:
        """Root mean square distance of the centre from its mean."""
        n = unknowns.call(self.kind, self.corners)
        if sizes.call(self.kind) == 0:
            c = self.covariance[:n, :n] / self.corners**2
            return math.sqrt(float(c[0::2, 0::2].sum() + c[1::2, 1::2].sum()))
        return math.hypot(self.std(0), self.std(1))
