"""``Reading``: one file while it is read, its troubles, and how its frames are made."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tactile_graph.errors import DataError
from tactile_graph.steps import Report
from tactile_graph.wires import FARTHEST_CM, LARGEST, PITCHES_CM, Frame, Image, TrueObject
from tactile_graph.wires.frame_stack import MOST_BYTES, MOST_FRAMES, FrameStack
from tactile_graph.wires.stacks import ImageStack
from tactile_graph_sources.readers.head import Head
from tactile_graph_sources.readers.words.counter import runs_over
from tactile_graph_sources.readers.words.filled import filling
from tactile_graph_sources.readers.words.own_number import counted
from tactile_graph_sources.readers.words.steady import Steady
from tactile_graph_sources.readers.words.told import Told

OF_TIMES = ("time_unit", "time_format")
"""Settings that are about times wherever they stand, not about columns alone."""
PITCH_UNTOLD = "recordings whose pitch is assumed to be 1 cm"
FEWEST_COUNTED, BEGUN = 32, 0.1
"""Frames by whose numbers it is known that they count, and the share of these that one which begins
anew may have left out."""


class Reading:
    """One file on its way to frames.

    Parameters
    ----------
    head : Head
    told : Told
        What the settings say; the file's own word counts where they say nothing.
    report : Report
        Takes counters and troubles.
    index : int
        Number of the first frame, where other files came before.
    label : str
        Put before the sensor's name in the frames' labels, where there are several files.
    """

    def __init__(
        self, head: Head, told: Told, report: Report, index: int = 0, label: str = ""
    ) -> None:
        self.head = head
        self.path: Path = head.path
        self.told = told
        self.report = report
        self.index = self.start = index
        self.place = 0
        """Which frame of the recording comes next, from 0; those that are left out count."""
        self.why = ""
        self.label = label
        self.sensors: dict[str, None] = {}
        self.first_damage = ""
        self._gaps: set[str] = set()
        self._seen: dict[str, set[float]] = {}
        self._last: dict[str, float] = {}
        self._fresh: set[str] = set()
        self.steady = Steady()
        self.is_own = False
        """Whether the project wrote the file, which says itself what cells are missing."""
        self.in_stacks = False
        """Whether frames are taken as stacks, where the file holds them so."""

    def of_part(self, head: Head) -> Reading:
        """Return the reading of one of the files that make up this recording, from its next frame.

        What is told once for a recording is not told again, and a gap goes over to the next file.
        """
        part = Reading(head, self.told, self.report, self.index, self.label)
        part.start, part.place, part.sensors = self.start, self.place, self.sensors
        part._fresh, part._gaps, part.steady = self._fresh, self._gaps, self.steady
        return part

    def text(self) -> Iterator[tuple[int, str]]:
        """Yield line numbers from 1 and lines without their ends, whatever ends them.

        Names that stand before each number or row of numbers are left out.
        """
        labels = self.head.labels
        with self.path.open(encoding=self.head.encoding, errors="backslashreplace") as file:
            for number, line in enumerate(file, 1):
                text = line.rstrip("\n")
                yield number, text if labels is None else labels.plain(text)

    def check_unchanged(self) -> None:
        """Refuse what was read of a file that was written meanwhile; raises DataError."""
        if self.head.seen is not None:
            self.head.seen.check(self.path, self.report)

    def count_bytes(self, needle: bytes) -> int:
        """Return how often ``needle`` stands in the file, to say how many frames to expect."""
        n, tail = 0, b""
        with self.path.open("rb") as file:
            while block := file.read(1 << 20):
                n += (tail + block).count(needle)
                tail = (tail + block)[-len(needle) + 1 :] if len(needle) > 1 else b""
        return n

    def lines_from(self, needle: bytes) -> Iterator[str]:
        """Yield the lines from the first one that starts with ``needle`` on; none without it."""
        with self.path.open("rb") as file:
            tail, place = b"", 0
            while block := file.read(1 << 20):
                found = (tail + block).find(b"\n" + needle)
                if found >= 0:
                    file.seek(place - len(tail) + found + 1)
                    yield from (line.decode("utf-8", "backslashreplace") for line in file)
                    return
                place += len(block)
                tail = block[-len(needle) :]

    def recognised(self, why: str, assumed: Iterable[str] = ()) -> None:
        """Note how the format was recognised, and what about it nobody said."""
        self.why = why
        for what in assumed:
            self.assume(what)

    def assume(self, what: str) -> None:
        """Note, once for the file, what nobody said and is taken to be so."""
        self._once(f"recordings with {what}")

    def heed(self, what: str) -> None:
        """Note likewise what the file itself says, or its reader was asked for."""
        self._once(f"recordings with {what}", self.report.count)

    def refuse_settings(self, *obeyed: str) -> None:
        """Refuse settings of columns and times but those ``obeyed``, for a file that has no use
        for them.

        Raises
        ------
        DataError
            If one is given.
        """
        unfit = [name for name in self.told.of_columns.given if name not in obeyed]
        if columns := [n for n in unfit if not n.startswith(OF_TIMES)]:
            why = "it has no columns, as tables have"
            raise DataError(str(self.path), _leave_out(columns, why))
        if unfit:
            why = "its times, if it has any, are in the unit that its format says"
            raise DataError(str(self.path), _leave_out(unfit, why))

    def pass_settings(self) -> None:
        """Note settings of columns and times that a file of ours, which says itself, passes by."""
        for name in self.told.of_columns.given:
            self.assume(f"{name} left out, as a file of ours says itself what it holds")

    def at(self, line: int | str) -> str:
        """Return a place in the file for messages."""
        return f"{self.path}:{line}"

    def damaged(
        self, line: int | str, what: str, sensors: Iterable[str] = (), n_frames: int = 1
    ) -> None:
        """Note a record that is left out; the next frame is marked as after a gap.

        Parameters
        ----------
        line : int or str
        what : str
        sensors : iterable of str
            Where they are named, the next frame of each of them is marked.
        n_frames : int
            How many frames are left out with it: 0 where it is no frame, or nobody knows.
        """
        self.place += n_frames
        self.report.count("damaged records skipped")
        self.report.trouble(self.at(line), what)
        self.first_damage = self.first_damage or f"line {line}: {what}"
        self._gaps |= set(sensors) or {""}

    def is_repeat(self, line: int | str, number: float, name: str, sensor: str = "") -> bool:
        """Return whether a frame of that number was given before; if so, note that it is dropped.

        Of frames with the same number the first whole one is kept. A number that falls back to
        where they began is of a counter that ran over, or of a device that started again.
        """
        seen = self._seen.setdefault(sensor, set())
        last = self._last.get(sensor, number)
        self._last[sensor] = number
        fell = len(seen) >= FEWEST_COUNTED and last - number >= len(seen) / 2
        again = fell and number in seen and number <= min(seen) + BEGUN * len(seen)
        if again or runs_over(last, number):
            self.report.count("frame numbers that begin anew")
            seen.clear()
        if number in seen:
            self.repeated(line, name)
            self.place += 1
            return True
        seen.add(number)
        return False

    def repeated(self, line: int | str, name: str) -> None:
        """Note a frame that was given before and is dropped."""
        self.report.count("repeated frames dropped")
        self.report.trouble(self.at(line), f"{name} comes again; the first one is kept")

    def wants(self, sensor: str) -> bool:
        """Return whether the settings ask for that sensor, by name or part of it."""
        self.sensors[sensor] = None
        return self.told.sensor.lower() in sensor.lower()

    def frame(
        self,
        values: NDArray[Any],
        *,
        pitch_cm: tuple[float, float] | None = None,
        origin_cm: tuple[float, float] | None = None,
        quantity: str = "raw",
        factor: float = 1.0,
        time_s: float | None = None,
        sensor: str = "",
        valid: NDArray[np.bool_] | None = None,
        truth: tuple[TrueObject, ...] | None = None,
        device_time_s: float | None = None,
        gap: bool = False,
        own_number: float | None = None,
    ) -> Frame:
        """Return the next frame; cells without a reading or not ``valid`` become invalid.

        ``own_number`` is the number that the file gives it, which counts if it is a whole one.
        """
        with np.errstate(over="ignore"):
            values = np.array(values, dtype=np.float64)  # the one copy: frames own their values
            filled = None if self.is_own else filling(values)
            good = np.abs(values) <= LARGEST
            if filled is not None:
                good &= values != filled
                self.assume(f"cells of {filled:g} taken for missing")
                self.steady.is_over = True
            if self.told.missing is not None:
                good &= values != self.told.missing
            elif not self.steady.is_over:
                self.steady.see(values)
            if factor != 1.0:
                values *= factor
                good &= np.abs(values) <= LARGEST
        if valid is not None:
            good &= valid
        if good.all():
            mask = None
        else:
            mask = good
            values[~good] = 0.0  # a NaN left in place would spread through the first sum
        values, mask = self._turned(values, mask, truth)
        image = Image(
            values,
            *self.grid(values.shape, pitch_cm, origin_cm, quantity),
            mask,
        )
        gap = gap or not self._gaps.isdisjoint(("", sensor))
        self._gaps -= {"", sensor}
        label = " ".join(filter(None, (self.label, sensor)))
        frame = Frame(
            image,
            self.index,
            time_s,
            truth,
            device_time_s,
            gap,
            label,
            place=self.place,
            own_number=counted(own_number),
        )
        self.index += 1
        self.place += 1
        return frame

    def of_state(self, frame: Frame, state_of: str | None) -> Frame:
        """Return a frame whose state is that of a sensor or file, whatever its label says."""
        if state_of is None:
            return frame
        return replace(frame, state_of=" ".join(filter(None, (self.label, state_of))))

    def frames(
        self,
        values: NDArray[Any],
        times_s: NDArray[np.float64] | None = None,
        *,
        factor: float = 1.0,
        **same: Any,
    ) -> Iterator[Frame | FrameStack]:
        """Yield the frames of a stack: as stacks, as long as nothing is to be said of single ones.

        Parameters
        ----------
        values : ndarray, shape (n, rows, columns)
        times_s : ndarray, shape (n,), optional
            NaN where none is known.
        factor, same
            As of `frame`, the same for all.
        """
        size = max(1, min(MOST_FRAMES, MOST_BYTES // max(values[0].size * 8, 1)))
        for start in range(0, len(values), size):
            part = slice(start, start + size)
            times = None if times_s is None else times_s[part]
            stack = self._stack(values[part], times, factor, same)
            if stack is not None:
                yield stack
                continue
            for k, matrix in enumerate(values[part]):
                timed = times is not None and bool(np.isfinite(times[k]))
                time_s = float(times[k]) if times is not None and timed else None
                yield self.frame(matrix, factor=factor, time_s=time_s, **same)

    def grid(
        self,
        shape: tuple[int, ...],
        pitch_cm: tuple[float, float] | None = None,
        origin_cm: tuple[float, float] | None = None,
        quantity: str = "raw",
    ) -> tuple[tuple[float, float], tuple[float, float], str]:
        """Return pitch, origin and quantity of frames: the settings', or what the file says.

        Raises
        ------
        DataError
            If they cannot be true, or the two disagree.
        """
        if self.told.pads:
            pitch_cm = self._beside_pads(shape, pitch_cm)
        return self._pitch(pitch_cm), self._origin(origin_cm), self._quantity(quantity)

    def _stack(
        self,
        values: NDArray[Any],
        times_s: NDArray[np.float64] | None,
        factor: float,
        same: dict[str, Any],
    ) -> FrameStack | None:
        """Return frames as a stack; None where each must be looked at for itself."""
        untold = times_s is not None and not np.isfinite(times_s).all()
        turned = self.told.transpose or self.told.flip
        if not self.in_stacks or untold or turned or self.label or self._gaps:
            return None
        with np.errstate(over="ignore"):
            values = np.array(values, dtype=np.float64)
            if not self.is_own and filling(values) is not None:
                return None
            if self.told.missing is not None and (values == self.told.missing).any():
                return None
            for frame in values:
                if self.steady.is_over:
                    break
                self.steady.see(frame)
            if factor != 1.0:
                values *= factor
        if not -LARGEST <= values.min() <= values.max() <= LARGEST:  # no NaN is
            return None
        images = ImageStack(values, *self.grid(values.shape[1:], **same))
        index = np.arange(self.index, self.index + len(values))
        place = np.arange(self.place, self.place + len(values))
        self.index += len(values)
        self.place += len(values)
        return FrameStack(images, index, times_s, place=place)

    def _turned(
        self, values: NDArray[Any], mask: NDArray[np.bool_] | None, truth: object
    ) -> tuple[NDArray[Any], NDArray[np.bool_] | None]:
        told = self.told
        if not (told.transpose or told.flip):
            return values, mask
        if truth is not None:
            raise DataError(
                str(self.path), "its truth lies as its cells do; leave out transpose and flip"
            )
        values = np.ascontiguousarray(told.turned(values))
        return values, None if mask is None else np.ascontiguousarray(told.turned(mask))

    def _beside_pads(
        self, shape: tuple[int, ...], own: tuple[float, float] | None
    ) -> tuple[float, float] | None:
        """Return the file's pitch, or that of a told pad; note pads that it cannot be of."""
        rows, columns = shape
        known = self.told.pitch_cm or (own[::-1] if own and self.told.transpose else own)
        for pad in self.told.pads:
            if known is None and (pitch := pad.pitch_of((rows, columns))) is not None:
                whose = f"that of {pad.name}, {pitch:g} cm"
                self._once(f"recordings whose pitch is assumed to be {whose}")
                own = known = pitch, pitch
            if misfit := pad.misfit((rows, columns), known):
                self._once(f"recordings whose {misfit}")
        return own

    def _pitch(self, own: tuple[float, float] | None) -> tuple[float, float]:
        pitch = self.told.pitch_cm or own
        if pitch is None:
            self._once(PITCH_UNTOLD)
            return 1.0, 1.0
        low, high = PITCHES_CM
        if not (low <= min(pitch) and max(pitch) <= high):
            text = f"a pitch of {pitch[0]:g} x {pitch[1]:g} cm; allowed are {low:g} to {high:g}"
            raise DataError(str(self.path), text)
        turned = self.told.transpose and self.told.pitch_cm is None
        return (pitch[1], pitch[0]) if turned else pitch

    def _origin(self, own: tuple[float, float] | None) -> tuple[float, float]:
        if own is not None and self.told.transpose:
            own = own[::-1]
        x, y = origin = self.told.origin_cm or own or (0.0, 0.0)
        if not (abs(x) <= FARTHEST_CM and abs(y) <= FARTHEST_CM):
            text = f"an origin at ({x:g}, {y:g}) cm; allowed are {FARTHEST_CM:g} cm to either side"
            raise DataError(str(self.path), text)
        return origin

    def published(self, pitch_cm: tuple[float, float], device: str) -> tuple[float, float]:
        """Return a pitch that the file does not say, noting whose it is unless one is told."""
        if self.told.pitch_cm is None:
            x, y = pitch_cm
            self.assume(f"the pitch assumed to be that of {device}, {x:g} x {y:g} cm")
        return pitch_cm

    def _quantity(self, own: str) -> str:
        told = self.told.quantity
        if told not in (None, "raw") and own not in ("raw", told):
            raise DataError(
                str(self.path),
                f"its values are {own}, the settings say {told}; leave that out, or say raw to take"
                " them for bare readings",
            )
        return told or own

    def _once(self, what: str, told: Callable[[str], None] | None = None) -> None:
        if what not in self._fresh:
            self._fresh.add(what)
            (told or self.report.assume)(what)


def _leave_out(names: list[str], why: str) -> str:
    return f"{' and '.join(names)}: {why}; leave {'it' if len(names) == 1 else 'them'} out"
