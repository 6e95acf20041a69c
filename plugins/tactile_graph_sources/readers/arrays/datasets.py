"""Files of named arrays (HDF5, MATLAB): which of them is the stack, and what stands beside it."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Iterator, Mapping
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tactile_graph.errors import DataError, did_you_mean, one_of
from tactile_graph_sources.readers.arrays.stack import MOST_CHANNELS, stack_of
from tactile_graph_sources.readers.choosing.choice import SeveralSensorsError
from tactile_graph_sources.readers.laid import Laid, laid_in
from tactile_graph_sources.readers.reading import Reading
from tactile_graph_sources.readers.tables.layout import assumed_unit
from tactile_graph_sources.readers.words.compact import stamps_s
from tactile_graph_sources.readers.words.names import ROLES, named
from tactile_graph_sources.readers.words.preamble import Described

MOST_VALUES = 500_000_000
_NUMBERED = re.compile(r"(.*?)(\d{1,9})(/\D*)?")
_FRAME_WORDS = {w for w, role in ROLES.items() if role == "frame" and len(w) > 2}
_FRAME_WORDS |= {"arr", "img", "matrix", "map", "t"}
"""What numbered matrices are called that are frames, not sensors."""


class Held(NamedTuple):
    """What is taken from a file.

    Parameters
    ----------
    values : ndarray
        The stack.
    what : str
        What messages call it.
    said : Described
        What the file says of it.
    times : ndarray, shape (n,), optional
        None where there are none.
    times_name : str
    known : bool
        Whether the frames of three axes are known to lie along the first.
    """

    values: NDArray[Any]
    what: str
    said: Described
    times: NDArray[Any] | None = None
    times_name: str = ""
    known: bool = False


class Unread(NamedTuple):
    """An array that is there and not read: what it is, and what to do about it."""

    what: str
    remedy: str = ""
    shape: tuple[int, ...] | None = None

    def __str__(self) -> str:
        return f"{'' if self.shape is None else f'{self.shape}, '}{self.what}"


def frames_of(reading: Reading, held: Held) -> Iterator[Any]:
    """Yield the matrices of a stack; times that are not as many as the frames are left out."""
    frames, times_s, said = _timed(reading, held)
    reading.report.expect(len(frames))
    yield from reading.frames(frames, times_s, **said)


def laid_of(reading: Reading, held: Held) -> Laid | None:
    """Return how the matrices of a stack are read, any without those before them."""
    frames, times_s, said = _timed(reading, held)
    return laid_in(reading, frames, times_s, **said)


def _timed(
    reading: Reading, held: Held
) -> tuple[NDArray[Any], NDArray[np.float64] | None, dict[str, Any]]:
    """Return matrices, their times, and what the file says of all of them."""
    _refuse_lone_matrix(reading, held)
    held = _along_times(reading, held)
    frames = stack_of(reading, held.values, held.what, "known" if held.known else "asked")
    times, factor = held.times, 1.0
    if times is not None and len(times) != len(frames):
        reading.assume(f"times left out ({len(times)}, for {len(frames)} frames)")
        times = None
    stamps = None if times is None else stamps_s(times.astype(np.float64))
    if stamps is not None:
        times = stamps - stamps[0]
    elif times is not None:
        factor = _factor(reading, held.times_name, times)
    said = held.said
    for note in said.notes:
        reading.assume(note)
    if times is None and said.frame_s is not None:
        times, factor = np.arange(len(frames)), said.frame_s
    times_s = None if times is None else times.astype(np.float64) * factor
    told = {"factor": said.factor, "quantity": said.quantity}
    told |= {"pitch_cm": said.pitch_cm, "origin_cm": said.origin_cm}
    return frames, times_s, told


def _along_times(reading: Reading, held: Held) -> Held:
    """Return a stack with its frames along the first axis, if its times tell where they lie."""
    told = reading.told.rows is not None and reading.told.columns is not None
    if held.known or told or held.times is None or held.values.ndim != 3:
        return held
    n, n_first, n_last = len(held.times), held.values.shape[0], held.values.shape[-1]
    if n == n_last != n_first:
        reading.assume(f"frames taken to lie along the last axis, as there are {n} times")
        return held._replace(values=np.moveaxis(held.values, -1, 0), known=True)
    return held._replace(known=n == n_first != n_last)


def _refuse_lone_matrix(reading: Reading, held: Held) -> None:
    """Refuse a matrix that has a time for each of its rows, so that these may be frames."""
    told = reading.told.rows is not None and reading.told.columns is not None
    if told or held.times is None or held.values.ndim != 2:
        return
    n, n_cells = held.values.shape
    if 1 < n == len(held.times):
        raise DataError(
            str(reading.path),
            f"{held.what} has shape {held.values.shape} and {held.times_name!r} {n} times: {n} "
            f"frames of {n_cells} cells; give rows and columns",
        )


def chosen(
    reading: Reading,
    shapes: Mapping[str, tuple[int, ...]],
    word: str,
    unread: Mapping[str, Unread] | None = None,
) -> str:
    """Return the name of the only stack, or of what ``sensor`` names.

    Parameters
    ----------
    reading : Reading
    shapes : mapping
        Name -> shape of each array of numbers.
    word : str
        What messages call an array: ``dataset``, ``variable``.
    unread : mapping, optional
        Name -> what else is there, and why it is not read.

    Raises
    ------
    DataError
        If there is none, or several could be meant, or the one is too large.
    """
    where, asked, others = str(reading.path), reading.told.sensor, unread or {}
    stacks = stacks_among(shapes)
    listed = one_of(f"{n} {s}" for n, s in shapes.items())
    if asked:
        if found := others.get(asked):
            remedy = f"; {found.remedy}" if found.remedy else ""
            raise DataError(where, f"{word} {asked!r} is not read: {found}{remedy}")
        if asked not in shapes:
            near = did_you_mean(asked, shapes)
            raise DataError(where, f"no {word} {asked!r}, there are {one_of(shapes)}{near}")
        reading.sensors[asked] = None
    elif not stacks:
        listed = one_of([*(f"{n} {s}" for n, s in shapes.items()),
                         *(f"{n} ({u})" for n, u in others.items())])  # fmt: skip
        likely = [
            n for n, u in others.items() if u.remedy and (u.shape is None or is_stack(u.shape))
        ]
        most = likely or [n for n, u in others.items() if u.remedy]
        remedy = f"; of {most[0]!r}: {others[most[0]].remedy}" if most else ""
        deep = [n for n, shape in shapes.items() if len(shape) > 2 and 0 not in shape]
        if deep and not likely:
            remedy = f"; {_hint(deep[0], shapes[deep[0]], word)}"
        told = f"no matrix or stack of matrices in it; its {word}s: {listed}{remedy}"
        raise DataError(where, told)
    elif len(stacks) > 1:
        told = f"several {word}s could be it ({listed}); name one with sensor"
        raise SeveralSensorsError(where, told, stacks)
    name = asked or stacks[0]
    if (n := math.prod(shapes[name])) > MOST_VALUES:
        raise DataError(
            where,
            f"{word} {name!r} of shape {shapes[name]} holds {n:,} values; allowed are "
            f"{MOST_VALUES:,}: save a part of it, or all as .npy, which is read piece by piece",
        )
    return name


def _hint(name: str, shape: tuple[int, ...], word: str) -> str:
    """Return what to do with an array that has the axes of no stack."""
    if len(shape) == 3:
        return f"{name!r} is read where sensor names it"
    if shape[-1] <= MOST_CHANNELS:
        return f"save one channel of {name!r}, array[..., 0], as a new {word}"
    return f"save each sensor of {name!r} as a new {word}"


def is_stack(shape: tuple[int, ...]) -> bool:
    """Return whether an array of such a shape may be a matrix or matrices, of one channel each."""
    axes = [n for n in shape[1:] if n != 1] if len(shape) > 3 else shape
    if len(shape) > 3:
        return len(axes) == 2 and min(shape) > 0
    return len(shape) in (2, 3) and min(shape[-2:]) > 1 and shape[0] > 0


def stacks_among(shapes: Mapping[str, tuple[int, ...]]) -> list[str]:
    """Return the names of arrays that may be the frames.

    One of a single frame is none beside others: it is a background, or a camera's matrix.
    """
    stacks = [n for n, shape in shapes.items() if is_stack(shape)]
    return [n for n in stacks if len(shapes[n]) != 3 or shapes[n][0] > 1] or stacks


def numbered(shapes: Mapping[str, tuple[int, ...]]) -> list[str]:
    """Return the names of matrices that are the frames of one recording, in their order.

    They are alike but for a number, as ``frame_07`` or ``arr_7`` is, and of one shape; none where
    anything else could be a stack as well.
    """
    found = {n: _NUMBERED.fullmatch(n) for n in stacks_among(shapes)}
    stems = {(m[1].lower(), m[3]) if m else None for m in found.values()}
    one_shape = len({shapes[n] for n in found}) == 1
    if len(found) < 2 or len(stems) > 1 or None in stems or not one_shape:
        return []
    stem = next((m[1].lower() for m in found.values() if m), "")
    word = re.split(r"[\W_]+", stem.strip("/_-. "))[-1].removesuffix("s")
    if len(shapes[next(iter(found))]) != 2 or not (not word or word in _FRAME_WORDS):
        return []
    return sorted(found, key=lambda n: int(m[2]) if (m := found[n]) else 0)


def seconds(times: NDArray[Any], name: str) -> tuple[NDArray[Any], str]:
    """Return times as numbers, and what they are then called: dates become seconds."""
    if times.dtype.kind not in "Mm" or not len(times):
        return times, name
    return (times - times[0]) / np.timedelta64(1, "s"), "time_s"


def time_among(names: Iterable[str]) -> str:
    """Return the first of the names that says time, ours before all; empty if none does."""
    ours_first = sorted(names, key=lambda n: (bare(n) != "time_s", n))
    return next((n for n in ours_first if "time" in named((bare(n), "")).roles), "")


def _factor(reading: Reading, name: str, times: NDArray[Any]) -> float:
    said = named((bare(name), ""))
    if said.time_factor is not None:
        return said.time_factor
    known = times[np.isfinite(times)].astype(np.float64)
    factor, note = assumed_unit(known, said.time_unit)
    reading.assume(note)
    return factor


def bare(name: str) -> str:
    """Return the name of an array without those of its groups."""
    return name.replace(".", "/").rpartition("/")[2]
