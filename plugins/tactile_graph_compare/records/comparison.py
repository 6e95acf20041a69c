"""``Comparison``: everything a comparison found out, as plain records."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tactile_graph import Pipeline
from tactile_graph_compare.records.frames import ChosenFrame, DifferenceImage
from tactile_graph_compare.records.graph import MergedGraph, Saving, Timeline
from tactile_graph_compare.records.scores import Agreement, Difference, Score, TimeDifference, Times
from tactile_graph_compare.score.quantities import in_order


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
        As it can be given again on a command line; empty where none can, for the pipeline is a
        program's own.
    asked : tuple of str
        The outputs that were asked for.
    parent : str
        Label of the variant it evolves from, over any number of steps; empty if none is here.
    times : Times
    timeline : Timeline
    n_ok, n_skipped, n_failed : int
        Frames in which all outputs came out, as finite numbers, some were skipped, some failed.
    reasons : tuple
        (``skipped`` or ``failed``, output, origin, reason of the first, number of frames), most
        frequent first. Of numbers that are not finite it is ``strange``, with the number's name as
        the origin.
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
        The source step and what was set of it; ``frames handed in`` where there was none.
    graph : MergedGraph
    saving : Saving
    fixed_us : float
        Median time per frame outside the nodes, for all variants together.
    scores : tuple of Score
        One for each variant and quantity that it gives and the truth knows.
    differences : tuple of Difference
        Of every variant but the first, against its parent or else the first, or the first that
        has the quantity at all; against ``reference`` where there is one.
    time_differences : tuple of TimeDifference
        The same for times.
    lineage : tuple of Evolution
    chosen : tuple of ChosenFrame
        In the order of the frames.
    agreements : tuple of Agreement
        How far variants lie from one another where nobody knows what is true, or, with a
        ``reference``, from that one everywhere.
    reference : str
        Label of the variant that was named to hold all others against; empty if none was.
    provenance : mapping
        How to make it again, as plain data.
    seconds : float
        The whole took so long.
    interrupted : bool
        Whether it was stopped before the source ended.
    notes : tuple of str
        What people should know: assumptions made, sources ignored.
    n_left_out : int
        Frames of which workers died each time: they count for no variant.
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
    agreements: tuple[Agreement, ...]
    reference: str
    provenance: Mapping[str, Any]
    seconds: float
    interrupted: bool = False
    notes: tuple[str, ...] = ()
    n_left_out: int = 0

    @property
    def labels(self) -> tuple[str, ...]:
        """Labels of the variants, in order."""
        return tuple(v.label for v in self.variants)

    @property
    def quantities(self) -> tuple[str, ...]:
        """The quantities that at least one variant was scored on, in a fixed order."""
        return in_order(s.quantity for s in self.scores)

    @property
    def units(self) -> dict[str, str]:
        """The unit of each quantity that variants were scored on, or held against each other in."""
        held = {a.quantity: a.unit for a in self.agreements}
        return {s.quantity: s.unit for s in self.scores} | held

    def variant(self, label: str) -> Variant:
        """Return the variant of that label."""
        return next(v for v in self.variants if v.label == label)

    def score(self, variant: str, quantity: str) -> Score | None:
        """Return a variant's score of a quantity; None if it was not scored on it."""
        found = (s for s in self.scores if s.variant == variant and s.quantity == quantity)
        return next(found, None)

    def agreement(self, variant: str, reference: str, quantity: str) -> Agreement | None:
        """Return how far a variant lies from another in a quantity; None if that is not known."""
        wanted = (variant, reference, quantity)
        found = (a for a in self.agreements if (a.variant, a.reference, a.quantity) == wanted)
        return next(found, None)

    def difference(self, variant: str, quantity: str) -> Difference | None:
        """Return a variant's difference from its reference; None if there is none."""
        found = (d for d in self.differences if d.variant == variant and d.quantity == quantity)
        return next(found, None)


@dataclass(frozen=True)
class SettingChange:
    """What of a node is another: a setting by its name, or ``step``, ``in``, ``when`` …"""

    what: str
    before: Any
    after: Any

    def __str__(self) -> str:
        return f"{self.what}: {_word(self.before)} -> {_word(self.after)}"


LONGEST_WORD = 60


def _word(value: Any) -> str:
    """Return a value as a pipeline file has it, cut where long; ``none`` where it has none."""
    if value is None:
        return "none"
    word = str(value).lower() if isinstance(value, bool) else str(value)
    return word if len(word) <= LONGEST_WORD else f"{word[: LONGEST_WORD - 1]}…"


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
