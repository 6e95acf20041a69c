"""Frames as people hand them in: frames, images, bare arrays; and what else is no frame."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping
from typing import Any

from tactile_graph.errors import FrameError, UsageError, one_of, shown
from tactile_graph.wires.checked import checked_image
from tactile_graph.wires.frame import Frame
from tactile_graph.wires.image import Image

WITH_SOURCE = "with_source('recording', path={path!r})"


def as_frame(given: Any, index: int | None = None) -> Frame:
    """Return a frame as it is, or one around an image or a bare array.

    Parameters
    ----------
    given : Frame, Image or array, shape (rows, columns)
        A bare array becomes a frame of pitch 1 cm and quantity ``raw``.
    index : int, optional
        Number of a frame that is made here, and by which errors name it.

    Raises
    ------
    UsageError
        If it is a path or text, or several frames.
    FrameError
        Where `Frame.of` raises a ValueError.
    """
    if isinstance(given, Frame):
        return given
    if isinstance(given, str | bytes | os.PathLike):
        raise UsageError(f"a frame is needed, got {_told(given, WITH_SOURCE)}")
    if isinstance(given, list | tuple) and any(isinstance(one, Frame | Image) for one in given):
        kind = type(given).__name__
        raise UsageError(f"a frame is needed, got a {kind} of {len(given)}; stream() takes several")
    try:
        if isinstance(given, Image):
            return Frame(checked_image(given), index or 0)
        return Frame.of(given, index=index or 0)
    except ValueError as error:
        where = "" if index is None else f"frame {index}: "
        raise FrameError(f"{where}{error}") from None


def as_frames(given: Any, reading: str = WITH_SOURCE) -> Iterator[Frame]:
    """Return what is handed in as frames, each as of `as_frame`; arrays are numbered as they come.

    Parameters
    ----------
    given : iterable of Frame, Image or array
        Looked at at once; its frames are taken when they are wanted.
    reading : str
        What reads the file ``{path!r}`` instead.

    Raises
    ------
    UsageError
        If it is one frame, a path, or nothing that has frames one after the other.
    """
    check_frames(given, reading)
    try:
        frames = iter(given)
    except TypeError:
        raise UsageError(f"frames are needed, got {type(given).__name__}") from None
    return (as_frame(frame, index) for index, frame in enumerate(frames))


def check_frames(given: Any, reading: str = WITH_SOURCE) -> None:
    """Refuse what has no frames one after the other; parameters and errors as of `as_frames`."""
    kind = type(given).__name__
    if isinstance(given, str | bytes | os.PathLike):
        raise UsageError(f"frames are needed, got {_told(given, reading)}")
    if isinstance(given, Mapping):
        names = f"; it has: {one_of([str(name) for name in given])}" if given else ""
        raise UsageError(f"frames are needed, got a {kind}: give one of its values{names}")
    if isinstance(given, Frame | Image) or getattr(given, "ndim", None) == 2:
        raise UsageError(f"frames are needed, got one {kind}: a list of it is a stream of one")
    if not (hasattr(given, "__iter__") or hasattr(given, "__getitem__")):
        raise UsageError(f"frames are needed, got {kind}")


def _told(path: str | bytes | os.PathLike[Any], reading: str) -> str:
    """Return what a path or text is, and what reads files."""
    text = os.fsdecode(path)
    return f"a path or text, {shown(text)}; {reading.format(path=text)} reads a recording"
