"""Kinds of error, told apart: how far off where something lies, missed there, false elsewhere.

One mean over all frames hides that a choice pays for its time where something lies and wins it back
on an empty pad, or the other way round.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

Reals = NDArray[np.float64]
Flags = NDArray[np.bool_]

SLACK = 1e-9
"""Two sums of the same numbers in another order are no different."""


class Means(NamedTuple):
    """What a choice comes to over some frames; many choices at once in arrays of one shape.

    Parameters
    ----------
    time_us : float
    error : float
        Of the frames where something lies; a missed one counts the price.
    missed : float
        Share of the frames where something lies of which nothing answers within the price.
    false : float
        Share of the frames where nothing lies that are answered all the same.
    failed : float
        Share of the frames in which a step fails: reported and counted, whatever answers then.
    """

    time_us: Any
    error: Any
    missed: Any
    false: Any
    failed: Any

    def within(self, limits: Means) -> Any:
        """Return where none of them is greater than its limit."""
        held = [mine <= most + SLACK for mine, most in zip(self, limits, strict=True)]
        return np.logical_and.reduce(held)


@dataclass(frozen=True, eq=False)
class Truths:
    """In which frames something truly lies, and what no answer there counts.

    Parameters
    ----------
    full : ndarray of bool, shape (n_frames,)
    price : float
        An error this great, or greater, is no answer.
    weights : ndarray of float64, shape (n_frames,)
        For how many frames each counts.
    """

    full: Flags
    price: float
    weights: Reals

    @property
    def none(self) -> Reals:
        """The error of each frame if nothing answers, shape (n_frames,)."""
        return np.where(self.full, self.price, 0.0)

    def taken(self, frames: NDArray[np.int64]) -> Truths:
        """Return some frames of it."""
        return Truths(self.full[frames], self.price, self.weights[frames])

    def parts(self, loss: Reals) -> list[tuple[str, Any, Flags]]:
        """Return each kind of error: its name, each frame's part in it, and of which frames."""
        full = self.full
        return [
            ("error", loss * full, full),
            ("missed", (loss >= self.price) & full, full),
            ("false", (loss > 0.0) & ~full, ~full),
        ]

    def means(self, time_us: Reals, loss: Reals, failed: Flags) -> Means:
        """Return the weighed means of columns of shape (n_frames,) or (n_choices, n_frames).

        Where nothing lies in any frame there is no error, and nothing false where something lies in
        all.
        """

        def mean(its: Any, of: Any = 1.0) -> Any:
            n = (of * self.weights).sum()
            return (its @ self.weights) / n if n > 0.0 else 0.0 * its.sum(axis=-1)

        error, missed, false = (mean(its, of) for _, its, of in self.parts(loss))
        return Means(mean(time_us), error, missed, false, mean(failed))
