"""Write frames as a recording of ours: an ``.npz`` that ``recording`` reads back whole."""

from __future__ import annotations

import os
import zipfile
from collections.abc import Iterable
from typing import IO, Any, BinaryIO

import numpy as np
from numpy.typing import NDArray

from tactile_graph.files import whole_file
from tactile_graph.wires import Frame
from tactile_graph_sources.readers.words.own_number import NO_NUMBER, counted
from tactile_graph_sources.readers.words.truth import own_shapes, truth_to_json
from tactile_graph_sources.writers.recording_writer import OWN_SHAPES, RecordingWriter

LEVEL = 4
"""Of zlib: 0 to 35 % more space than 6, the usual one, in 0.3 to 0.9 of its time; 1 is little
faster and takes 8 to 80 % more."""
BLOCK = 64
"""Frames that are packed together."""


def write_npz(
    path: str | os.PathLike[str], frames: Iterable[Frame], pitch_told: bool = True
) -> int:
    """Return the number of frames written to ``path``, which appears whole or not at all.

    Parameters
    ----------
    path : path
        An existing file is replaced, at the end and at once.
    frames : iterable of Frame
        All of one shape, pitch, origin and quantity.
    pitch_told : bool
        Whether anybody said the pitch; it is left out otherwise.

    Raises
    ------
    ValueError
        If there is no frame, or a frame lies on another grid than the first.
    UsageError
        If the file cannot be written.

    Notes
    -----
    Arrays: ``values`` (N, rows, columns), ``pitch_cm`` (2,), ``origin_cm`` (2,), ``quantity``;
    where a frame has them ``valid`` (N, rows, columns), ``time_s``, ``device_time_s``, ``gap``,
    ``doubtful``, ``label``, ``state_of``, ``own_number`` (N,; the least number of 64 bits where a
    frame has none), and ``truth``, a JSON text: for each frame null or a list of objects with
    ``kind``, the fields of that shape, ``weight_g`` and ``name``. A frame's truth is left out if it
    has a shape of a plugin's own.

    All frames are held until the last one has come, as their number stands before the first.
    """
    arrays = _arrays(list(frames))
    if not pitch_told:
        del arrays["pitch_cm"]
    with whole_file(path) as file:
        _write(file, arrays)
        file.flush()
        os.fsync(file.fileno())
    return len(arrays["values"])


def _write(file: BinaryIO, arrays: dict[str, Any]) -> None:
    """Write what `numpy.savez_compressed` would, at our `LEVEL` and frame by frame."""
    with zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED, compresslevel=LEVEL) as packed:
        for name, array in arrays.items():
            with packed.open(f"{name}.npy", "w", force_zip64=True) as member:
                if isinstance(array, list):
                    _write_frames(member, array)
                else:
                    np.lib.format.write_array(member, array, allow_pickle=False)


def _write_frames(member: IO[bytes], frames: list[NDArray[Any]]) -> None:
    """Write arrays of one shape as one array, of which no second copy is held."""
    dtype = np.result_type(*{frame.dtype for frame in frames})
    shape = (len(frames), *frames[0].shape)
    descr = np.lib.format.dtype_to_descr(dtype)
    np.lib.format.write_array_header_1_0(
        member, {"descr": descr, "fortran_order": False, "shape": shape}
    )
    for first in range(0, len(frames), BLOCK):
        member.write(np.stack(frames[first : first + BLOCK]).astype(dtype, copy=False).tobytes())


def _grid(frame: Frame) -> tuple[Any, ...]:
    image = frame.image
    return image.shape, image.pitch_cm, image.origin_cm, image.quantity


def _arrays(frames: list[Frame]) -> dict[str, Any]:
    """Return what is to be written; a list where each frame has its own array."""
    if not frames:
        raise ValueError("there is no frame to write")
    first = frames[0].image
    for k, frame in enumerate(frames):
        if _grid(frame) != _grid(frames[0]):
            raise ValueError(
                f"frame {k} is {frame.image}, the first is {first}; a recording has one grid"
            )
    arrays: dict[str, Any] = {
        "values": [f.image.values for f in frames],
        "pitch_cm": np.array(first.pitch_cm, dtype=np.float64),
        "origin_cm": np.array(first.origin_cm, dtype=np.float64),
        "quantity": np.array(first.quantity),
    }
    if any(f.image.valid is not None for f in frames):
        whole = np.ones(first.shape, dtype=bool)
        arrays["valid"] = [whole if f.image.valid is None else f.image.valid for f in frames]
    for name in ("time_s", "device_time_s"):
        times = [getattr(f, name) for f in frames]
        if any(t is not None for t in times):
            arrays[name] = np.array([np.nan if t is None else t for t in times], dtype=np.float64)
    for name in ("gap", "doubtful"):
        marks = [getattr(f, name) for f in frames]
        if any(marks):
            arrays[name] = np.array(marks)
    if any(f.label for f in frames):
        arrays["label"] = np.array([f.label for f in frames])
    if any(f.state_of is not None for f in frames):
        whose = [f.label if f.state_of is None else f.state_of for f in frames]
        arrays["state_of"] = np.array(whose)
    numbers = [counted(f.own_number) for f in frames]
    if any(n is not None for n in numbers):
        told = [NO_NUMBER if n is None else n for n in numbers]
        arrays["own_number"] = np.array(told, dtype=np.int64)
    truths = [None if own_shapes(f.truth) else f.truth for f in frames]
    if any(truth is not None for truth in truths):
        arrays["truth"] = np.array(truth_to_json(truths))
    return arrays


WRITER = RecordingWriter(
    lambda path, frames, about: write_npz(path, frames),
    (OWN_SHAPES,),
    lambda path, frames, about: write_npz(path, frames, pitch_told=False),
)
