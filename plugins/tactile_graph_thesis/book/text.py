"""Numbers as people read them."""

from __future__ import annotations

import math


def number(value: float | None) -> str:
    """Return a number with as many digits as matter, a dash where there is none.

    Parameters
    ----------
    value : float or None
    """
    if value is None or not math.isfinite(value):
        return "–"
    if value == 0.0:
        return "0"
    decimals = 2 - math.floor(math.log10(abs(value)))
    return f"{value:.{min(max(decimals, 0), 4)}f}"
