"""Records of the merged graph: whose each node is, and what it cost."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from tactile_graph import Pipeline
from tactile_graph.inspect import NOT_ASKED, Failed, Skipped


@dataclass(frozen=True)
class MergedEdge:
    """A wire of the merged graph, from node ``start`` (or ``frame``) to node ``end``."""

    start: str
    end: str
    kind: Literal["data", "choice", "guard"]
    port: str = ""
    path: str = ""
    """Field that is read, as ``count`` of ``footprint.count``; empty for the whole value."""


@dataclass(frozen=True, eq=False)
class MergedNode:
    """One node of the merged graph, run once a frame for all variants it is credited to.

    Parameters
    ----------
    name : str
        Unique in the merged graph: ``eroded``, or ``eroded@2`` for that of the second variant
        where several different nodes are called so.
    own_name : str
        What the first of its variants calls it.
    kind : str
        ``step``, ``first_of``, ``pass`` or ``map``.
    what : str
        Step, pipeline or choice, as tables show it.
    settings : mapping
        Plain data, all spelled out.
    guard : str
        The text of ``when``; empty without one.
    own_names : mapping
        Label of each variant it is credited to -> what that variant calls it (rarely several).
    new_in : tuple of str
        Labels of the variants whose parent among the variants lacks it.
    output_of : tuple of str
        Labels of the variants that ask for it.
    stateful : bool
    n_ran : int
        Frames its step was called in.
    n_skipped, n_failed, n_not_asked : int
        Frames it was skipped or failed in (its own failure or one handed on), and those in which
        nothing asked for it.
    time_us : float
        Median over the frames it ran in; 0 if it never did.
    total_s : float
        Sum over all frames.
    """

    name: str
    own_name: str
    kind: str
    what: str
    settings: Mapping[str, Any]
    guard: str
    own_names: Mapping[str, tuple[str, ...]]
    new_in: tuple[str, ...]
    output_of: tuple[str, ...]
    stateful: bool
    n_ran: int = 0
    n_skipped: int = 0
    n_failed: int = 0
    n_not_asked: int = 0
    time_us: float = 0.0
    total_s: float = 0.0

    @property
    def variants(self) -> tuple[str, ...]:
        """Labels of the variants it is credited to."""
        return tuple(self.own_names)

    @property
    def shared(self) -> bool:
        """Whether more than one variant has it."""
        return len(self.own_names) > 1


@dataclass(frozen=True, eq=False)
class MergedGraph:
    """The one graph all variants ran in; nodes each after those they read."""

    nodes: tuple[MergedNode, ...]
    edges: tuple[MergedEdge, ...]
    pipeline: Pipeline
    """It as a pipeline, fit to draw; its outputs are named ``number:output``."""

    def node(self, name: str) -> MergedNode:
        """Return the node of that merged name."""
        return next(n for n in self.nodes if n.name == name)

    def named(self, variant: str, own_name: str) -> MergedNode:
        """Return the node that a variant calls so."""
        return next(n for n in self.nodes if own_name in n.own_names.get(variant, ()))


@dataclass(frozen=True)
class Saving:
    """What running equal nodes once saved.

    Times are sums of node times over all frames, in seconds: ``alone_s`` adds up what each
    variant alone would have spent in the nodes it needed, at the times measured here.
    """

    alone_s: float
    merged_s: float
    n_nodes_alone: int
    n_nodes_merged: int
    n_shared: int
    """Merged nodes that more than one variant has."""

    @property
    def share(self) -> float:
        """Saved share of the time alone, 0 to 1."""
        return 1.0 - self.merged_s / self.alone_s if self.alone_s > 0.0 else 0.0


STATES = ("not asked", "ran", "skipped", "failed")
"""What the codes 0 to 3 of `Timeline.states` mean."""


def state_of(outcome: Any) -> int:
    """Return the code of what a node came to."""
    if outcome is NOT_ASKED:
        return 0
    return {Skipped: 2, Failed: 3}.get(outcome.__class__, 1)


@dataclass(frozen=True, eq=False)
class Timeline:
    """What each node of a variant came to in each frame, as it would have alone.

    Parameters
    ----------
    nodes : tuple of str
        The variant's own names, in the order of its file; those its outputs need.
    states : ndarray of uint8, shape (n_frames, n_nodes)
        Index into `STATES`. A node whose guard is false, or an input of which was skipped, is
        skipped; one that nothing asked for in that frame (it stands behind a guard that was
        false) is ``not asked``. ``failed`` holds for nodes that failed and those that needed one.
    """

    nodes: tuple[str, ...]
    states: NDArray[np.uint8]

    @property
    def ran(self) -> NDArray[np.int64]:
        """Nodes that ran in each frame, shape (n_frames,)."""
        return np.asarray((self.states == 1).sum(axis=1), dtype=np.int64)

    @property
    def not_run(self) -> NDArray[np.int64]:
        """Nodes that were skipped or not asked for in each frame, shape (n_frames,)."""
        quiet = (self.states == 0) | (self.states == 2)
        return np.asarray(quiet.sum(axis=1), dtype=np.int64)
