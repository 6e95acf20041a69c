"""The curves a calibration may have: grams on an element as a function of its reading."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import Annotated, ClassVar, Literal

import numpy as np
from annotated_types import Gt, Len
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Polynomial:
    """Grams as a polynomial of the reading; the thesis' is of the fifth order (figure 2.18).

    Parameters
    ----------
    kind : "polynomial"
    coefficients : tuple of float
        Grams for each power of the reading, constant first; the constant is 0.
    """

    kind: Literal["polynomial"]
    coefficients: Annotated[tuple[float, ...], Len(2)]
    __pydantic_config__: ClassVar[dict[str, str]] = {"extra": "forbid"}

    def grams(self, readings: Array) -> Array:
        """Return the grams behind readings within the calibrated range."""
        return np.asarray(np.polyval(self.coefficients[::-1], readings))


@dataclass(frozen=True)
class Isotonic:
    """Straight lines between points that rise: monotone, and nothing else is assumed.

    Parameters
    ----------
    kind : "isotonic"
    points : tuple of (float, float)
        Reading and grams, rising, from (0, 0) on.
    """

    kind: Literal["isotonic"]
    points: Annotated[tuple[tuple[float, float], ...], Len(2)]
    __pydantic_config__: ClassVar[dict[str, str]] = {"extra": "forbid"}

    def __post_init__(self) -> None:
        if self.points[0] != (0.0, 0.0):
            raise ValueError(f"points (reading, grams) must start at (0, 0), got {self.points[0]}")
        for (r0, g0), (r1, g1) in pairwise(self.points):
            if not (r0 < r1 and g0 <= g1):
                raise ValueError(
                    f"points (reading, grams) must rise, got ({r1:g}, {g1:g}) "
                    f"after ({r0:g}, {g0:g})"
                )

    def grams(self, readings: Array) -> Array:
        """Return the grams behind readings within the calibrated range."""
        of, grams = np.array(self.points).T
        return np.asarray(np.interp(readings, of, grams))


@dataclass(frozen=True)
class PowerLaw:
    """Grams as ``scale_g * (reading / unit) ** exponent``; true of conductance, not of volts.

    Parameters
    ----------
    kind : "power"
    scale_g : float
        Grams at the reading ``unit``.
    exponent : float
        How much steeper than a straight line.
    unit : float
        Keeps the scale a number that can be read, where readings are microsiemens.
    """

    kind: Literal["power"]
    scale_g: Annotated[float, Gt(0)]
    exponent: Annotated[float, Gt(0)]
    unit: Annotated[float, Gt(0)] = 1.0
    __pydantic_config__: ClassVar[dict[str, str]] = {"extra": "forbid"}

    def grams(self, readings: Array) -> Array:
        """Return the grams behind readings within the calibrated range."""
        return np.asarray(self.scale_g * (readings / self.unit) ** self.exponent)
