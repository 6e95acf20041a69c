"""MATLAB files of versions 5 to 7: one stack of matrices, in a variable, a struct or a cell array.

Those of version 7.3 are HDF5.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tactile_graph.errors import DataError
from tactile_graph.wires import Frame
from tactile_graph_sources.readers.arrays.datasets import (
    Held,
    chosen,
    frames_of,
    is_stack,
)
from tactile_graph_sources.readers.arrays.mat5 import DamagedError, Unread, variables
from tactile_graph_sources.readers.arrays.times import time_among
from tactile_graph_sources.readers.head import Head
from tactile_graph_sources.readers.reading import OF_TIMES, Reading
from tactile_graph_sources.readers.recording_format import RecordingFormat
from tactile_graph_sources.readers.words.preamble import described_by

_MARKS = (b"\x00\x01IM", b"\x01\x00MI")
_AS_REAL = {"complex": "{0} = abs({0})", "sparse": "{0} = full({0})"}
LONGEST_SIDE = 4
"""Times both others: a longer axis is the frames'."""


def recognises(head: Head) -> bool:
    """Return whether the file has MATLAB's header of version 5."""
    return head.raw.startswith(b"MATLAB 5.0 MAT-file") and head.raw[124:128] in _MARKS


def read(reading: Reading) -> Iterator[Frame]:
    """Yield the matrices of the only stack in the file, or of the one that ``sensor`` names.

    Raises
    ------
    DataError
        If the file is damaged, no stack or several could be meant, or its axes can be read two
        ways.
    """
    reading.refuse_settings(*OF_TIMES)
    everything = list(_variables("", _loaded(reading)))
    found = [v for v in everything if not isinstance(v.value, Unread)]
    arrays = {v.name: v.value for v in found if isinstance(v.value, np.ndarray)}
    if not any(n == reading.told.sensor for n in arrays):
        _refuse_unread(reading, everything, arrays)
    name = chosen(reading, {n: a.shape for n, a in arrays.items()}, "variable")
    times, time = _times(reading, everything, arrays)
    said = described_by({v.bare: v.value for v in found})
    in_cells = any(v.in_cells for v in found if v.name == name)
    held = Held(arrays[name], f"variable {name!r}", said, times, time, in_cells)
    yield from frames_of(reading, of_matlab(reading, held))


def _times(
    reading: Reading, found: list[_Variable], arrays: dict[str, NDArray[Any]]
) -> tuple[NDArray[Any] | None, str]:
    """Return the times, numbers before texts, and their name; those that are not read are told."""
    time = time_among(n for n, a in arrays.items() if 1 < a.size == max(a.shape))
    if time:
        return arrays[time].ravel(), time
    texts = {v.name: v.value for v in found if isinstance(v.value, list)}
    if time := time_among(texts):
        return np.array(texts[time]), time
    unread = {v.name: v.value for v in found if isinstance(v.value, Unread)}
    if time := time_among(unread):
        kind = unread[time].kind
        reading.assume(f"times left out, as {time!r} is {kind} (save it as numbers of seconds)")
    return None, ""


def _refuse_unread(
    reading: Reading, found: list[_Variable], arrays: dict[str, NDArray[Any]]
) -> None:
    """Refuse a file whose frames are of a kind that is not read, and say which and what to do."""
    asked = reading.told.sensor
    unread = {v.name: v.value for v in found if isinstance(v.value, Unread)}
    if asked:
        unread = {n: v for n, v in unread.items() if n == asked}
    elif any(is_stack(a.shape) for a in arrays.values()):
        return
    else:
        unread = {n: v for n, v in unread.items() if not arrays or is_stack(v.shape)}
    if not unread:
        return
    name, value = next(iter(unread.items()))
    shape = f" of shape {value.shape}" if value.shape else ""
    real = _AS_REAL.get(value.kind, "{0} = double({0})").format(name)
    raise DataError(
        str(reading.path),
        f"its variable {name!r}{shape} is {value.kind}, no matrix of real numbers; save it as "
        f"such, in MATLAB: {real}; save('out.mat', '{name.partition('.')[0]}', '-v7')",
    )


def _loaded(reading: Reading) -> dict[str, Any]:
    try:
        return variables(reading.path)
    except DamagedError as error:
        told = f"the MATLAB file cannot be read: {error}"
        raise DataError(str(reading.path), told) from None


class _Variable(NamedTuple):
    """An array of numbers, a text, or a list of texts; ``name`` is ``a.b`` within a struct.

    ``in_cells`` says that its first axis runs over the cells of a cell array, or over structs.
    """

    name: str
    value: Any
    in_cells: bool = False

    @property
    def bare(self) -> str:
        return self.name.rpartition(".")[2]


def _variables(name: str, value: Any) -> Iterator[_Variable]:
    if isinstance(value, dict):
        for key, inner in value.items():
            yield from _variables(f"{name}.{key}" if name else str(key), inner)
    elif isinstance(value, list) and value and all(isinstance(v, str) for v in value):
        yield _Variable(name, value)
    elif isinstance(value, list):
        yield from _cells(name, value)
    elif value is not None:
        yield _Variable(name, value)


def _cells(name: str, cells: list[Any]) -> Iterator[_Variable]:
    """Yield what cells or structs of one kind hold, one behind the other."""
    if cells and all(isinstance(c, dict) and c.keys() == cells[0].keys() for c in cells):
        for key in cells[0]:
            yield from _variables(f"{name}.{key}", [c[key] for c in cells])
        return
    arrays = [c for c in cells if isinstance(c, np.ndarray)]
    if len(arrays) == len(cells) and len({a.shape for a in arrays}) == 1:
        yield _Variable(name, np.stack(arrays), in_cells=True)


def of_matlab(reading: Reading, held: Held) -> Held:
    """Return what a variable of MATLAB holds with its frames along the first axis.

    Whether they lie there is asked of its values where it has three equal sides.

    Raises
    ------
    DataError
        As `frames_first`.
    """
    values = held.values
    if not held.known:
        values = frames_first(reading, values, held.what, held.times)
    cube = values.ndim == 3 and len({*values.shape}) == 1 and not held.known
    return held._replace(values=values, known=not cube, of_matlab=True)


def frames_first(
    reading: Reading, values: NDArray[Any], what: str, times: NDArray[Any] | None
) -> NDArray[Any]:
    """Return a stack with its frames along the first axis, whichever they lie along.

    Parameters
    ----------
    reading : Reading
    values : ndarray
        As MATLAB indexes it: mostly (rows, columns, frames).
    what : str
        What messages call it.
    times : ndarray, optional
        Times, of which there may be as many as frames.

    Raises
    ------
    DataError
        If neither times, nor a square matrix, nor one long axis tells.
    """
    if values.ndim != 3 or reading.told.shape:
        return values
    first, middle, last = values.shape
    votes = {len(times)} & {first, last} if times is not None and first != last else set()
    if not votes and (first == middle) != (middle == last):
        votes = {last if first == middle else first}
    longest = max(first, last)
    if not votes and longest > LONGEST_SIDE * max(middle, min(first, last)):
        votes = {longest}
    if not votes:
        remedy = "give rows and columns"
        if first == middle == last:
            remedy = f"put frames first, in MATLAB permute(array, [3 1 2]), and {remedy}"
        raise DataError(
            str(reading.path),
            f"{what} has shape {values.shape}: {last} frames of {first} x {middle} along the last "
            f"axis, or {first} frames of {middle} x {last} along the first; {remedy}",
        )
    return values if votes == {first} else np.moveaxis(values, -1, 0)


FORMAT = RecordingFormat("MATLAB 5 to 7 (.mat)", recognises, read)
