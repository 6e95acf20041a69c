"""Frames of garbage, as pads send them at start-up: found by what comes before and after them."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from itertools import chain, islice
from statistics import median
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tactile_graph.errors import DataError
from tactile_graph.steps import Report
from tactile_graph.wires import Frame, Image
from tactile_graph.wires.frame_stack import FrameStack

NEIGHBOURS = 3
"""How many frames before and as many after a frame it is held against."""
JUMP = 8.0
"""Times the neighbours' own differences that garbage differs from them."""
NEARLY = 1.0 - 1e-6
"""Of that: sums of many frames at once may be rounded otherwise."""
WIDE = 0.25
"""Share of the cells that garbage reaches, and of its peak that counts as reached."""
COHERENT = 0.3
FEWEST_CELLS = 16
Values = NDArray[Any]


def without_garbage(
    frames: Iterator[Frame], report: Report, where: str, begun: _Film | None = None
) -> Iterator[Frame]:
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
    begun : _Film, optional
        What came before, of frames without a label.
    """
    pending: deque[Frame] = deque()
    films: dict[str, _Film] = {} if begun is None else {"": begun}
    failed: list[DataError] = []
    for frame in _until_failed(frames, failed):
        pending.append(frame)
        films.setdefault(frame.label, _Film()).add(frame)
        while len(films[pending[0].label].ahead) > NEIGHBOURS:
            yield from _settled(films[pending[0].label], pending.popleft(), report, where)
    while pending:
        yield from _settled(films[pending[0].label], pending.popleft(), report, where)
    if failed:
        raise failed[0]


def stacks_without_garbage(
    frames: Iterator[Frame | FrameStack], report: Report, where: str
) -> Iterator[Frame | FrameStack]:
    """Yield what `without_garbage` does, as stacks up to the first frame of garbage.

    Parameters
    ----------
    frames : iterator of Frame or FrameStack
        Frames in stacks bear no label, and nobody knows their truth.
    report, where
        As of `without_garbage`.
    """
    failed: list[DataError] = []
    yield from _in_stacks(_until_failed(frames, failed), report, where)
    if failed:
        raise failed[0]


def _in_stacks(
    frames: Iterator[Frame | FrameStack], report: Report, where: str
) -> Iterator[Frame | FrameStack]:
    film = _Film()
    now: FrameStack | None = None
    while True:
        after = next(frames, None)
        if now is not None and not _is_clean(film, now, after):
            rest = chain([now], [] if after is None else [after], frames)
            yield from without_garbage(_flat(rest), report, where, film)
            return
        if now is not None:
            yield now
        if after is None:
            return
        if not isinstance(after, FrameStack):
            yield from without_garbage(_flat(chain([after], frames)), report, where, film)
            return
        now = after


def _until_failed(frames: Iterator[Any], failed: list[DataError]) -> Iterator[Any]:
    """Yield frames until they end or fail, so that those that are held go on before the error."""
    try:
        yield from frames
    except DataError as error:
        failed.append(error)


def _flat(frames: Iterable[Frame | FrameStack]) -> Iterator[Frame]:
    for some in frames:
        yield from some if isinstance(some, FrameStack) else (some,)


def _is_clean(film: _Film, now: FrameStack, after: Frame | FrameStack | None) -> bool:
    """Return whether no frame of a stack is garbage; if so, take it into the film.

    A stack that is short, or followed by anything but another one of its shape, is not looked at.
    """
    following = after.images.values[:NEIGHBOURS] if isinstance(after, FrameStack) else None
    values = now.images.values
    if len(values) <= NEIGHBOURS or (after is not None and following is None):
        return False
    if following is not None and following.shape != (NEIGHBOURS, *values.shape[1:]):
        return False
    around = [f.image.values for f, _ in film.behind]
    if around and around[-1].shape != values.shape[1:]:
        return False
    n_behind, n = len(around), len(values)
    after_it = values[:0] if following is None else following
    with np.errstate(over="ignore"):
        parts = [np.array([*around[-1:], values[0]]), values, np.array([values[-1], *after_it])]
        onward = np.concatenate([_changes(part) for part in parts])
    kept = [change for _, change in film.behind] or [np.inf]
    changes = np.concatenate([kept, onward])
    film_values = [*around, *values, *after_it]
    jumps = _jumps(changes, n_behind, n).tolist()
    for i in _suspects(film_values, jumps):
        near = film_values[max(0, i - NEIGHBOURS) : i + NEIGHBOURS + 1]
        others = [Frame(Image(v)) for k, v in enumerate(near, max(0, i - NEIGHBOURS)) if k != i]
        if is_garbage(Frame(Image(film_values[i])), others):
            return False
    for i in range(n - NEIGHBOURS, n):
        film.behind.append((now[i], float(changes[n_behind + i])))
    film.last = values[-1]
    return True


def _changes(values: Values) -> NDArray[np.float64]:
    """Return by how much each of some frames, shape (n, rows, columns), differs from the last."""
    size = values[0].size
    apart = values[1:] - values[:-1]
    np.abs(apart, out=apart)
    means: NDArray[np.float64] = apart.reshape(len(apart), size).sum(axis=1) / size
    return means


def _jumps(changes: NDArray[np.float64], first: int, n: int) -> NDArray[np.intp]:
    """Return which of ``n`` frames from ``first`` on change more than those around them."""
    edge = np.full(NEIGHBOURS, np.inf)
    padded = np.concatenate([edge, changes, edge])
    at = np.arange(first, first + n) + NEIGHBOURS
    others = np.min([padded[at + k] for k in (-3, -2, -1, 2, 3)], axis=0)
    jumps = np.minimum(padded[at], padded[at + 1]) > 2.0 * others
    return np.asarray(at[jumps] - NEIGHBOURS)


def _suspects(film_values: Sequence[Values], jumps: Sequence[int]) -> list[int]:
    """Return which of the frames that jump may be garbage: some have not all neighbours, others
    are not nearly as far from the usual as garbage is."""
    whole = [i for i in jumps if NEIGHBOURS <= i < len(film_values) - NEIGHBOURS]
    if not whole:
        return [*jumps]
    places = [k for k in range(-NEIGHBOURS, NEIGHBOURS + 1) if k]
    size = film_values[0].size
    near = np.array([film_values[i + k] for i in whole for k in places])
    near = near.reshape(len(whole), len(places), size)
    usual = np.median(near, axis=1, keepdims=True)
    apart = np.median(np.abs(near - usual).sum(axis=2), axis=1)
    own = np.array([film_values[i] for i in whole]).reshape(len(whole), size)
    far = np.abs(own - usual[:, 0]).sum(axis=1) > NEARLY * JUMP * apart
    cleared = {i for i, is_far in zip(whole, far.tolist(), strict=True) if not is_far}
    return [i for i in jumps if i not in cleared]


@dataclass(slots=True)
class _Film:
    """One sensor's frames around the one that is judged, each with its change from the last."""

    ahead: deque[tuple[Frame, float]] = field(default_factory=deque)
    behind: deque[tuple[Frame, float]] = field(default_factory=lambda: deque(maxlen=NEIGHBOURS))
    last: NDArray[Any] | None = None
    after_garbage: bool = False

    def add(self, frame: Frame) -> None:
        values = frame.image.values
        alike = self.last is not None and self.last.shape == values.shape
        change = _distance(values, self.last) if alike and self.last is not None else np.inf
        self.ahead.append((frame, change))
        self.last = values


def _settled(film: _Film, frame: Frame, report: Report, where: str) -> Iterator[Frame]:
    """Yield the frame, the first of those ahead, unless it is garbage."""
    _, change = film.ahead.popleft()
    around = [*film.behind, *film.ahead]
    following = film.ahead[0][1] if film.ahead else np.inf
    others = [*film.behind, *islice(film.ahead, 1, None)]
    # Nearly all frames change about as much as the others do, and need not be looked at further.
    jumps = min(change, following) > 2.0 * min((c for _, c in others), default=np.inf)
    if jumps and frame.truth is None and is_garbage(frame, [f for f, _ in around]):
        report.count("frames of garbage left out")
        report.trouble(
            f"{where}: frame {frame.index}",
            "is garbage by those around it (no patch of it lies together, "
            "and none of them is like it) and is left out",
        )
        film.after_garbage = True
        return
    film.behind.append((frame, change))
    yield replace(frame, gap=True) if film.after_garbage else frame
    film.after_garbage = False


def is_garbage(frame: Frame, around: Sequence[Frame]) -> bool:
    """Return whether a frame is garbage by those around it; with fewer than three never."""
    values = frame.image.values
    others = [f.image.values for f in around if f.image.values.shape == values.shape]
    if len(others) < NEIGHBOURS or values.size < FEWEST_CELLS:
        return False
    nearest = min(_distance(values, v) for v in (others[0], others[-1]))
    if not 0.0 < nearest < 1e100:
        return False
    usual = _middle(np.array(others))
    apart = median(_distance(v, usual) for v in others)
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


def _middle(values: Values) -> Values:
    """Return the median of a few frames, cell by cell, as `np.median` does in twice the time."""
    n = len(values)
    both: Values = np.sort(values, axis=0)[(n - 1) // 2 : n // 2 + 1]
    return np.asarray(both.mean(axis=0))


def _distance(a: Values, b: Values) -> float:
    with np.errstate(over="ignore"):
        return float(np.abs(a - b).sum()) / a.size
