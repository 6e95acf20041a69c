"""``Reading``: how workers read frames themselves, and come by the state of those before."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from typing import Any, NamedTuple, TypeVar

from tactile_graph.engine.outcomes.outcomes import Outcomes
from tactile_graph.many.division import Division, Settling
from tactile_graph.many.feed import absolute
from tactile_graph.many.portion import Portion
from tactile_graph.pipeline.graph import Source
from tactile_graph.plugins.registry import installed
from tactile_graph.steps.ranges import Ranges
from tactile_graph.wires.frame import Frame
from tactile_graph.wires.frame_stack import FrameStack

FARTHER = 4
"""Times that is gone back when state was not settled by as many frames as it remembers."""
Run = TypeVar("Run", bound=Callable[[Frame], Outcomes])


class Reading(NamedTuple):
    """What a worker reads frames by; it can be pickled.

    Attributes
    ----------
    step : str
        The source.
    settings : dict
        Of it, with paths that hold in any folder.
    memory : dict of str to int
        As of `Division`.
    start : int
        Place in the source of the first frame of all.
    """

    step: str
    settings: dict[str, Any]
    memory: dict[str, int]
    start: int = 0

    @classmethod
    def of(cls, source: Source, division: Division, start: int = 0) -> Reading:
        """Return how the frames of a source are read that offers `Ranges`."""
        settings = absolute(source.signature.arguments(source.settings))
        return cls(source.name, settings, division.memory, start)

    def reader(self) -> Reader:
        """Return what reads them."""
        target: Any = installed().step(self.step).target
        return Reader(target.ranges(**self.settings), self.memory)


class Reader:
    """Frames of portions, read or taken from what was sent.

    Parameters
    ----------
    ranges : Ranges, optional
        None where all frames are sent.
    memory : dict of str to int
        As of `Division`.
    """

    def __init__(self, ranges: Ranges | None, memory: dict[str, int]) -> None:
        self._ranges = ranges
        self._memory = memory

    def frames(self, portion: Portion) -> Iterator[Frame]:
        """Yield a portion's frames that are not left out.

        Raises
        ------
        Irregular
            If they cannot be read without all before them.
        """
        if portion.sent is not None:
            yield from portion.frames()[1]
            return
        assert self._ranges is not None  # or they would have been sent
        frames = self._ranges.read(portion.low, portion.high)
        for place, frame in enumerate(frames, portion.low):
            if place not in portion.without:
                yield frame

    def stacks(self, portion: Portion) -> Iterable[Frame | FrameStack] | None:
        """Return a portion's frames in stacks where they are to be had so, and are all wanted."""
        if portion.sent is not None:
            return portion.given()
        read = None if self._ranges is None else self._ranges.read_in_stacks
        wanted = portion.without.isdisjoint(range(portion.low, portion.high))
        return read(portion.low, portion.high) if read is not None and wanted else None

    def settled(self, portion: Portion, make: Callable[[], Run]) -> Run:
        """Return what ``make`` returns with the state of one that ran all frames before a portion.

        Parameters
        ----------
        portion : Portion
        make : callable
            Returns a runner without any state, each time it is called.
        """
        memory = self._memory
        back = sum(memory.values())
        while True:
            low = max(portion.start, portion.low - back)
            run, settling = make(), Settling(memory)
            before = Portion(low, portion.low, without=portion.without)
            for frame in self.frames(before) if memory else ():
                settling.add(run(frame))
            if settling.done or low == portion.start or not memory:
                return run
            back *= FARTHER
