"""HDF5 files, MATLAB's of version 7.3 among them: one stack of matrices, its times beside it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from types import ModuleType
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tactile_graph.errors import DataError, did_you_mean, one_of
from tactile_graph.wires import Frame
from tactile_graph_sources.readers.head import Head
from tactile_graph_sources.readers.reading import Reading
from tactile_graph_sources.readers.stack import stack_of
from tactile_graph_sources.readers.tables.layout import unit_of
from tactile_graph_sources.readers.tables.names import named
from tactile_graph_sources.readers.tables.preamble import Described, described

NAME = "HDF5 (.h5, .hdf5, MATLAB 7.3 .mat)"
_MARK = b"\x89HDF\r\n\x1a\n"
_MATLAB = b"MATLAB 7.3"
MOST_VALUES = 500_000_000
NODE_IMAGES = "tactile-graph node images"
"""What the files say that ``tactile-graph run -o images.h5`` writes."""


_OWN = {"kind", "quantity", "pitch_cm", "origin_cm"}


class _Held(NamedTuple):
    """What is taken from a file; ``times`` are None where none fit."""

    values: NDArray[Any]
    name: str
    times: NDArray[Any] | None
    times_name: str
    said: Described
    origin_cm: tuple[float, float] | None = None


def recognises(head: Head) -> bool:
    """Return whether the file starts as HDF5 does, MATLAB's own words in front or not."""
    return head.raw.startswith(_MARK) or (
        head.raw.startswith(_MATLAB) and head.raw[512:].startswith(_MARK)
    )


def read(reading: Reading) -> Iterator[Frame]:
    """Yield the matrices of the only stack in the file, or of the one that ``sensor`` names.

    Raises
    ------
    DataError
        If h5py is not installed, the file is damaged, or no stack or several could be meant.
    """
    held = _held(reading, _h5py(reading))
    frames = stack_of(reading, held.values, f"dataset {held.name!r}")
    times, factor = held.times, 1.0
    if times is not None and len(times) != len(frames):
        times = None
    if times is not None:
        factor = _factor(reading, held.times_name, times)
    reading.report.expect(len(frames))
    said = held.said
    for k, matrix in enumerate(frames):
        timed = times is not None and np.isfinite(times[k])
        yield reading.frame(
            matrix,
            pitch_cm=said.pitch_cm,
            origin_cm=held.origin_cm,
            quantity=said.quantity,
            factor=said.factor,
            time_s=float(times[k]) * factor if times is not None and timed else None,
        )


def _h5py(reading: Reading) -> ModuleType:
    try:
        import h5py
    except ImportError:
        raise DataError(
            str(reading.path),
            "is HDF5, which needs the 'hdf5' extra: pip install 'tactile-graph[hdf5]'",
        ) from None
    module: ModuleType = h5py
    return module


def _held(reading: Reading, h5py: ModuleType) -> _Held:
    where = str(reading.path)
    try:
        with h5py.File(reading.path, "r") as file:
            sets: dict[str, Any] = {}
            file.visititems(lambda n, o: sets.update({n: o} if isinstance(o, h5py.Dataset) else {}))
            numbers = {n: d for n, d in sets.items() if d.dtype.kind in "buif"}
            name = _chosen(reading, {n: d.shape for n, d in numbers.items()})
            if numbers[name].size > MOST_VALUES:
                raise DataError(where, f"dataset {name!r} holds {numbers[name].size} values")
            values = numbers[name][()]
            timed = {n for n, d in numbers.items() if d.ndim == 1 or 1 in d.shape}
            time = next((n for n in sorted(timed) if _is_time(n)), "")
            times = numbers[time][()].ravel() if time else None
            attributes = {**file.attrs, **numbers[name].attrs}
            lines = [f"{k}: {v}" for k, v in attributes.items() if np.ndim(v) == 0]
    except DataError:
        raise
    except Exception as error:  # HDF5 has a dozen kinds of errors over damaged files
        raise DataError(where, f"the HDF5 file cannot be read: {str(error)[:120]}") from error
    if reading.head.raw.startswith(_MATLAB):
        values = values.T  # MATLAB counts the other way round
    said, origin_cm = described(lines), None
    if attributes.get("format") == NODE_IMAGES and attributes.keys() >= _OWN:
        said, origin_cm = _place(attributes)
        if attributes.get("kind") == "mask":
            values = np.where(values > 1, np.nan, values)  # no value in that frame
    return _Held(values, name, times, time, said, origin_cm)


def _place(attributes: Mapping[str, Any]) -> tuple[Described, tuple[float, float]]:
    """Return what a stack says of itself that a run has written."""
    (x, y), (left, top) = attributes["pitch_cm"], attributes["origin_cm"]
    said = Described(pitch_cm=(float(x), float(y)), quantity=str(attributes["quantity"]))
    return said, (float(left), float(top))


def _is_time(name: str) -> bool:
    return "time" in named((name.rpartition("/")[2], "")).roles


def _chosen(reading: Reading, shapes: dict[str, tuple[int, ...]]) -> str:
    where, asked = str(reading.path), reading.told.sensor
    if asked:
        if asked not in shapes:
            near = did_you_mean(asked, shapes)
            raise DataError(where, f"no dataset {asked!r}, there are {one_of(shapes)}{near}")
        reading.sensors[asked] = None
        return asked
    stacks = [n for n, s in shapes.items() if len(s) in (2, 3) and min(s) > 1]
    if len(stacks) == 1:
        return stacks[0]
    listed = one_of(f"{n} {s}" for n, s in shapes.items())
    if stacks:
        raise DataError(where, f"several datasets could be it ({listed}); name one with sensor")
    raise DataError(where, f"no matrix or stack of matrices in it; its datasets: {listed}")


def _factor(reading: Reading, name: str, times: NDArray[Any]) -> float:
    factor = named((name.rpartition("/")[2], "")).time_factor
    if factor is not None:
        return factor
    known = times[np.isfinite(times)].astype(np.float64)
    factor, unit = unit_of(known)
    reading.assume(f"times assumed to be in {unit}")
    return factor
