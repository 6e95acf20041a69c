"""What a live run is asked for, checked where it is asked: numbers, and a pipeline."""

from __future__ import annotations

import math
from numbers import Integral, Real
from typing import Any

from tactile_graph.errors import UsageError, shown


def checked_deadline(deadline_us: Any) -> Any:
    """Return a deadline in microseconds, or None; raises UsageError."""
    if deadline_us is not None and not (_is_above_0(deadline_us) and deadline_us < math.inf):
        got = shown(deadline_us)
        raise UsageError(f"a deadline is a number of microseconds above 0, got {got}")
    return deadline_us


def checked_rate(rate_hz: Any) -> Any:
    """Return a rate in frames a second, or None; raises UsageError."""
    if rate_hz is not None and not _is_above_0(rate_hz):
        raise UsageError(f"a rate is above 0 frames a second, got {shown(rate_hz)}")
    return rate_hz


def checked_room(name: str, n: Any) -> int:
    """Return for how many there is room: at least one; raises UsageError."""
    if not isinstance(n, Integral) or isinstance(n, bool) or n < 1:
        raise UsageError(f"{name}: must be a whole number >= 1, got {shown(n)}")
    return int(n)


def check_pipeline(given: Any) -> None:
    """Refuse what is no pipeline; raises UsageError."""
    if not callable(getattr(given, "runner", None)):
        hint = f"; load({given!r}) makes one" if isinstance(given, str) else ""
        raise UsageError(f"a pipeline is needed, got {shown(given)}{hint}")


def _is_above_0(number: Any) -> bool:
    return isinstance(number, Real) and not isinstance(number, bool) and float(number) > 0.0
