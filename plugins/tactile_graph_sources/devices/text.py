"""Framer of text lines of numbers."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from tactile_graph_sources.devices.counters import LinkCounts
from tactile_graph_sources.devices.preset import Preset, Text, unit_cells
from tactile_graph_sources.devices.units import Units

LONGEST_NUMBER = 12
"""Characters a number takes at most, separator included; bounds the buffer."""
LARGEST = 2**53


class TextFramer:
    """Reads lines; a line with the wrong count of numbers is bad, any other line is junk."""

    def __init__(self, preset: Preset, counts: LinkCounts) -> None:
        assert isinstance(preset.framer, Text)
        text = preset.framer
        self.counts = counts
        self.geometry = preset.geometry
        self.between = text.separator
        self.separator = text.separator.encode()
        self.digits = b"0123456789 \t".replace(self.separator, b"")
        self.head = text.prefix.encode() + self.separator if text.prefix else b""
        self.size_head = text.size_prefix.encode() + self.separator if text.size_prefix else b""
        self.timed = text.time_unit_s is not None
        self.trailing = text.trailing_separator
        self.n_numbers = unit_cells(preset) + self.timed
        self.residue = self.head + self.separator * (self.n_numbers - 1 + self.trailing)
        self.longest = len(self.head) + LONGEST_NUMBER * self.n_numbers + 64
        self.announced = ""
        self._wrong_size = False
        self._buffer = b""
        self._place = 0
        self._skipping = not self.head  # the first line may lack its beginning
        self._ever = False
        self._broken = self._opens = False
        self._run = (False, False)
        self._no_rows = (np.zeros((0, self.n_numbers), np.int64), np.zeros(0, np.int64))
        self._n_last = 0
        self._odd = b""

    def feed(self, data: bytes) -> list[Units]:
        """Take bytes, return the runs of good lines that they complete."""
        self._buffer += data
        *lines, self._buffer = self._buffer.replace(b"\r", b"\n").split(b"\n")
        out: list[Units] = []
        rows: list[NDArray[np.int64]] = []
        ends: list[int] = []
        for line in lines:
            self._place += len(line) + 1
            if not line:
                continue
            numbers = self._line(line)
            if numbers is None:
                self._flush(rows, ends, out)
                continue
            if not rows:
                self._claim()
                self.counts.resyncs += self._run[0] and self._ever
                self._ever = True
            rows.append(numbers)
            ends.append(self._place)
        self._flush(rows, ends, out)
        self._bound()
        return out

    def boundary(self) -> list[Units]:
        """Take note of a silence: what comes next starts afresh."""
        if self._buffer:
            self._bad(self._buffer, "short")
            self.counts.discarded_bytes -= 1  # there was no line end
            self._place += len(self._buffer)
            self._buffer = b""
        self._claim()
        out = [Units(*self._no_rows, *self._run)]
        self._skipping, self._opens = False, True
        return out

    def reset(self) -> None:
        """Forget what was buffered."""
        self.counts.discarded_bytes += len(self._buffer)
        self._place += len(self._buffer)
        self._buffer, self._skipping, self._broken = b"", not self.head, True

    def hint(self) -> str:
        """Return what the bytes themselves say about why no frame is found."""
        if self._wrong_size:
            g = self.geometry
            return f"the device announces {self.announced}, the preset has {g.rows} x {g.columns}"
        if self._n_last:
            return f"lines come with {self._n_last} numbers, the preset expects {self.n_numbers}"
        if self._odd:
            expected = f"with {self.head.decode()!r}" if self.head else "with a number"
            got = repr(self._odd).removeprefix("b")
            return f"a line begins with {got}, the preset expects it to begin {expected}"
        return ""

    def _bound(self) -> None:
        """Keep no more than a line can take: a line end that never comes fills no memory."""
        if len(self._buffer) > self.longest:
            self.counts.discarded_bytes += len(self._buffer)
            self._place += len(self._buffer)
            self._buffer, self._skipping, self._broken = b"", True, True

    def _flush(self, rows: list[NDArray[np.int64]], ends: list[int], out: list[Units]) -> None:
        if rows:
            out.append(self._units(rows, ends))
            rows.clear()
            ends.clear()

    def _claim(self) -> None:
        """Let the run that begins now own what went before it."""
        self._run = (self._broken, self._opens)
        self._broken = self._opens = False

    def _units(self, rows: list[NDArray[np.int64]], ends: list[int]) -> Units:
        """Return a run of lines, with what went before it."""
        broken, opens = self._run
        numbers = np.stack(rows)
        time = numbers[:, 0] if self.timed else None
        cells = numbers[:, 1:] if self.timed else numbers
        return Units(cells, np.array(ends, dtype=np.int64), broken, opens, time=time)

    def _line(self, line: bytes) -> NDArray[np.int64] | None:
        """Return a line's numbers, or None where it is bad or junk (counted as such)."""
        if self._skipping:
            self._skipping = False
            self.counts.discarded_bytes += len(line) + 1
            return None
        if line.translate(None, self.digits) != self.residue or self._wrong_size:
            self._refuse(line)
            return None
        try:
            numbers = np.fromstring(line[len(self.head) :], np.int64, sep=self.between)
        except ValueError:
            numbers = np.zeros(0, np.int64)
        if len(numbers) != self.n_numbers or numbers.max() > LARGEST:
            self._bad(line, "number")
            return None
        return numbers

    def _refuse(self, line: bytes) -> None:
        """Tell bad data from junk."""
        if self.size_head and line.startswith(self.size_head):
            self._take_size(line)
            return
        rest = line.translate(None, self.digits)
        if not line.startswith(self.head):
            self._junk(line)
        elif rest.replace(self.separator, b"") != self.head[:-1]:
            # A line without a prefix that holds other characters is no data at all.
            if self.head:
                self._bad(line, "text")
            else:
                self._junk(line)
        else:
            n = rest.count(self.separator) - self.residue.count(self.separator)
            self._n_last = self.n_numbers + n
            self._bad(line, "size" if self._wrong_size else "short" if n < 0 else "long")

    def _take_size(self, line: bytes) -> None:
        self.counts.discarded_bytes += len(line) + 1
        want = b"%d%s%d" % (self.geometry.rows, self.separator, self.geometry.columns)
        got = line[len(self.size_head) :].strip()
        self._wrong_size = got != want
        self.announced = got.decode("ascii", "replace").replace(",", " x ")

    def _junk(self, line: bytes) -> None:
        self._odd = line[:20]
        self.counts.discarded_bytes += len(line) + 1
        self._opens = True

    def _bad(self, line: bytes, cause: str) -> None:
        self.counts.discarded_bytes += len(line) + 1
        self._broken = True
        if self._ever:
            self.counts.bad[cause] += 1
