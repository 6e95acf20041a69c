"""Audit what is skipped: run guarded-off nodes in shadow, and tell what each guard is worth.

For every guard a shadow of the pipeline is made in which the guard always holds, for every
``first_of`` one in which only its later choices are left. Pipeline and shadows are compared like
any variants: merged into one graph, so that only what a guard keeps from running is run besides.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from tactile_graph.api.pipeline import Pipeline
from tactile_graph.api.result import Result
from tactile_graph.engine.outcome import NO_VALUE
from tactile_graph.engine.rows import as_data
from tactile_graph.wires.frame import Frame
from tactile_graph_compare.records.audit import Audit, GuardAudit
from tactile_graph_compare.records.comparison import Comparison
from tactile_graph_compare.records.scores import Difference
from tactile_graph_compare.run.frame_choice import Keeper
from tactile_graph_compare.run.session import WARM_FRAMES, Session, VariantLog
from tactile_graph_compare.run.summarise import close
from tactile_graph_compare.run.variant_result import OwnResult
from tactile_graph_compare.variants.shadows import shadows_of
from tactile_graph_compare.variants.variants import Prepared


class Auditor:
    """Takes frames and a sample of them through a pipeline and its shadows.

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
        self.shadows = shadows_of(pipeline)
        asked = asked or tuple(pipeline.outputs)
        rows = [(pipeline.name, pipeline)]
        rows += [(s.label, s.pipeline) for s in self.shadows]
        prepared = [Prepared(label, p, asked, pipeline.name) for label, p in rows]
        self.session = Session(prepared, seed, Keeper(n_regular=0, most=0))
        self.whole = self.session.stateful
        self.sample = sample
        self.n_seen = 0
        self._rng = np.random.default_rng(seed)
        self._waiting: list[Frame] | None = []
        n = len(self.shadows)
        self._more_us: list[list[float]] = [[] for _ in self.shadows]
        self._stopped: list[list[bool]] = [[] for _ in self.shadows]
        self._counts = {k: [0] * n for k in ("false", "failed", "changed")}

    def add(self, frame: Frame) -> bool:
        """Look at a frame; return whether it is in the sample."""
        self.n_seen += 1
        taken = bool(self._rng.random() < self.sample) or self.whole
        if not taken:
            return False
        if self._waiting is None:
            self._take(frame)
        else:
            self._waiting.append(frame)
            if len(self._waiting) == WARM_FRAMES:
                self._start()
        return True

    def _start(self) -> None:
        """Warm up with the first frames of the sample, and then take them."""
        waiting, self._waiting = self._waiting or [], None
        self.session.warm_up(waiting)
        for frame in waiting:
            self._take(frame)

    def _take(self, frame: Frame) -> None:
        result = self.session.add(frame)
        times_us = result.times_us
        logs = self.session.logs
        plain, spent = OwnResult(result, logs[0].member), _spent_us(logs[0], times_us)
        for i, log in enumerate(logs[1:]):
            self._compare(i, result, plain, OwnResult(result, log.member))
            # Node by node: what both run takes the same, whatever the clock says.
            its = _spent_us(log, times_us)
            more = [its[n] for n in its if n not in spent]
            self._more_us[i].append(sum(more) - sum(spent[n] for n in spent if n not in its))
            self._stopped[i].append(bool(more))

    def _compare(self, i: int, result: Result, plain: OwnResult, shadow: OwnResult) -> None:
        ours = [plain.merged_outcome(r) for r in plain.member.asked]
        theirs = [shadow.merged_outcome(r) for r in shadow.member.asked]
        told = [(_told(a), _told(b)) for a, b in zip(ours, theirs, strict=True) if a is not b]
        changed = any(a != b for a, b in told)
        self._counts["changed"][i] += changed
        self._counts["failed"][i] += any(b == "Failed" and a != b for a, b in told)
        empty = result.frame.truth == ()
        found = any(
            a.__class__ in NO_VALUE and b.__class__ not in NO_VALUE
            for a, b in zip(ours, theirs, strict=True)
        )
        self._counts["false"][i] += empty and found

    def close(self, interrupted: bool = False) -> Audit:
        """Return what the guards came to over the frames so far."""
        if self._waiting:
            self._start()
        found = close(self.session, interrupted=interrupted)
        return Audit(
            pipeline=self.pipeline,
            guards=tuple(self._guards(found)),
            n_frames=found.frames.n,
            n_seen=self.n_seen,
            median_us=found.variants[0].times.median_us,
            everything=found,
            whole=self.whole,
        )

    def _guards(self, found: Comparison) -> Iterator[GuardAudit]:
        n = max(1, found.frames.n)
        plain_us = float(np.nansum(found.variants[0].times.per_frame_us))
        for i, (shadow, variant) in enumerate(zip(self.shadows, found.variants[1:], strict=True)):
            more = np.array(self._more_us[i])
            stopped = np.array(self._stopped[i], dtype=np.bool_)
            without = plain_us + float(more.sum())
            yield GuardAudit(
                shadow.node,
                shadow.kind,
                shadow.text,
                int(stopped.sum()),
                float(more.sum()) / n,
                float(more.sum()) / without if without > 0.0 else 0.0,
                float(more[stopped].mean()) if stopped.any() else 0.0,
                tuple(_turned(d) for d in found.differences if d.variant == variant.label),
                self._counts["false"][i],
                self._counts["failed"][i],
                self._counts["changed"][i],
            )


def _spent_us(log: VariantLog, times_us: Mapping[str, float]) -> dict[str, float]:
    """Return the time of each node that a variant's last frame needed and that ran."""
    return {
        node: time
        for node, code in zip(log.nodes, log.states[-1], strict=True)
        if code and (time := times_us[log.member.names[node]]) > 0.0
    }


def _told(outcome: Any) -> Any:
    """Return an outcome as plain data; of skips and failures only that they are."""
    return outcome.__class__.__name__ if outcome.__class__ in NO_VALUE else as_data(outcome)


def _turned(d: Difference) -> Difference:
    """Return the difference the other way round: the pipeline's error less its shadow's."""

    def less(x: float | None) -> float | None:
        return None if x is None else -x + 0.0

    return replace(
        d, variant=d.reference, reference=d.variant, mean=less(d.mean), low=less(d.high),
        high=less(d.low), n_only_variant=d.n_only_reference, n_only_reference=d.n_only_variant,
    )  # fmt: skip


def audit(
    pipeline: Pipeline,
    frames: Iterable[Frame] | None = None,
    *,
    asked: tuple[str, ...] = (),
    sample: float = 1.0,
    seed: int = 0,
) -> Audit:
    """Return what each guard of a pipeline saves, and what error it brings in.

    Parameters
    ----------
    pipeline : Pipeline
    frames : iterable of Frame, optional
        The pipeline's own source if not given.
    asked, sample, seed
        As in `Auditor`.

    Raises
    ------
    RuleError
        If a frame breaks a rule of a step.

    Notes
    -----
    Guards inside a pipeline that is run over a list (``use`` with ``each``) are not audited.
    """
    if frames is None:
        frames = pipeline.frames(seed)
    else:
        pipeline = replace(pipeline, source=None)
    auditor = Auditor(pipeline, asked, sample, seed)
    for frame in frames:
        auditor.add(frame)
    return auditor.close()
