"""What a worker does for a session: it notes frames, and what it noted is joined in order."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from contextlib import suppress
from typing import NamedTuple

from tactile_graph.many import Portion, Reader, Reading, for_the_way
from tactile_graph.steps.ranges import Irregular
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
    reading: Reading | None = None


class SessionWorker:
    """Notes portions of frames in a worker.

    Parameters
    ----------
    given : Given
    """

    def __init__(self, given: Given) -> None:
        self._session = Session(given.prepared, given.seed, reference=given.reference)
        self._noting = Noting(self._session, given.reading)

    def __call__(self, portion: Portion) -> tuple[Part, Exception | None]:
        """Return what was noted of a portion's frames, and the error that ended them if one did."""
        error = self._noting(portion, self._session.add)
        return self._session.part(), error


class Noting:
    """Notes portions of frames, which were sent or are read here.

    Parameters
    ----------
    session : Session
    reading : Reading, optional
        How frames are read here whose state hangs on those before them.
    """

    def __init__(self, session: Session, reading: Reading | None) -> None:
        self._session = session
        self._start = 0 if reading is None else reading.start
        self._reader = None if reading is None else reading.reader()
        self._warm = False

    def __call__(self, portion: Portion, note: Callable[[Frame], object]) -> Exception | None:
        """Note a portion's frames; return the error that ended them if one did.

        Parameters
        ----------
        portion : Portion
        note : callable
            Adds a frame to the session, which begins to note anew.

        Raises
        ------
        Irregular
            If they cannot be read without all before them.
        """
        session = self._session
        frames = self._sent(portion) if self._reader is None else self._read(self._reader, portion)
        session.begin(portion.low - self._start)
        try:
            for frame in frames:
                note(frame)
        except Irregular:
            raise
        except Exception as raised:  # what was noted before is kept
            return for_the_way(raised)
        return None

    def _sent(self, portion: Portion) -> Iterable[Frame]:
        before, frames = portion.frames()
        if not self._warm:
            self._session.warm_up(frames)
            self._warm = True
        with suppress(Exception):  # told where that frame is noted
            for frame in before:
                self._session.pass_over(frame)
        return frames

    def _read(self, reader: Reader, portion: Portion) -> Iterable[Frame]:
        frames: Iterable[Frame] = reader.frames(portion)
        if not self._warm:
            frames = self._session.warmed(iter(frames))
            self._warm = True
        reader.settled(portion, self._session.without_state)
        return frames
