"""Write frames as a table, one frame a line, that ``recording`` reads back."""

from __future__ import annotations

import os
from collections.abc import Iterable
from itertools import chain
from pathlib import Path

from tactile_graph.errors import DataError
from tactile_graph.files import whole_file
from tactile_graph.wires.frame import Frame
from tactile_graph_sources.writers.recording_writer import RecordingWriter


def write_csv(
    path: str | os.PathLike[str], frames: Iterable[Frame], pitch_told: bool = True
) -> int:
    """Return the number of frames written to ``path``, which appears whole or not at all.

    The table keeps values and times (where the first frame has one), and says shape, pitch, origin
    and quantity in a comment, which `recording` reads back; cells that are not valid become
    ``nan``. Frames are numbered from 0; truth, device time, gaps, doubts, labels and own numbers
    have no place in it.

    Parameters
    ----------
    path : path
    frames : iterable of Frame
        All of one shape.
    pitch_told : bool
        Whether anybody said the pitch; it is left out otherwise.

    Raises
    ------
    DataError
        If there is no frame, a frame is of another shape, or a time is missing.
    UsageError
        If the file cannot be written.
    """
    it = iter(frames)
    first = next(it, None)
    if first is None:
        raise DataError(str(path), "there is no frame to write")
    n = 0
    with whole_file(path) as file:
        file.write(_head(first, pitch_told).encode())
        for frame in chain([first], it):
            file.write(_line(Path(path), frame, n, first).encode())
            n += 1
    return n


def _head(first: Frame, pitch_told: bool) -> str:
    image = first.image
    cells = [f"r{r}c{c}" for r in range(image.rows) for c in range(image.columns)]
    names = ["frame", *(["time_s"] if first.time_s is not None else []), *cells]
    pitch = f"pitch {image.pitch_cm} cm, " if pitch_told else ""
    about = (
        f"# {image.rows} rows, {image.columns} columns, {pitch}"
        f"origin {image.origin_cm} cm, {image.quantity}; cells row by row\n"
    )
    return about + ",".join(names) + "\n"


def _line(path: Path, frame: Frame, n: int, first: Frame) -> str:
    if frame.image.shape != first.image.shape:
        raise DataError(
            str(path), f"frame {n} is of shape {frame.image.shape}, the first {first.image.shape}"
        )
    fields = [str(n)]
    if first.time_s is not None:
        if frame.time_s is None:
            raise DataError(str(path), f"frame {n} has no time, the first has one")
        fields.append(repr(float(frame.time_s)))
    values = frame.image.filled(float("nan")).astype(float).ravel().tolist()
    fields += [repr(v).removesuffix(".0") for v in values]
    return ",".join(fields) + "\n"


WRITER = RecordingWriter(
    lambda path, frames, about: write_csv(path, frames),
    loses=("truth", "device time", "gaps", "doubts", "labels", "own numbers"),
    write_untold=lambda path, frames, about: write_csv(path, frames, pitch_told=False),
)
