"""Which frame of a recording a file of truth means by a number."""

from __future__ import annotations

from typing import Literal

from tactile_graph.errors import DataError
from tactile_graph.foreign_text import tell
from tactile_graph.wires import Frame

By = Literal["frames", "places", "numbers"]
BY: tuple[By, ...] = ("frames", "places", "numbers")
"""Columns of a table of truth that say which frames a line is about; it has one of them.

``places`` counts the frames as they stand in the recording, from 0, those that were left out too;
``numbers`` takes the numbers that the recording itself gives them. ``frames`` are places as well,
and refused where the recording's own numbers tell otherwise.
"""
_WAY_OUT = (
    "name the column 'numbers' to count by the recording's own numbers, or 'places' to count the "
    "frames as they stand in it, from 0"
)


class Counting:
    """Gives each frame, in turn, the number by which truth is looked up.

    What may surprise is told on stderr, once each: that frames which were left out count, that the
    recording marks a gap of nobody knows how many, and that its own numbers begin elsewhere.

    Parameters
    ----------
    path : str
        The file of truth, for messages.
    by : str
        How it counts, one of `BY`.
    """

    def __init__(self, path: str, by: By) -> None:
        self._path, self._by = path, by
        self._due = 0
        self._last: dict[str, tuple[int, int]] = {}
        self._last_label = ""
        self._seen: set[tuple[str, int]] = set()
        self._told: set[str] = set()
        self.last = -1
        """The largest number that was given."""
        self.numbers_itself = False
        """Whether the recording gave a frame a number of its own."""

    def of(self, frame: Frame) -> int:
        """Return the number of the next frame.

        Raises
        ------
        DataError
            If it has none, or it is not sure which one is meant.
        """
        place = frame.index if frame.place is None else frame.place
        own = frame.own_number
        self.numbers_itself |= own is not None
        number = self._own(frame, place) if self._by == "numbers" else place
        if self._by != "numbers":
            if self._by == "frames" and own is not None:
                self._check(frame.label, place, own)
            self._tell_of(frame, place)
        self._due = place + 1
        self.last = max(self.last, number)
        return number

    def _own(self, frame: Frame, place: int) -> int:
        number = frame.own_number
        if number is None:
            raise DataError(
                self._path,
                "its column 'numbers' counts by the numbers that the recording gives its frames, "
                f"and frame {place}, counted from 0, has none; name the column 'frames' to count "
                "the frames as they stand there, from 0",
            )
        if (frame.label, number) in self._seen:
            raise DataError(
                self._path,
                "its column 'numbers' counts by the numbers that the recording gives its frames, "
                f"and {number} comes again at frame {place}, counted from 0; name the column "
                "'places' to count the frames as they stand there, from 0",
            )
        self._seen.add((frame.label, number))
        return number

    def _check(self, label: str, place: int, own: int) -> None:
        """Refuse numbers of the recording's own that do not go on as its frames do."""
        before = self._last.get(label)
        alone = label == self._last_label
        self._last[label], self._last_label = (place, own), label
        if before is None:
            if own != place:
                self._tell_once(
                    "own",
                    f"frames are counted from 0 as they stand in the recording, which itself gives "
                    f"frame {place} the number {own}; name the column 'numbers' to count by its "
                    "own numbers",
                )
            return
        step, places = own - before[1], place - before[0]
        # Frames of several sensors take turns, and then only each one's own numbers tell.
        if (step != places and (step != 1 or not label)) or (step != 1 and not alone):
            raise DataError(
                self._path,
                "its column 'frames' may mean two things: the recording numbers its frames "
                f"itself, and after {before[1]} comes {own} at frame {place}, counted from 0 as "
                f"they stand there; {_WAY_OUT}",
            )

    def _tell_of(self, frame: Frame, place: int) -> None:
        if place > self._due and place > frame.index:
            self._tell_once(
                "left out",
                "frames are counted from 0 as they stand in the recording; those that were left "
                f"out, of which {self._due} is the first, count too",
            )
        elif frame.gap and frame.own_number is None:
            self._tell_once(
                "gap",
                f"the recording marks a gap before frame {place}; how many frames are missing "
                "there nobody knows, and none is counted",
            )

    def _tell_once(self, what: str, text: str) -> None:
        if what not in self._told:
            self._told.add(what)
            tell(f"{self._path}: {text}")
