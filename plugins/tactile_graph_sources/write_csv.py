"""Write frames as a table, one frame a line, that ``recording`` reads back."""

from __future__ import annotations

import os
from collections.abc import Iterable
from itertools import chain
from pathlib import Path

from tactile_graph.errors import DataError
from tactile_graph.wires.frame import Frame


def write_csv(path: str | os.PathLike[str], frames: Iterable[Frame]) -> int:
    """Return the number of frames written to ``path``, which appears whole or not at all.

    The table keeps values, frame numbers and times (where the first frame has one), and says
    shape, pitch and quantity in a comment; cells that are not valid become ``nan``. Truth, device
    time and gaps have no place in it.

    Parameters
    ----------
    path : path
    frames : iterable of Frame
        All of one shape.

    Raises
    ------
    DataError
        If there is no frame, a frame is of another shape, or a time is missing.
    """
    it = iter(frames)
    first = next(it, None)
    if first is None:
        raise DataError(str(path), "there is no frame to write")
    target = Path(path)
    beside = target.with_name(f".{target.name}.part")
    n = 0
    try:
        with beside.open("w", encoding="utf-8", newline="\n") as file:
            file.write(_head(first))
            for frame in chain([first], it):
                file.write(_line(target, frame, n, first))
                n += 1
        beside.replace(target)
    except BaseException:
        beside.unlink(missing_ok=True)
        raise
    return n


def _head(first: Frame) -> str:
    image = first.image
    cells = [f"r{r}c{c}" for r in range(image.rows) for c in range(image.columns)]
    names = ["frame", *(["time_s"] if first.time_s is not None else []), *cells]
    about = (
        f"# {image.rows} rows, {image.columns} columns, pitch {image.pitch_cm} cm, "
        f"{image.quantity}; cells row by row\n"
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
