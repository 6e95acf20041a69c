"""Audit what is skipped: run guarded-off nodes besides, and tell what each guard is worth.

Pipeline and ablations (each without one guard, or without the first choices of a ``first_of``)
are compared like any variants: merged into one graph, so that only what a guard keeps from running
is run besides.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tactile_graph import Image, Pipeline, load
from tactile_graph.inspect import NO_VALUE, as_data
from tactile_graph.many import Portion, Reading
from tactile_graph.wires.frame import Frame
from tactile_graph.wires.given import as_frames
from tactile_graph_compare.records.comparison import Comparison
from tactile_graph_compare.records.scores import Difference
from tactile_graph_compare.run.frame_choice import FrameChooser
from tactile_graph_compare.run.logs import VariantLog
from tactile_graph_compare.run.session import WARM_FRAMES, Part, Session
from tactile_graph_compare.run.shared import Noting
from tactile_graph_compare.run.summarise import summarise
from tactile_graph_compare.variants.ablations import Ablation, ablations_of
from tactile_graph_compare.variants.prepare import PreparedVariant


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
        the ablation only, less that of nodes only the guard itself needs.
    saved_share : float
        The same as a share of the time per frame without it.
    saved_when_us : float
        Time saved per frame in which it stopped something.
    differences : tuple of Difference
        For each quantity, the pipeline's absolute error less the ablation's: what the guard brought
        in. ``n_only_reference`` counts the answers it cost.
    n_false_prevented : int
        Frames in which truly nothing lay on the pad and only the ablation answered.
    n_failed_prevented : int
        Frames in which an output failed in the ablation only.
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

    ``everything`` is the comparison of the pipeline with its ablations; ``whole`` tells that a step
    keeps state, so that every frame had to be taken.
    """

    pipeline: Pipeline
    guards: tuple[GuardAudit, ...]
    n_frames: int
    n_seen: int
    median_us: float
    everything: Comparison
    whole: bool


def audit(
    pipeline: Pipeline | str | Path,
    frames: Iterable[Frame | Image | NDArray[np.generic]] | None = None,
    *,
    asked: tuple[str, ...] = (),
    sample: float = 1.0,
    seed: int = 0,
) -> Audit:
    """Return what each guard of a pipeline saves, and what error it brings in.

    Parameters
    ----------
    pipeline : Pipeline, str or Path
        Itself, or its name or file.
    frames : iterable of Frame, Image or ndarray, optional
        The pipeline's own source if not given.
    asked, sample, seed
        As in `Auditor`.

    Raises
    ------
    RuleError
        If a frame breaks a rule of a step.
    UsageError, PipelineError
        If there is no such pipeline, or it is none.

    Notes
    -----
    Guards inside a pipeline that is run over a list (``use`` with ``each``) are not audited.
    """
    if not isinstance(pipeline, Pipeline):
        pipeline = load(pipeline)
    if frames is None:
        frames = pipeline.frames(seed)
    else:
        frames = as_frames(frames)
        pipeline = replace(pipeline, source=None)
    auditor = Auditor(pipeline, asked, sample, seed)
    for frame in frames:
        auditor.add(frame)
    return auditor.summarise()


class _Given(NamedTuple):
    """What a worker audits."""

    pipeline: Pipeline
    asked: tuple[str, ...]
    seed: int
    reading: Reading | None


class _Noted(NamedTuple):
    """What was noted of a guard."""

    saved_us: list[float]
    stopped: list[bool]
    counts: tuple[int, int, int]


class AuditPart(NamedTuple):
    """What a worker noted of its frames, and the error that ended them if one did."""

    session: Part
    guards: list[_Noted]
    error: Exception | None


class AuditWorker:
    """Audits portions of frames in a worker.

    Parameters
    ----------
    given : record
        As of `Auditor.for_workers`.
    """

    def __init__(self, given: _Given) -> None:
        self._auditor = Auditor(given.pipeline, given.asked, seed=given.seed)
        self._noting = Noting(self._auditor.session, given.reading)

    def __call__(self, portion: Portion) -> AuditPart:
        """Return what was noted of a portion's frames."""
        return self._auditor.part(portion, self._noting)


class Auditor:
    """Takes frames, or a sample of them, through a pipeline and its ablations.

    Parameters
    ----------
    pipeline : Pipeline
    asked : tuple of str
        Outputs or nodes asked for; the pipeline's outputs where empty.
    sample : float
        Share of the frames that is taken, 0 to 1; all of them where a step keeps state.
    seed : int
        Of the sample, and of the steps that take randomness.
    """

    def __init__(
        self, pipeline: Pipeline, asked: tuple[str, ...] = (), sample: float = 1.0, seed: int = 0
    ) -> None:
        self.pipeline = pipeline
        self.guards = [_GuardLog(ablation) for ablation in ablations_of(pipeline)]
        asked = asked or tuple(pipeline.outputs)
        rows = [(pipeline.name, pipeline)]
        rows += [(g.ablation.label, g.ablation.pipeline) for g in self.guards]
        prepared = [PreparedVariant(label, p, asked, pipeline.name) for label, p in rows]
        self.session = Session(prepared, seed, FrameChooser(n_regular=0, most=0))
        self.whole = self.session.stateful
        self.asked, self.sample, self.seed = asked, sample, seed
        self.n_seen = 0
        self._rng = np.random.default_rng(seed)
        self._waiting: list[Frame] | None = []

    def add(self, frame: Frame) -> bool:
        """Look at a frame; return whether it is in the sample."""
        if not self.drawn():
            return False
        if self._waiting is None:
            self._take(frame)
        else:
            self._waiting.append(frame)
            if len(self._waiting) == WARM_FRAMES:
                self._start()
        return True

    def drawn(self) -> bool:
        """Return whether the next frame is in the sample."""
        self.n_seen += 1
        return bool(self._rng.random() < self.sample) or self.whole

    def _start(self) -> None:
        """Warm up with the first frames of the sample, and then take them."""
        waiting, self._waiting = self._waiting or [], None
        self.session.warm_up(waiting)
        for frame in waiting:
            self._take(frame)

    # -- by workers ------------------------------------------------------------------------------

    def begin(self) -> None:
        """Take frames anew, from the first."""
        self.session.begin()
        for guard in self.guards:
            guard.begin()
        self.n_seen = 0
        self._waiting = []

    def for_workers(self, reading: Reading | None = None) -> _Given:
        """Return what `AuditWorker` is made of; frames of the sample alone go there.

        Parameters
        ----------
        reading : Reading, optional
            By which workers read the frames themselves, where a step keeps state.
        """
        return _Given(self.pipeline, self.asked, self.seed, reading)

    def join(self, part: AuditPart) -> None:
        """Take in what a worker noted of the frames that come next."""
        self._waiting = None  # who ran none needs no warming up
        self.session.join(part.session)
        for guard, its in zip(self.guards, part.guards, strict=True):
            guard.join(its)

    def part(self, portion: Portion, noting: Noting) -> AuditPart:
        """Return what is noted of a portion's frames, of which all are of the sample."""
        for guard in self.guards:
            guard.begin()
        error = noting(portion, self._take)
        return AuditPart(self.session.part(), [g.noted() for g in self.guards], error)

    def _take(self, frame: Frame) -> None:
        self.session.add(frame)
        whole, *ablations = self.session.logs
        for guard, log in zip(self.guards, ablations, strict=True):
            guard.add(frame, whole, log)

    def summarise(self, interrupted: bool = False) -> Audit:
        """Return what the guards came to over the frames so far."""
        if self._waiting:
            self._start()
        found = summarise(self.session, interrupted=interrupted)
        return Audit(
            pipeline=self.pipeline,
            guards=tuple(guard.audited(found) for guard in self.guards),
            n_frames=found.frames.n,
            n_seen=self.n_seen,
            median_us=found.variants[0].times.median_us,
            everything=found,
            whole=self.whole,
        )


@dataclass
class _GuardLog:
    """What one guard did so far, frame by frame."""

    ablation: Ablation
    saved_us: list[float] = field(default_factory=list)
    stopped: list[bool] = field(default_factory=list)
    n_false_prevented: int = 0
    n_failed_prevented: int = 0
    n_changed: int = 0

    def begin(self) -> None:
        """Note anew."""
        self.saved_us, self.stopped = [], []
        self.n_false_prevented = self.n_failed_prevented = self.n_changed = 0

    def noted(self) -> _Noted:
        """Return what was noted so far, as it travels between processes."""
        counts = (self.n_false_prevented, self.n_failed_prevented, self.n_changed)
        return _Noted(self.saved_us, self.stopped, counts)

    def join(self, later: _Noted) -> None:
        """Note what was noted elsewhere of the frames that come next."""
        self.saved_us += later.saved_us
        self.stopped += later.stopped
        self.n_false_prevented += later.counts[0]
        self.n_failed_prevented += later.counts[1]
        self.n_changed += later.counts[2]

    def add(self, frame: Frame, whole: VariantLog, ablated: VariantLog) -> None:
        """Note the last frame of the pipeline and of its ablation."""
        # Node by node: what both run takes the same, whatever the clock says.
        with_it, without = _spent_us(whole), _spent_us(ablated)
        more = [without[n] for n in without if n not in with_it]
        saved = sum(more) - sum(with_it[n] for n in with_it if n not in without)
        self.saved_us.append(0.0 if math.isnan(whole.times_us[-1]) else saved)
        self.stopped.append(bool(more))
        pairs = list(zip(_asked_of(whole), _asked_of(ablated), strict=True))
        compared = [(_comparable(a), _comparable(b)) for a, b in pairs if a is not b]
        self.n_changed += any(a != b for a, b in compared)
        self.n_failed_prevented += any(b == "Failed" and a != b for a, b in compared)
        self.n_false_prevented += frame.truth == () and any(
            a.__class__ in NO_VALUE and b.__class__ not in NO_VALUE for a, b in pairs
        )

    def audited(self, found: Comparison) -> GuardAudit:
        """Return what it came to in all frames, which that comparison is of."""
        ablation = self.ablation
        saved, stopped = np.array(self.saved_us), np.array(self.stopped, dtype=np.bool_)
        total_us = float(saved.sum())
        without_us = float(np.nansum(found.variants[0].times.per_frame_us)) + total_us
        return GuardAudit(
            node=ablation.node,
            kind=ablation.kind,
            text=ablation.text,
            n_stopped=int(stopped.sum()),
            saved_us=total_us / max(1, found.frames.n),
            saved_share=total_us / without_us if without_us > 0.0 else 0.0,
            saved_when_us=float(saved[stopped].mean()) if stopped.any() else 0.0,
            differences=tuple(
                _reversed(d) for d in found.differences if d.variant == ablation.label
            ),
            n_false_prevented=self.n_false_prevented,
            n_failed_prevented=self.n_failed_prevented,
            n_changed=self.n_changed,
        )


def _asked_of(log: VariantLog) -> list[Any]:
    """Return the outcomes of what was asked of a variant in its last frame."""
    return [log.last.outcome_at(ref) for ref in log.member.asked]


def _spent_us(log: VariantLog) -> dict[str, float]:
    """Return the time of each node that ran for a variant's last frame."""
    return {node: time for node, time in log.last.times_us.items() if time > 0.0}


def _comparable(outcome: Any) -> Any:
    """Return an outcome as plain data; of skips and failures only that they are."""
    return outcome.__class__.__name__ if outcome.__class__ in NO_VALUE else as_data(outcome)


def _reversed(d: Difference) -> Difference:
    """Return the difference the other way round: the pipeline's error less its ablation's."""

    def less(x: float | None) -> float | None:
        return None if x is None else -x + 0.0

    return replace(
        d, variant=d.reference, reference=d.variant, mean=less(d.mean), low=less(d.high),
        high=less(d.low), n_only_variant=d.n_only_reference, n_only_reference=d.n_only_variant,
    )  # fmt: skip
