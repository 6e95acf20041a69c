"""``Audit``: what the guards of a pipeline are worth, as plain records."""

from __future__ import annotations

from dataclasses import dataclass

from tactile_graph.api.pipeline import Pipeline
from tactile_graph_compare.records.comparison import Comparison
from tactile_graph_compare.records.scores import Difference


@dataclass(frozen=True)
class GuardAudit:
    """What one guard, or one hand-over, saved and what it cost.

    Parameters
    ----------
    node : str
        The guarded node, or the ``first_of``.
    kind : str
        ``when`` or ``first_of``.
    text : str
        The condition, or the choices that were left out.
    n_stopped : int
        Frames in which it kept something from running.
    saved_us : float
        Time saved per frame, mean over all frames of the sample: that of the nodes which ran in
        the shadow only, less that of nodes only the guard itself needs.
    saved_share : float
        The same as a share of the time per frame without it.
    saved_when_us : float
        Time saved per frame in which it stopped something.
    differences : tuple of Difference
        For each quantity, the pipeline's absolute error less the shadow's: what the guard brought
        in. ``n_only_reference`` counts the answers it cost.
    n_false_prevented : int
        Frames in which truly nothing lay on the pad and only the shadow answered.
    n_failed_prevented : int
        Frames in which an output failed in the shadow only.
    n_changed : int
        Frames in which an output came out otherwise in any way.
    """

    node: str
    kind: str
    text: str
    n_stopped: int
    saved_us: float
    saved_share: float
    saved_when_us: float
    differences: tuple[Difference, ...]
    n_false_prevented: int
    n_failed_prevented: int
    n_changed: int


@dataclass(frozen=True, eq=False)
class Audit:
    """All guards of a pipeline, on one sample of frames.

    ``everything`` is the comparison of the pipeline with its shadows; ``whole`` tells that a step
    keeps state, so that every frame had to be taken.
    """

    pipeline: Pipeline
    guards: tuple[GuardAudit, ...]
    n_frames: int
    n_seen: int
    median_us: float
    everything: Comparison
    whole: bool
