"""Outlines under two pressures at once: what leans, or lies under foam, and falls or leans, too."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np

from tactile_graph_likelihood.any_pad.fits.pressure_chances import FOAM
from tactile_graph_likelihood.geometry.outlines import Values
from tactile_graph_likelihood.single.any_pressure import BOTH, CLEAR, COUNTS, EVEN, RISE
from tactile_graph_likelihood.single.model import Likeliest, Model
from tactile_graph_likelihood.single.readings import Readings

LEAN = "lean"

PARTS: dict[str, tuple[str, ...]] = {EVEN: (), RISE: ("profile",), **BOTH}
"""What a pressure estimates beside an even face's numbers, where it has another name than that."""

CLEARLY, FAR = 5.0, 15.0
"""Nats by which another pressure is clearly likelier, and by which one beside foam must be: foam is
not quite as it is modelled."""

PROFILED = 1.5
"""Deviations by which residuals under a lean fall or rise to the rim from which on that is sought
with it."""


def under_two(
    fit: Callable[[str], Model],
    point_of: Callable[[Likeliest], Values],
    readings: Readings,
    found: Mapping[str, Likeliest],
) -> dict[str, Likeliest]:
    """Return outlines under the best pressure and another that is likelier than that alone.

    Parameters
    ----------
    fit : callable
        Returns the model of a pressure.
    point_of : callable
        Returns a top in the outline's own numbers.
    readings : Readings
    found : mapping of str to Likeliest
        By pressure, an even face's among them.
    """
    best = max(found, key=lambda part: found[part].evidence)
    top, more = found[best], {}
    if top.evidence < found[EVEN].evidence + CLEARLY:
        return {}
    p, least = point_of(top), FAR if best == FOAM else 0.0
    for both, (part, other) in BOTH.items():
        if part != best or not _leaves(top, part, other):
            continue
        begin = np.concatenate([p[:-2], np.zeros(COUNTS[other]), p[-2:]])
        its = fit(both).likeliest_near(readings, begin)
        if its.evidence > top.evidence + least:
            more[both] = its
    return more


def _leaves(top: Likeliest, part: str, other: str) -> bool:
    """Return whether a fit under a pressure leaves so much of another that it is worth its time."""
    if other == LEAN:
        return top.fit.lean >= CLEAR.lean
    return part == FOAM or abs(top.fit.fall) >= PROFILED
