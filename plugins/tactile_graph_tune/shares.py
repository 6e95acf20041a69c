"""What share of the frames to come is of which kind, where those to choose by are mixed otherwise.

A kind of frame that is rare decides little of what is chosen, and is known by a few. Record as many
of it as of the others, and say how rare it is: each frame then counts for as many as it stands for.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from fnmatch import fnmatchcase
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from tactile_graph.errors import UsageError, did_you_mean
from tactile_graph.wires.frame import Frame
from tactile_graph_tune.table.kinds import Reals

EMPTY = "empty"
"""The kind of a frame where nothing lies, whatever its label."""
SIDES = ("choose", "report")
SLACK = 1e-9


class Share(NamedTuple):
    """How many of the frames to come are of a kind.

    Parameters
    ----------
    kind : str
        `EMPTY`, or a label; ``*`` stands for anything.
    share : float
        From 0 to 1.
    """

    kind: str
    share: float

    def names(self, frame: Frame) -> bool:
        """Return whether a frame is of the kind."""
        if self.kind == EMPTY:
            return frame.truth == ()
        return fnmatchcase(frame.label, self.kind)

    def __str__(self) -> str:
        return f"{self.kind} {100 * self.share:.3g} %"


def parse_share(text: str) -> Share:
    """Return what ``KIND=SHARE`` spells.

    Raises
    ------
    UsageError
        If it spells none.
    """
    kind, _, given = (part.strip() for part in text.rpartition("="))
    try:
        share = float(given)
    except ValueError:
        share = math.nan
    if not kind or not 0.0 < share <= 1.0:
        raise UsageError(
            f"--share {text}: must be empty=SHARE or LABEL=SHARE, SHARE above 0, at most 1"
        )
    return Share(kind, share)


def weights_of(
    frames: Sequence[Frame],
    shares: Sequence[Share],
    sides: tuple[NDArray[np.int64], NDArray[np.int64]],
) -> Reals:
    """Return for how many each frame counts, shape (n_frames,), 1 in the mean of either side.

    A frame is of the first kind that names it. Those of none have what the shares leave.

    Parameters
    ----------
    frames : sequence of Frame
    shares : sequence of Share
    sides : tuple of ndarray of int64
        The rows that choose, and those that report; the shares hold on either side.

    Raises
    ------
    UsageError
        If a side has no frame of a kind, or shares leave nothing for frames of none of the kinds,
        or too much.
    """
    weights = np.ones(len(frames))
    if not shares:
        return weights
    kinds = np.array([_kind_of(f, shares) for f in frames])
    left = 1.0 - sum(s.share for s in shares)
    wanted = [*(s.share for s in shares), left]
    _check(frames, shares, kinds, left)
    for side, rows in enumerate(sides):
        counts = np.bincount(kinds[rows], minlength=len(wanted))
        for share, n in zip(shares, counts, strict=False):
            if not n:
                raise UsageError(
                    f"--share {share.kind}={share.share:g}: there are such frames, but none among "
                    f"the {len(rows)} that {SIDES[side]}: record more, in several stretches"
                )
        each = len(rows) * np.array(wanted) / np.maximum(counts, 1)
        weights[rows] = each[kinds[rows]]
    return weights


def _kind_of(frame: Frame, shares: Sequence[Share]) -> int:
    return next((k for k, share in enumerate(shares) if share.names(frame)), len(shares))


def _check(
    frames: Sequence[Frame], shares: Sequence[Share], kinds: NDArray[np.int64], left: float
) -> None:
    for k, share in enumerate(shares):
        if not (kinds == k).any():
            labels = {f.label for f in frames if f.label}
            hint = did_you_mean(share.kind, labels)
            raise UsageError(f"--share {share.kind}={share.share:g}: no frame is of it{hint}")
    told = ", ".join(map(str, shares))
    n = int((kinds == len(shares)).sum())
    if left < -SLACK:
        raise UsageError(f"--share: {told} come to {100 * (1.0 - left):.3g} %, more than all")
    if n and left <= SLACK:
        raise UsageError(f"--share: {told} are all, but {n} frames are of none of these kinds")
    if not n and left > SLACK:
        raise UsageError(
            f"--share: {told} leave {100 * left:.3g} %, but every frame is of one of these kinds"
        )
