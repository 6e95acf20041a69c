"""What the engine hands to a step that asks for it by annotation.

A keyword-only parameter annotated ``np.random.Generator`` receives a generator seeded for the
run, the step and the frame; one annotated `Report` receives the run's report (sources only);
one annotated `TimeGap` (``__call__`` of a stateful step only) receives the true time since the
step last ran on a frame of the same label.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator
from typing import Annotated


class _Gap:
    """Marks a parameter that takes the seconds since the step last ran."""


TimeGap = Annotated[float | None, _Gap()]
"""Seconds since the step last ran; None at its first frame, and where no times say. For a frame
without a time of its own it is what the frames before lie apart; that of the next one with a time
makes up for it."""


def is_time_gap(metadata: tuple[object, ...]) -> bool:
    """Return whether an annotation's metadata marks a `TimeGap`."""
    return any(isinstance(m, _Gap) for m in metadata)


MOST_TOLD = 5
"""Troubles that people are told word for word; of the others they are told how many there are."""


class Report:
    """What a source has to say beside its frames: counters, troubles by place, frames to expect.

    Parameters
    ----------
    listener : callable, optional
        Called with ``(where, what)`` at each trouble, as it happens.
    keep : int
        How many troubles are kept word for word; all are counted.

    Attributes
    ----------
    counts, troubles, assumed
        What `count`, `trouble` and `assume` were told, in order.
    n_places : int or None
        How many frames the recordings hold, those that were left out too (`Frame.place`); None
        until they are read to their end.
    wanted : bool
        Whether more frames are taken: false once nobody waits for the source any more. One that
        waits for a device looks here now and then, and ends, after what it has read by then.
    awaited : bool
        Whether a device that is not there at first is waited for, as one that went away is.
    n_waiting : int or None
        How many frames have come and wait to be taken, of a source that reads on meanwhile; None
        of others.
    """

    def __init__(
        self, listener: Callable[[str, str], None] | None = None, keep: int = 1000
    ) -> None:
        self.counts: Counter[str] = Counter()
        self.troubles: list[tuple[str, str]] = []
        self.assumed: dict[str, None] = {}
        self.n_expected: int | None = None
        self.n_places: int | None = None
        self.digests: dict[str, str] = {}
        self.wanted = True
        self.awaited = False
        self.n_waiting: int | None = None
        self._listener = listener
        self._keep = keep

    def count(self, what: str, n: int = 1) -> None:
        """Add ``n`` to the counter ``what``."""
        self.counts[what] += n

    def assume(self, what: str) -> None:
        """Count ``what``, which nobody said and is taken to be so: people are warned of it."""
        self.count(what)
        self.assumed[what] = None

    def trouble(self, where: str, what: str) -> None:
        """Note that ``what`` was wrong at ``where`` (file and line, or port) and was left out."""
        self.counts["troubles"] += 1
        if len(self.troubles) < self._keep:
            self.troubles.append((where, what))
        if self._listener is not None:
            self._listener(where, what)

    def few_troubles(self) -> Iterator[str]:
        """Yield the first troubles as lines for people, and how many more there are."""
        yield from (f"{where}: {what}" for where, what in self.troubles[:MOST_TOLD])
        if (n := self.counts["troubles"]) > MOST_TOLD:
            yield f"… and {n - MOST_TOLD} more"

    def expect(self, n_frames: int) -> None:
        """Say how many more frames are coming, for progress bars."""
        self.n_expected = (self.n_expected or 0) + n_frames

    def digest(self, source: str, sha256: str) -> None:
        """Note the SHA-256 of a file the frames come from, for the record of how it was made."""
        self.digests[source] = sha256
