"""All cases of all subjects, one row each."""

from __future__ import annotations

import zlib
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from tactile_graph.errors import PipelineError, TactileGraphError
from tactile_graph.plugins.registry import Registry, installed
from tactile_graph_stress.case import Case
from tactile_graph_stress.cases.stress_cases import StressCases
from tactile_graph_stress.judge import Judge
from tactile_graph_stress.subject import Subject
from tactile_graph_stress.trial import NODE, Trial
from tactile_graph_stress.verdict import Outcome, Verdict

OFFERS = "stress_cases"


class NotStressed(TactileGraphError):  # noqa: N818 -- what becomes of the step
    """A step that cannot be built with its defaults, and why not."""


@dataclass(frozen=True)
class Row:
    """One step, one case, and what it came to."""

    step: str
    kind: str
    plugin: str
    group: str
    case: str
    verdict: Verdict


def cases_of(subject: Subject, seed: int, quick: bool) -> list[Case]:
    """Return all cases for a subject; those of one kind are the same for all its steps."""
    registry = installed()
    found: list[Case] = []
    for name in registry.offered(OFFERS):
        cases: StressCases = registry.load(OFFERS, name)
        if cases.suits(subject):
            rng = np.random.default_rng([seed, zlib.crc32(subject.kind.encode())])
            found += cases.make(subject, rng, quick)
    return found


def stressed(
    subject: Subject, seed: int = 0, quick: bool = True, registry: Registry | None = None
) -> Iterator[Row]:
    """Yield a row for each case of a subject.

    Raises
    ------
    NotStressed
        If it cannot be built with its defaults: two settings of which one must be given, say.
    """
    try:
        trial = Trial(subject, seed, registry)
    except PipelineError as error:
        told = "; ".join(p.message.removeprefix(f"node {NODE!r}: ") for p in error.problems)
        raise NotStressed(told) from error
    except TactileGraphError as error:
        raise NotStressed(str(error)) from error
    judge = Judge(trial, np.random.default_rng([seed, 1]))
    for case in cases_of(subject, seed, quick):
        verdict = judge.of(case)
        yield Row(subject.label, subject.kind, subject.plugin, case.group, case.name, verdict)


def worst_first(rows: Sequence[Row]) -> list[Row]:
    """Return rows by outcome, the worst first, and within one by falling error."""
    order = list(Outcome)
    return sorted(rows, key=lambda r: (-order.index(r.verdict.outcome), -(r.verdict.units or 0.0)))
