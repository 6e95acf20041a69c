"""Spell out the frames that were kept: every variant's nodes, in its own names."""

from __future__ import annotations

import math

from tactile_graph.api.result import Result
from tactile_graph.pipeline.wiring import Ref
from tactile_graph_compare.records.frames import ChosenFrame, NodeStory
from tactile_graph_compare.records.graph import STATES
from tactile_graph_compare.run.session import Session, VariantLog
from tactile_graph_compare.run.variant_result import NOT_SETTLED, RAN, OwnResult


def chosen_frames(session: Session) -> tuple[ChosenFrame, ...]:
    """Return the frames a session's keeper has chosen, in order."""
    errors = {log.prepared.label: _errors(log) for log in session.logs}
    return tuple(
        ChosenFrame(
            position,
            result.frame,
            choices,
            {log.prepared.label: stories(result, log) for log in session.logs},
            {label: of.get(position, {}) for label, of in errors.items()},
        )
        for position, result, choices in session.keeper.chosen()
    )


def stories(result: Result, log: VariantLog) -> dict[str, NodeStory]:
    """Return what each node of a variant came to in one frame, as it alone would have."""
    own = OwnResult(result, log.member)
    states, times_us = own.states(), result.times_us
    found = {}
    for name in log.nodes:
        merged = log.member.names[name]
        state = states.get(name, NOT_SETTLED)
        if state == NOT_SETTLED:
            found[name] = NodeStory(name, merged, STATES[0], "nothing asked for it", "", 0.0, None)
            continue
        outcome = own.outcome_at(Ref(name))
        ran = state == RAN
        found[name] = NodeStory(
            name,
            merged,
            STATES[state],
            "" if ran else outcome.reason,
            "" if ran else outcome.origin,
            times_us[merged],
            outcome if ran else None,
        )
    return found


def _errors(log: VariantLog) -> dict[int, dict[str, float]]:
    """Return by frame and quantity the signed error that is largest."""
    found: dict[int, dict[str, float]] = {}
    for quantity, targets in log.scorer.targets.items():
        for position, error in zip(targets.positions, targets.errors, strict=True):
            if math.isnan(error):
                continue
            here = found.setdefault(position, {})
            if abs(error) >= abs(here.get(quantity, 0.0)):
                here[quantity] = error
    return found
