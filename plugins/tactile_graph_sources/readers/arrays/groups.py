"""Groups of named arrays on the disk (HDF5, Zarr): the stack in them, and what lies beside it."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tactile_graph.errors import DataError
from tactile_graph_sources.readers.arrays.datasets import (
    Held,
    Unread,
    chosen,
    is_stack,
    numbered,
)
from tactile_graph_sources.readers.arrays.packing import Packing, packing_of
from tactile_graph_sources.readers.arrays.times import TEXTS, bare, time_among
from tactile_graph_sources.readers.reading import Reading
from tactile_graph_sources.readers.words.names import named
from tactile_graph_sources.readers.words.preamble import described_by

LONGEST_TEXT = 1000
"""Letters of a text that says something of the stack."""
TEXT = "text"
LEAST_TEXT = 120
"""Bytes that a text takes in memory, however short it is."""
_NOT_READ = {
    "c": ("complex", "save it as real numbers, such as abs(array)"),
    "O": ("objects or rows of unlike lengths",
          "save frames of one shape: numpy.stack([numpy.reshape(row, (ROWS, COLUMNS)) for row in "
          "array])"),
    "S": (TEXT, "save it as numbers: array.astype(float)"),
    "U": (TEXT, "save it as numbers: array.astype(float)"),
    "T": (TEXT, "save it as numbers: array.astype(float)"),
}  # fmt: skip


class Group(NamedTuple):
    """What a file or store holds.

    Parameters
    ----------
    word : str
        What messages call an array: ``dataset``, ``array``.
    arrays : mapping
        Name -> array of h5py or Zarr: of numbers, of dates, or with fields.
    unread : mapping
        Name -> what is there and why it is not read.
    root : File, Group or None
        Whose attributes hold for all of it.
    check : callable
        Refuses arrays, by name, that are too large to be read.
    load : callable
        Returns the values of the stack, or of its times, from the array and how it is packed.
    texts : callable
        Returns the texts in what is not read, by its name; none where it holds something else.
        Refuses what is too large, as ``check`` does.
    packing : callable
        Returns how an array is packed, from the file, its name and itself.
    framed : frozenset of str
        Names of arrays whose first axis is known to be that of the frames.
    """

    word: str
    arrays: Mapping[str, Any]
    unread: Mapping[str, Unread]
    root: Any
    check: Callable[[Mapping[str, Any]], None]
    load: Callable[[Any, Packing], Any]
    texts: Callable[[str], Sequence[str]]
    packing: Callable[[str, str, Any], Packing]
    framed: frozenset[str] = frozenset()


def attributes_of(item: Any) -> dict[str, Any]:
    """Return the attributes of a file, a group or an array, as far as they can be read."""
    found: dict[str, Any] = {}
    for key in () if item is None else item.attrs:
        try:
            found[key] = item.attrs[key]
        except Exception:  # of a type that the library does not know
            continue
    return found


def packing(where: str, name: str, array: Any) -> Packing:
    """Return how an array is packed, as its attributes say; raises as `packing_of`."""
    return packing_of(where, name, array.dtype, attributes_of(array))


def item_bytes(dtype: np.dtype[Any]) -> int:
    """Return how many bytes an item of an array takes in memory, at the least."""
    return max(dtype.itemsize, LEAST_TEXT) if dtype.kind in TEXTS else dtype.itemsize


def _values_beside(group: Group) -> Iterator[tuple[str, Any]]:
    """Yield what arrays of one or two numbers, or of one text, hold; not those of other files."""
    found = {n: a for n, a in group.arrays.items() if a.dtype.kind in "buif" and a.size in (1, 2)}
    texts = [n for n, u in group.unread.items() if u.what == TEXT and group.root is not None]
    for name in (*found, *texts):
        try:
            array = found[name] if name in found else group.root[name]
            group.check({name: array})
            most = 1 if array.dtype.kind in "OT" else LONGEST_TEXT  # of texts of any length
            value: Any = array[()] if array.size <= most else None
            if name in texts and not _is_text(value):
                value = group.texts(name)  # in cells of MATLAB's
        except Exception:  # of a type that the library does not know, or far too large
            continue
        if name in texts and np.ndim(value) and np.asarray(value).dtype.kind == "u":  # of MATLAB
            value = "".join(map(chr, np.ravel(value)))
        yield bare(name), value


def _is_text(value: Any) -> bool:
    return value is None or all(isinstance(v, str | bytes | int) for v in np.ravel(value).tolist())


def _with_unit(name: str, unit: object) -> str:
    """Return the name of times with the unit that an attribute says: ``milliseconds since …``."""
    text = unit.decode("utf-8", "replace") if isinstance(unit, bytes) else str(unit or "")
    told = f"{bare(name)} ({text.partition(' since ')[0].strip()})"
    return told if named((told, "")).time_factor is not None else name


def unread(dtype: np.dtype[Any], shape: tuple[int, ...]) -> Unread | None:
    """Return why an array of such a type is not read; None where it may be."""
    if dtype.names == ("real", "imag"):  # as MATLAB writes it
        dtype = np.dtype(complex)
    if dtype.names or dtype.kind in "buifMm":
        return None
    what, remedy = _NOT_READ.get(dtype.kind, (f"of type {dtype}", "save it as numbers"))
    return Unread(what, remedy, shape)


def held_in(reading: Reading, group: Group) -> Held:
    """Return the only stack, those that are numbered, or the one that ``sensor`` names.

    Raises
    ------
    DataError
        If no stack or several could be meant, or it is too large.
    """
    where = str(reading.path)
    numbers = {n: a for n, a in group.arrays.items() if a.dtype.kind in "buif"}
    dates = {n: a for n, a in group.arrays.items() if a.dtype.kind in "Mm"}
    others = {**group.unread, **{n: Unread("dates", "", a.shape) for n, a in dates.items()}}
    shapes = {n: tuple(a.shape) for n, a in numbers.items()}
    _refuse_fields(where, shapes, {n: a.dtype.names for n, a in group.arrays.items()}, group.word)
    frames = [] if reading.told.sensor else numbered(shapes)
    name = frames[0] if frames else chosen(reading, shapes, group.word, others)
    timed = {n: a for n, a in {**numbers, **dates}.items() if a.ndim == 1 or 1 in a.shape}
    time = time_among(n for n in timed if n not in {*frames, name})
    read = {*(frames or [name]), time}
    group.check({n: a for n, a in {**numbers, **timed}.items() if n in read})
    packed = {n: group.packing(where, n, numbers[n]) for n in frames or [name]}
    loaded = [group.load(numbers[n], p) for n, p in packed.items()]
    values = np.stack(loaded) if frames else loaded[0]
    if packed[name].said:
        reading.heed(f"values unpacked, as the file says: {packed[name].said}")
    times = None
    if time:
        how = group.packing(where, time, timed[time])
        times = np.asarray(group.load(timed[time], how)).ravel()
        time = _with_unit(time, attributes_of(timed[time]).get("units"))
    else:
        times, time = _worded_times(reading, group)
    attributes = {**attributes_of(group.root), **attributes_of(numbers[name])}
    if packed[name].said:  # its factor is applied
        attributes.pop("scale_factor", None)
    attributes |= _values_beside(group)
    said = described_by(attributes)
    what = f"{group.word} {name!r}"
    if frames:
        what = f"{group.word}s {frames[0]!r} to {frames[-1]!r}"
    return Held(values, what, said, times, time, bool(frames) or name in group.framed)


def _worded_times(reading: Reading, group: Group) -> tuple[NDArray[Any] | None, str]:
    """Return times that are texts, and their name; those that are neither are told."""
    several = {n: u for n, u in group.unread.items() if u.shape is None or math.prod(u.shape) > 1}
    name = time_among(several)
    texts = group.texts(name) if name else ()
    if name and not texts:
        reading.assume(f"times left out, as {name!r} is not read: {several[name]}")
    short = np.array([text[:LONGEST_TEXT] for text in texts], object)
    return (short, name) if len(texts) > 1 else (None, "")


def _refuse_fields(
    where: str, shapes: Mapping[str, tuple[int, ...]], fields: Mapping[str, Any], word: str
) -> None:
    """Refuse a file whose only matrices may be fields of an array."""
    name = next((n for n, names in fields.items() if names), "")
    if name and not any(map(is_stack, shapes.values())):
        raise DataError(
            where,
            f"{word} {name!r} has fields ({', '.join(fields[name])}); save the one with the cells "
            f"as {'an' if word[0] in 'aeiou' else 'a'} {word} of its own, in Python: "
            f"file['frames'] = file[{name!r}][field]",
        )
