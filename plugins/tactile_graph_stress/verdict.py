"""``Verdict``: what a case came to, in classes and in units of rounding times conditioning."""

from __future__ import annotations

from enum import Enum
from typing import NamedTuple

EPS = 2.0**-52
QUANTUM = 2.0**-1074
"""Distance of neighbouring numbers near 0, below which nothing can be told apart."""

EXACT_UNITS = 10.0
GOOD_UNITS = 1e3
WRONG = 1e-3
NO_DIGITS = 1e-3


class Outcome(Enum):
    """What a case came to, from best to worst."""

    EXACT = "exact"
    GOOD = "good"
    DEGRADED = "degraded"
    NO_DIGITS = "no digits"
    FINITE = "finite"
    GAVE_UP = "gave up"
    BROKEN = "BROKEN"


class Verdict(NamedTuple):
    """What a case came to.

    Parameters
    ----------
    outcome : Outcome
    units : float, optional
        Error over ``eps * (condition + 1)`` and the answer's size; None where nothing was compared.
    condition : float, optional
        Relative: by how much more the answer changes than the largest coordinate or value, each
        against its size.
    note : str
        Why it gave up, or what broke.
    """

    outcome: Outcome
    units: float | None = None
    condition: float | None = None
    note: str = ""


def graded(units: float, condition: float, relative: float) -> Verdict:
    """Return the verdict on a measured error.

    Parameters
    ----------
    units : float
        The error in units of eps times conditioning.
    condition : float
    relative : float
        The error over the answer's size.
    """
    if condition * EPS > NO_DIGITS:
        return Verdict(Outcome.NO_DIGITS, units, condition, "rounding of the input decides")
    if units <= EXACT_UNITS:
        return Verdict(Outcome.EXACT, units, condition)
    if units <= GOOD_UNITS:
        return Verdict(Outcome.GOOD, units, condition)
    if relative > WRONG:
        return Verdict(Outcome.BROKEN, units, condition, f"wrong by {relative:.2g} of its size")
    return Verdict(Outcome.DEGRADED, units, condition)
