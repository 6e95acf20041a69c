"""``Comparison``: everything a comparison found out, as plain records."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tactile_graph.compare.frame_records import ChosenFrame, DifferenceImage
from tactile_graph.compare.graph_records import MergedGraph, Saving, Timeline
from tactile_graph.pipeline.pipeline import Pipeline


@dataclass(frozen=True, eq=False)
class Times:
    """Time per frame of one variant: the sum of the times of the nodes it needed.

    ``per_frame_us`` has shape (n_frames,), in microseconds; frames equal to the one before, which
    cost nothing, hold NaN and are left out of the figures. The rest of a frame's cost (reading
    it, the engine's own hops) is the same for all and stands in `Comparison.fixed_us`.
    """

    per_frame_us: NDArray[np.float64]
    median_us: float
    p95_us: float
    mean_us: float


@dataclass(frozen=True, eq=False)
class Variant:
    """One of the pipelines that were compared.

    Parameters
    ----------
    label : str
        What it is called everywhere: its pipeline's name and what was set.
    number : int
        From 1, in the order they were named.
    pipeline : Pipeline
        As it ran.
    given : str
        As it can be given again on a command line.
    asked : tuple of str
        The outputs that were asked for.
    parent : str
        Label of the variant it evolves from, over any number of steps; empty if none is here.
    times : Times
    timeline : Timeline
    n_ok, n_skipped, n_failed : int
        Frames in which all outputs came out, some were skipped, some failed.
    reasons : tuple
        (``skipped`` or ``failed``, output, origin, reason of the first, number of frames), most
        frequent first.
    """

    label: str
    number: int
    pipeline: Pipeline
    given: str
    asked: tuple[str, ...]
    parent: str
    times: Times
    timeline: Timeline
    n_ok: int
    n_skipped: int
    n_failed: int
    reasons: tuple[tuple[str, str, str, str, int], ...]


@dataclass(frozen=True, eq=False)
class Score:
    """How far one variant's quantity is off, over all true objects it could have answered for.

    Errors are found less true, in ``unit``; that of a centre is the distance, of an identity 1
    where it is wrong and 0 where it is right.

    Parameters
    ----------
    variant, quantity, unit : str
        ``unit`` is cm, °, cm² or empty.
    positions : ndarray of int64, shape (n,)
        Row of each target's frame.
    objects : ndarray of int64, shape (n,)
        Number of the true object within its frame's truth; -1 where the quantity is of the whole
        frame (count), or nobody can say which of several was meant.
    errors : ndarray of float64, shape (n,)
        Signed error; NaN where there was no answer.
    mean, median, p95, largest : float or None
        Of the absolute errors; None without any answer.
    bias : float or None
        Mean of the signed errors; of centres the length of the mean offset.
    n_answered, n_missing : int
        True objects with and without an answer.
    n_extra : int
        Answers with nothing there to answer for.
    pareto : bool
        Whether no other variant that answers as often or more is better in mean error without
        being slower, or faster without being worse.
    """

    variant: str
    quantity: str
    unit: str
    positions: NDArray[np.int64]
    objects: NDArray[np.int64]
    errors: NDArray[np.float64]
    mean: float | None
    median: float | None
    p95: float | None
    largest: float | None
    bias: float | None
    n_answered: int
    n_missing: int
    n_extra: int
    pareto: bool = False

    @property
    def absolute(self) -> NDArray[np.float64]:
        """Absolute errors of the answers, shape (n_answered,)."""
        return np.abs(self.errors[~np.isnan(self.errors)])


@dataclass(frozen=True)
class Difference:
    """A variant's absolute error less its reference's, on targets that both answered.

    ``low`` and ``high`` bound the mean at ``level``; None where fewer than two frames tell.
    Negative is better.
    """

    variant: str
    reference: str
    quantity: str
    unit: str
    mean: float | None
    low: float | None
    high: float | None
    level: float
    method: str
    """``bootstrap over frames`` or ``normal over frames``."""
    n_both: int
    n_only_variant: int
    n_only_reference: int
    n_neither: int

    @property
    def verdict(self) -> str:
        """``better``, ``worse`` or ``no clear difference``: whether the interval leaves out 0."""
        if self.low is not None and self.high is not None:
            if self.high < 0.0:
                return "better"
            if self.low > 0.0:
                return "worse"
        return "no clear difference"


@dataclass(frozen=True)
class TimeDifference:
    """A variant's time per frame against its reference's, over the same frames.

    ``low_us`` and ``high_us`` bound the median difference at 95 %; None below six frames. Medians,
    since a frame in which the machine did something else may take a hundred times as long.
    """

    variant: str
    reference: str
    median_us: float
    """Median over frames of the variant's time less the reference's."""
    low_us: float | None
    high_us: float | None
    ratio: float
    """Median over frames of the variant's time by the reference's."""


@dataclass(frozen=True)
class SettingChange:
    """What of a node is another: a setting by its name, or ``step``, ``in``, ``when`` …"""

    what: str
    before: Any
    after: Any

    def __str__(self) -> str:
        return f"{self.what}: {self.before} -> {self.after}"


@dataclass(frozen=True)
class NodeChange:
    """A node that parent and child both have by name, and what differs."""

    node: str
    changes: tuple[SettingChange, ...]


@dataclass(frozen=True, eq=False)
class Evolution:
    """One step of the lineage: what the child did to its parent, and what that did.

    ``added``, ``removed`` and ``kept`` are node names; ``kept`` nodes are the same in themselves,
    though what they read may have changed. ``images`` are the difference images of the chosen
    frames, where the two differ.
    """

    parent: str
    child: str
    added: tuple[str, ...]
    removed: tuple[str, ...]
    changed: tuple[NodeChange, ...]
    kept: tuple[str, ...]
    differences: tuple[Difference, ...]
    time: TimeDifference
    images: tuple[DifferenceImage, ...]


@dataclass(frozen=True, eq=False)
class FrameTable:
    """The frames everything was run on; a row of every array over frames is one of them."""

    indices: NDArray[np.int64]
    """Number of each in its source, shape (n_frames,)."""
    times_s: NDArray[np.float64]
    """When each was taken; NaN where the source keeps no time, shape (n_frames,)."""
    labels: tuple[str, ...]
    n_true: NDArray[np.int64]
    """True objects in each; -1 where nobody knows, shape (n_frames,)."""
    reused: NDArray[np.bool_]
    """Whether it was equal to the one before, so that nothing had to run, shape (n_frames,)."""

    @property
    def n(self) -> int:
        """Number of frames."""
        return len(self.indices)


@dataclass(frozen=True, eq=False)
class Comparison:
    """What a comparison found out.

    Parameters
    ----------
    variants : tuple of Variant
        In the order they were named.
    frames : FrameTable
    source : str
        The source step and what was set of it.
    graph : MergedGraph
    saving : Saving
    fixed_us : float
        Median time per frame outside the nodes, for all variants together.
    scores : tuple of Score
        One for each variant and quantity that it gives and the truth knows.
    differences : tuple of Difference
        Of every variant but the first, against its parent or else the first, or the first that
        has the quantity at all.
    time_differences : tuple of TimeDifference
        The same for times.
    lineage : tuple of Evolution
    chosen : tuple of ChosenFrame
        In the order of the frames.
    provenance : mapping
        How to make it again, as plain data.
    seconds : float
        The whole took so long.
    interrupted : bool
        Whether it was stopped before the source ended.
    notes : tuple of str
        What people should know: assumptions made, sources ignored.
    """

    variants: tuple[Variant, ...]
    frames: FrameTable
    source: str
    graph: MergedGraph
    saving: Saving
    fixed_us: float
    scores: tuple[Score, ...]
    differences: tuple[Difference, ...]
    time_differences: tuple[TimeDifference, ...]
    lineage: tuple[Evolution, ...]
    chosen: tuple[ChosenFrame, ...]
    provenance: Mapping[str, Any]
    seconds: float
    interrupted: bool = False
    notes: tuple[str, ...] = ()

    @property
    def labels(self) -> tuple[str, ...]:
        """Labels of the variants, in order."""
        return tuple(v.label for v in self.variants)

    @property
    def quantities(self) -> tuple[str, ...]:
        """The quantities that at least one variant was scored on, in a fixed order."""
        from tactile_graph.compare.quantities import QUANTITIES

        found = {s.quantity for s in self.scores}
        return tuple(q for q in QUANTITIES if q in found)

    def variant(self, label: str) -> Variant:
        """Return the variant of that label."""
        return next(v for v in self.variants if v.label == label)

    def score(self, variant: str, quantity: str) -> Score | None:
        """Return a variant's score of a quantity; None if it was not scored on it."""
        found = (s for s in self.scores if s.variant == variant and s.quantity == quantity)
        return next(found, None)

    def difference(self, variant: str, quantity: str) -> Difference | None:
        """Return a variant's difference from its reference; None if there is none."""
        found = (d for d in self.differences if d.variant == variant and d.quantity == quantity)
        return next(found, None)
