"""What results come to: of each recording, and of all."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from itertools import islice
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tactile_graph.cli.summary.quantiles import Numbers
from tactile_graph.cli.summary.reading import LEAD, Chunk, Column, Lines, as_float, is_long
from tactile_graph.vocabulary import UNITS, error_name, words_and_unit

LONG = ("output", "item", "outcome", "type")
SHARES = (0.05, 0.25, 0.5, 0.75, 0.95)
HALF_TURN = {"°": 180.0, "rad": math.pi}
"""By unit of an angle; axes, as those of shapes, wrap at a quarter to either side of 0."""
JITTER = 3.0
"""Usual steps by which frames may come out of order, on one clock."""
MOST_WORDS = 1000
"""How many different reasons or texts are told apart."""
OTHERS = "(others)"
WHOLE_RECORDINGS = 64
"""Of so many recordings, the latest, all is kept that makes their quantiles exact."""


class Quantity(NamedTuple):
    """A column whose numbers are in one unit: those of another are another quantity."""

    key: str
    unit: str
    """"" where the numbers are bare, or nobody told it."""


class Statistics(NamedTuple):
    """What numbers come to; NaN what there is none of. ``quantiles`` are those at `SHARES`."""

    mean: float
    least: float
    most: float
    quantiles: NDArray[np.float64]


@dataclass
class Times:
    """When frames were taken, in the clock of their recording."""

    lasts_s: float | None = None
    """What passed from frame to frame, where a clock that begins anew counts nothing; None where no
    frame has a time."""
    n_back: int = 0
    """How often the clock goes back."""
    _last_s: float = math.nan

    def add(self, time_s: NDArray[np.float64]) -> None:
        """Take in times; NaN is none."""
        known = time_s[np.isfinite(time_s)]
        if known.size:
            steps = np.diff(known, prepend=self._last_s)
            onward = steps[steps > 0.0]
            near = JITTER * float(np.median(onward)) if onward.size else 0.0
            passed = steps[(steps > 0.0) | (steps >= -near)]
            self.lasts_s = (self.lasts_s or 0.0) + float(passed.sum())
            self.n_back += int(np.count_nonzero(steps < 0.0))
            self._last_s = float(known[-1])


@dataclass
class Group:
    """What some results come to: those of a recording, or all."""

    frames: int = 0
    times: Times = field(default_factory=Times)
    outcomes: dict[str, Counter[str]] = field(default_factory=dict)
    """By output, how often each outcome: ``ok``, ``skipped: why``, ``failed: why``."""
    numbers: dict[Quantity, Numbers] = field(default_factory=dict)
    """Errors by their size."""
    signed: dict[Quantity, Numbers] = field(default_factory=dict)
    """Errors with their sign, where they have one."""
    turned: dict[Quantity, Numbers] = field(default_factory=dict)
    """Angles below 0, errors apart, by half a turn more: those of axes that lie across the pad."""
    texts: dict[str, Counter[str]] = field(default_factory=dict)
    _last_frame: float = math.nan

    def count_frames(self, numbers: NDArray[np.float64]) -> None:
        """Count frames by the numbers in their rows, several rows of one standing together."""
        if numbers.size:
            new = int(numbers[0] != self._last_frame) + int(np.count_nonzero(np.diff(numbers)))
            self.frames += new
            self._last_frame = float(numbers[-1])

    def add_outcomes(self, output: str, words: Mapping[str, int]) -> None:
        """Count outcomes of an output."""
        _count(self.outcomes.setdefault(output, Counter()), words)

    def add_values(self, key: str, values: Column, unit: str) -> None:
        """Take in the values of a column."""
        if values.dtype == object:
            _count(
                self.texts.setdefault(key, Counter()), Counter(v for v in values if v is not None)
            )
            return
        told = values[~np.isnan(values)]
        quantity = Quantity(key, unit)
        if "_error_" in key:
            self.signed.setdefault(quantity, Numbers()).add(told)
            told = np.abs(told)
        elif unit in HALF_TURN:
            turned = np.where(told < 0.0, told + HALF_TURN[unit], told)
            self.turned.setdefault(quantity, Numbers()).add(turned)
        self.numbers.setdefault(quantity, Numbers()).add(told)

    def statistics(self, quantity: Quantity) -> Statistics:
        """Return what the numbers of a quantity come to.

        Angles have no mean. Those of axes are taken from where fewest lie, so that 88, 90 and -88
        degrees are 88, 90 and 92; where they lie all around, they have no order either.
        """
        numbers, half_turn = self.numbers[quantity], HALF_TURN.get(quantity.unit)
        mean, turned = numbers.mean, self.turned.get(quantity)
        widest = math.inf
        if half_turn is not None:
            mean = math.nan
        if half_turn is not None and turned is not None and numbers.n:
            axes = max(-numbers.least, numbers.most) <= 0.5 * half_turn
            both = numbers.least < 0.0 <= numbers.most  # of one sign, they lie as near as turned
            if axes and both and turned.most - turned.least < numbers.most - numbers.least:
                numbers = turned
            widest = 0.5 * half_turn if axes else half_turn
        quantiles = numbers.quantiles(SHARES)
        if quantiles[-1] - quantiles[0] > widest:
            return Statistics(mean, math.nan, math.nan, np.full(len(SHARES), math.nan))
        ends = (numbers.least, numbers.most) if numbers.n else (math.nan, math.nan)
        return Statistics(mean, *ends, quantiles)

    def spoken_for(self, units: Mapping[str, str]) -> None:
        """Give the numbers of columns that no unit was told of the one that is told of others."""
        for table in (self.numbers, self.signed, self.turned):
            for quantity in [q for q in table if not q.unit and q.key in units]:
                numbers, other = table.pop(quantity), Quantity(quantity.key, units[quantity.key])
                if other in table:
                    table[other].take(numbers)
                else:
                    table[other] = numbers

    def compress(self) -> None:
        """Take little memory from now on."""
        for table in (self.numbers, self.signed, self.turned):
            for numbers in table.values():
                numbers.compress()

    def ended(self, how: str) -> int:
        """Return how many outcomes are ``ok``, ``skipped`` or ``failed``."""
        return sum(
            n for words in self.outcomes.values() for w, n in words.items() if kind(w) == how
        )


@dataclass
class Summary:
    """What results come to, by recording and in all."""

    recordings: dict[str, Group] = field(default_factory=dict)
    all: Group = field(default_factory=Group)

    @property
    def frames(self) -> int:
        """Of all recordings."""
        return sum(group.frames for group in self.recordings.values())

    @property
    def lasts_s(self) -> float | None:
        """Of all recordings whose frames have times, together."""
        told = [g.times.lasts_s for g in self.recordings.values()]
        known = [t for t in told if t is not None]
        return sum(known) if known else None

    @property
    def n_steps(self) -> int:
        """How many steps from frame to frame those seconds are."""
        return self.frames - sum(1 + g.times.n_back for g in self.recordings.values())

    def add(self, chunk: Chunk | Lines, otherwise: str, prefix: str = "") -> None:
        """Take in some rows.

        Parameters
        ----------
        chunk : Chunk or Lines
        otherwise : str
            The recording of rows without a label.
        prefix : str
            Stands before the names of recordings, those of other files being others.
        """
        if isinstance(chunk, Lines):
            for name, rows in _by_label(chunk, otherwise):
                self._lines(self._groups(prefix + name), rows)
            return
        for name, columns in _split(chunk, otherwise):
            self._rows(self._groups(prefix + name), columns, chunk.units)

    def end(self) -> None:
        """Count columns that no unit was told of with those of their name, if these have one.

        JSON lines tell none of sums of readings, nor a CSV file without the file beside it.
        """
        told: dict[str, set[str]] = {}
        for key, unit in self.all.numbers:
            if unit:
                told.setdefault(key, set()).add(unit)
        units = {key: next(iter(its)) for key, its in told.items() if len(its) == 1}
        for group in (self.all, *self.recordings.values()):
            group.spoken_for(units)

    def _groups(self, name: str) -> tuple[Group, Group]:
        found = self.recordings.get(name)
        if found is None:
            found = self.recordings[name] = Group()
            if len(self.recordings) > WHOLE_RECORDINGS:
                next(islice(reversed(self.recordings.values()), WHOLE_RECORDINGS, None)).compress()
        return found, self.all

    def _rows(
        self, groups: tuple[Group, Group], columns: dict[str, Column], units: Mapping[str, str]
    ) -> None:
        frames, times = columns["frame"], columns.get("time_s")
        for group in groups:
            group.count_frames(frames)
            if times is not None and times.dtype != object:
                group.times.add(times)
        for output, key, values in _cells(columns):
            for group in groups:
                if output:
                    group.add_outcomes(output, Counter(v for v in values if v is not None))
                else:
                    group.add_values(key, values, _unit(key, units))

    def _lines(self, groups: tuple[Group, Group], rows: list[dict[str, Any]]) -> None:
        numbers: dict[str, list[float]] = {}
        texts: dict[str, list[str]] = {}
        words: dict[str, Counter[str]] = {}
        for row in rows:
            for output, value in row["outputs"].items():
                words.setdefault(output, Counter())[_ended(value)] += 1
                for item in value if isinstance(value, list) else [value]:
                    _gather(output, item, numbers, texts)
            for output, errors in row.get("errors", {}).items():
                for error, value in errors.items():
                    _gather(f"{output}.{error_name(error)}", value, numbers, texts)
        frames = np.array([as_float(row.get("frame", np.nan)) for row in rows])
        times = np.array([as_float(row.get("time_s", np.nan)) for row in rows])
        for group in groups:
            group.count_frames(frames)
            group.times.add(times)
            for output, counted in words.items():
                group.add_outcomes(output, counted)
            for key, found in numbers.items():
                group.add_values(key, np.array(found, dtype=np.float64), _unit(key, {}))
            for key, told in texts.items():
                group.add_values(key, np.array(told, dtype=object), "")


def _unit(key: str, units: Mapping[str, str]) -> str:
    """Return the unit of a column: as its file tells, otherwise by its name."""
    field = key.rpartition(".")[2]
    told = units.get(key if key in units else field) or words_and_unit(field)[1]
    return "" if told == "1" else UNITS.get(told, told)  # files of before have errors in "deg"


def kind(word: str) -> str:
    """Return ``ok``, ``skipped`` or ``failed`` of an outcome; a list with a failed item failed."""
    if word in ("ok", "no items"):
        return "ok"
    return "failed" if "failed: " in word else "skipped"


def _count(counter: Counter[str], more: Mapping[str, int]) -> None:
    for word, n in more.items():
        counter[word if word in counter or len(counter) < MOST_WORDS else OTHERS] += n


def _split(chunk: Chunk, otherwise: str) -> Iterator[tuple[str, dict[str, Column]]]:
    """Yield rows by recording."""
    labels = chunk.columns.get("label")
    if chunk.recording or labels is None or labels.dtype != object:
        yield chunk.recording or otherwise, chunk.columns
        return
    names = np.array([label or otherwise for label in labels], dtype=object)
    for name in dict.fromkeys(names.tolist()):
        mine = names == name
        yield name, {key: values[mine] for key, values in chunk.columns.items()}


def _by_label(lines: Lines, otherwise: str) -> Iterable[tuple[str, list[dict[str, Any]]]]:
    found: dict[str, list[dict[str, Any]]] = {}
    for row in lines.rows:
        found.setdefault(str(row.get("label") or otherwise), []).append(row)
    return found.items()


def _cells(columns: dict[str, Column]) -> Iterator[tuple[str, str, Column]]:
    """Yield outputs' outcomes, and the values of columns, named by their output in long tables."""
    if not is_long(columns):
        for key, values in columns.items():
            output = key.removesuffix(".outcome") if key.endswith(".outcome") else ""
            if key not in LEAD:
                yield output, key, values
        return
    for output in dict.fromkeys(columns["output"].tolist()):
        mine = columns["output"] == output
        yield str(output), "", columns["outcome"][mine]
        for key, values in columns.items():
            if key not in (*LEAD, *LONG):
                told = values[mine]
                there = told != None if told.dtype == object else ~np.isnan(told)  # noqa: E711
                if np.any(there):
                    yield "", f"{output}.{key}", told


def _ended(value: Any) -> str:
    if isinstance(value, dict):
        for word in ("skipped", "failed"):
            if word in value and "origin" in value:
                return f"{word}: {value[word]}"
    if isinstance(value, list):
        gaps = [_ended(item) for item in value]
        return "; ".join(gap for gap in gaps if gap != "ok") or "ok"
    return "ok"


def _gather(
    key: str, value: Any, numbers: dict[str, list[float]], texts: dict[str, list[str]]
) -> None:
    """Put the single numbers and texts of a value in their lists; of lists, those of each item."""
    if isinstance(value, bool):
        texts.setdefault(key, []).append("yes" if value else "no")
    elif isinstance(value, int | float):
        numbers.setdefault(key, []).append(as_float(value))
    elif isinstance(value, str):
        texts.setdefault(key, []).append(value)
    elif isinstance(value, dict) and _ended(value) == "ok":
        for name, inner in value.items():
            if name != "shape" or not isinstance(inner, list):
                _gather(f"{key}.{name}", inner, numbers, texts)
    elif isinstance(value, list):
        named = any(isinstance(item, dict) and _ended(item) == "ok" for item in value)
        for item in value if named else ():
            _gather(key, item, numbers, texts)
