"""Recordings of one pad as a stack of frames, and what is known of what lay on it."""

from __future__ import annotations

import csv
import io
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tactile_graph.errors import DataError, UsageError, did_you_mean
from tactile_graph.plugins.registry import installed
from tactile_graph.steps import Report
from tactile_graph.text_files import decoded
from tactile_graph.wires import Frame, Image
from tactile_graph_pads.same_pad import check_same_pad

Array = NDArray[np.float64]
Places = tuple[tuple[float, float], ...]
SOURCE = "recording"
NOT_READINGS = ("binary",)


@dataclass(frozen=True, eq=False)
class Stack:
    """Frames of one or more recordings of the same pad.

    Parameters
    ----------
    values : ndarray, shape (frames, rows, columns)
        As recorded; NaN where an element was not read.
    recording : ndarray of int, shape (frames,)
        Which of ``names`` a frame comes from.
    names : tuple of str
    places_cm : tuple
        For each frame the true centres (x, y) of what lay there; None where nobody knows.
    weight_g : ndarray, shape (frames,)
        All that lay on the pad; NaN where nobody knows.
    image : Image
        The first frame's, for grid and quantity.
    digests : mapping
        SHA-256 by file name.
    pitch_assumed : bool
        Whether no file says the pitch.
    """

    values: Array
    recording: NDArray[np.int64]
    names: tuple[str, ...]
    places_cm: tuple[Places | None, ...]
    weight_g: Array
    image: Image
    digests: Mapping[str, str]
    pitch_assumed: bool = False

    @property
    def shape(self) -> tuple[int, int]:
        """Rows and columns."""
        return self.image.shape

    def __len__(self) -> int:
        return len(self.values)


def read_stack(
    files: Sequence[tuple[Path, float | None]],
    places: Mapping[str, Mapping[int | None, Places]] | None = None,
    settings: Mapping[str, Any] | None = None,
) -> Stack:
    """Return the frames of some recordings, read by whichever plugin offers that source.

    Parameters
    ----------
    files : sequence of (Path, float or None)
        Each recording, and the grams that lay on the pad where that is known.
    places : mapping, optional
        By the recording's name and the frame's number in it (None: all its frames) what lay
        where; goes before what the recording itself says.
    settings : mapping, optional
        Of the step that reads them, such as ``pitch_cm``.

    Raises
    ------
    DataError
        If a recording holds no frames, or its grid or quantity is not that of the first one.
    UsageError
        If no plugin reads recordings.
    """
    steps = installed()
    if not steps.has("steps", SOURCE):
        raise UsageError(f"recordings need the step {SOURCE!r}: {steps.unknown('steps', SOURCE)}")
    read, report = steps.load("steps", SOURCE), Report()
    frames: list[Frame] = []
    of: list[int] = []
    known: list[Places | None] = []
    grams: list[float] = []
    for number, (path, load_g) in enumerate(files):
        for n, frame in enumerate(read(path=path, report=report, **settings or {})):
            if frames:
                check_same_pad(frames[0].image, frame.image, str(files[of[0]][0]), str(path))
            frames.append(frame)
            of.append(number)
            known.append(_places(frame, (places or {}).get(path.name), n))
            grams.append(_weight_g(frame) if load_g is None else load_g)
    if not frames:
        raise DataError(str(files[0][0]), "holds no frame")
    if frames[0].image.quantity in NOT_READINGS:
        raise DataError(str(files[0][0]), "holds yes and no, not readings")
    return Stack(
        np.stack([_with_nan(frame.image) for frame in frames]),
        np.array(of),
        tuple(path.name for path, _ in files),
        tuple(known),
        np.array(grams),
        frames[0].image,
        {Path(name).name: digest for name, digest in report.digests.items()},
        any("pitch is assumed to be 1 cm" in what for what in report.counts),
    )


def _with_nan(image: Image) -> Array:
    values = np.asarray(image.values, np.float64)
    return values if image.valid is None else np.where(image.valid, values, np.nan)


def _places(frame: Frame, told: Mapping[int | None, Places] | None, n: int) -> Places | None:
    if told is not None:
        return told.get(n, told.get(None))
    if frame.truth is None:
        return None
    return tuple((float(thing.shape.x_cm), float(thing.shape.y_cm)) for thing in frame.truth)


def _weight_g(frame: Frame) -> float:
    weights = [thing.weight_g for thing in frame.truth or ()]
    if frame.truth is None or any(w is None for w in weights):
        return float("nan")
    return float(sum(w for w in weights if w is not None))


def off_pad(stack: Stack) -> str:
    """Return how many known places lie off the pad, and the first; empty where none does."""
    left, right, bottom, top = stack.image.extent_cm
    places = [(k, x, y) for k, of in enumerate(stack.places_cm) for x, y in of or ()]
    off = [p for p in places if not (left <= p[1] <= right and top <= p[2] <= bottom)]
    if not off:
        return ""
    k, x, y = off[0]
    in_mm = left <= 0.1 * x <= right and top <= 0.1 * y <= bottom
    return (
        f"{len(off)} of {len(places)} known places lie off the pad of {right - left:g} by "
        f"{bottom - top:g} cm, first x {x:g}, y {y:g} cm in {stack.names[stack.recording[k]]}; "
        "places are cm from the pad's top left corner, x to the right, y down"
        + (": are these mm?" if in_mm else "")
    )


def read_places(path: Path, names: Sequence[str]) -> dict[str, dict[int | None, Places]]:
    """Return what lay where in which recording, as a CSV file tells.

    Parameters
    ----------
    path : Path
        Columns ``recording`` (the file's name), ``x_cm``, ``y_cm`` and, where a recording's
        frames differ, ``frame`` (its number in the recording, from 0); a line an object.
    names : sequence of str
        The recordings there are.

    Raises
    ------
    DataError
        If it is no such file, or names a recording that is not among them.
    """
    try:
        with io.StringIO(decoded(path.read_bytes()), newline="") as file:
            head = file.readline()
            file.seek(0)
            separator = max(",;\t", key=head.count)
            lines = list(csv.DictReader(file, delimiter=separator, skipinitialspace=True))
    except (OSError, UnicodeDecodeError, csv.Error) as error:
        raise DataError(str(path), f"the list of places cannot be read: {error}") from error
    if not lines or {"recording", "x_cm", "y_cm"} - set(lines[0]):
        got = ", ".join(lines[0]) if lines else "no line"
        raise DataError(f"{path}:1", f"needs the columns recording, x_cm and y_cm, got {got}")
    found: dict[str, dict[int | None, Places]] = {}
    for n, line in enumerate(lines, 2):
        name = Path(line["recording"].strip()).name
        if name not in names:
            raise DataError(
                f"{path}:{n}", f"{name!r} is not among the recordings{did_you_mean(name, names)}"
            )
        try:
            place = (float(line["x_cm"]), float(line["y_cm"]))
            if not np.isfinite(place).all():
                raise ValueError(
                    f"x_cm and y_cm must be numbers, got {place[0]:g} and {place[1]:g}"
                )
            frame = int(line["frame"]) if line.get("frame") else None
        except (TypeError, ValueError) as error:
            raise DataError(f"{path}:{n}", f"is no place: {error}") from error
        of = found.setdefault(name, {})
        of[frame] = (*of.get(frame, ()), place)
    return found
