"""``Unevenness``: bumps, valleys and voids between an object and the elements."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Annotated, ClassVar, NamedTuple

import numpy as np
from annotated_types import Ge, Le
from numpy.typing import NDArray

from tactile_graph_pads.geometry import Geometry

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Bump:
    """One element that stands out by itself, and so takes ``gain`` times its share.

    Parameters
    ----------
    row, column : int
        Element, counted from 0.
    gain : float
        Above 1 for a bump, below 1 for a valley, 0 for a void.
    """

    row: Annotated[int, Ge(0)]
    column: Annotated[int, Ge(0)]
    gain: Annotated[float, Ge(0)]
    __pydantic_config__: ClassVar[dict[str, str]] = {"extra": "forbid"}


class Fields(NamedTuple):
    """Standard normal fields behind bumps and behind voids, each shape (rows, columns)."""

    bumps: Array
    voids: Array


@dataclass(frozen=True)
class Unevenness:
    """How unevenly an object's load comes down (thesis section 2.4, figures 2.12 and 2.13).

    Parameters
    ----------
    sigma : float
        Standard deviation of the logarithm of an element's gain.
    correlation_cm : float
        Distance over which the gains' correlation falls to exp(-1/2); 0 for independent ones.
    voids : float
        Share of elements that make no contact at all; voids cluster as bumps do.
    fixed : float
        Share of the variance that belongs to the pad and stays from placement to placement;
        the rest is drawn anew each time an object is put down.
    bumps : tuple of Bump
        Elements known to stand out.
    strays : float
        Share of the elements that no object covers and that bear something all the same, drawn
        anew at each placement: the "random noise points" of thesis figure 4.24.
    stray_g : float
        What each of them bears.
    """

    sigma: Annotated[float, Ge(0)] = 0.0
    correlation_cm: Annotated[float, Ge(0)] = 0.0
    voids: Annotated[float, Ge(0), Le(1)] = 0.0
    fixed: Annotated[float, Ge(0), Le(1)] = 0.0
    bumps: tuple[Bump, ...] = ()
    strays: Annotated[float, Ge(0), Le(1)] = 0.0
    stray_g: Annotated[float, Ge(0)] = 15.0
    __pydantic_config__: ClassVar[dict[str, str]] = {"extra": "forbid"}

    @cached_property
    def _void_level(self) -> float:
        from statistics import NormalDist

        if self.voids in (0.0, 1.0):
            return float("inf") if self.voids else float("-inf")
        return NormalDist().inv_cdf(self.voids)

    def draw(self, geometry: Geometry, rng: np.random.Generator) -> Fields:
        """Return fresh fields for a placement (or, once a run, for the pad itself)."""
        white = rng.standard_normal((2, *geometry.shape))
        if self.correlation_cm > 0.0:
            down = _root(geometry.y_cm, self.correlation_cm)
            across = _root(geometry.x_cm, self.correlation_cm)
            white = down @ white @ across.T
        return Fields(white[0], white[1])

    def gains(self, of_pad: Fields, of_placement: Fields) -> Array:
        """Return each element's gain, shape (rows, columns); 0 in a void.

        Parameters
        ----------
        of_pad, of_placement : Fields
            As drawn; mixed so that ``fixed`` of the variance is the pad's.
        """
        a, b = np.sqrt(self.fixed), np.sqrt(1.0 - self.fixed)
        gains = np.exp(self.sigma * (a * of_pad.bumps + b * of_placement.bumps))
        gains[a * of_pad.voids + b * of_placement.voids < self._void_level] = 0.0
        for bump in self.bumps:
            gains[bump.row, bump.column] *= bump.gain
        return np.asarray(gains)

    def strays_g(self, covered_cm2: Array, rng: np.random.Generator) -> Array:
        """Return what elements bear that no object covers, shape (rows, columns), in grams.

        Parameters
        ----------
        covered_cm2 : ndarray of float64, shape (rows, columns)
            How much of each element objects cover.
        rng : numpy.random.Generator
        """
        hit = (rng.random(covered_cm2.shape) < self.strays) & (covered_cm2 <= 0.0)
        return np.where(hit, self.stray_g, 0.0)


def _root(at_cm: Array, correlation_cm: float) -> Array:
    """Return a matrix that gives white noise a Gaussian correlation along one axis."""
    distance = at_cm[:, None] - at_cm[None, :]
    values, vectors = np.linalg.eigh(np.exp(-0.5 * (distance / correlation_cm) ** 2))
    return np.asarray(vectors * np.sqrt(np.maximum(values, 0.0)))
