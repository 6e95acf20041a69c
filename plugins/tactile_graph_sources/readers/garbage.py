"""Frames of garbage, as pads send them at start-up: found by what comes before and after them."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tactile_graph.steps import Report
from tactile_graph.wires import Frame

NEIGHBOURS = 3
"""How many frames before and as many after a frame it is held against."""
JUMP = 8.0
"""Times the neighbours' own differences that garbage differs from them."""
WIDE = 0.25
"""Share of the cells that garbage reaches, and of its peak that counts as reached."""
COHERENT = 0.3
FEWEST_CELLS = 16
Values = NDArray[Any]


def without_garbage(frames: Iterator[Frame], report: Report, where: str) -> Iterator[Frame]:
    """Yield the frames but for those of garbage, which are counted and told.

    A frame is garbage if it differs from those around it many times as much as they do among
    themselves, over much of the pad, without neighbouring cells having anything in common; or if
    every cell of it is the same and of none of those around it. What presses on a pad
    lies in patches, stays for more than one frame, or both. Frames whose truth is known are left
    alone: they are no film. The frame after garbage is marked as following a gap.

    Parameters
    ----------
    frames : iterator of Frame
        Those of several sensors, told apart by their labels, may take turns.
    report : Report
    where : str
        The file, for the report.
    """
    pending: deque[Frame] = deque()
    ahead: dict[str, deque[Frame]] = {}
    behind: dict[str, deque[Frame]] = {}
    dropped: set[str] = set()

    def settled(frame: Frame) -> Iterator[Frame]:
        ahead[frame.label].popleft()
        before = behind.setdefault(frame.label, deque(maxlen=NEIGHBOURS))
        around = [*before, *list(ahead[frame.label])[:NEIGHBOURS]]
        if frame.truth is None and is_garbage(frame, around):
            report.count("frames of garbage left out")
            report.trouble(
                f"{where}: frame {frame.index}",
                "is garbage by those around it (no patch of it lies together, "
                "and none of them is like it) and is left out",
            )
            dropped.add(frame.label)
            return
        before.append(frame)
        yield replace(frame, gap=True) if frame.label in dropped else frame
        dropped.discard(frame.label)

    for frame in frames:
        pending.append(frame)
        ahead.setdefault(frame.label, deque()).append(frame)
        while len(ahead[pending[0].label]) > NEIGHBOURS:
            yield from settled(pending.popleft())
    while pending:
        yield from settled(pending.popleft())


def is_garbage(frame: Frame, around: Sequence[Frame]) -> bool:
    """Return whether a frame is garbage by those around it; with fewer than three never."""
    values = frame.image.values
    others = [f.image.values for f in around if f.image.values.shape == values.shape]
    if len(others) < NEIGHBOURS or values.size < FEWEST_CELLS:
        return False
    with np.errstate(over="ignore"):
        nearest = min(_distance(values, v) for v in (others[0], others[-1]))
        others_own = min(_distance(*others[:2]), _distance(*others[-2:]))
    if nearest <= 2.0 * others_own or not 0.0 < nearest < 1e100:
        return False  # so it is with all but a few frames, which need not be looked at further
    usual = np.median(others, axis=0)
    apart = np.median([_distance(v, usual) for v in others])
    change = values - usual
    if _distance(values, usual) <= JUMP * apart:
        return False
    if np.ptp(values) == 0.0 and values.flat[0] != 0.0:
        return not any(np.ptp(v) == 0.0 for v in others)
    reached = np.abs(change) > WIDE * np.abs(change).max()
    return bool(reached.mean() >= WIDE) and coherence(change) < COHERENT


def coherence(values: Values) -> float:
    """Return how much neighbouring cells have in common: 1 in broad patches, 0 at random."""
    spread = float(values.var())
    if spread == 0.0:
        return 1.0
    steps = [np.diff(values, axis=axis).ravel() for axis in (0, 1)]
    along = np.concatenate(steps)
    return 1.0 - float((along**2).mean()) / (2.0 * spread) if len(along) else 1.0


def _distance(a: Values, b: Values) -> float:
    return float(np.abs(a - b).mean())
