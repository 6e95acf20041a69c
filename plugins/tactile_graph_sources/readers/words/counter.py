"""``runs_over``: a counter of few digits."""

from __future__ import annotations

FEWEST_RUN_OVER = 99
"""The largest number of two digits: no counter that begins anew runs over sooner."""


def runs_over(last: float, number: float) -> bool:
    """Return whether a counter began anew at 0 or 1, as one of two digits or of a byte does."""
    return last >= FEWEST_RUN_OVER and 0 <= number <= 1
