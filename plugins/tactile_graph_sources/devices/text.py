"""Framer of text lines of numbers."""

from __future__ import annotations

from collections import deque
from statistics import median_low
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tactile_graph_sources.devices.counters import LinkCounts
from tactile_graph_sources.devices.preset import Preset, Text, unit_cells
from tactile_graph_sources.devices.units import Units

LONGEST_NUMBER = {"whole": 12, "any": 26}
"""Characters a number takes at most, separator included; bounds the buffer."""
LARGEST = 2**53
OTHER_SEPARATORS = ",;\t|:/ "
NO_NUMBER = "which is no number"
SHOWN = 20
"""Characters of a line or value that a hint repeats."""


class TextFramer:
    """Reads lines; a line with the wrong count of numbers is bad, any other line is junk.

    Of rows, an empty line ends a frame, unless as many stand behind most rows.

    Lines of digits, which most are, are read at once; others number by number, where the preset
    allows such.
    """

    def __init__(self, preset: Preset, counts: LinkCounts) -> None:
        assert isinstance(preset.framer, Text)
        text = preset.framer
        self.counts = counts
        self.geometry = preset.geometry
        self.between = text.separator
        self.separator = text.separator.encode()
        self.whole = text.numbers == "whole"
        self.digits = b"0123456789 \t".replace(self.separator, b"")
        self.letters = b"0123456789 \t+-.eEnNaA".replace(self.separator, b"")
        self.head = text.prefix.encode() + self.separator if text.prefix else b""
        self.size_head = text.size_prefix.encode() + self.separator if text.size_prefix else b""
        self.timed = text.time_unit_s is not None
        self.trailing = text.trailing_separator
        self.n_numbers = unit_cells(preset) + self.timed
        self.residue = self.separator * (self.n_numbers - 1 + self.trailing)
        self.longest = len(self.head) + LONGEST_NUMBER[text.numbers] * self.n_numbers + 64
        self.announced = ""
        self._wrong_size = False
        self._buffer = b""
        self._place = 0
        self._skipping = not self.head  # the first line may lack its beginning
        self._ever = False
        self._broken = self._opens = False
        self._run = (False, False)
        self._no_rows = (np.zeros((0, self.n_numbers), np.int64), np.zeros(0, np.int64))
        self._bad_line = self._junk_line = b""
        self._by_rows = preset.assembler == "rows"
        self._usual: deque[int] = deque(maxlen=preset.geometry.rows)
        """Empty lines behind each of the last rows, as many as a frame has."""
        self._n_empty = 0
        self._behind_row = False

    def feed(self, data: bytes) -> list[Units]:
        """Take bytes, return the runs of good lines that they complete."""
        self._buffer += data
        *lines, self._buffer = self._buffer.replace(b"\r", b"\n").split(b"\n")
        out: list[Units] = []
        rows: list[NDArray[Any]] = []
        ends: list[int] = []
        for line in lines:
            self._place += len(line) + 1
            if not line:
                if self._ends_frame():
                    self._flush(rows, ends, out)
                    self._claim()
                    out.append(Units(*self._no_rows, *self._run))
                continue
            self._note_empty()
            numbers = self._line(line)
            self._behind_row = numbers is not None
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

    def _ends_frame(self) -> bool:
        """Take note of an empty line; return whether it stands where rows usually have none.

        Both bytes of a line end count, so that there may be one or more behind every row.
        """
        self._n_empty += 1
        return bool(self._usual) and self._n_empty == median_low(self._usual) + 1

    def _note_empty(self) -> None:
        if self._behind_row and self._by_rows:
            self._usual.append(self._n_empty)
        self._n_empty = 0

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
        self._usual.clear()
        self._n_empty, self._behind_row = 0, False

    def hint(self) -> str:
        """Return what the bytes themselves say about why no frame is found."""
        if self._wrong_size:
            g = self.geometry
            return f"the device announces {self.announced}, the preset has {g.rows} x {g.columns}"
        line = self._bad_line or self._junk_line
        return self._explained(line) if line else ""

    def _explained(self, line: bytes) -> str:
        """Return in words why a line is refused."""
        begins = f"a line begins with {_shown(line)}, the preset expects it to begin with"
        if not line.startswith(self.head):
            return f"{begins} {self.head.decode()!r}"
        fields = line[len(self.head) :].split(self.separator)
        ends = not fields[-1].strip() and (self.trailing or len(fields) > self.n_numbers)
        if ends:
            fields.pop()
        if len(fields) == 1 < self.n_numbers and (other := _separator_of(fields[0])):
            return (
                f"the numbers of a line stand between {other!r}, the preset expects "
                f"{self.between!r} (key 'separator')"
            )
        for k, field in enumerate(fields, 1):
            trouble = self._trouble(field, time=self.timed and k == 1)
            if trouble == NO_NUMBER and k == 1 and not self.head:
                return f"{begins} a number"
            if trouble:
                return f"value {k} of a line is {_shown(field)}, {trouble}"
        return self._miscounted(len(fields), ends)

    def _trouble(self, field: bytes, time: bool = False) -> str:
        """Return what is wrong with a number; "" if nothing is."""
        if not field.strip():
            return "which is empty"
        try:
            number = float(field)
        except ValueError:
            return NO_NUMBER
        if self.whole and field.translate(None, self.digits):
            return "the preset expects whole numbers from 0 on (key 'numbers')"
        if time and not 0.0 <= number <= LARGEST:
            return "which is no time"
        return "which is not finite" if np.isinf(number) else ""

    def _miscounted(self, n: int, ends: bool) -> str:
        if n == self.n_numbers and ends != self.trailing:
            how = "ends" if ends else "does not end"
            return f"a line {how} with {self.between!r} (key 'trailing_separator')"
        return f"lines come with {n} numbers, the preset expects {self.n_numbers}"

    def _bound(self) -> None:
        """Keep no more than a line can take: a line end that never comes fills no memory."""
        if len(self._buffer) > self.longest:
            self.counts.discarded_bytes += len(self._buffer)
            self._place += len(self._buffer)
            self._buffer, self._skipping, self._broken = b"", True, True

    def _flush(self, rows: list[NDArray[Any]], ends: list[int], out: list[Units]) -> None:
        if rows:
            out.append(self._units(rows, ends))
            rows.clear()
            ends.clear()

    def _claim(self) -> None:
        """Let the run that begins now own what went before it."""
        self._run = (self._broken, self._opens)
        self._broken = self._opens = False

    def _units(self, rows: list[NDArray[Any]], ends: list[int]) -> Units:
        """Return a run of lines, with what went before it."""
        broken, opens = self._run
        numbers = np.stack(rows)
        time = numbers[:, 0] if self.timed else None
        cells = numbers[:, 1:] if self.timed else numbers
        return Units(cells, np.array(ends, dtype=np.int64), broken, opens, time=time)

    def _line(self, line: bytes) -> NDArray[Any] | None:
        """Return a line's numbers, or None where it is bad or junk (counted as such)."""
        if self._skipping:
            self._skipping = False
            self.counts.discarded_bytes += len(line) + 1
            return None
        if self._wrong_size or not line.startswith(self.head):
            self._refuse(line)
            return None
        text = line[len(self.head) :]
        numbers: NDArray[Any] | None
        if text.translate(None, self.digits) == self.residue:
            numbers = self._whole_numbers(text)
        else:
            numbers = None if self.whole else self._any_numbers(text)
        if numbers is None:
            self._refuse(line)
        return numbers

    def _whole_numbers(self, text: bytes) -> NDArray[np.int64] | None:
        """Return the numbers of a line that holds nothing but digits and separators."""
        try:
            numbers = np.fromstring(text, np.int64, sep=self.between)
        except ValueError:
            return None
        good = len(numbers) == self.n_numbers and numbers.max() <= LARGEST
        return numbers if good else None

    def _any_numbers(self, text: bytes) -> NDArray[np.float64] | None:
        """Return the numbers of a line, NaN among them for what the pad has no value of."""
        if text.translate(None, self.letters) != self.residue:
            return None
        fields = text.split(self.separator)
        if self.trailing and fields.pop().strip():
            return None
        try:
            numbers = np.array([float(field) for field in fields])
        except ValueError:
            return None
        timed = not self.timed or 0.0 <= numbers[0] <= LARGEST
        return numbers if timed and not np.isinf(numbers).any() else None

    def _refuse(self, line: bytes) -> None:
        """Tell bad data from junk."""
        if self.size_head and line.startswith(self.size_head):
            self._take_size(line)
            return
        if not line.startswith(self.head):
            self._junk(line)
            return
        text = line[len(self.head) :]
        n = text.count(self.separator) - len(self.residue)
        known = (self.digits if self.whole else self.letters) + self.separator
        if text.translate(None, known):
            # A line without a prefix that holds other characters is no data at all.
            if self.head or self._like_data(text, n):
                self._bad(line, "text")
            else:
                self._junk(line)
                return
        elif n == 0 and not self._wrong_size:
            self._bad(line, "number")
        else:
            self._bad(line, "size" if self._wrong_size else "short" if n < 0 else "long")
        self._bad_line = line

    def _like_data(self, text: bytes, n: int) -> bool:
        """Return whether a line has as many values as it must have, and begins with a number."""
        first = text.split(self.separator, 1)[0]
        return not self.whole and n == 0 and self.n_numbers > 1 and not self._trouble(first)

    def _take_size(self, line: bytes) -> None:
        self.counts.discarded_bytes += len(line) + 1
        want = b"%d%s%d" % (self.geometry.rows, self.separator, self.geometry.columns)
        got = line[len(self.size_head) :].strip()
        self._wrong_size = got != want
        self.announced = got.decode("ascii", "replace").replace(",", " x ")

    def _junk(self, line: bytes) -> None:
        self._junk_line = line
        self.counts.discarded_bytes += len(line) + 1
        self._opens = True

    def _bad(self, line: bytes, cause: str) -> None:
        self.counts.discarded_bytes += len(line) + 1
        self._broken = True
        if self._ever:
            self.counts.bad[cause] += 1


def _shown(text: bytes) -> str:
    return repr(text[:SHOWN]).removeprefix("b")


def _separator_of(text: bytes) -> str:
    """Return what seems to stand between the numbers of a line; "" if nothing does."""
    for other in OTHER_SEPARATORS:
        fields = text.strip().split(other.encode())
        try:
            if len([float(field) for field in fields if field]) > 1:
                return other
        except ValueError:
            continue
    return ""
