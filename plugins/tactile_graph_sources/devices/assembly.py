"""Assemblers: from units (packets, lines) to whole frames; never padded, never out of order."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tactile_graph_sources.devices.counters import LinkCounts
from tactile_graph_sources.devices.units import Assembled, Units


class Sequence:
    """Counts jumps in the device's own numbering of units."""

    def __init__(self, modulus: int, counts: LinkCounts) -> None:
        self.modulus = modulus
        self.counts = counts
        self._last: int | None = None

    def jumps(self, numbers: NDArray[Any] | None, k: int) -> NDArray[np.bool_]:
        """Return before which units some are missing by their number."""
        out = np.zeros(k, dtype=np.bool_)
        if numbers is None or k == 0:
            return out
        wide = numbers.astype(np.int64)
        steps: NDArray[np.int64] = np.mod(np.diff(wide), self.modulus)
        out[1:] = steps != 1
        out[0] = self._last is not None and (int(numbers[0]) - self._last) % self.modulus != 1
        self._last = int(numbers[-1])
        self.counts.sequence_gaps += int(np.count_nonzero(out))
        return out

    def reset(self) -> None:
        """Forget the last number: after a reconnect the device counts anew."""
        self._last = None


class Whole:
    """Each unit is a frame."""

    def __init__(self, sequence: Sequence) -> None:
        self.sequence = sequence

    def feed(self, units: Units) -> list[Assembled]:
        """Return the units as frames."""
        k = len(units.cells)
        if k == 0:
            return []
        gap = self.sequence.jumps(units.sequence, k)
        gap[0] |= units.broken
        return [Assembled(units.cells, units.ends, units.time, gap, units.doubtful)]

    def reset(self) -> None:
        """Forget what came before."""
        self.sequence.reset()


class Pieces:
    """Puts together frames of pieces (rows, chunks, cells) that say where they start.

    Pieces must follow each other without a jump from cell 0 to the last; a piece may run over the
    end of a frame into the next one. A frame with anything missing is counted and dropped.
    """

    def __init__(
        self, n_cells: int, per_start: int, sequence: Sequence, counts: LinkCounts
    ) -> None:
        self.n_cells = n_cells
        self.per_start = per_start
        self.sequence = sequence
        self.counts = counts
        self._held: Units | None = None
        self._next = -1
        self._device = -1
        self._lost = False
        self._ever = False

    def feed(self, units: Units) -> list[Assembled]:
        """Take pieces, return the frames that they complete."""
        k = len(units.cells)
        if k == 0:
            return []
        assert units.start is not None
        m = units.cells.shape[1]
        start = units.start * self.per_start
        breaks = self._breaks(units, start, m)
        self._next = int(start[-1] + m) % self.n_cells
        bounds = [0, *np.flatnonzero(breaks[1:]) + 1, k]
        out: list[Assembled] = []
        for low, high in pairwise(bounds):
            if breaks[low]:
                self._abandon()
            self._run(_part(units, start, low, high), out)
        return out

    def _breaks(self, units: Units, start: NDArray[np.int64], m: int) -> NDArray[np.bool_]:
        """Return before which pieces the run of pieces is interrupted."""
        breaks = self.sequence.jumps(units.sequence, len(start))
        expected = np.concatenate([[self._next], (start[:-1] + m) % self.n_cells])
        breaks |= start != expected
        breaks[0] |= units.broken
        if units.device is not None:
            breaks |= units.device != np.concatenate([[self._device], units.device[:-1]])
            self._device = int(units.device[-1])
        return breaks

    def _abandon(self) -> None:
        """Drop a frame in the making."""
        if self._held is not None or self._ever:
            self._lost = True
        if self._held is not None:
            self.counts.bad["incomplete"] += self._ever
            self.counts.discarded_pieces += len(self._held.cells)
        self._held = None

    def _run(self, piece: Units, out: list[Assembled]) -> None:
        """Add pieces that follow each other, cut off the frames that are complete."""
        held = piece if self._held is None else _joined(self._held, piece)
        assert held.start is not None
        m = held.cells.shape[1]
        skip = -int(held.start[0]) % self.n_cells
        total = held.cells.size
        n = max(0, total - skip) // self.n_cells
        if n == 0:
            # Before a frame starts nothing needs keeping; the last piece may hold its beginning.
            self._held = held if total > skip else None
            self.counts.discarded_pieces += 0 if total > skip else len(held.cells)
            return
        self.counts.discarded_pieces += skip // m
        flat = held.cells.reshape(-1)[skip : skip + n * self.n_cells]
        last = (skip + self.n_cells * np.arange(1, n + 1) - 1) // m
        first = (skip + self.n_cells * np.arange(n)) // m
        gap = np.zeros(n, dtype=np.bool_)
        gap[0], self._lost = self._lost, False
        time = None if held.time is None else held.time[first]
        cells = flat.reshape(n, self.n_cells)
        out.append(Assembled(cells, held.ends[last], time, gap, held.doubtful))
        self._ever = True
        rest = (skip + n * self.n_cells) // m
        left = total - (skip + n * self.n_cells)
        self._held = _part(held, held.start, rest, len(held.cells)) if left else None

    def reset(self) -> None:
        """Forget what came before."""
        self._abandon()
        self._next = self._device = -1
        self.sequence.reset()


def _part(units: Units, start: NDArray[np.int64], low: int, high: int) -> Units:
    time = None if units.time is None else units.time[low:high]
    return Units(
        units.cells[low:high],
        units.ends[low:high],
        start=start[low:high],
        time=time,
        doubtful=units.doubtful,
    )


def _joined(a: Units, b: Units) -> Units:
    assert a.start is not None
    assert b.start is not None
    times = [u.time for u in (a, b) if u.time is not None]
    return Units(
        np.concatenate([a.cells, b.cells]),
        np.concatenate([a.ends, b.ends]),
        start=np.concatenate([a.start, b.start]),
        time=np.concatenate(times) if len(times) == 2 else None,
        doubtful=a.doubtful or b.doubtful,
    )


class BetweenSilences:
    """Rows without a number: those between two silences are a frame if there are just enough."""

    def __init__(self, n_rows: int, silence_s: float, counts: LinkCounts) -> None:
        self.n_rows = n_rows
        self.silence_s = silence_s
        self.counts = counts
        self._rows: list[NDArray[Any]] = []
        self._n = 0
        self._end = 0
        self._open = False
        self._hurt = False
        self._lost = False
        self._ever = False
        self._hint = ""

    def feed(self, units: Units) -> list[Assembled]:
        """Take rows; a silence, or a line that is no data, closes a frame."""
        out = self._flush() if units.opens or len(units.cells) == 0 else []
        if len(units.cells) == 0:
            self._open = True
            return out
        if units.opens:
            self._open = True
        self._hurt |= units.broken
        self._end = int(units.ends[-1])
        self._n += len(units.cells)
        self._rows.extend(units.cells[: self.n_rows + 1])
        if self._n > self.n_rows:
            self._hurt = True  # too long already: keep no more of it
            del self._rows[1:]
        return out

    def hint(self) -> str:
        """Return what the count of rows says about why no frame is found; may be empty."""
        if self._n <= self.n_rows:
            return self._hint
        return (
            f"{self._n} rows came without a pause of {self.silence_s:g} s (key 'silence_s'), an "
            f"empty line or a line without data between them; a frame has {self.n_rows}"
        )

    def _flush(self) -> list[Assembled]:
        rows, self._rows = self._rows, []
        n, self._n = self._n, 0
        hurt, self._hurt = self._hurt, False
        if self._open and n == self.n_rows and not hurt:
            self._ever = True
            self._hint = ""
            gap = np.array([self._lost])
            self._lost = False
            return [Assembled(np.concatenate(rows)[None, :], np.array([self._end]), None, gap)]
        self.counts.discarded_pieces += n
        if self._open and (n or hurt):
            self._lost = self._ever
            self.counts.bad["incomplete"] += self._ever
            if n != self.n_rows:
                self._hint = f"frames come with {n} rows, the preset expects {self.n_rows}"
        return []

    def reset(self) -> None:
        """Forget what came before."""
        self.counts.discarded_pieces += self._n
        self._rows, self._n, self._open, self._hurt = [], 0, False, False
        self._lost = self._ever
