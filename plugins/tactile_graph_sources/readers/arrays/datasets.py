"""Files of named arrays (HDF5, MATLAB): which of them is the stack, and what stands beside it."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping
from types import MappingProxyType
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tactile_graph.errors import DataError, did_you_mean, one_of
from tactile_graph_sources.readers.arrays.masks import Masks, of_frames
from tactile_graph_sources.readers.arrays.stack import MOST_CHANNELS, one_of_channels, stack_of
from tactile_graph_sources.readers.arrays.times import TEXTS, in_seconds
from tactile_graph_sources.readers.choice import SeveralSensorsError
from tactile_graph_sources.readers.laid import Laid, laid_in
from tactile_graph_sources.readers.reading import Reading
from tactile_graph_sources.readers.words.names import ROLES
from tactile_graph_sources.readers.words.preamble import Described

MOST_VALUES = 500_000_000
BY_COLUMN = "order=columns where they come column by column, as MATLAB's reshape puts them"
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
        Numbers, dates or texts; None where there are none.
    times_name : str
    known : bool
        Whether the frames of three axes are known to lie along the first.
    of_matlab : bool
        Whether MATLAB wrote it, where cells in a row mostly come column by column.
    masks : mapping
        Arrays that say of frames or their cells whether they are good, for `of_frames`.
    """

    values: NDArray[Any]
    what: str
    said: Described
    times: NDArray[Any] | None = None
    times_name: str = ""
    known: bool = False
    of_matlab: bool = False
    masks: Masks = MappingProxyType({})


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
    try:
        _refuse_lone_matrix(reading, held)
        held = _along_times(reading, held)
        frames = stack_of(reading, held.values, held.what, "known" if held.known else "asked")
    except DataError as error:
        if held.of_matlab and held.values.ndim == 2 and not reading.told.shape:
            error.what += f" (and {BY_COLUMN})"
        raise
    _tell_order(reading, held, frames)
    frames = of_frames(reading, held.what, frames, held.masks)
    times, said = held.times, held.said
    if times is not None and len(times) != len(frames):
        reading.assume(f"times left out ({len(times)}, for {len(frames)} frames)")
        times = None
    elif times is None and (named := reading.told.of_columns.given):
        reading.assume(f"no times beside the frames, so {' and '.join(named)} says nothing")
    for note in said.notes:
        reading.assume(note)
    times_s = None if times is None else in_seconds(reading, held.times_name, times)
    if times_s is None and said.frame_s is not None:
        times_s = np.arange(len(frames), dtype=np.float64) * said.frame_s
    told = {"factor": said.factor, "quantity": said.quantity}
    told |= {"pitch_cm": said.pitch_cm, "origin_cm": said.origin_cm}
    return frames, times_s, told


def _tell_order(reading: Reading, held: Held, frames: NDArray[Any]) -> None:
    """Tell in which order cells in a row of MATLAB are read, where nobody says it is its own."""
    in_a_row = held.values.ndim == 2 and held.values.shape != frames.shape[1:]
    if held.of_matlab and in_a_row and reading.told.order == "rows":
        reading.assume(f"cells assumed to come row by row ({BY_COLUMN})")


def _along_times(reading: Reading, held: Held) -> Held:
    """Return a stack with its frames along the first axis, if its times tell where they lie."""
    if held.known or reading.told.shape or held.times is None or held.values.ndim != 3:
        return held
    n, n_first, n_last = len(held.times), held.values.shape[0], held.values.shape[-1]
    if n == n_last != n_first:
        reading.assume(f"frames taken to lie along the last axis, as there are {n} times")
        return held._replace(values=np.moveaxis(held.values, -1, 0), known=True)
    return held._replace(known=n == n_first != n_last)


def _refuse_lone_matrix(reading: Reading, held: Held) -> None:
    """Refuse a matrix that has a time for each of its rows, so that these may be frames."""
    if reading.told.shape or held.times is None or held.values.ndim != 2:
        return
    n, n_cells = held.values.shape
    labels = held.times.dtype.kind in TEXTS
    if labels and in_seconds(reading, held.times_name, held.times) is None:
        return  # words that name its rows
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
            remedy = f"; {hint_on(deep[0], shapes[deep[0]], word)}"
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


def hint_on(name: str, shape: tuple[int, ...], word: str) -> str:
    """Return what to do with an array that has the axes of no stack."""
    if len(shape) == 3:
        return f"{name!r} is read where sensor names it"
    if shape[-1] <= MOST_CHANNELS:
        return f"save one channel of {name!r} as a new {word}: {one_of_channels('...,', -1)}"
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
