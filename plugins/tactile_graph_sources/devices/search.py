"""Where in a stream units start: every phase that could be it, weighed against the others."""

from __future__ import annotations

from enum import Enum, auto
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from tactile_graph_sources.devices.layout import Layout
from tactile_graph_sources.devices.likeness import Likeness

MOST_UNITS = 16
"""Units that are waited for before a phase is taken that nothing favours."""
RUN = 3
"""Beginnings in a row that a lock takes at least: with one flipped, the true phase has two.
Pieces of a frame must come in order besides, and take but two."""
STANDS_FOR = 12
"""Units in most of which a header among the values must be to count as standing there."""
MOST_CONTENDERS = 8
LOOKS_AHEAD = 4096
"""Bytes in which the next beginning is looked for at once."""


class Found(NamedTuple):
    """Where to go on, whether units start there, and whether others could as well."""

    at: int
    locked: bool = False
    doubtful: bool = False


class Verdict(Enum):
    """What rivals mean for a phase."""

    HOLDS = auto()
    NEW = auto()  # a header that comes to stand among the values
    EITHER = auto()  # the same is seen from each, and nothing else tells
    LOST = auto()


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

    def possible(self, units: NDArray[np.uint8]) -> NDArray[np.bool_]:
        """Return which units hold what they must, values in the allowed range included."""
        return self.layout.ok(units) & self.layout.in_range(units)

    def verdict(self, units: NDArray[np.uint8], offsets: list[int]) -> Verdict:
        """Weigh the phase of the first unit against others that have beginnings there, too.

        Where false headers stood decides first, as it survives a change of what the pad shows.
        Likeness alone takes the phase from none: a pad that shows something else, with a header
        in it, is likelier than a cut of just the length that leads from header to header.

        Parameters
        ----------
        units : ndarray of uint8, shape (1 + k, size)
            One of the phase that is weighed, and one of each rival's.
        offsets : list of int
            Where, counted from the first unit, all the rivals are; those of ``units`` first.
        """
        places = [0, *offsets]
        mine = self._stands(0, places)
        theirs = np.array([self._stands(o, places) for o in offsets[: len(units) - 1]])
        if (mine > theirs).all():
            return Verdict.HOLDS
        if (theirs > mine).any():
            return Verdict.LOST
        nats = self.likeness.log_likelihood(units[np.append(True, theirs == mine)])
        if self.likeness.decides(float(nats[0]), float(nats[1:].max())):
            return Verdict.HOLDS
        return Verdict.EITHER if mine else Verdict.NEW

    def _stands(self, origin: int, places: list[int]) -> bool:
        """Return whether, seen from ``origin``, false headers are where they stood so far."""
        seen = {(p - origin) % self.layout.size for p in places}
        return any(stood and stood <= seen for stood in (self.last_seen, self.standing))

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
            if first[phase] < 0 and self.possible(array[None, start : start + size])[0]:
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
        nats = np.array([self._nats(array, at + p, table[:-1, p]) for p in phases.tolist()])
        stands = np.array([self._stands(p, phases.tolist()) for p in phases.tolist()])
        order = np.lexsort((-nats, ~stands))
        best = int(phases[order[0]])
        sure = len(phases) == 1 or bool(stands[order[0]] > stands[order[1]])
        sure = sure or self.likeness.decides(float(nats[order[0]]), float(nats[order[1]]))
        if sure and first[best] >= 0:
            self.forget()
            begin = int(first[best])
            if len(phases) > 1:
                begin = self._surely(array, at, table, best, phases)
            return Found(at + begin * size + best, locked=True)
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
            starts = [at + unit * size + best + o for o in [0, *offsets]]
            rows = np.stack([array[s : s + size] for s in starts])
            if table[unit, best] and (not offsets or self.verdict(rows, offsets) is Verdict.HOLDS):
                return unit + 1
        return len(table) - 1

    def _nats(self, array: NDArray[np.uint8], start: int, there: NDArray[np.bool_]) -> float:
        """Return the mean log likelihood of a phase's units; impossible ones count as refuted."""
        size = self.layout.size
        units = array[start : start + len(there) * size].reshape(-1, size)[there]
        units = units[self.possible(units)]
        return float(self.likeness.log_likelihood(units).mean()) if len(units) else -np.inf

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
