"""Truth that comes in a file of its own: JSON of every frame, or a table of one object a line."""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Iterator, Mapping
from dataclasses import replace
from pathlib import Path

from tactile_graph.errors import DataError, did_you_mean, one_of
from tactile_graph.wires import Circle, Ellipse, Frame, Rectangle, TrueObject
from tactile_graph_sources.readers.words.truth import Truth, truth_from_json

SHAPES = {
    "circle": (Circle, ("x_cm", "y_cm", "radius_cm")),
    "ellipse": (Ellipse, ("x_cm", "y_cm", "semi_major_cm", "semi_minor_cm", "angle_deg")),
    "rectangle": (Rectangle, ("x_cm", "y_cm", "length_cm", "breadth_cm", "angle_deg")),
}
COLUMNS = ("frames", "kind", *sorted({f for _, fields in SHAPES.values() for f in fields}),
           "weight_g", "name")  # fmt: skip
MOST_BYTES = 1 << 28
Spans = list[tuple[range | None, TrueObject | None]]


def with_truth(frames: Iterator[Frame], path: Path) -> Iterator[Frame]:
    """Yield the frames with the truth that a file holds; what they carried before is replaced.

    Parameters
    ----------
    frames : iterator of Frame
    path : Path
        ``.json``: a list with, for each frame, null or a list of objects (as in our ``.npz``).
        Anything else: a table with a header, an object a line. Its column ``frames`` says in
        which frames it lies (``7``, ``10-25``, or ``all``), ``kind`` what it is; a line of kind
        ``none`` says that nothing lies there. Lengths are in cm, angles counter-clockwise in
        degrees.

    Raises
    ------
    DataError
        If the file cannot be understood, or speaks of frames that are not there.
    """
    if path.suffix.lower() == ".json":
        yield from _by_list(frames, _listed(path), path)
    else:
        yield from _by_spans(frames, _spans(path), path)


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
        return truth_from_json(_text(path))
    except ValueError as error:
        raise DataError(str(path), str(error)) from error


def _by_list(frames: Iterator[Frame], truths: list[Truth], path: Path) -> Iterator[Frame]:
    n = 0
    for frame in frames:
        if n >= len(truths):
            raise DataError(str(path), f"holds the truth of {len(truths)} frames, there are more")
        yield replace(frame, truth=truths[n])
        n += 1
    if n < len(truths):
        raise DataError(str(path), f"holds the truth of {len(truths)} frames, there are {n}")


def _by_spans(frames: Iterator[Frame], spans: Spans, path: Path) -> Iterator[Frame]:
    last = -1
    for frame in frames:
        last = frame.index
        lie = [o for span, o in spans if span is None or frame.index in span]
        known = tuple(o for o in lie if o is not None)
        yield replace(frame, truth=known if lie else None)
    beyond = max((span.stop - 1 for span, _ in spans if span is not None), default=-1)
    if beyond > last:
        raise DataError(str(path), f"speaks of frame {beyond}, the last one is {last}")


def _spans(path: Path) -> Spans:
    text = _text(path)
    first = text.partition("\n")[0]
    separator = next((s for s in (";", "\t") if s in first), ",")
    rows = csv.reader(io.StringIO(text), delimiter=separator)
    header = [n.strip().lower() for n in next(rows, [])]
    for name in header:
        if name not in COLUMNS:
            near = did_you_mean(name, COLUMNS)
            raise DataError(f"{path}:1", f"no column {name!r}; known: {', '.join(COLUMNS)}{near}")
    if not {"frames", "kind"} <= set(header):
        raise DataError(f"{path}:1", "a header with 'frames' and 'kind' is needed")
    spans: Spans = []
    for fields in rows:
        if any(f.strip() for f in fields):
            where = f"{path}:{rows.line_num}"
            row = dict(zip(header, (f.strip() for f in fields), strict=False))
            spans.append((_span(where, row["frames"]), _object(where, row)))
    return spans


def _span(where: str, text: str) -> range | None:
    if text in ("all", "*"):
        return None
    first, dash, last = (p.strip() for p in text.partition("-"))
    last = last if dash else first
    if not (first.isdecimal() and last.isdecimal() and int(first[:9]) <= int(last[:9])):
        raise DataError(where, f"frames: must be such as 7, 10-25 or all, got {text!r}")
    return range(int(first[:9]), int(last[:9]) + 1)


def _object(where: str, row: Mapping[str, str]) -> TrueObject | None:
    kind = row.get("kind", "").lower()
    if kind == "none":
        return None
    if kind not in SHAPES:
        known = one_of((*SHAPES, "none"))
        raise DataError(where, f"unknown kind {kind!r}, known: {known}{did_you_mean(kind, SHAPES)}")
    shape, names = SHAPES[kind]
    numbers = [_number(where, name, row.get(name, "")) for name in names]
    if names[-1] == "angle_deg":
        numbers[-1] = math.radians(numbers[-1])
    weight = row.get("weight_g", "")
    grams = _number(where, "weight_g", weight) if weight else None
    return TrueObject(shape(*numbers), grams, row.get("name", ""))


def _number(where: str, name: str, text: str) -> float:
    try:
        number = float(text.replace(",", "."))
    except ValueError:
        number = math.nan
    if not math.isfinite(number) or (number <= 0.0 and name not in ("x_cm", "y_cm", "angle_deg")):
        needed = "a number" if name in ("x_cm", "y_cm", "angle_deg") else "a number > 0"
        raise DataError(where, f"{name}: must be {needed}, got {text!r}")
    return number
