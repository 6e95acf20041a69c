"""Make the ``Comparison`` of what a session has seen."""

from __future__ import annotations

import sys
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from tactile_graph.inspect import Source
from tactile_graph.steps.injected import Report
from tactile_graph_compare.output.notebook import ShownComparison
from tactile_graph_compare.records.comparison import Comparison, Evolution, Variant
from tactile_graph_compare.records.graph import Saving, Timeline
from tactile_graph_compare.records.scores import Difference, Score, TimeDifference
from tactile_graph_compare.run.chosen_frames import chosen_frames
from tactile_graph_compare.run.crowded import crowded
from tactile_graph_compare.run.logs import VariantLog
from tactile_graph_compare.run.merged_graph import merged_graph
from tactile_graph_compare.run.session import Session
from tactile_graph_compare.score.statistics import (
    LEAST_FRAMES,
    difference_of,
    for_all_together,
    score_of,
    time_difference_of,
    times_of,
    with_pareto,
)
from tactile_graph_compare.variants.lineage import difference_images, nodes_between
from tactile_graph_compare.variants.request import as_yaml

LONGEST_SOURCE = 120


def summarise(
    session: Session,
    report: Report | None = None,
    interrupted: bool = False,
    notes: Sequence[str] = (),
    start: int = 0,
    n_left_out: int = 0,
) -> Comparison:
    """Return what the comparison found out so far.

    Parameters
    ----------
    session : Session
    report : Report, optional
        Of the source: its counters, troubles and digests go into the provenance.
    interrupted : bool
        Whether frames are missing.
    notes : sequence of str
        What people should know.
    start : int
        How many frames of the source were left out before the first.
    n_left_out : int
        Frames of which workers died each time.
    """
    variants = tuple(_variant(i, log) for i, log in enumerate(session.logs, 1))
    scores = with_pareto(
        [score_of(log.prepared.label, q, log.scorer.answers.units[q], t) for log in session.logs
         for q, t in _scored(log).items()],
        {v.label: v.times.median_us for v in variants},
    )  # fmt: skip
    rng = np.random.default_rng(session.seed)
    references = _references(variants, session.reference)
    differences = for_all_together(_differences(references, scores, rng))
    times = tuple(_time_differences(references, variants))
    chosen = chosen_frames(session)
    of_parents = differences
    if session.reference:
        of_parents = for_all_together(_differences(_references(variants, ""), scores, rng))
    return ShownComparison(
        variants=variants,
        frames=session.merged_log.frames(),
        source=source_told(session.merged.pipeline.source),
        graph=merged_graph(session),
        saving=_saving(session, variants),
        fixed_us=times_of(session.merged_log.fixed_us).median_us,
        scores=scores,
        differences=differences,
        time_differences=times,
        lineage=tuple(_evolutions(variants, of_parents, times, chosen)),
        chosen=chosen,
        agreements=session.agreement.agreements(),
        reference=session.reference,
        provenance=_provenance(session, report or Report(), interrupted, start),
        seconds=session.last - session.started,
        interrupted=interrupted,
        notes=(*notes, *_few_placements(session), *crowded(session.waiting)),
        n_left_out=n_left_out,
    )


def _few_placements(session: Session) -> Iterator[str]:
    """Yield that frames are hardly more than one another again, where they are."""
    log = session.merged_log
    n, n_frames = log.n_placements, int((log.frames().n_true > 0).sum())
    if 0 < n < LEAST_FRAMES and n_frames >= LEAST_FRAMES * n:
        yield (
            f"in {n_frames} frames objects lie in {n} way{'s' * (n != 1)} alone: frames of one are "
            "hardly more than one, so intervals are too narrow and verdicts too sure; put the "
            "objects down anew"
        )


def _scored(log: VariantLog) -> dict[str, Any]:
    """Return the targets of each quantity that something was there to answer for."""
    return {q: t for q, t in log.scorer.errors.items() if t.positions or t.n_extra}


def _variant(number: int, log: VariantLog) -> Variant:
    prepared = log.prepared
    states = np.frombuffer(b"".join(log.states), dtype=np.uint8)
    told = [(*key, *kept) for key, kept in log.reasons.items()]
    return Variant(
        label=prepared.label,
        number=number,
        pipeline=prepared.pipeline,
        given=prepared.given,
        asked=prepared.asked,
        parent=prepared.parent,
        times=times_of(log.times_us),
        timeline=Timeline(log.nodes, states.reshape(len(log.states), len(log.nodes))),
        n_ok=log.n_ok,
        n_skipped=log.n_skipped,
        n_failed=log.n_failed,
        reasons=tuple(sorted(told, key=lambda row: -row[4])),
    )


def source_told(source: Source | None) -> str:
    """Return where frames come from, in words."""
    if source is None:
        return "frames handed in"
    name, given = source.name, source.given
    told = ", ".join(f"{k}: {as_yaml(v)}" for k, v in given.items())
    told = told if len(told) <= LONGEST_SOURCE else told[: LONGEST_SOURCE - 1] + "…"
    return f"{name} ({told})" if told else name


def _saving(session: Session, variants: Sequence[Variant]) -> Saving:
    alone_us = sum(float(np.nansum(v.times.per_frame_us)) for v in variants)
    members = session.merged.members
    owners: dict[str, int] = {}
    for member in members:
        for merged in {member.names[i.name] for i in member.plan.nodes}:
            owners[merged] = owners.get(merged, 0) + 1
    return Saving(
        alone_s=alone_us * 1e-6,
        merged_s=float(np.nansum(session.merged_log.times_us())) * 1e-6,
        n_nodes_alone=sum(len(m.plan.nodes) for m in members),
        n_nodes_merged=len(session.merged_log.nodes),
        n_shared=sum(n > 1 for n in owners.values()),
    )


# -- one against the other -------------------------------------------------------------------


def _references(variants: Sequence[Variant], reference: str) -> dict[str, str]:
    """Return what each variant is held against: the one named, or its parent, or the first."""
    if reference:
        found = {v.label: reference for v in variants}
    else:
        found = {v.label: v.parent or variants[0].label for v in variants[1:]}
    return {label: other for label, other in found.items() if other != label}


def _differences(
    references: Mapping[str, str], scores: Sequence[Score], rng: np.random.Generator
) -> list[Difference]:
    """Return each variant's differences; where its reference lacks a quantity, from the first."""
    by_quantity: dict[str, dict[str, Score]] = {}
    for score in scores:
        by_quantity.setdefault(score.quantity, {})[score.variant] = score
    found = []
    for score in scores:
        others = by_quantity[score.quantity]
        if score.variant not in references:
            continue
        reference = references[score.variant]
        if reference not in others:
            reference = next(iter(others))  # in the order the variants were named
        if reference != score.variant:
            found.append(difference_of(score, others[reference], rng))
    return found


def _time_differences(
    references: Mapping[str, str], variants: Sequence[Variant]
) -> list[TimeDifference]:
    times = {v.label: v.times for v in variants}
    return [
        time_difference_of(label, reference, times[label], times[reference])
        for label, reference in references.items()
    ]


def _evolutions(
    variants: Sequence[Variant],
    differences: Sequence[Difference],
    times: Sequence[TimeDifference],
    chosen: Sequence[Any],
) -> list[Evolution]:
    by_label = {v.label: v for v in variants}
    found = []
    for child in variants:
        if not child.parent:
            continue
        parent = by_label[child.parent]
        added, removed, changed, kept = nodes_between(parent.pipeline, child.pipeline)
        both = [n for n in child.pipeline.nodes if n in parent.pipeline.nodes]
        pair = (child.label, parent.label)
        time = next((t for t in times if (t.variant, t.reference) == pair), None)
        if time is None:  # another reference was named, or the first evolved from a later one
            time = time_difference_of(child.label, parent.label, child.times, parent.times)
        found.append(
            Evolution(
                parent=parent.label,
                child=child.label,
                added=added,
                removed=removed,
                changed=changed,
                kept=kept,
                differences=tuple(d for d in differences if d.variant == child.label),
                time=time,
                images=difference_images(parent.label, child.label, both, chosen),
            )
        )
    return found


# -- how it was made -------------------------------------------------------------------------


def _provenance(session: Session, report: Report, interrupted: bool, start: int) -> dict[str, Any]:
    """Return how to make it again: as of a run, with the pipeline of every variant."""
    from tactile_graph.provenance import code_digest, provenance

    rows = [
        provenance(p.pipeline, session.seed, report, given=p.given, asked=p.asked)
        for p in session.prepared
    ]
    first = rows[0]
    plugins = {name: one for row in rows for name, one in row["plugins"].items()}
    return {
        "command": [*sys.argv],
        "complete": not interrupted,
        "frames": {"from": start, "to": start + session.n},
        "seed": session.seed,
        "source": first["source"],
        "versions": first["versions"],
        "plugins": plugins,
        "code": code_digest([p.pipeline for p in session.prepared]),
        "variants": {
            p.label: {k: row[k] for k in ("given", "asked", "pipeline", "file")}
            for p, row in zip(session.prepared, rows, strict=True)
        },
    }
