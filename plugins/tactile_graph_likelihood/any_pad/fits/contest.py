"""Which of some kinds of outlines a frame leaves possible, each looked at as long as it may win."""

from __future__ import annotations

import math
from collections.abc import Mapping

from tactile_graph.errors import Degenerate
from tactile_graph_likelihood.any_pad.fits.localise import AnyPad
from tactile_graph_likelihood.any_pad.pad_effects.from_frame import variance_inflation
from tactile_graph_likelihood.geometry.outlines import (
    DISC,
    ELLIPSE,
    RECTANGLE,
    as_ellipse_of_disc,
)
from tactile_graph_likelihood.single.any_pressure import EVEN
from tactile_graph_likelihood.single.climbs.search import POOR, moments
from tactile_graph_likelihood.single.model import Likeliest
from tactile_graph_likelihood.single.readings import Readings

ROUND = 0.6
"""Variance of touched elements across over along from which on a disc is looked at first."""

HOPELESS = 12.0
"""Nats, over what neighbouring elements share, by which an even face's evidence is behind that of
another kind once it is no longer looked at: what explains the rest explains it for both."""

LOST = -5.0
"""Surprise below which an attempt has rather been caught somewhere than shown a kind's worth; where
a quick answer will do that is asked only if no other kind explains the readings."""

Tops = dict[str, Likeliest]


def tops_of_each(
    every: Mapping[str, AnyPad], readings: Readings
) -> tuple[Mapping[str, AnyPad], Readings, dict[str, Tops]]:
    """Return the most likely outlines of each kind, by pressure, and what they are found with.

    Parameters
    ----------
    every : mapping of str to AnyPad
        By the name of the kind.
    readings : Readings

    Returns
    -------
    mapping of str to AnyPad
        Fits that know of strays and told foam, as far as readings are likelier for these.
    Readings
        As of `AnyPad.cleared`.
    dict of str to dict
        Of a kind that is hopelessly behind, the even face's alone, roughly; a kind of which no
        outline is possible is left out.

    Raises
    ------
    Degenerate
        If none is possible.
    """
    found: dict[str, Likeliest] = {}
    if not readings.is_wide and len(every) > 1:
        readings, every, found = _first_look(every, readings)
    best = max(found.values(), key=lambda its: its.evidence, default=None)
    tops: dict[str, Tops] = {}
    reason = Degenerate("none of the shapes explains what is touched")
    for name, any_pad in [*every.items()]:
        try:
            if best is None:
                its, readings, even = any_pad.first(readings)
                every = {**every, name: its}
                tops[name] = its.completed(readings, even)
            elif _may_win(any_pad, found[name], best, readings.touched):
                tops[name] = any_pad.completed(readings, found[name], alone=False)
            else:
                tops[name] = {EVEN: found[name]}
        except Degenerate as why:
            reason = why
    if not tops:
        raise reason
    return every, readings, tops


def _first_look(
    every: Mapping[str, AnyPad], readings: Readings
) -> tuple[Readings, Mapping[str, AnyPad], dict[str, Likeliest]]:
    """Return what attempts find of each kind that may win, and roughly of the others.

    Before it readings as of `AnyPad.cleared`, by the kind that is looked at first. Where there are
    strays, with the fits that know of them: they compare where all know of as many.
    """
    kinds = {any_pad.told.kind: name for name, any_pad in every.items()}
    first = kinds.get(DISC if _is_round(readings) else RECTANGLE, next(iter(every)))
    begun, lead = every[first].begun(readings)
    lead = begun.sought(readings, lead)
    if lead.mode.height == -math.inf:
        return readings, every, {}
    knowing = begun
    if knowing is every[first] and (strays := knowing.strays(readings, lead)):
        knowing, lead = knowing.likelier_with(strays, readings, lead)
    if knowing is not every[first]:
        strays = knowing.told.noise.strays
        every = {name: any_pad.knowing(strays) for name, any_pad in every.items()}
    readings, lead = every[first].cleared(readings, lead)
    under, readings, lead = every[first].on_told_foam(readings, lead)
    if under is not every[first]:
        every = {name: any_pad.told_of_foam for name, any_pad in every.items()}
    found, is_disc = {first: lead}, every[first].told.kind == DISC and lead.fit.surprise > POOR
    for name, any_pad in every.items():
        if name == first:
            continue
        grown = is_disc and any_pad.told.kind == ELLIPSE
        its = any_pad.near(readings, as_ellipse_of_disc(lead.mode.p) if grown else None)
        best = max(found.values(), key=lambda one: one.evidence)
        if (its.unsure or not grown) and _may_win(any_pad, its, best, readings.touched):
            its = any_pad.searched(readings, its)
        found[name] = its
    return readings, *_knowing_as_many(every, readings, found)


def _knowing_as_many(
    every: Mapping[str, AnyPad], readings: Readings, found: dict[str, Likeliest]
) -> tuple[Mapping[str, AnyPad], dict[str, Likeliest]]:
    """Return fits that all know of the strays that the likeliest kind leaves, and what they find.

    Those given, if none of what they find is likelier for it.
    """
    first = max(found, key=lambda name: found[name].evidence)
    strays = every[first].strays(readings, found[first])
    if not strays:
        return every, found
    knowing = {name: any_pad.knowing(strays) for name, any_pad in every.items()}
    again = {name: its.again(readings, found[name]) for name, its in knowing.items()}
    best = max(its.evidence for its in again.values()) + every[first].bare_by(strays, readings)
    return (knowing, again) if best > found[first].evidence else (every, found)


def _may_win(any_pad: AnyPad, its: Likeliest, best: Likeliest, touched: int) -> bool:
    """Return whether an outline is not hopelessly behind another one, or only caught there."""
    if its.mode.height == -math.inf:
        return True
    caught = its.fit.surprise < LOST and any_pad.told.kind != DISC
    if caught and not (any_pad.quick and best.fit.surprise > POOR):
        return True
    shared = variance_inflation(best.fit.neighbours, touched)
    return best.evidence - its.evidence < HOPELESS * shared


def _is_round(readings: Readings) -> bool:
    """Return whether what is touched is about as wide as it is high, along any axis."""
    _, _, _, xx, xy, yy, _ = moments.call(readings.grid, readings.logs, readings.states).tolist()
    middle, off = 0.5 * (xx + yy), math.hypot(0.5 * (xx - yy), xy)
    return bool(middle - off >= ROUND * (middle + off))
