"""``Identity``: which known object it is, and how sure that is."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

UNKNOWN = "unknown"
"""The name of what is none of the known objects; no object can be learned under it."""


@dataclass(frozen=True)
class Identity:
    """The object a reading belongs to.

    Parameters
    ----------
    name : str
        Of the object; ``unknown`` where even the nearest is too far.
    shape : str
        What it was learned as: disc, rectangle, ellipse, polygon; empty where unknown.
    known : bool
        Whether the nearest object is near enough.
    distance : float
        To the nearest object, as the classifier measures it.
    limit : float, optional
        Largest distance at which that object is accepted, learned from the readings; None where
        nothing is rejected.
    nearest : str
        The nearest object, near enough or not.
    runner_up : str
        The second nearest; empty where only one object is known.
    runner_up_distance : float, optional
        None where only one object is known.
    margin : float
        0 for a tie of the two, 1 if nothing else comes into question: 1 - distance /
        runner_up_distance, or of a discriminant 1 - likelihood of the second / of the first. It
        knows nothing of a third.
    n_presses : int
        How many readings of the object the answer rests on.
    note : str
        Why it is unknown though the nearest object is near enough; empty otherwise.
    probability : float, optional
        Of a discriminant: that it is the nearest object and no other known one, as sure as readings
        left out allow; None where a classifier knows only distances.
    """

    name: str
    shape: str
    known: bool
    distance: float
    limit: float | None
    nearest: str
    runner_up: str
    runner_up_distance: float | None
    margin: float
    n_presses: int = 1
    note: str = ""
    probability: float | None = None
    columns_shown: ClassVar[tuple[str, ...]] = (
        "name",
        "distance",
        "runner_up",
        "margin",
        "known",
    )
