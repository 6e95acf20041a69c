"""``Scan``: from volts to counts and back, through samples, noise and a converter."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, ClassVar

import numpy as np
from annotated_types import Ge, Le
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Converter:
    """An analogue to digital converter.

    Parameters
    ----------
    bits : int, optional
        Resolution; None for an ideal converter that neither rounds nor limits.
    low_v, high_v : float
        Range; the thesis' card takes -5 to 5 V with 12 bits, so a step is 2.44 mV.
    """

    bits: Annotated[int, Ge(1), Le(32)] | None = 12
    low_v: float = -5.0
    high_v: float = 5.0
    __pydantic_config__: ClassVar[dict[str, str]] = {"extra": "forbid"}

    def __post_init__(self) -> None:
        if self.high_v <= self.low_v:
            raise ValueError(
                f"converter: high_v must be above low_v, got {self.low_v:g} to {self.high_v:g}"
            )

    @property
    def step_v(self) -> float:
        """Volts of one count; for an ideal converter one volt, counted from 0 V."""
        return 1.0 if self.bits is None else (self.high_v - self.low_v) / 2**self.bits

    @property
    def zero_counts(self) -> float:
        """What 0 V reads as."""
        return 0.0 if self.bits is None else -self.low_v / self.step_v

    def counts(self, volts: Array) -> Array:
        """Return what the converter reads, whole numbers within its range, same shape."""
        if self.bits is None:
            return np.array(volts, dtype=np.float64)
        return self._rounded(volts / self.step_v + self.zero_counts)

    def _rounded(self, counts: Array) -> Array:
        """Round and limit ``counts`` in place: a scan's samples are worth no second array."""
        np.rint(counts, out=counts)
        return np.clip(counts, 0.0, 2.0 ** (self.bits or 0) - 1.0, out=counts)

    def mean_counts(self, noise: Array, volts: Array, scale_v: Array | float) -> Array:
        """Return the mean count over samples of ``volts`` with noise, shape (rows, columns).

        Parameters
        ----------
        noise : ndarray of float64, shape (samples, rows, columns)
            Standard normal; used up.
        volts : ndarray of float64, shape (rows, columns)
        scale_v : float or ndarray
            Standard deviation of the noise.
        """
        noise *= scale_v / self.step_v
        noise += volts / self.step_v + self.zero_counts
        return np.asarray((noise if self.bits is None else self._rounded(noise)).mean(axis=0))

    def volts(self, counts: Array) -> Array:
        """Return the volts that (averaged) counts stand for, same shape."""
        return np.asarray((counts - self.zero_counts) * self.step_v)

    @property
    def max_v(self) -> float:
        """Largest voltage that can be read; infinite for an ideal converter."""
        return float("inf") if self.bits is None else self.high_v - self.step_v


@dataclass(frozen=True)
class Scan:
    """How one frame is read: each element some times, then averaged.

    Parameters
    ----------
    samples : int
        Readings of one element that are averaged; the thesis takes 100 and finds 10 as good.
    noise_v : float
        Standard deviation of one reading before conversion.
    sample_s : float
        Time one reading takes; 2 ms make the thesis' "less than one minute" a scan.
    """

    samples: Annotated[int, Ge(1)] = 100
    noise_v: Annotated[float, Ge(0)] = 0.002
    sample_s: Annotated[float, Ge(0)] = 0.002
    __pydantic_config__: ClassVar[dict[str, str]] = {"extra": "forbid"}

    def frame_s(self, n_elements: int) -> float:
        """Return the time one frame takes."""
        return self.samples * self.sample_s * n_elements

    def counts(
        self,
        volts: Array,
        converter: Converter,
        rng: np.random.Generator,
        noise_scale: Array | float = 1.0,
    ) -> Array:
        """Return the mean counts of each element, shape (rows, columns).

        Parameters
        ----------
        volts : ndarray of float64, shape (rows, columns)
            True voltages at the converter's input.
        converter : Converter
        rng : numpy.random.Generator
            Draws the noise; untouched where ``noise_v`` is 0.
        noise_scale : ndarray of float64, shape (rows, columns), optional
            Factor of each element's noise.
        """
        if self.noise_v == 0.0:
            return converter.counts(volts)
        noise = rng.standard_normal((self.samples, *volts.shape))
        return converter.mean_counts(noise, volts, self.noise_v * noise_scale)
