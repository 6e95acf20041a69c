"""Which frame the viewers look at: the newest, one held still, or one of the last minute."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Coroutine
from typing import Any

from tactile_graph_live.bench import wire
from tactile_graph_live.server.lookback import Lookback
from tactile_graph_live.server.unawaited import unawaited
from tactile_graph_live.server.viewers import Picture, Viewer, Viewers

Later = Callable[[Coroutine[Any, Any, None]], None]


class Gaze:
    """Shows the viewers what they look at; the bench goes on meanwhile.

    A device is not held up by anybody who looks closer: its frames go on through the bench. What is
    played is held as well.

    Parameters
    ----------
    send : callable
        Tells the bench.
    viewers : Viewers
    lookback : callable
        Returns what runs a frame again.
    later : callable
        Runs a coroutine beside.
    holds : bool
        Whether the source waits while nobody looks at the newest.
    """

    def __init__(
        self,
        send: Callable[[wire.ToBench], None],
        viewers: Viewers,
        lookback: Callable[[], Lookback],
        later: Later,
        holds: bool,
    ) -> None:
        self._send, self._viewers, self._lookback = send, viewers, lookback
        self._later, self._holds = later, holds
        self._ticket = 0
        self._after: int | None = None
        self._stepping = False
        self._newest: Picture | None = None
        self._early: Picture | None = None
        self._lock = asyncio.Lock()
        self.paused = False
        self._holders: set[Viewer] = set()
        self.shown: Picture | None = None
        self._lost: Picture | None = None

    def came(self, picture: Picture) -> None:
        """Take a frame that ran just now; it is shown if the newest is looked at.

        One of a graph that the viewers were not told of yet waits for `told`.
        """
        if picture.frame.version > self._lookback().version:
            self._early = picture
            return
        self._newest, self._early = picture, None
        if not self.paused or self._stepping:
            self._stepping = False
            self._show(picture)

    def told(self) -> None:
        """Go on with the graph that the viewers were just told of."""
        if self._early is not None:
            self.came(self._early)
        self.again()

    def pause(self) -> None:
        """Keep looking at this frame."""
        self.paused = True
        if self._holds:
            self._send(wire.Hold(True))

    def live(self) -> None:
        """Look at the newest again."""
        self.paused, self._stepping = False, False
        self._holders.clear()
        self._ticket += 1
        if self._holds:
            self._send(wire.Hold(False))
        if self._newest is not None:
            self._show(self._newest.shown_again())

    def held_by(self, viewer: Viewer) -> None:
        """Note who holds the picture still, if it is: it goes on once all of them have left."""
        if self.paused:
            self._holders.add(viewer)

    def left(self, viewer: Viewer) -> bool:
        """Go on if nobody who is still there holds the picture; return whether it did."""
        if self._holders != {viewer}:
            self._holders.discard(viewer)
            return False
        self.live()
        return True

    def step(self) -> None:
        """Look at the frame behind this one; what is held plays one more where there is none."""
        self.pause()
        if self.shown is not None and self.shown is not self._lost:
            self._fetch(self.shown.frame.index, 0.0)
        else:
            self._one_more()

    def scrub(self, back_s: float) -> None:
        """Look at the frame that came so long ago."""
        self.pause()
        self._fetch(None, back_s)

    def again(self) -> None:
        """Run the frame again that is looked at, if it is held still: something else changed."""
        if self.paused and self.shown is not None and self.shown is not self._lost:
            self._fetch(self.shown.frame.index - 1, 0.0)

    @property
    def held(self) -> bool:
        """Whether the source waits."""
        return self.paused and self._holds

    def bench_died(self) -> None:
        """Go on with another bench, which has none of the frames so far and counts from 0."""
        self._ticket += 1
        self._newest = self._early = None
        self._lost = self.shown

    def found(self, kept: wire.Kept) -> None:
        """Take frames that were kept."""
        if kept.ticket != self._ticket or not kept.frames:
            return
        if self._after is not None and kept.frames[-1].index <= self._after:
            if self._holds:  # nothing newer is there: have it come
                self._one_more()
            return
        self._later(self._look(kept))

    def _one_more(self) -> None:
        """Show the next frame that comes; of what is held, have one come."""
        self._stepping = True
        if self._holds:
            self._send(wire.OneMore())

    def _fetch(self, after: int | None, back_s: float) -> None:
        self._ticket += 1
        self._after = after
        self._send(wire.Fetch(self._ticket, after, back_s, self._lookback().lead))

    async def _look(self, kept: wire.Kept) -> None:
        async with self._lock:
            if kept.ticket != self._ticket:
                return
            pad = self._newest.frame.pad if self._newest is not None else None
            look, shown = self._lookback(), self._viewers.shown
            frame = await unawaited(look.frame, kept, shown, pad)
            if kept.ticket == self._ticket:
                self._show(Picture(frame))

    def _show(self, picture: Picture) -> None:
        self.shown = picture
        self._viewers.show(picture)
