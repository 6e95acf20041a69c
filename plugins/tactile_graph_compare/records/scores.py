"""How far variants are off and how long they take, and how two of them differ in both."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True, eq=False)
class Times:
    """Time per frame of one variant: the sum of the times of the nodes it needed.

    ``per_frame_us`` has shape (n_frames,), in microseconds; frames equal to the one before, which
    cost nothing, hold NaN and are left out of the figures. The rest of a frame's cost (reading
    it, the engine's own hops) is the same for all and stands in `Comparison.fixed_us`.
    """

    per_frame_us: NDArray[np.float64]
    median_us: float
    p95_us: float
    mean_us: float


@dataclass(frozen=True, eq=False)
class Score:
    """How far one variant's quantity is off, over all true objects it could have answered for.

    Errors are found less true, in ``unit``; that of a centre is the distance, of an identity 1
    where it is wrong and 0 where it is right.

    Parameters
    ----------
    variant, quantity, unit : str
        ``unit`` is cm, °, cm² or empty.
    positions : ndarray of int64, shape (n,)
        Row of each target's frame.
    objects : ndarray of int64, shape (n,)
        Number of the true object within its frame's truth; -1 where the quantity is of the whole
        frame (count), or nobody can say which of several was meant.
    errors : ndarray of float64, shape (n,)
        Signed error; NaN where there was no answer.
    mean, median, p95, largest : float or None
        Of the absolute errors; None without any answer.
    bias : float or None
        Mean of the signed errors; of centres the length of the mean offset.
    n_answered, n_missing : int
        True objects with and without an answer.
    n_extra : int
        Answers with nothing there to answer for.
    pareto : bool
        Whether no other variant that answers as often or more is better in mean error without
        being slower, or faster without being worse.
    """

    variant: str
    quantity: str
    unit: str
    positions: NDArray[np.int64]
    objects: NDArray[np.int64]
    errors: NDArray[np.float64]
    mean: float | None
    median: float | None
    p95: float | None
    largest: float | None
    bias: float | None
    n_answered: int
    n_missing: int
    n_extra: int
    pareto: bool = False

    @property
    def absolute(self) -> NDArray[np.float64]:
        """Absolute errors of the answers, shape (n_answered,)."""
        return np.abs(self.errors[~np.isnan(self.errors)])


@dataclass(frozen=True)
class Difference:
    """A variant's absolute error less its reference's, on targets that both answered.

    ``low`` and ``high`` bound the mean at ``level``; None where fewer than six frames differ.
    Negative is better.
    """

    variant: str
    reference: str
    quantity: str
    unit: str
    mean: float | None
    low: float | None
    high: float | None
    level: float
    method: str
    """``bootstrap over frames``, ``normal over frames``, or why there are no bounds."""
    n_both: int
    n_only_variant: int
    n_only_reference: int
    n_neither: int
    p: float | None = None
    """How often a mean as far from 0 would come by chance, were there no difference."""
    for_all: bool = True
    """Whether 0 is left out at ``level`` for all comparisons made beside it together."""

    @property
    def verdict(self) -> str:
        """``better``, ``worse`` or ``no clear difference``: whether the interval leaves out 0.

        ``perhaps better`` and ``perhaps worse`` where that may well be the chance of one among
        many comparisons, ``none in common`` where no target was answered by both.
        """
        if not self.n_both:
            return "none in common"
        perhaps = "" if self.for_all else "perhaps "
        if self.low is not None and self.high is not None:
            if self.high < 0.0:
                return f"{perhaps}better"
            if self.low > 0.0:
                return f"{perhaps}worse"
        return "no clear difference"


@dataclass(frozen=True)
class TimeDifference:
    """A variant's time per frame against its reference's, over the same frames.

    ``low_us`` and ``high_us`` bound the median difference at 95 %; None below six frames. Medians,
    since a frame in which the machine did something else may take a hundred times as long.
    """

    variant: str
    reference: str
    median_us: float
    """Median over frames of the variant's time less the reference's."""
    low_us: float | None
    high_us: float | None
    ratio: float
    """Median over frames of the variant's time by the reference's."""


@dataclass(frozen=True, eq=False)
class Agreement:
    """How far a variant's answers lie from another's, whatever is true.

    Parameters
    ----------
    variant, reference, quantity, unit : str
    positions : ndarray of int64, shape (n,)
        Row of the frame of each pair of answers.
    differences : ndarray of float64, shape (n,)
        The variant's less the reference's; of centres their distance, of identities 1 where the
        names differ and 0 where not.
    mean, median, p95, largest : float or None
        Of the absolute differences; None without a pair.
    bias : float or None
        Mean of the signed differences; of centres the length of the mean offset.
    n_only_variant, n_only_reference : int or None
        Things (of counts and identities: frames) that one alone has an answer for; None for
        sizes and angles, which stand or fall with the centre.
    n_neither : int or None
        Frames in which neither has an answer.
    """

    variant: str
    reference: str
    quantity: str
    unit: str
    positions: NDArray[np.int64]
    differences: NDArray[np.float64]
    mean: float | None
    median: float | None
    p95: float | None
    largest: float | None
    bias: float | None
    n_only_variant: int | None
    n_only_reference: int | None
    n_neither: int | None

    @property
    def n_both(self) -> int:
        """Pairs of answers."""
        return len(self.differences)
