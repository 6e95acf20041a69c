"""Where in a stream units start: every phase that could be it, weighed against the others."""

from __future__ import annotations

from bisect import bisect_left
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from tactile_graph_sources.devices.layout import Layout
from tactile_graph_sources.devices.likeness import Likeness
from tactile_graph_sources.devices.trust import SURE, Verdict

MOST_UNITS = 16
"""Units that are waited for before a phase is taken that nothing favours."""
RUN = 3
"""Beginnings in a row that a lock takes at least: with one flipped, the true phase has two.
Pieces of a frame must come in order besides, and take but two."""
STANDS_FOR = 12
"""Units in most of which a header among the values must be to count as standing there."""
MOST_CONTENDERS = 8
SHORT_LOSS = 8
"""Bytes that are lost often: from a header so near another one a loss leads to that one."""
LOOKS_AHEAD = 4096
"""Bytes in which the next beginning is looked for at once."""


class Found(NamedTuple):
    """Where to go on, whether units start there, and whether others could as well."""

    at: int
    locked: bool = False
    doubtful: bool = False


class Rivals:
    """Where beginnings are that are none of a phase's units, by unit."""

    def __init__(self, places: NDArray[np.int64], size: int, n_follow: int) -> None:
        self._within: dict[int, set[int]] = {}
        for place in places.tolist():
            self._within.setdefault(place // size, set()).add(place % size)
        self._near = sorted({unit - i for unit in self._within for i in range(n_follow)})

    def next_near(self, unit: int, stop: int) -> int:
        """Return the first from ``unit`` on that has a rival, or before one; at most ``stop``."""
        i = bisect_left(self._near, unit)
        return min(self._near[i], stop) if i < len(self._near) else stop

    def within(self, unit: int) -> frozenset[int]:
        """Return where in a unit rivals are."""
        return frozenset(self._within.get(unit, ()))

    def lasting(self, unit: int) -> list[int]:
        """Return where in a unit rivals are that are there one unit later, too."""
        return sorted(self.within(unit) & self.within(unit + 1))


class Phases:
    """Finds where units start after a loss, or at first.

    A phase can be locked to when enough beginnings follow each other in it. It contends with
    any other phase that has half as many at the same time: a flipped header does not leave
    the field to a header among the values. Of several contenders the one whose units are
    like the last good ones wins; while none stands out more units are waited for.
    """

    def __init__(self, layout: Layout, likeness: Likeness) -> None:
        self.layout = layout
        self.likeness = likeness
        self.n_lock = 2 if layout.in_pieces else max(RUN, layout.n_follow + 1)
        self.fewest = self.n_lock + (1 if layout.in_pieces else 2)
        self._standing: tuple[int, frozenset[int]] = (-1, frozenset())
        self.last_seen: frozenset[int] = frozenset()
        self.forget()

    def forget(self) -> None:
        """Start a search afresh."""
        self._n_units = self.fewest

    @property
    def need(self) -> int:
        """How many bytes the next decision takes."""
        if self.layout.crc:
            return 2 * self.layout.size
        return self._n_units * self.layout.size + self.layout.ahead

    def rivals(self, array: NDArray[np.uint8], at: int, stop: int) -> NDArray[np.int64]:
        """Return where beginnings are that are none of the phase of ``at``, counted from there."""
        size = self.layout.size
        places = self.layout.beginnings(array, at, stop) - at
        places = places[places % size != 0]
        if not self.layout.anchor and len(places):
            n = (len(array) - at) // size
            held = self.layout.like_tags(array[at : at + n * size].reshape(n, size))
            places = places[places < n * size]
            places = places[held[places // size]]
        return np.asarray(places)

    def rivals_by_unit(self, array: NDArray[np.uint8], at: int) -> Rivals:
        """Return the rivals of the phase of ``at`` in all that came since."""
        places = self.rivals(array, at, len(array) - self.layout.ahead + 1)
        return Rivals(places, self.layout.size, self.layout.n_follow)

    def possible(self, units: NDArray[np.uint8]) -> NDArray[np.bool_]:
        """Return which units hold what they must, values in the allowed range included."""
        return self.layout.ok(units) & self.layout.in_range(units)

    def verdict(
        self, array: NDArray[np.uint8], at: int, offsets: list[int], strict: bool = False
    ) -> Verdict:
        """Weigh the phase of the unit at ``at`` against those of beginnings at offsets from it.

        Where false headers stood decides first, as it survives a change of what the pad shows.
        Likeness alone takes the phase from none: a pad that shows something else, with a header
        in it, is likelier than a cut of just the length that leads from header to header; but
        not than the loss of a byte or a few. After a loss (``strict``) a place must be seen on
        units that are like the last good ones.
        """
        places = [0, *offsets]
        mine = bool(offsets) and self._stands(0, places)
        theirs = [o for o in offsets if self._stands(o, places)]
        if mine and not theirs and not strict:
            return Verdict.HOLDS
        real = [o for o in offsets if self._may_start(array, at + o)]
        if not real:
            return Verdict.ALONE
        if strict and not (mine and self._is_typical(array, at)):
            return Verdict.NEW
        standing = [o for o in real if o in theirs]
        if bool(standing) is not mine:
            return Verdict.LOST if standing else Verdict.HOLDS
        size = self.layout.size
        units = np.stack([array[at + o : at + o + size] for o in [0, *(standing or real)]])
        nats = self.likeness.log_likelihood(units)
        if self.likeness.decides(float(nats[0]), float(nats[1:].max())):
            return Verdict.HOLDS
        close = any(min(o % size, -o % size) <= SHORT_LOSS for o in standing or real)
        return Verdict.EITHER if mine or close else Verdict.NEW

    def _is_typical(self, array: NDArray[np.uint8], at: int) -> bool:
        unit = array[None, at : at + self.layout.size]
        return self.likeness.is_typical(float(self.likeness.log_likelihood(unit)[0]))

    def _may_start(self, array: NDArray[np.uint8], at: int) -> bool:
        return bool(self.possible(array[None, at : at + self.layout.size])[0])

    def _stands(self, origin: int, places: list[int]) -> bool:
        """Return whether, seen from ``origin``, false headers are where they stood so far."""
        seen = {(p - origin) % self.layout.size for p in places}
        return any(stood and stood <= seen for stood in (self.last_seen, self.standing))

    @property
    def wary(self) -> bool:
        """Whether a rival has stood so far: where it is not seen, that may be a flip's doing."""
        return bool(self.standing)

    @property
    def standing(self) -> frozenset[int]:
        """Where within the last good units beginnings of others seem to be.

        They survive a change of the scene, of which a likeness knows nothing.
        """
        age, found = self._standing
        if age != self.likeness.age and self.layout.ahead:
            units = self.likeness.units[-STANDS_FOR:]
            flat = units.reshape(-1)
            places = self.rivals(flat, 0, len(flat) - self.layout.ahead + 1)
            count = np.bincount(places % self.layout.size, minlength=1)
            found = frozenset(np.flatnonzero(count > len(units) // 2).tolist())
            self._standing = (self.likeness.age, found)
        return found

    def find(self, array: NDArray[np.uint8], at: int) -> Found:
        """Decide on the units from ``at`` on, or ask for more of them."""
        size, n = self.layout.size, self._n_units
        places = self.layout.beginnings(array, at, at + n * size) - at
        if len(places) == 0:
            return self._on(self._next_beginning(array, at + n * size))
        table = np.zeros((n, size), np.bool_)
        table.reshape(-1)[places] = True
        first = self._first(array, at, table)
        lockable = np.flatnonzero(first >= 0)
        if len(lockable) == 0:  # none of the runs that are whole within these units
            return self._on(at + (n - self.n_lock + 1) * size)
        earliest = lockable[np.argmin(first[lockable] * size + lockable)]
        # Only phases of the same time contend: after a loss the same units come in another one.
        together = table[table[:, earliest]]
        shared = together.sum(axis=0)
        phases = np.flatnonzero(shared >= max(2, len(together) // 2))
        if len(phases) > MOST_CONTENDERS:
            return self._wait(at) if n < MOST_UNITS else self._on(at + size)
        return self._weigh(array, at, table, first, phases)

    def _first(
        self, array: NDArray[np.uint8], at: int, table: NDArray[np.bool_]
    ) -> NDArray[np.int64]:
        """Return for each phase the unit with which a run begins that can be locked to; or -1."""
        n, size = table.shape
        length = self.n_lock
        runs = np.ones((n - length + 1, size), np.bool_)
        for i in range(length):
            runs &= table[i : n - length + 1 + i]
        first = np.full(size, -1)
        for unit, phase in np.argwhere(runs).tolist():
            start = at + unit * size + phase
            if first[phase] < 0 and self._may_start(array, start):
                first[phase] = unit
        return first

    def _weigh(
        self,
        array: NDArray[np.uint8],
        at: int,
        table: NDArray[np.bool_],
        first: NDArray[np.int64],
        phases: NDArray[np.int64],
    ) -> Found:
        size = self.layout.size
        each = [self._nats(array, at + p, table[:-1, p]) for p in phases.tolist()]
        nats = np.array([n.mean() for n in each])
        stands = np.array([self._stands(p, phases.tolist()) for p in phases.tolist()])
        order = np.lexsort((-nats, ~stands))
        best, alone = int(phases[order[0]]), len(phases) == 1
        placed, sure = False, alone and not self.wary
        if not alone:
            first_nats, next_nats = nats[order[:2]].tolist()
            placed = bool(stands[order[0]] and not stands[order[1]])
            like = self.likeness.is_typical(float(each[order[0]].max()))
            # Where none stands as before, the scene has changed: likeness to it says nothing.
            both = bool(stands[order[:2]].all())
            sure = (placed and like) or (both and self.likeness.decides(first_nats, next_nats))
        if (sure or placed or alone) and first[best] >= 0:
            self.forget()
            begin = int(first[best]) if alone else self._surely(array, at, table, best, phases)
            return Found(at + begin * size + best, locked=True, doubtful=not sure)
        if len(table) < MOST_UNITS:
            return self._wait(at)
        ready = [p for p in phases[order].tolist() if first[p] >= 0]
        self.forget()
        return Found(at + int(first[ready[0]]) * size + ready[0], locked=True, doubtful=True)

    def _surely(
        self,
        array: NDArray[np.uint8],
        at: int,
        table: NDArray[np.bool_],
        best: int,
        phases: NDArray[np.int64],
    ) -> int:
        """Return the first unit of a phase behind one that is like no rival's.

        A loss as long as a rival is away makes that rival's phase the true one: units before are
        cut at the wrong place, and the one in which it happened is so in part.
        """
        size = self.layout.size
        for unit in range(len(table) - 1):
            offsets = [int(p) - best for p in phases.tolist() if p != best and table[unit, p]]
            start = at + unit * size + best
            if table[unit, best] and self.verdict(array, start, offsets) in SURE:
                return unit + 1
        return len(table) - 1

    def _nats(
        self, array: NDArray[np.uint8], start: int, there: NDArray[np.bool_]
    ) -> NDArray[np.float64]:
        """Return the log likelihood of each possible unit of a phase; one of -inf if none is."""
        size = self.layout.size
        units = array[start : start + len(there) * size].reshape(-1, size)[there]
        units = units[self.possible(units)]
        return self.likeness.log_likelihood(units) if len(units) else np.array([-np.inf])

    def _wait(self, at: int) -> Found:
        self._n_units += 1
        return Found(at)

    def _on(self, to: int) -> Found:
        self.forget()
        return Found(to)

    def _next_beginning(self, array: NDArray[np.uint8], at: int) -> int:
        """Return the next place that looks like a beginning, or how far there is none."""
        stop = max(at, min(at + LOOKS_AHEAD, len(array) - self.layout.ahead))
        places = self.layout.beginnings(array, at, stop)
        return int(places[0]) if len(places) else stop
