"""The error of an answer in units of eps times conditioning: against references and laws."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from tactile_graph_stress.answer import answer_of, half_extent, largest, off_by
from tactile_graph_stress.references.exact_hull import hull_error
from tactile_graph_stress.references.known import parts_of
from tactile_graph_stress.references.network import Conductances
from tactile_graph_stress.references.stationary import DIGITS, Solved
from tactile_graph_stress.similarity import Similarity
from tactile_graph_stress.verdict import EPS, QUANTUM, Outcome, Verdict, graded

Values = NDArray[np.float64]


def against_reference(value: Any, xy: Values, right: Solved) -> Verdict:
    """Return the verdict on a shape fitted to points, shape (N, 2), beside the right one."""
    from mpmath import mp, mpf, pi

    with mp.workdps(DIGITS):
        coordinate = _grain(mpf(largest(xy)))
        lengths = right.shape[2 : len(right.shape) - right.angled]
        size = max([mpf(half_extent(xy)), *(abs(v) for v in lengths)])
        units = condition = relative = mpf(0)
        for k, (got, want) in enumerate(zip(parts_of(value), right.shape, strict=True)):
            off, moves = abs(mpf(got) - want), mpf(float(right.moves[k]))
            if right.angled and k == len(right.shape) - 1:
                turns = (mpf(got) - want) / pi
                off = abs(turns - mp.nint(turns)) * pi * size
                moves *= size / right.unit_cm
            rounding = moves * coordinate + _grain(size)
            units = max(units, off / rounding)
            condition = max(condition, moves * mpf(largest(xy)) / size)
            relative = max(relative, off / size)
        return graded(float(units), float(condition), float(relative))


def _grain(size: Any) -> Any:
    return max(size * EPS, QUANTUM)


def against_law(
    value: Any, base: Any, law: Similarity, reach_cm: tuple[float, float, float], condition: float
) -> Verdict:
    """Return the verdict on an answer beside another's that went through a law.

    Parameters
    ----------
    value, base : Any
        The answers to the case and to its base.
    law : Similarity
    reach_cm : (float, float, float)
        Largest coordinate of case and base, half the extent of the case.
    condition : float
        Largest change of the answer for a change of the points by 1.
    """
    from mpmath import mp, mpf

    here, there, half = reach_cm
    with np.errstate(over="ignore", under="ignore"):
        off = off_by(answer_of(value), law.of_answer(answer_of(base)), half)
    if off is None:
        return Verdict(Outcome.BROKEN, note="an answer of another form than for the plain case")
    if off.size_cm == 0.0:
        return Verdict(Outcome.FINITE)
    with mp.workdps(DIGITS):
        size = mpf(off.size_cm)
        grain = _grain(mpf(here)) + _grain(mpf(there) * mpf(law.scale))
        rounding = mpf(condition) * grain + _grain(size)
        relative = mpf(off.most_cm) / size
        at_size = mpf(condition) * mpf(here) / size
        return graded(float(mpf(off.most_cm) / rounding), float(at_size), float(relative))


def of_hull(value: Any, xy: Values) -> Verdict:
    """Return the verdict on the hull of points, shape (N, 2)."""
    outside, wrong = hull_error(xy, value.xy_cm)
    if wrong:
        return Verdict(Outcome.BROKEN, note=wrong)
    size = largest(xy)
    grain = max(size * EPS, QUANTUM)
    return graded(outside / grain, 1.0, outside / size if size else 0.0)


def of_conductances(got_s: Values, right: Conductances) -> Verdict:
    """Return the verdict on conductances, shape (rows, columns), each against its own size."""
    from mpmath import mp, mpf

    with mp.workdps(DIGITS):
        worst = max(
            abs(mpf(float(got)) - want) / want
            for row, wanted in zip(got_s, right.siemens, strict=True)
            for got, want in zip(row, wanted, strict=True)
        )
        units = worst / (EPS * (mpf(right.condition) + 1))
        return graded(float(units), right.condition, float(worst))


def of_values(got: Values, want: Values, given: Values, condition: float) -> Verdict:
    """Return the verdict on restored values beside those they must be.

    Parameters
    ----------
    got, want, given : ndarray
        All of one shape.
    condition : float
        Largest change of a restored value for a change of the given ones by 1.
    """
    span = float(given.max() - given.min())
    size = float(np.abs(given).max())
    off = float(np.abs(got - want).max())
    rounding = EPS * (2.0 * condition * size + span)
    return graded(off / rounding, condition * size / span, off / span)
