"""How likely each pressure is by the fits under it, and what is told of them together."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from tactile_graph_likelihood.any_pad.pad_effects.from_frame import variance_inflation
from tactile_graph_likelihood.single.any_pressure import BOTH, EVEN, FOAM_ODDS, chances, log_of
from tactile_graph_likelihood.single.model import Likeliest

FALL, FOAM = "fall", "foam"

OWN_ODDS = 1.0
"""Of foam under which elements keep their own gains over a round face, before a frame is read."""

TWO = 0.2
"""Of faces that lean or lie under foam and leave another pressure's pattern, those under both."""

FARTHEST = 4.0
"""Nats by which a round face and foam can be told apart at most: each is but like what it is for,
and what is off by that passes for evidence."""


def on_foam(pressures: Mapping[str, float]) -> dict[str, float]:
    """Return how likely each pressure is, where an even face's readings had foam undone."""
    found = {part: chance for part, chance in pressures.items() if part != EVEN}
    return {FOAM: pressures.get(EVEN, 0.0) + found.pop(FOAM, 0.0), **found}


def shared_by(tops: Iterable[Likeliest], touched: int) -> float:
    """Return by how much elements count for less, since neighbours hang together in any fit."""
    return min(variance_inflation(top.fit.neighbours, touched) for top in tops)


def log_chances(
    tops: Mapping[str, Likeliest],
    shared: float,
    touched: int,
    foam_odds: float = FOAM_ODDS,
    own_odds: float = OWN_ODDS,
) -> dict[str, float]:
    """Return the log probability of each pressure with its fit, up to a constant.

    Evidence takes elements for independent; it is worth as many times less as they are ``shared``,
    and tells a round face from foam no farther than `FARTHEST`.
    ``foam_odds`` and ``own_odds`` as in `chances`.
    """
    before = {EVEN: 1.0}
    if len(tops) > 1:
        others = {part: top.fit for part, top in tops.items() if part != EVEN}
        plain = {part: fit for part, fit in others.items() if part not in BOTH}
        before = chances(plain, touched, foam_odds, own_odds)
        for both, (part, _) in BOTH.items():
            if both in others:
                before |= {both: TWO * before[part], part: (1.0 - TWO) * before[part]}
    logs = {part: top.evidence / shared for part, top in tops.items()}
    if FALL in logs and FOAM in logs:
        better, worse = sorted((FALL, FOAM), key=logs.__getitem__, reverse=True)
        behind = logs[better] - logs[worse]
        logs[worse] = logs[better] - behind / (1.0 + behind / FARTHEST)
    return {part: log + log_of(before[part]) for part, log in logs.items()}
