"""``LiveResult``: the result of a frame that was answered as it came, with its times."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Generic, TypeVar

from tactile_graph.engine.outcomes.outcomes import Outcomes

ResultT = TypeVar("ResultT", bound=Outcomes)


@dataclass(frozen=True, slots=True)
class LiveResult(Generic[ResultT]):
    """What a frame came to, and when.

    Attributes
    ----------
    result : Result
    arrived_ns, begun_ns, done_ns : int
        When the source gave the frame, when its first step began, and when its last had ended, by
        the run's clock (`time.perf_counter_ns` unless told otherwise).
    shed : int
        How many frames have been shed since the run began: they had waited longest when too many
        waited.
    lost : int
        How many times the source has said that frames were lost just before one it gave
        (``Frame.gap``).
    decisions : tuple of str
        The nodes that were skipped to keep the deadline, in the order of the plan.
    """

    result: ResultT
    arrived_ns: int
    begun_ns: int
    done_ns: int
    shed: int = 0
    lost: int = 0
    decisions: tuple[str, ...] = ()

    @property
    def latency_us(self) -> float:
        """Microseconds from the frame's arrival to its result."""
        return (self.done_ns - self.arrived_ns) / 1e3
