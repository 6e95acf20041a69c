"""Truth that comes in a file of its own: JSON of every frame, or a table of one object a line."""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Generator, Iterable, Iterator, Mapping
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

from tactile_graph.errors import DataError, did_you_mean, one_of
from tactile_graph.foreign_text import tell
from tactile_graph.steps.injected import Report
from tactile_graph.wires import Circle, Ellipse, Frame, Image, Rectangle, Shape, TrueObject
from tactile_graph_sources.placement import is_off
from tactile_graph_sources.readers.words.counting import BY, By, Counting
from tactile_graph_sources.readers.words.truth import Truth, truth_from_json

SHAPES = {
    "circle": (Circle, ("x_cm", "y_cm", "radius_cm")),
    "ellipse": (Ellipse, ("x_cm", "y_cm", "semi_major_cm", "semi_minor_cm", "angle_deg")),
    "rectangle": (Rectangle, ("x_cm", "y_cm", "length_cm", "breadth_cm", "angle_deg")),
}
COLUMNS = (*BY, "kind", *sorted({f for _, fields in SHAPES.values() for f in fields}),
           "weight_g", "name")  # fmt: skip
MOST_BYTES = 1 << 28
MOST_DIGITS = 12
"""Of a frame's number."""
_Extent = tuple[float, float, float, float]
_Where = tuple[int, ...]


class _Said(NamedTuple):
    """What a line of a table says: in which frames (None: all) lies what (None: nothing)."""

    span: range | None
    lies: TrueObject | None
    line: int


Spans = list[_Said]


class _Table(NamedTuple):
    """A table of truth: how it counts frames, and what lies in which."""

    by: By
    spans: Spans


def with_truth(
    frames: Iterator[Frame], path: Path, report: Report | None = None
) -> Generator[Frame, None, None]:
    """Yield the frames with the truth that a file holds, instead of what the recording held.

    Frames are counted as they stand in the recording (`Frame.place`), so that one which was left
    out, by ``skip`` too, keeps its number; what may surprise about that is told on stderr. So is,
    at the end or when this is closed, of how many frames the recording held a truth, and which
    objects lie wholly off the pad, or are another one again, which are left out.

    Parameters
    ----------
    frames : iterator of Frame
        All of the recording, from its first on.
    path : Path
        ``.json``: a list with, for each frame, null or a list of objects (as in our ``.npz``).
        Anything else: a table with a header, an object a line. Its column ``frames`` says in
        which frames it lies (``7``, ``10-25``, or ``all``), ``kind`` what it is; a line of kind
        ``none`` says that nothing lies there. Lengths are in cm, angles counter-clockwise in
        degrees. Named ``numbers`` instead of ``frames`` the column counts by the recording's own
        numbers, named ``places`` by places whatever these say.
    report : Report, optional
        That of the recording, which tells how many frames it holds.

    Raises
    ------
    DataError
        If the file cannot be understood, speaks of frames that are not there, or may mean others.
    """
    replaced, objects = _Replaced(), _Objects()
    kept = replaced.watch(frames)
    if path.suffix.lower() == ".json":
        attached = _by_list(kept, _listed(path), path, report, objects)
    else:
        attached = _by_spans(kept, _spans(path), path, report, objects)
    try:
        for frame in attached:
            replaced.n_unknown += replaced.was_known and frame.truth is None
            yield frame
    except GeneratorExit:  # who takes them has enough
        replaced.tell(str(path))
        objects.tell(str(path))
        raise
    replaced.tell(str(path))
    objects.tell(str(path))


class _Replaced:
    """Counts frames whose truth the recording held, and of which the file says nothing."""

    def __init__(self) -> None:
        self.n = self.n_unknown = 0
        self.was_known = False

    def watch(self, frames: Iterator[Frame]) -> Iterator[Frame]:
        for frame in frames:
            self.was_known = frame.truth is not None
            self.n += self.was_known
            yield frame

    def tell(self, path: str) -> None:
        if self.n:
            told = f"{path}: replaces the truth that the recording held of {_frames(self.n)}"
            of_it = f"; of {self.n_unknown} of them it says nothing" if self.n_unknown else ""
            tell(told + of_it)


class _Objects:
    """Notes which objects of a file lie wholly off the pad, and which are another one again."""

    def __init__(self) -> None:
        self._seen: set[tuple[_Where, _Extent]] = set()
        self._off: dict[_Where, tuple[float, float, _Extent]] = {}
        self._again: dict[_Where, _Where] = {}

    def of(
        self, objects: Iterable[tuple[_Where, TrueObject]], image: Image
    ) -> tuple[TrueObject, ...]:
        """Return the objects of a frame, each by its line or its frame and number, once each."""
        found: dict[object, tuple[_Where, TrueObject]] = {}
        for where, lies in objects:
            self._see(where, lies, image)
            said = lies.shape, lies.weight_g, lies.name  # what is stacked has weights of its own
            first, _ = found.setdefault(said, (where, lies))
            if first != where:
                self._again.setdefault(where, first)
        return tuple(lies for _, lies in found.values())

    def _see(self, where: _Where, lies: TrueObject, image: Image) -> None:
        extent_cm, shape = image.extent_cm, lies.shape
        if (where, extent_cm) in self._seen or not isinstance(shape, Shape):
            return
        self._seen.add((where, extent_cm))
        if is_off(shape, extent_cm):
            self._off.setdefault(where, (shape.x_cm, shape.y_cm, extent_cm))

    def tell(self, path: str) -> None:
        """Tell of both kinds how many there are, and which is the first."""
        if self._again:
            n, (where, first) = len(self._again), min(self._again.items())
            are = "s are others" if n != 1 else " is another one"
            tell(
                f"{path}: {n} object{are} again, of the same kind, place, size, weight and name, "
                f"and left out, first that of {_named(where)}, which is that of {_named(first)}"
            )
        if not self._off:
            return
        n, n_off = len({where for where, _ in self._seen}), len(self._off)
        where, (x, y, (left, right, bottom, top)) = min(self._off.items())
        in_mm = left <= 0.1 * x <= right and top <= 0.1 * y <= bottom
        tell(
            f"{path}: {n_off} of {n} object{'s' if n != 1 else ''} lie{'s' if n_off == 1 else ''} "
            f"wholly off the pad of {right - left:g} by {bottom - top:g} cm, first that "
            f"of {_named(where)} at x {x:g}, y {y:g} cm; lengths are cm from the pad's top "
            f"left corner, x to the right, y down{': are these mm?' if in_mm else ''}"
        )


def _named(where: _Where) -> str:
    return ("line {}" if len(where) == 1 else "frame {}, object {}").format(*where)


def _frames(n: int) -> str:
    return f"{n} frame{'s' if n != 1 else ''}"


def _text(path: Path) -> str:
    try:
        with path.open("rb") as file:
            data = file.read(MOST_BYTES + 1)
        if len(data) > MOST_BYTES:
            raise DataError(str(path), f"is larger than {MOST_BYTES >> 20} MB")
        return data.decode("utf-8-sig").replace("\r\n", "\n").replace("\r", "\n")
    except (OSError, ValueError) as error:
        raise DataError(str(path), f"the truth cannot be read: {error}") from error


def _listed(path: Path) -> list[Truth]:
    try:
        return truth_from_json(_text(path), by_hand=True)
    except ValueError as error:
        raise DataError(str(path), str(error)) from error


def _by_list(
    frames: Iterator[Frame],
    truths: list[Truth],
    path: Path,
    report: Report | None,
    objects: _Objects,
) -> Iterator[Frame]:
    counting, n = Counting(str(path), "places"), len(truths)
    for frame in frames:
        place = counting.of(frame)
        if place >= n:
            raise DataError(str(path), f"holds the truth of {n} frames, there are more")
        truth = truths[place]
        if truth is not None:
            truth = objects.of((((place, j), o) for j, o in enumerate(truth)), frame.image)
        yield replace(frame, truth=truth)
    held = _n_places(counting, report)
    if n != held:
        way_out = (
            "; the recording numbers its frames itself: in a table, the column 'numbers' counts by "
            "these"
        )
        told = f"holds the truth of {n} frames, there are {held}, those that were left out too"
        raise DataError(str(path), told + (way_out if counting.numbers_itself else ""))


def _by_spans(
    frames: Iterator[Frame], table: _Table, path: Path, report: Report | None, objects: _Objects
) -> Iterator[Frame]:
    counting, spans = Counting(str(path), table.by), table.spans
    beyond = max((said.span.stop - 1 for said in spans if said.span is not None), default=-1)
    for frame in frames:
        number = counting.of(frame) if beyond >= 0 else 0
        about = [said for said in spans if said.span is None or number in said.span]
        lies = (((said.line,), said.lies) for said in about if said.lies is not None)
        known = objects.of(lies, frame.image)
        yield replace(frame, truth=known if about else None)
    if beyond < 0:
        return
    if table.by == "numbers" and beyond > counting.last:
        told = f"speaks of frame {beyond}, the recording's own numbers end at {counting.last}"
        raise DataError(str(path), told)
    last = _n_places(counting, report) - 1
    if table.by != "numbers" and beyond > last:
        told = f"speaks of frame {beyond}, the last one is {last}, counted from 0"
        raise DataError(str(path), told)


def _n_places(counting: Counting, report: Report | None) -> int:
    """Return how many frames the recording holds; those left out at its end its report tells."""
    told = None if report is None else report.n_places
    return max(counting.last + 1, told or 0)


def _spans(path: Path) -> _Table:
    text = _text(path)
    first = text.partition("\n")[0]
    separator = next((s for s in (";", "\t") if s in first), ",")
    rows = csv.reader(io.StringIO(text), delimiter=separator)
    header = [n.strip().lower() for n in next(rows, [])]
    by = _checked_header(f"{path}:1", header)
    spans: Spans = []
    for fields in rows:
        if any(f.strip() for f in fields):
            where = f"{path}:{rows.line_num}"
            row = _row(where, header, [f.strip() for f in fields])
            spans.append(_Said(_span(where, by, row[by]), _object(where, row), rows.line_num))
    if not spans:
        told = "a header and no line below it; each line says what lies in which frames"
        raise DataError(str(path), told)
    _refuse_contradictions(path, spans)
    return _Table(by, spans)


def _row(where: str, header: list[str], fields: list[str]) -> dict[str, str]:
    """Return a line's fields by the names of their columns; those that are not there are empty."""
    n = len(header)
    if any(fields[n:]):
        raise DataError(
            where,
            f"{len(fields)} fields, the header names {n}; decimal commas need ';' or tabs between "
            "the columns, in all lines",
        )
    return dict(zip(header, fields[:n] + [""] * (n - len(fields)), strict=True))


def _refuse_contradictions(path: Path, spans: Spans) -> None:
    """Refuse a frame of which one line says that nothing lies there, and another that something."""
    ends = {False: (-1, 0), True: (-1, 0)}  # of frames said to be empty, and not: up to, by line
    whole = range(10**MOST_DIGITS)
    said = [(span or whole, lies is not None, line) for span, lies, line in spans]
    for span, holds, line in sorted(said, key=lambda one: one[0].start):
        stop, other = ends[not holds]
        if span.start < stop:
            what = "an object lies there" if holds else "nothing does"
            raise DataError(
                f"{path}:{line}",
                f"{what} in frame {span.start}, and line {other} says the opposite; keep one",
            )
        ends[holds] = max(ends[holds], (span.stop, line))


def _checked_header(where: str, header: list[str]) -> By:
    """Return how a table counts its frames, by its header."""
    for name in header:
        if name not in COLUMNS:
            near = did_you_mean(name, COLUMNS)
            raise DataError(where, f"no column {name!r}; known: {', '.join(COLUMNS)}{near}")
        if header.count(name) > 1:
            first, second = [k for k, n in enumerate(header, 1) if n == name][:2]
            told = f"columns {first} and {second} are both {name!r}; keep one of them"
            raise DataError(where, told)
    by = [name for name in BY if name in header]
    if not by or "kind" not in header:
        raise DataError(where, "a header with 'frames' and 'kind' is needed")
    if len(by) > 1:
        told = f"{' and '.join(map(repr, by))} both say which frames are meant; keep one of them"
        raise DataError(where, told)
    return by[0]


def _span(where: str, by: By, text: str) -> range | None:
    if text in ("all", "*"):
        return None
    first, dash, last = (p.strip() for p in text.partition("-"))
    last = last if dash else first
    whole = all(p.isdecimal() and len(p) <= MOST_DIGITS for p in (first, last))
    if not whole or int(first) > int(last):
        raise DataError(where, f"{by}: must be such as 7, 10-25 or all, got {text!r}")
    return range(int(first), int(last) + 1)


def _object(where: str, row: Mapping[str, str]) -> TrueObject | None:
    kind = row.get("kind", "").lower()
    known = (*SHAPES, "none")
    if kind not in known:
        told = f"unknown kind {kind!r}, known: {one_of(known)}{did_you_mean(kind, known)}"
        raise DataError(where, told)
    shape, names = SHAPES.get(kind, (None, ()))
    about = (*BY, "kind", "name") if shape is None else (*BY, "kind", *names, "weight_g", "name")
    for name, text in row.items():
        if text and name not in about and not _is_nothing(text):
            has = f"kind {kind!r} has no {name}, got {text!r}"
            commas = "; decimal commas need ';' or tabs between the columns" if names else ""
            raise DataError(where, f"{has}; leave it out{commas}")
    if shape is None:
        return None
    numbers = [_number(where, name, row.get(name, "")) for name in names]
    if names[-1] == "angle_deg":
        numbers[-1] = math.radians(numbers[-1])
    weight = row.get("weight_g", "")
    grams = _number(where, "weight_g", weight) if weight else None
    return TrueObject(shape(*numbers), grams, row.get("name", ""))


def _is_nothing(text: str) -> bool:
    """Return whether a cell is a zero or no number, with which tables of many kinds are filled."""
    try:
        return not float(text) or math.isnan(float(text))
    except ValueError:
        return False


def _number(where: str, name: str, text: str) -> float:
    try:
        number = float(text.replace(",", "."))
    except ValueError:
        number = math.nan
    if not math.isfinite(number) or (number <= 0.0 and name not in ("x_cm", "y_cm", "angle_deg")):
        needed = "a number" if name in ("x_cm", "y_cm", "angle_deg") else "a number > 0"
        raise DataError(where, f"{name}: must be {needed}, got {text!r}")
    return number
