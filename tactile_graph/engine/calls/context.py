"""``Context``: what the calls of one run share while a frame is under way."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from tactile_graph.engine.calls.isolated import Host
from tactile_graph.engine.outcomes.outcome import Failed
from tactile_graph.engine.outcomes.outcomes import Outcomes
from tactile_graph.pipeline.graph import Graph
from tactile_graph.wires.frame import Frame

RunInner = Callable[[Frame, tuple[int, ...]], Outcomes]
"""Runs an embedded pipeline on the frame of one item; where the item stands seeds its numbers."""


class Context:
    """What the calls of one context share: the frame that is under way, and what items came to.

    Parameters
    ----------
    seed : int
        Seed of the steps that take randomness.
    embedded : callable
        Gives what runs an embedded pipeline, and the processes of its nodes that run apart.
    """

    __slots__ = (
        "apart", "embedded", "frame", "hosts", "inner_results", "item", "item_failures", "labels",
        "seed",
    )  # fmt: skip

    def __init__(
        self, seed: int, embedded: Callable[[Graph], tuple[RunInner, Mapping[str, Host]]]
    ) -> None:
        self.seed = seed
        self.embedded = embedded
        self.frame: Frame
        self.item: tuple[int, ...] = ()
        self.inner_results: dict[str, list[Outcomes | None]] = {}
        self.item_failures: list[Failed] = []
        self.labels: set[str] = set()
        """Of the frames that steps have kept state of."""
        self.hosts: dict[str, Host] = {}
        """Processes that nodes of the runner which is being made share."""
        self.apart: dict[str, Host] = {}
        """Node -> its process, of the nodes of that runner which run apart."""

    def drop_items(self) -> None:
        """Forget what items came to of a frame that is broken off: the next one has its own."""
        self.inner_results, self.item_failures = {}, []
