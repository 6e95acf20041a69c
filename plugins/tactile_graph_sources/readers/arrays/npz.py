"""NumPy ``.npz`` files: our own recordings, CapContact frames, or any file with one stack."""

from __future__ import annotations

import math
import os
import zipfile
from collections.abc import Iterator, Sequence
from dataclasses import replace
from functools import partial
from typing import IO, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tactile_graph.errors import DataError, did_you_mean, one_of
from tactile_graph.quantities import unknown_quantity
from tactile_graph_sources.readers.arrays import capcontact
from tactile_graph_sources.readers.arrays.archive import mapped, opened
from tactile_graph_sources.readers.arrays.datasets import (
    Held,
    frames_of,
    hint_on,
    is_stack,
    laid_of,
    numbered,
)
from tactile_graph_sources.readers.arrays.masks import (
    Masks,
    masks_among,
    refuse_unclear,
    without_invalid,
)
from tactile_graph_sources.readers.arrays.stack import Axes, stack_of
from tactile_graph_sources.readers.arrays.times import time_among
from tactile_graph_sources.readers.choice import SeveralSensorsError
from tactile_graph_sources.readers.choosing.others import document_in
from tactile_graph_sources.readers.head import Head
from tactile_graph_sources.readers.laid import Laid, laid_in
from tactile_graph_sources.readers.reading import OF_TIMES, Reading
from tactile_graph_sources.readers.recording_format import RecordingFormat
from tactile_graph_sources.readers.words.own_number import NO_NUMBER
from tactile_graph_sources.readers.words.preamble import described_by
from tactile_graph_sources.readers.words.truth import Truth, truth_from_json

MOST_MEMBERS = 1000
MOST_TIMES = 200
SMALL, LARGE = 64_000_000, 256_000_000
"""Bytes; a smaller array may be packed as small as it likes."""
WORTH_MAPPING = 1_000_000
"""Bytes of an array, stored as it is, from which on it is mapped, not read."""
_UNPACK = "unpack it, and give those that are recordings"
OURS = ("values", "valid", "time_s", "device_time_s", "gap", "doubtful", "label", "state_of",
        "own_number",
        "quantity", "pitch_cm", "origin_cm", "truth")  # fmt: skip


def recognises(head: Head) -> bool:
    """Return whether the file is a zip archive; NumPy's are the only ones read."""
    return head.raw.startswith((b"PK\x03\x04", b"PK\x05\x06"))


def read(reading: Reading) -> Iterator[Any]:
    """Yield the frames of whichever kind of archive it is.

    Raises
    ------
    DataError
        If the archive is damaged or holds no stack, or several and none is chosen by ``sensor``.
    """
    with opened(reading.path) as file:
        arrays = Archive(str(reading.path), file)
        if {"cap", "ftir"} <= arrays.names.keys():
            reading.refuse_settings()
            arrays.check_sizes(("cap", "ftir"))
            yield from capcontact.frames(reading, arrays.load("cap"), arrays.load("ftir"))
        elif "values" in arrays.names:
            reading.pass_settings()
            ours = _ours(reading, arrays)
            reading.report.expect(len(ours.values))
            yield from _frames_alone(ours, reading, 0, len(ours.values))
        else:
            yield from frames_of(reading, _foreign(reading, arrays))


def laid(reading: Reading) -> Laid | None:
    """Return how frames are read where they lie in the archive, without those before them.

    None where an array is packed, as nobody then reads a part of it alone; where the stack is put
    together of several arrays; and where a truth stands beside the frames, of which each reader
    would need all.
    """
    with opened(reading.path) as file:
        arrays = Archive(str(reading.path), file, check=False)
        if not _is_in_place(reading, arrays):
            return None
        if "values" not in arrays.names:
            found = laid_of(reading, _foreign(reading, arrays))
        elif reading.told.sensor:
            return None
        else:
            ours = _ours(reading, arrays)
            found = laid_in(reading, ours.values, ours.times, **ours.grid)
            found = found and found._replace(frames=partial(_frames_alone, ours))

    def check() -> None:
        with opened(reading.path) as file:
            again = Archive(str(reading.path), file)
            for name in arrays.unchecked:
                again.load(name)

    return found and found._replace(check=check)


def _is_in_place(reading: Reading, arrays: Archive) -> bool:
    names = arrays.names.keys()
    several = sum(len(arrays.outline(name)[0]) > 1 for name in names) > 1
    if several and not ("values" in names or reading.told.sensor):
        return False
    return all(map(arrays.is_stored, names)) and not ({"cap", "ftir"} <= names or "truth" in names)


class Archive:
    """The arrays of an archive by name; each is read when it is asked for, never unpickled.

    Parameters
    ----------
    where : str
    file : ZipFile
    check : bool
        Whether what is mapped is held against its checksum; else somebody does so once for all.
    """

    def __init__(self, where: str, file: zipfile.ZipFile, check: bool = True) -> None:
        self.where = where
        self._check = check
        self.unchecked: list[str] = []
        """Arrays that were mapped and not held against their checksums."""
        self._file = file
        self._size = os.path.getsize(where)
        members = file.infolist()
        if len(members) > MOST_MEMBERS:
            raise DataError(where, f"holds {len(members)} members; allowed are {MOST_MEMBERS}")
        document = document_in([m.filename for m in members])
        if document:
            raise DataError(where, document)
        arrays = [m for m in members if m.filename.endswith(".npy")]
        self.held = [m.filename for m in members]
        self.names = {m.filename.removesuffix(".npy"): m for m in arrays}

    def outline(self, name: str) -> tuple[tuple[int, ...], np.dtype[Any]]:
        """Return shape and type of an array by its head alone; errors as of `load`."""
        try:
            with self._file.open(self.names[name]) as member:
                shape, _, dtype = _head_of(member)
                return shape, dtype
        except Exception as error:
            raise DataError(self.where, f"array {name!r} cannot be read: {error}") from error

    def check_sizes(self, names: Sequence[str]) -> None:
        """Refuse arrays that together are nearly nothing but zeros, packed away.

        Raises
        ------
        DataError
        """
        members = [self.names[name] for name in names]
        unpacked = sum(m.file_size for m in members)
        packed = min(sum(m.compress_size for m in members), self._size)  # two may share their bytes
        if unpacked > LARGE and unpacked > MOST_TIMES * packed:
            which = f"array {names[0]!r} unpacks"
            if len(names) > 1:
                which = f"arrays {names[0]!r} to {names[-1]!r} unpack"
            raise DataError(
                self.where,
                f"{which} to {unpacked / 1e6:,.0f} MB, {unpacked // max(packed, 1)} times what is "
                f"packed; allowed are {MOST_TIMES} beyond {LARGE / 1e6:,.0f} MB",
            )

    def load(self, name: str) -> NDArray[Any]:
        """Return an array; a large one that is stored as it is never stands in memory as a whole.

        Raises
        ------
        DataError
            If it is damaged, holds objects, or its size is refused by `check_sizes`.
        """
        self.check_sizes([name])
        try:
            info = self.names[name]
            stored = self._is_stored(info)
            found = self._mapped(info) if stored and info.file_size > WORTH_MAPPING else None
            if found is not None:
                self.unchecked += [] if self._check else [name]
                return found
            if info.file_size > SMALL and not stored:
                # What is damaged is refused before it fills the memory.
                with self._file.open(self.names[name]) as member:
                    while member.read(1 << 20):
                        pass
            with self._file.open(self.names[name]) as member:
                array = np.asarray(np.lib.format.read_array(member, allow_pickle=False))
                if member.read(1):  # the CRC is checked at the member's end, and only there
                    raise ValueError("it holds more than its shape says")
                return array
        except Exception as error:
            raise DataError(self.where, f"array {name!r} cannot be read: {error}") from error

    def is_stored(self, name: str) -> bool:
        """Return whether an array lies in the file as it is, unpacked."""
        return self._is_stored(self.names[name])

    def _is_stored(self, info: zipfile.ZipInfo) -> bool:
        return info.compress_type == zipfile.ZIP_STORED and info.file_size <= self._size

    def _mapped(self, info: zipfile.ZipInfo) -> NDArray[Any] | None:
        """Return a stored array as it lies in the file; None where its size is not as it says."""
        with self._file.open(info) as member:
            shape, by_column, dtype = _head_of(member)
            begin = member.tell()
        if dtype.hasobject or math.prod(shape) * dtype.itemsize != info.file_size - begin:
            return None
        held = mapped(self.where, info, self._check)
        return np.ndarray(shape, dtype, held, begin, order="F" if by_column else "C")

    def optional(
        self, name: str, shape: tuple[int, ...], kinds: str, meaning: str = ""
    ) -> NDArray[Any] | None:
        """Return an array if it is there; a wrong shape or type is an error that says the meaning.

        Raises
        ------
        DataError
            If it is there and is not what it should be.
        """
        if name not in self.names:
            return None
        array = self.load(name)
        if array.shape != shape or array.dtype.kind not in kinds:
            raise DataError(
                self.where,
                f"array {name!r} has shape {array.shape} and type {array.dtype}, "
                f"expected shape {shape}{meaning}",
            )
        return array


def _head_of(member: IO[bytes]) -> tuple[tuple[int, ...], bool, np.dtype[Any]]:
    """Return shape, whether columns come first, and type of an array, by its head."""
    version = np.lib.format.read_magic(member)
    read = (
        np.lib.format.read_array_header_1_0
        if version == (1, 0)
        else np.lib.format.read_array_header_2_0
    )
    shape, by_column, dtype = read(member)
    return shape, by_column, dtype


def _checked(reading: Reading, arrays: Archive, name: str, axes: Axes = "asked") -> NDArray[Any]:
    """Return an array of which its head alone, looked at first, says that it may be a stack."""
    what = f"array {name!r}"
    shape, dtype = arrays.outline(name)
    try:
        outline = np.broadcast_to(np.zeros((), dtype), shape)
        stack_of(reading, outline, what, "known" if axes == "known" else "outline")
    except ValueError as error:  # a shape that no array has
        raise DataError(arrays.where, f"{what} cannot be read: {error}") from error
    return arrays.load(name)


def _foreign(reading: Reading, arrays: Archive) -> Held:
    """Return the only stack of another's archive, its times beside it."""
    reading.refuse_settings(*OF_TIMES)
    outlines = {name: arrays.outline(name) for name in arrays.names}
    masks = masks_among(outlines, arrays.load)
    values, what, known = _only(reading, arrays, masks)
    masks.pop(reading.told.sensor, None)
    values, of_frames = without_invalid(reading, values, masks)
    lines = {n: t.kind for n, (s, t) in outlines.items() if len(s) == 1}
    time = time_among(n for n, kind in lines.items() if kind in "iufMm")
    time = time or time_among(n for n, kind in lines.items() if kind in "US")
    small = [n for n, (s, t) in outlines.items() if math.prod(s) in (1, 2) and t.kind in "iufUS"]
    said = described_by({n: arrays.load(n) for n in small})
    times = arrays.load(time) if time else None
    return Held(values, what, said, times, time, known, masks=of_frames)


def _only(reading: Reading, arrays: Archive, masks: Masks) -> tuple[NDArray[Any], str, bool]:
    """Return the only stack, what it is called, and whether numbers say that frames come first."""
    where, asked = str(reading.path), reading.told.sensor
    if asked:
        if asked not in arrays.names:
            near = did_you_mean(asked, arrays.names)
            raise DataError(where, f"no array {asked!r}, there are {one_of(arrays.names)}{near}")
        reading.sensors[asked] = None
        return _checked(reading, arrays, asked), f"array {asked!r}", False
    outlines = {name: arrays.outline(name) for name in arrays.names}
    shapes_of = {n: s for n, (s, t) in outlines.items() if t.kind in "buif" and n not in masks}
    stacks = [n for n, s in shapes_of.items() if len(s) in (2, 3) or is_stack(s)]
    if len(stacks) == 1:
        take_all = f"or take all cells, such as sensor={stacks[0]}"
        refuse_unclear(
            where, {n: m.shape for n, m in masks.items()}, shapes_of[stacks[0]], take_all
        )
    if len(stacks) > 1 and (frames := numbered({n: shapes_of[n] for n in stacks})):
        arrays.check_sizes(frames)
        what = f"arrays {frames[0]!r} to {frames[-1]!r}"
        return np.stack([arrays.load(n) for n in frames]), what, True
    if len(stacks) == 1:
        return _checked(reading, arrays, stacks[0]), f"array {stacks[0]!r}", False
    shapes = one_of(
        f"{n} {shape}" + ("" if t.kind in "buif" else f" of {_kind_of(t)}")
        for n, (shape, t) in outlines.items()
    )
    if stacks:
        told = f"several arrays could be it ({shapes}); name one with sensor"
        raise SeveralSensorsError(where, told, stacks)
    if not outlines and arrays.held:
        raise DataError(where, f"it holds no array but {one_of(arrays.held)}; {_UNPACK}")
    deep = [n for n, (s, t) in outlines.items() if len(s) == 4 and t.kind in "buif"]
    hint = f"; {hint_on(deep[0], outlines[deep[0]][0], 'array')}" if deep else ""
    if fields := [n for n, (_, t) in outlines.items() if t.names]:
        hint = f"; save the field of {fields[0]!r} with the cells: array[field]"
    if odd := [n for n, (s, t) in outlines.items() if t.kind == "U" and len(s) in (2, 3)]:
        hint = f"; save {odd[0]!r} as numbers: array.astype(float)"
    if odd := [n for n, (s, t) in outlines.items() if t.kind == "c" and len(s) in (2, 3)]:
        hint = f"; {odd[0]!r} is complex; save it as real numbers: array.real, or numpy.abs(…)"
    if objects := [n for n, (_, t) in outlines.items() if t.kind == "O"]:
        hint = (
            f"; {objects[0]!r} holds Python objects, which are not opened, as they may run any "
            f"program; save them as numbers: numpy.savez('out.npz', frames=numpy.stack(frames))"
        )
    raise DataError(where, f"no matrix or stack of matrices in it; its arrays: {shapes}{hint}")


def _kind_of(dtype: np.dtype[Any]) -> str:
    """Return in words what an array holds that is no array of numbers."""
    if dtype.names:
        return f"fields ({', '.join(dtype.names)})"
    words = {"c": "complex numbers", "O": "objects", "U": "text", "S": "text", "M": "dates",
             "m": "times"}  # fmt: skip
    return words.get(dtype.kind, str(dtype))


def _pair(arrays: Archive, name: str, smallest: float) -> tuple[float, float] | None:
    if name == "pitch_cm" and name in arrays.names and arrays.load(name).shape in ((), (1,)):
        one = arrays.optional(name, arrays.load(name).shape, "fiu")  # of square cells
        pair = None if one is None else np.repeat(one, 2)
    else:
        pair = arrays.optional(name, (2,), "fiu", ", along x and along y")
    if pair is None:
        return None
    x, y = float(pair[0]), float(pair[1])
    if not (np.isfinite(pair).all() and min(x, y) > smallest):
        raise DataError(arrays.where, f"{name} is ({x}, {y}), which no pad has")
    return x, y


class _Ours(NamedTuple):
    """A recording of ours; None for what is said of none of its frames."""

    values: NDArray[Any]
    times: NDArray[Any] | None
    grid: dict[str, Any]
    valid: NDArray[Any] | None
    device_times: NDArray[Any] | None
    gaps: NDArray[Any] | None
    doubtful: NDArray[Any] | None
    labels: NDArray[Any] | None
    states: NDArray[Any] | None
    numbers: NDArray[Any] | None
    truths: list[Truth] | None

    @property
    def says_more(self) -> bool:
        """Whether anything is to be said of single frames."""
        return any(one is not None for one in self[3:])


def _ours(reading: Reading, arrays: Archive) -> _Ours:
    """Return a recording of ours; all but ``values`` is optional in it."""
    reading.is_own = True
    arrays.check_sizes([name for name in OURS if name in arrays.names])
    # Who writes our files says the quantity, and that frames lie along the first axis.
    axes: Axes = "known" if "quantity" in arrays.names else "asked"
    if axes == "asked":
        outlines = {name: arrays.outline(name) for name in arrays.names}
        shapes = {n: s for n, (s, t) in outlines.items() if t.kind == "b"}
        of = outlines["values"][0]
        refuse_unclear(arrays.where, shapes, of, "or leave it out to take all cells")
    values = _checked(reading, arrays, "values", axes)
    values = stack_of(reading, values, "array 'values'", axes)
    n = len(values)
    valid = arrays.optional("valid", values.shape, "b")
    times = arrays.optional("time_s", (n,), "fiu")
    device_times = arrays.optional("device_time_s", (n,), "fiu")
    gaps = arrays.optional("gap", (n,), "b")
    doubtful = arrays.optional("doubtful", (n,), "b")
    labels = arrays.optional("label", (n,), "U")
    states = arrays.optional("state_of", (n,), "U")
    numbers = arrays.optional("own_number", (n,), "iu")
    quantity = str(q) if (q := arrays.optional("quantity", (), "U")) is not None else "raw"
    if unknown := unknown_quantity([quantity]):
        raise DataError(arrays.where, unknown)
    pitch, origin = _pair(arrays, "pitch_cm", 0.0), _pair(arrays, "origin_cm", -np.inf)
    truths = _truths(reading, arrays, n)
    grid = {"pitch_cm": pitch, "origin_cm": origin, "quantity": quantity}
    marks = (gaps, doubtful, labels, states, numbers)
    return _Ours(values, times, grid, valid, device_times, *marks, truths)


def _frames_alone(ours: _Ours, reading: Reading, low: int, high: int) -> Iterator[Any]:
    """Yield some frames of a recording of ours."""
    reading.is_own = True
    if not ours.says_more:
        times_s = None if ours.times is None else ours.times[low:high].astype(np.float64)
        if reading.wants(""):
            yield from reading.frames(ours.values[low:high], times_s, **ours.grid)
        return
    gaps, doubtful, labels = ours.gaps, ours.doubtful, ours.labels
    for k in range(low, high):
        sensor = "" if labels is None else str(labels[k])
        if reading.wants(sensor):
            frame = reading.frame(
                ours.values[k],
                **ours.grid,
                time_s=_time(ours.times, k),
                sensor=sensor,
                valid=None if ours.valid is None else ours.valid[k],
                truth=None if ours.truths is None else ours.truths[k],
                device_time_s=_time(ours.device_times, k),
                gap=gaps is not None and bool(gaps[k]),
                own_number=_number(ours.numbers, k),
            )
            frame = reading.of_state(frame, None if ours.states is None else str(ours.states[k]))
            unsure = doubtful is not None and bool(doubtful[k])
            yield replace(frame, doubtful=True) if unsure else frame


def _time(times: NDArray[Any] | None, k: int) -> float | None:
    return float(times[k]) if times is not None and np.isfinite(times[k]) else None


def _number(numbers: NDArray[Any] | None, k: int) -> int | None:
    return int(numbers[k]) if numbers is not None and numbers[k] != NO_NUMBER else None


def _truths(reading: Reading, arrays: Archive, n: int) -> list[Truth] | None:
    """Return the truth of each frame; None where nobody knows any."""
    text = arrays.optional("truth", (), "U")
    if text is None:
        return None
    try:
        truths = truth_from_json(str(text))
        if len(truths) != n:
            raise ValueError(f"truth of {len(truths)} frames for {n} frames")
    except ValueError as error:
        reading.report.trouble(reading.at("truth"), f"the truth is left out: {error}")
        return None
    return None if all(truth is None for truth in truths) else truths


FORMAT = RecordingFormat(
    "NumPy .npz (ours, CapContact, or one stack of matrices)", recognises, read, laid=laid
)
