"""What a worker does for a session: it notes frames, and what it noted is joined in order."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import suppress
from typing import NamedTuple

from tactile_graph.many import Portion, for_the_way
from tactile_graph.wires.frame import Frame
from tactile_graph_compare.run.session import Part, Session
from tactile_graph_compare.variants.prepare import PreparedVariant

N_BEFORE = 1
"""Frames that come along ahead of a portion's: its first may be equal to the one before."""


class Given(NamedTuple):
    """What a worker makes its session of."""

    prepared: Sequence[PreparedVariant]
    seed: int
    reference: str


class SessionWorker:
    """Notes portions of frames in a worker.

    Parameters
    ----------
    given : Given
    """

    def __init__(self, given: Given) -> None:
        self._session = Session(given.prepared, given.seed, reference=given.reference)
        self._warm = False

    def __call__(self, portion: Portion) -> tuple[Part, Exception | None]:
        """Return what was noted of a portion's frames, and the error that ended them if one did."""
        error = noted(self._session, portion, self._session.add, self._warm)
        self._warm = True
        return self._session.part(), error


def noted(
    session: Session, portion: Portion, note: Callable[[Frame], object], warm: bool
) -> Exception | None:
    """Note a portion's frames; return the error that ended them if one did.

    Parameters
    ----------
    session : Session
        Begins to note anew.
    portion : Portion
    note : callable
        Adds a frame to the session.
    warm : bool
        Whether the session ran frames before.
    """
    before, frames = portion.frames()
    if not warm:
        session.warm_up(frames)
    session.begin(portion.low)
    with suppress(Exception):  # told where that frame is noted
        for frame in before:
            session.pass_over(frame)
    try:
        for frame in frames:
            note(frame)
    except Exception as raised:  # what was noted before is kept
        return for_the_way(raised)
    return None
