"""What LabVIEW's measurement files (.lvm) say before their values: channels, unit and times.

Source: National Instruments, Specification for the LabVIEW Measurement File (.lvm).
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from typing import NamedTuple

from tactile_graph_sources.readers.words.preamble import Described

_FIRST = "LabVIEW Measurement"
_OPENS = "Channels"
_ENDS = "***End_of_Header***"
_X = "x_value"
_TIME = "time [s]"


class Segment(NamedTuple):
    """A segment as other tables are written.

    Parameters
    ----------
    names : tuple of str
        Of the columns.
    cells : str
        Which columns are cells, where each of them has its own times before it; else empty.
    said : Described
        What the words before the values say.
    lines : tuple of str
        Those of the values, without the segments behind it.
    """

    names: tuple[str, ...]
    cells: str
    said: Described
    lines: tuple[str, ...]


def is_labview(lines: Sequence[str]) -> bool:
    """Return whether a file begins as LabVIEW's measurement files do."""
    return bool(lines) and lines[0].startswith(_FIRST)


def end_of_header(lines: Sequence[str]) -> int:
    """Return the index behind the header of the first segment; 0 where there is none.

    The file's own header comes before it.
    """
    ends = [k for k, line in enumerate(lines) if line.startswith(_ENDS)]
    return ends[min(len(ends), 2) - 1] + 1 if ends else 0


def first_segment(
    names: Sequence[str], lines: Sequence[str], start: int, said: Described, timed: bool
) -> Segment:
    """Return the first segment of a file.

    Parameters
    ----------
    names : sequence of str
        Of the columns as written: ``X_Value``, ``Voltage``, ``Voltage 1``, …
    lines : sequence of str
        The first ones of the file.
    start : int
        Index of the first row.
    said : Described
        What the words before it say as those of any table.
    timed : bool
        Whether there is anything in the first column.
    """
    words = _words(lines[:start])
    in_time = words.get("X_Dimension", ["Time"])[0] == "Time"
    found = list(names)
    if len(found) > 2 and found[2] == f"{found[1]} 1":
        found[1] += " 0"  # the first of channels that nobody named
    if timed and in_time and found and found[0].lower() == _X:
        found[0] = _TIME
    own_times = [n.lower() for n in names].count(_X) > 1
    cells = [str(k + 1) for k, n in enumerate(names) if n.lower() not in (_X, "comment")]
    end = next((k for k, x in enumerate(lines) if k > start and x.startswith(_OPENS)), None)
    return Segment(
        tuple(found),
        ",".join(cells) if own_times else "",
        _said(words, said, in_time),
        tuple(lines[start:end]),
    )


def without_headers(lines: Iterable[tuple[int, str]]) -> Iterator[tuple[int, str]]:
    """Yield numbered lines without the headers of further segments."""
    inside = False
    for number, line in lines:
        inside = inside or line.startswith(_OPENS)
        if not inside:
            yield number, line
        elif line.lower().startswith(_X):
            inside = False


def _said(words: dict[str, list[str]], said: Described, in_time: bool) -> Described:
    """Return what is said, with the unit and the time from row to row of all channels."""
    units = set(words.get("Y_Unit_Label", []))
    if len(units) == 1:
        said = said.in_unit(units.pop())
    steps = set(words.get("Delta_X", []))
    try:
        step_s = float(steps.pop().replace(",", ".")) if len(steps) == 1 and in_time else 0.0
    except ValueError:
        return said
    return replace(said, frame_s=step_s) if 0.0 < step_s < 1e6 else said


def _words(before: Sequence[str]) -> dict[str, list[str]]:
    """Return what stands behind each word, a value a channel."""
    separator = "," if any(line.startswith("Separator,") for line in before) else "\t"
    fields = (line.strip().split(separator) for line in before)
    found = {f[0]: [v.strip() for v in f[1:] if v.strip()] for f in fields}
    return {word: values for word, values in found.items() if values}
