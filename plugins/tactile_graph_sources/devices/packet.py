"""Framer of units of fixed size, found by header look-ahead or by checksum."""

from __future__ import annotations

from collections import Counter
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from tactile_graph_sources.devices.counters import LinkCounts
from tactile_graph_sources.devices.layout import Layout
from tactile_graph_sources.devices.likeness import KEPT, Likeness
from tactile_graph_sources.devices.search import Found, Phases, Rivals
from tactile_graph_sources.devices.trust import Trust, Verdict
from tactile_graph_sources.devices.units import Units

RECENT = 8192
"""Bytes kept for a hint while no frame is found."""


class Judged(NamedTuple):
    """How many units go on, which of them are doubtful, and if the next one is out of phase."""

    n: int
    doubtful: NDArray[np.bool_]
    jumped: bool


class PacketFramer:
    """Finds units in a stream.

    Without a checksum a unit is good when its own fixed bytes are right *and* those of the units
    that follow, as many as it takes for chance to be out. Bytes that look so at other places are
    rivals: a pad may hold the header, still or at a fixed place. Where a rival lasts, the phase is
    the one whose units are like the last good ones; units for which this decides nothing go on
    marked as doubtful.
    """

    def __init__(self, layout: Layout, counts: LinkCounts) -> None:
        self.layout = layout
        self.counts = counts
        self.likeness = Likeness(layout.size)
        self.phases = Phases(layout, self.likeness)
        self._buffer = b""
        self._place = 0  # of the buffer's first byte in the stream
        self._locked = False
        self._ever = False
        self._broken = False
        self.trust = Trust()
        self._rivalled = False
        self._since_boundary = 0
        self.recent = b""
        self.near_miss: NDArray[np.uint8] | None = None

    @property
    def complete(self) -> bool:
        """Whether as many bytes as a reply has came since the last silence."""
        return self._since_boundary >= self.layout.size

    def reset(self) -> None:
        """Forget what was buffered; what the pad looked like is remembered."""
        self.counts.discarded_bytes += len(self._buffer)
        self._place += len(self._buffer)
        self._buffer, self._locked, self._broken = b"", False, True
        self.phases.forget()

    def boundary(self) -> list[Units]:
        """Take note that a reply ends; units are found by what they hold."""
        self._since_boundary = 0
        return []

    def feed(self, data: bytes) -> list[Units]:
        """Take bytes, return the runs of good units that they complete."""
        self._buffer += data
        self._since_boundary += len(data)
        if not self._locked:
            self.recent = (self.recent + data)[-RECENT:]
        out: list[Units] = []
        at = 0
        array = np.frombuffer(self._buffer, np.uint8)
        while len(array) - at >= self._need():
            at = self._take(array, at, out) if self._locked else self._search(array, at)
        self._drop(at)
        return out

    def _need(self) -> int:
        """Return how many bytes the next decision takes."""
        layout = self.layout
        if not self._locked:
            return self.phases.need
        n = layout.n_follow
        if self._rivalled:
            n = max(n, 3)  # the unit, and one behind it at any phase
        return n * layout.size + layout.ahead

    def _drop(self, n: int) -> None:
        self._buffer = self._buffer[n:]
        self._place += n

    def _take(self, array: NDArray[np.uint8], at: int, out: list[Units]) -> int:
        """Take the run of good units at ``at``; where it ends too early, unlock."""
        layout = self.layout
        k = (len(array) - at - layout.ahead) // layout.size - (layout.n_follow - 1)
        rows = array[at : at + k * layout.size].reshape(k, layout.size)
        fits = layout.ok(rows)
        if layout.ahead:
            good = fits & self._followed(array, at, rows)
        else:
            good = fits & layout.checksum_ok(rows)
        n = k if good.all() else int(np.argmin(good))
        judged = self._judge(array, at, n, n == k)
        self._emit(rows[: judged.n], at, judged.doubtful, out)
        at += judged.n * layout.size
        if judged.jumped or (judged.n == n < k):
            self._lose(rows[judged.n], bool(fits[judged.n]))
            at += 1
            self.counts.discarded_bytes += 1
        return at

    def _followed(
        self, array: NDArray[np.uint8], at: int, rows: NDArray[np.uint8]
    ) -> NDArray[np.bool_]:
        """Return which of the units at ``at`` have the beginnings of others right behind them."""
        layout, k = self.layout, len(rows)
        size, n = layout.size, k + layout.n_follow - 1
        following = np.ndarray((n, layout.ahead), np.uint8, array, at + size, (size, 1))
        heads = layout.ahead_ok(following)
        good = heads[:k]
        for i in range(1, layout.n_follow):
            good = good & heads[i : k + i]
        return good & layout.in_order(rows, following[:k])

    def _may_hold_rivals(self, array: NDArray[np.uint8], rows: NDArray[np.uint8], at: int) -> bool:
        """Return quickly whether good units, or what must follow them, may hold a rival."""
        layout, n = self.layout, len(rows) + self.layout.n_follow
        if not layout.anchor:
            return bool(layout.like_tags(rows).any())
        stop = at + (n - 1) * layout.size + len(layout.anchor)
        return layout.count_of_headers(array[at:stop]) != n

    def _judge(self, array: NDArray[np.uint8], at: int, n: int, whole: bool) -> Judged:
        """Hold the next ``n`` units against rivals, where any are about.

        ``whole`` tells that these are all the units that are there.
        """
        size = self.layout.size
        rows = array[at : at + n * size].reshape(n, size)
        doubtful = np.zeros(n, np.bool_)
        if not self.layout.ahead or self.layout.in_pieces:
            return Judged(n, doubtful, False)  # pieces must come in order, which rivals do not
        if not self._rivalled and whole and not self._may_hold_rivals(array, rows, at):
            self._pass_clear(rows)
            return Judged(n, doubtful, False)
        rivals = self.phases.rivals_by_unit(array, at)
        n_told = (len(array) - at - self.layout.ahead) // size - 2
        i = 0
        while i < n:
            if not self._rivalled:
                until = rivals.next_near(i, n)
                self._pass_clear(rows[i:until])
                i = until
            self._rivalled |= i < n
            if i >= min(n, n_told):  # what comes next must be here to be weighed
                break
            began_in_doubt = self.trust.doubt
            if self._jumped(array, at, i, rivals):
                return Judged(i, doubtful[:i], True)
            doubtful[i] = began_in_doubt or self.trust.doubt
            i += 1
        return Judged(i, doubtful[:i], False)

    def _pass_clear(self, rows: NDArray[np.uint8]) -> None:
        """Remember units near which no rival is."""
        self.likeness.remember(rows[-KEPT:], len(rows))
        self.phases.last_seen = frozenset()
        self.trust.pass_clear(len(rows))

    def _jumped(self, array: NDArray[np.uint8], at: int, unit: int, rivals: Rivals) -> bool:
        """Weigh the phase at the end of a unit, and remember the unit; or say that it was lost."""
        end = at + (unit + 1) * self.layout.size
        offsets = rivals.lasting(unit + 1)
        verdict = self.phases.verdict(array, end, offsets, self.trust.strict)
        if verdict is Verdict.LOST:
            return True
        self.trust.weigh(verdict, bool(rivals.within(unit + 1)), self.phases.wary)
        if not self.trust.strict:
            self.likeness.remember(array[end - self.layout.size : end][None, :], 1)
            self.phases.last_seen = rivals.within(unit)
        self._rivalled = self.trust.doubt or bool(offsets)
        return False

    def _emit(
        self, rows: NDArray[np.uint8], at: int, doubtful: NDArray[np.bool_], out: list[Units]
    ) -> None:
        """Hand on good units, those in doubt apart from those not."""
        cuts = [0, len(rows)]
        if doubtful.any():
            cuts[1:1] = (np.flatnonzero(np.diff(doubtful)) + 1).tolist()
        for low, high in pairwise(cuts):
            if high == low:
                continue
            end = self._place + at + high * self.layout.size
            units = self.layout.units(rows[low:high], end, self._broken)
            units.doubtful = bool(doubtful[low])
            self._broken = False
            out.append(units)

    def _lose(self, row: NDArray[np.uint8], fits: bool) -> None:
        if not fits:
            cause = "header or trailer"
        elif self.layout.crc is not None:
            cause = "checksum"
            self.near_miss = row.copy()
        else:
            cause = "length"
        self.counts.bad[cause] += 1
        self._locked, self._broken = False, True
        self.phases.forget()
        self.recent = b""

    def _search(self, array: NDArray[np.uint8], at: int) -> int:
        """Go to where units start, if the bytes tell by now; lock there."""
        found = self._checked(array, at) if self.layout.crc else self.phases.find(array, at)
        self.counts.discarded_bytes += found.at - at
        if not found.locked:
            return found.at
        self._locked = True
        self.trust.lock(found.doubtful, self.phases.wary)
        self._rivalled = self.trust.doubt
        self.counts.resyncs += self._ever
        self._ever = True
        if self.layout.anchor:
            return found.at
        # Row tags cannot tell the last byte of a frame from a lost first byte of the next one,
        # so the first frame of a lock, whose beginning nothing vouches for, is not taken.
        self._broken = True
        self.counts.discarded_bytes += self.layout.size
        return found.at + self.layout.size

    def _checked(self, array: NDArray[np.uint8], at: int) -> Found:
        """Return the next place at which two units in a row carry the right checksum."""
        layout = self.layout
        last = len(array) - 2 * layout.size
        while at <= last:
            at = self._buffer.find(layout.anchor, at) if layout.anchor else at
            if at < 0 or at > last:
                return Found(last + 1 if at < 0 else at)
            rows = array[at : at + 2 * layout.size].reshape(2, layout.size)
            fits = layout.ok(rows)
            if fits[0]:
                right = fits & layout.checksum_ok(rows)
                if right.all():
                    self.near_miss = None
                    return Found(at, locked=True)
                self.near_miss = None if right[0] else rows[0].copy()
            at += 1
        return Found(at)

    def hint(self) -> str:
        """Return what the bytes themselves say about why no frame is found."""
        layout = self.layout
        if self.near_miss is not None:
            fits = layout.matching_variants(self.near_miss)
            if fits:
                return f"the checksum never fits, but this one would: {fits[0]}"
        if not layout.anchor or len(layout.anchor) < 2:
            return ""
        places = [i for i in range(len(self.recent)) if self.recent.startswith(layout.anchor, i)]
        if not places:
            return f"the header {layout.anchor.hex(' ').upper()} was not seen"
        if any(p + layout.size in places for p in places):
            return ""  # the size is right; steps between others are those of the pad's own values
        steps = Counter(np.diff(places).tolist())
        step, n = steps.most_common(1)[0] if steps else (0, 0)
        if n > 1:
            return (
                f"headers come every {step} bytes, the preset expects {layout.size}: rows, columns?"
            )
        return ""
