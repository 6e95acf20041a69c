"""Spell out the frames that were kept: every variant's nodes, in its own names."""

from __future__ import annotations

import math

from tactile_graph_compare.records.frames import ChosenFrame
from tactile_graph_compare.run.logs import VariantLog
from tactile_graph_compare.run.session import Session


def chosen_frames(session: Session) -> tuple[ChosenFrame, ...]:
    """Return the frames a session's chooser has chosen, in order."""
    errors = {log.prepared.label: _errors(log) for log in session.logs}
    found = []
    for position, held, choices in session.chooser.chosen():
        frame, told = session.told(held)
        here = {label: of.get(position, {}) for label, of in errors.items()}
        found.append(ChosenFrame(position, frame, choices, told, here))
    return tuple(found)


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
