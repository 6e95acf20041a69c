"""How a discriminant is made, and how well the chosen one did on what it was not told."""

from __future__ import annotations

from typing import NamedTuple

CONFIDENCE = 0.95
"""Share of known objects' readings that is to be accepted, unless told."""

FEW = 10
"""Readings of an object below which nothing says how much it varies."""


class Manner(NamedTuple):
    """How a discriminant is made.

    Parameters
    ----------
    shrinkage : float
        Share of a common variance in the covariance of all objects.
    variates : int
        How many canonical variates tell objects apart, at most.
    prior_readings : float
        How many readings the covariance of all objects counts for beside an object's own.
    beyond : float
        Share of what lies beside the variates in the distance that strangers are known by.
    """

    shrinkage: float
    variates: int
    prior_readings: float
    beyond: float = 1.0


class Choice(NamedTuple):
    """The manner that did best, and how well it did.

    Parameters
    ----------
    manner : Manner
    n_left_out, n_right : int
        Readings left out with others of their object learned, and how many were named right.
    n_strangers, n_found : int
        Readings of objects left out whole, and how many of these were unknown where `CONFIDENCE`
        of the others were accepted.
    """

    manner: Manner
    n_left_out: int
    n_right: int
    n_strangers: int
    n_found: int

    def __str__(self) -> str:
        """How well it did, for people."""
        parts = []
        if self.n_left_out:
            share = 100.0 * self.n_right / self.n_left_out
            parts.append(
                f"{share:.1f} % of {self.n_left_out} readings are named right when left out"
            )
        if self.n_strangers:
            share = 100.0 * self.n_found / self.n_strangers
            parts.append(f"{share:.0f} % are unknown when their object is left out whole")
        return "; ".join(parts) or "too few readings to leave any out"
