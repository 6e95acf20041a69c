"""Spell out the frames that were kept: every variant's nodes, in its own names."""

from __future__ import annotations

import math

from tactile_graph import Result
from tactile_graph.inspect import NO_VALUE, Ref
from tactile_graph_compare.records.frames import ChosenFrame, NodeStory
from tactile_graph_compare.records.graph import STATES, state_of
from tactile_graph_compare.run.logs import VariantLog
from tactile_graph_compare.run.session import Session


def chosen_frames(session: Session) -> tuple[ChosenFrame, ...]:
    """Return the frames a session's chooser has chosen, in order."""
    errors = {log.prepared.label: _errors(log) for log in session.logs}
    found = []
    for position, held, choices in session.chooser.chosen():
        result = session.whole(held)
        told = {log.prepared.label: stories(result, log) for log in session.logs}
        here = {label: of.get(position, {}) for label, of in errors.items()}
        found.append(ChosenFrame(position, result.frame, choices, told, here))
    return tuple(found)


def stories(result: Result, log: VariantLog) -> dict[str, NodeStory]:
    """Return what each node of a variant came to in one frame, as it alone would have."""
    alone = log.member.alone(result)
    times_us = alone.times_us
    found = {}
    for name in log.nodes:
        outcome = alone.outcome_at(Ref(name))
        ran = outcome.__class__ not in NO_VALUE
        found[name] = NodeStory(
            name,
            log.member.names[name],
            STATES[state_of(outcome)],
            "" if ran else outcome.reason,
            "" if ran else outcome.origin,
            times_us[name],
            outcome if ran else None,
        )
    return found


def _errors(log: VariantLog) -> dict[int, dict[str, float]]:
    """Return by frame and quantity the signed error that is largest."""
    found: dict[int, dict[str, float]] = {}
    for quantity, errors in log.scorer.errors.items():
        for position, error in zip(errors.positions, errors.errors, strict=True):
            if math.isnan(error):
                continue
            here = found.setdefault(position, {})
            if abs(error) >= abs(here.get(quantity, 0.0)):
                here[quantity] = error
    return found
