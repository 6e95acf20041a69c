"""How a pipeline's frames may be divided among workers so that nothing of the answers changes."""

from __future__ import annotations

from typing import NamedTuple

from tactile_graph.engine.outcomes.outcome import NO_VALUE
from tactile_graph.engine.outcomes.outcomes import Outcomes
from tactile_graph.engine.plan import Plan
from tactile_graph.pipeline.graph import Node
from tactile_graph.steps.ranges import Ranges

REMEMBERS = "remembers"
"""The attribute by which a step says how many frames that it ran on it remembers at most."""


class Division(NamedTuple):
    """How frames are divided.

    Attributes
    ----------
    memory : mapping of str to int
        For each node that keeps state, how many frames it remembers that it ran on; in the order
        in which they run. Empty where no node does, or a worker takes a whole recording.
    by_recording : bool
        Whether each recording goes to one worker, and state starts anew with each.
    why_not : str
        Why frames cannot be divided at all; "" if they can.
    """

    memory: dict[str, int]
    by_recording: bool = False
    why_not: str = ""


def division_of(plan: Plan, ranges: Ranges | None) -> Division:
    """Return how the frames of a plan may be divided.

    Parameters
    ----------
    plan : Plan
    ranges : Ranges, optional
        What can read the frames in any order, if anything can.
    """
    nodes = [i.node for i in plan.items if i.node is not None]
    sinks = [n.name for n in nodes if n.is_sink]
    if sinks:
        return Division({}, why_not=f"{sinks[0]} writes something itself")
    keeping = {n.name: _remembered(n) for n in nodes if n.stateful}
    endless = [name for name, n in keeping.items() if n is None]
    if not keeping:
        return Division({})
    if ranges is None:
        name = next(iter(keeping))
        why = f"{name} keeps state from frame to frame, and these frames come in one row only"
        return Division({}, why_not=f"{why} (of recordings: convert them to .zarr)")
    if not endless:
        return Division({name: n for name, n in keeping.items() if n is not None})
    if len(ranges.recordings) > 1:
        return Division({}, by_recording=True)
    return Division({}, why_not=f"{endless[0]} keeps state from frame to frame, of one recording")


def led_to(start: int, division: Division) -> Division:
    """Return how frames from a place on may be divided, if state has seen those before them."""
    if not (start and division.by_recording):
        return division
    return Division({}, why_not=f"steps keep state, and frames before {start} are run first")


def _remembered(node: Node) -> int | None:
    """Return how many frames a node's step says it remembers; None if it does not say."""
    assert node.signature is not None
    if node.signature.rng_at_init:
        return None  # it draws on from frame to frame, whatever it says
    n = getattr(node.signature.target, REMEMBERS, None)
    if not isinstance(n, int):
        n = getattr(node.bound(), REMEMBERS, None)
    return n if isinstance(n, int) and n >= 0 else None


def one_process_only(plan: Plan) -> str:
    """Return why frames of a plan cannot be given to workers in any order; "" if they can."""
    for item in plan.items:
        if item.node is not None and item.node.is_sink:
            return f"{item.name} writes something itself"
        if item.node is not None and item.node.stateful:
            return f"{item.name} keeps state from frame to frame"
    return ""


class Settling:
    """Whether state that began anew has become what it would be had it seen all frames before.

    A step that has answered for as many frames as it remembers is settled, once those are that it
    reads: of a frame for which it raised nobody knows whether it remembers it.

    Parameters
    ----------
    memory : mapping of str to int
        As of `Division`.
    """

    def __init__(self, memory: dict[str, int]) -> None:
        self._left = dict(memory)

    def add(self, result: Outcomes) -> None:
        """Take a frame in."""
        for name, left in self._left.items():
            if left > 0:
                self._left[name] = left - (result.outcome(name).__class__ not in NO_VALUE)
                return  # those behind it may have read what was not settled

    @property
    def done(self) -> bool:
        """Whether all steps are settled."""
        return not any(self._left.values())
