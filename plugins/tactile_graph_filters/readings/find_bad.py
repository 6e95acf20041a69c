"""Step ``find_bad``: elements that behave unlike the others found and made invalid."""

from __future__ import annotations

from typing import Annotated

import numpy as np
from annotated_types import Ge, Gt, Le
from numpy.typing import NDArray

from tactile_graph.errors import DataError
from tactile_graph.steps.rules import Grid, Quantity
from tactile_graph.wires import Image
from tactile_graph_filters.nan import finite, refuse_nan

MAD_TO_SIGMA = 1.4826
"""Of a normal distribution: standard deviation over median absolute deviation."""


class FindBad:
    """Find broken elements in the first frames, taken of the empty pad; make them invalid.

    Parameters
    ----------
    n_frames : int
        How many frames to look at; before that nothing is found.
    n_sigma : float
        How far from the others, in robust standard deviations, an element's mean (hot) or the
        logarithm of its noise (noisy) must be.
    dead : bool
        Whether an element that never changes while most others do is broken too. Switch it off
        for converters so coarse that an empty pad reads the same count for long.

    Notes
    -----
    An element is hot if its mean is off the median of all by more than ``n_sigma`` robust
    standard deviations (1.4826 times the median absolute deviation) and by more than ``n_sigma``
    times the median noise, so that an even pad is not judged by rounding. Only valid readings
    count, and only elements that have one in at least half of the frames are judged, by one
    another. State: what was found.
    """

    def __init__(
        self,
        *,
        n_frames: Annotated[int, Ge(2), Le(10_000)] = 30,
        n_sigma: Annotated[float, Gt(0)] = 8.0,
        dead: bool = True,
    ) -> None:
        self._n_frames, self._n_sigma, self._dead = n_frames, n_sigma, dead
        self._seen = 0
        self._n: NDArray[np.int64] = np.zeros((0, 0), np.int64)
        self._mean: NDArray[np.float64] = np.zeros((0, 0))
        self._squares: NDArray[np.float64] = np.zeros((0, 0))
        self._good: NDArray[np.bool_] | None = None

    def __call__(
        self, image: Image
    ) -> Annotated[Image, Quantity.like("image"), Grid.like("image")]:
        """Return the image with what was found so far invalid.

        Raises
        ------
        DataError
            If a valid cell holds NaN or infinity, or the shape changed since the first frame.
        """
        if self._seen and self._mean.shape != image.shape:
            raise DataError(
                "image", f"must keep its shape, got {image.shape} after {self._mean.shape}"
            )
        if self._seen < self._n_frames:
            self._look(image)
        if self._good is None or self._good.all():
            return image
        valid = self._good.copy() if image.valid is None else self._good & image.valid
        return image.with_values(np.where(valid, image.values, 0.0), valid=valid)

    def _look(self, image: Image) -> None:
        """Take one frame into the running mean and variance (Welford 1962)."""
        if not finite(image.values):
            refuse_nan(image, infinite=True)
        values = image.filled(0.0).astype(np.float64)
        valid = np.ones(values.shape, np.bool_) if image.valid is None else image.valid
        self._seen += 1
        if self._seen == 1:
            self._n, self._mean = valid.astype(np.int64), values
            self._squares = np.zeros(values.shape)
            return
        self._n = self._n + valid
        off = np.where(valid, values - self._mean, 0.0)
        self._mean = self._mean + off / np.maximum(self._n, 1)
        self._squares = self._squares + off * (values - self._mean)
        if self._seen == self._n_frames:
            judged = self._n >= max(2.0, 0.5 * self._n_frames)
            self._good = ~judged
            if judged.any():
                n = self._n[judged]
                noise = np.sqrt(self._squares[judged] / (n - 1))
                self._good[judged] = self._judge(self._mean[judged], noise, n)

    def _judge(
        self, mean: NDArray[np.float64], noise: NDArray[np.float64], n: NDArray[np.int64]
    ) -> NDArray[np.bool_]:
        """Return which elements are good, by the mean and noise of their n readings each."""
        usual = float(np.median(noise))
        far = np.abs(mean - np.median(mean))
        spread = MAD_TO_SIGMA * float(np.median(far))
        good: NDArray[np.bool_] = far <= self._n_sigma * max(spread, usual, _smallest(mean))
        changing = noise > 0.0
        if usual > 0.0:
            logs = np.log(noise[changing])
            off = np.abs(logs - np.median(logs))
            # Even equal elements scatter: the log of a noise estimate by about 1 / sqrt(2 n).
            scatter = np.maximum(MAD_TO_SIGMA * float(np.median(off)), (2.0 * n[changing]) ** -0.5)
            loud = logs > np.median(logs) + self._n_sigma * scatter
            good[changing] &= ~loud
            if self._dead:
                good &= changing
        return good


def _smallest(mean: NDArray[np.float64]) -> float:
    """Return a spread below which differences are rounding."""
    return float(np.finfo(np.float64).eps * np.abs(mean).max())
