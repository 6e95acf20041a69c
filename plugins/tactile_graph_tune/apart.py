"""What reports is not what was chosen by: recordings given twice, frames found on both sides."""

from __future__ import annotations

import hashlib
import os
from collections.abc import Sequence
from itertools import combinations
from pathlib import Path

from tactile_graph.errors import UsageError
from tactile_graph.files import sha256_of
from tactile_graph.wires.frame import Frame

WAY_OUT = (
    "name a recording of other frames, or leave --held-out away: half of the frames then report"
)


def check_recordings(choosing: Sequence[str], held_out: Sequence[str]) -> None:
    """Refuse a file that would be chosen by and reported on, by its name or by a copy of it.

    Parameters
    ----------
    choosing : sequence of str
        Recordings to choose by; halved by recording where none is held out.
    held_out : sequence of str

    Raises
    ------
    UsageError
    """
    for other in held_out:
        for one in choosing:
            if same := _same(one, other):
                raise UsageError(
                    f"--held-out {other}: {same} {one}, which is chosen by; it must hold frames "
                    f"that are not: {WAY_OUT}"
                )
    for one, other in combinations(held_out, 2):
        if same := _same(one, other):
            raise UsageError(f"--held-out {other}: {same} {one}; hold each recording out once")
    if held_out:
        return
    for one, other in combinations(choosing, 2):
        if same := _same(one, other):
            raise UsageError(
                f"{other}: {same} {one}; of several recordings some choose and the others report, "
                "so give each once"
            )


def _same(one: str, other: str) -> str:
    """Return how a file is another one's frames again, in words; empty if it is not."""
    try:
        if os.path.samefile(one, other):
            return "is the same file as"
        files = Path(one).is_file() and Path(other).is_file()
        alike = files and os.path.getsize(one) == os.path.getsize(other)
        return "has the same content as" if alike and sha256_of(one) == sha256_of(other) else ""
    except OSError:
        return ""  # whoever reads it says why it cannot be read


def without_seen(choosing: Sequence[Frame], held_out: Sequence[Frame]) -> list[Frame]:
    """Return the frames held out less those that choose, too, as in a converted copy.

    Frames where nothing lies may well be alike in two recordings, and stay.

    Parameters
    ----------
    choosing, held_out : sequence of Frame
        With their truth.

    Raises
    ------
    UsageError
        If none in which something lies is left.
    """
    seen = {_values_of(f) for f in choosing if f.truth}
    left = [f for f in held_out if not f.truth or _values_of(f) not in seen]
    n = sum(bool(f.truth) for f in held_out)
    if n and not any(f.truth for f in left):
        raise UsageError(
            f"--held-out: all {n} frames in which something lies have, value by value, the images "
            f"of frames that are chosen by: {WAY_OUT}"
        )
    return left


def without_repeats(frames: Sequence[Frame]) -> list[Frame]:
    """Return frames less those whose image an earlier recording holds, too, as in a converted copy.

    Frames where nothing lies, or where what lies leaves all cells alike, may well be alike in two
    recordings, and stay.

    Parameters
    ----------
    frames : sequence of Frame
        Of one or more recordings, with their truth.

    Raises
    ------
    UsageError
        If a recording has none in which something is seen to lie but such.
    """
    images = [(f, _values_of(f) if _is_seen(f) else None) for f in frames]
    first: dict[object, str] = {}
    for frame, values in images:
        first.setdefault(values, frame.label)
    left = [(f, values) for f, values in images if values is None or first[values] == f.label]
    alone = {f.label for f, values in left if values is not None}
    for frame, values in images:
        if values is not None and frame.label not in alone:
            n = sum(f.label == frame.label and its is not None for f, its in images)
            raise UsageError(
                f"{frame.label}: all {n} frames in which something lies have, value by value, the "
                f"images of frames of {first[values]}; of several recordings some choose and the "
                "others report, so give each once"
            )
    return [f for f, _ in left]


def _is_seen(frame: Frame) -> bool:
    """Return whether something lies there, and the image tells of it."""
    values = frame.image.values
    return bool(frame.truth) and bool((values != values.flat[0]).any())


def _values_of(frame: Frame) -> tuple[tuple[int, ...], bytes]:
    values = frame.image.values
    return values.shape, hashlib.blake2b(values.tobytes(), digest_size=16).digest()
