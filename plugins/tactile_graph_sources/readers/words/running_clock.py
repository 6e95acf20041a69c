"""``RunningClock``: one time after the other, as a time that goes on where clocks begin anew."""

from __future__ import annotations

import math
from collections.abc import Callable

from tactile_graph.errors import DataError
from tactile_graph_sources.readers.words.moments import DAY_S, Moment, moment_of

_SOON_S = 60.0
"""No longer than this passes from the end of an hour to what is taken to be in the next one."""


class RunningClock:
    """Reads the times of a recording in turn, in seconds of which only differences mean anything.

    Times of day go on over midnight, minutes and seconds over the hour. Offsets from UTC count:
    time goes on where a clock is put forward or back. A time without one among others is taken to
    have that of the one before, which is told. A leap second is one.

    Parameters
    ----------
    where : str
        The file.
    tell : callable
        Takes what is assumed.
    given : str
        How times are written, as `strptime` takes it; empty if that is to be seen.
    colon_s : float
        As `moment_of` takes it.
    """

    def __init__(
        self, where: str, tell: Callable[[str], None], given: str = "", colon_s: float = 0.0
    ) -> None:
        self._where, self._tell, self._given, self._colon_s = where, tell, given, colon_s
        self._last_s = -math.inf
        self._ahead_s = self._leap_s = 0.0
        self._first_zone_s: float | None = None
        self._zone_s: float | None = None
        self._without_zone = False
        self._digits = 0
        self._leaps = False

    def read(self, text: str) -> float | None:
        """Return the seconds that a text says; None where it is no time.

        Raises
        ------
        DataError
            If digits behind a last colon were taken for decimals, and cannot have been.
        """
        found = moment_of(text, self._given, self._colon_s)
        if found is None:
            return None
        if found.colon_digits and not self._colon_s:
            self._see_digits(text.strip(), found.colon_digits)
        at_s = self._in_first_zone(found) + self._ahead_s + self._leap_s
        if _began_anew(at_s, self._last_s, found.cycle_s):
            self._ahead_s += found.cycle_s
            at_s += found.cycle_s
        if self._leaps and not found.leaps and at_s <= self._last_s:
            self._leap_s += 1.0  # the second 60 is no second 0 of the next minute
            at_s += 1.0
        self._leaps, self._last_s = found.leaps, at_s
        return at_s

    def _in_first_zone(self, found: Moment) -> float:
        if found.zone_s is None:
            self._without_zone = True
        else:
            self._zone_s = found.zone_s
            if self._first_zone_s is None:
                self._first_zone_s = found.zone_s
        if self._zone_s is None or self._first_zone_s is None:
            return found.at_s
        if self._without_zone:
            self._tell("times without an offset from UTC taken to have that of those before")
        shift_s = self._first_zone_s - self._zone_s
        at_s = found.at_s + shift_s
        return at_s % found.cycle_s if shift_s and found.cycle_s else at_s

    def _see_digits(self, text: str, n: int) -> None:
        if self._digits not in (0, n):
            raise DataError(
                self._where,
                f"its time {text[:30]!r} has {n} digits behind the last ':', times before "
                f"{self._digits}: write all milliseconds with three digits",
            )
        if n < 3 and not self._digits:
            self._tell(f"times such as {text[:30]!r} taken to end in decimals of a second")
        self._digits = n


def _began_anew(at_s: float, last_s: float, cycle_s: float) -> bool:
    """Return whether a clock began anew; an hour's only shortly before, as a recording may."""
    if not cycle_s or at_s >= last_s - cycle_s / 2:
        return False
    return cycle_s == DAY_S or 0.0 <= at_s + cycle_s - last_s < _SOON_S
