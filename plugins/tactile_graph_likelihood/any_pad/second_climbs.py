"""Likelier outlines by another climb, from where a frame says that one may have been missed."""

from __future__ import annotations

import math
from collections.abc import Iterable

from tactile_graph_likelihood.any_pad.clump import clump_of
from tactile_graph_likelihood.any_pad.elsewhere import (
    discs_around,
    grown_beyond,
    with_sides_moved,
    without_lone,
)
from tactile_graph_likelihood.geometry.outlines import DISC, RECTANGLE, Values
from tactile_graph_likelihood.single.model import Likeliest, Model
from tactile_graph_likelihood.single.readings import Readings

BEGUN = 3
"""Outlines that are climbed from, the likeliest of those that are tried."""


def around_few(model: Model, readings: Readings, found: Likeliest) -> Likeliest:
    """Return a likelier outline of few touched elements.

    Around what hangs together, where some lie apart; or a disc around all that are scattered, most
    of which reads nothing. By evidence: few elements hold an outline loosely, and a narrow top that
    is the highest may have the least room.
    """
    begins = _that_of(model, clump_of(readings))
    best = max([found, *_near_each(model, readings, begins)], key=_evidence)
    if model.kind != DISC or best.mode.height == -math.inf:
        return best
    tried = discs_around(readings, model.point_of(best))
    if tried is None:
        return best
    begins = list(model.likeliest_points(readings, tried, BEGUN))
    return max([best, *_near_each(model, readings, begins)], key=_evidence)


def among_strays(model: Model, readings: Readings, found: Likeliest) -> Likeliest:
    """Return a likelier outline near that of what has touched neighbours."""
    begins = _that_of(model, without_lone(readings))
    return max([found, *_near_each(model, readings, begins)], key=_height)


def likelier_elsewhere(model: Model, readings: Readings, found: Likeliest) -> Likeliest:
    """Return a likelier outline where it may reach beyond the pad, or where voids hide its ends."""
    p, begins = model.point_of(found), list[Values]()
    if model.kind != RECTANGLE:
        grown = grown_beyond(model.kind, readings, p)
        begins += [] if grown is None else [grown]
    elif (tried := with_sides_moved(readings, p)) is not None:
        begins += list(model.likeliest_points(readings, tried, BEGUN))
    return max([found, *_near_each(model, readings, begins)], key=_height)


def _that_of(model: Model, some: Readings | None) -> list[Values]:
    """Return the most likely outline of some of the readings, if there are any and it is one."""
    if some is None:
        return []
    its = model.likeliest(some)
    return [model.point_of(its)] if its.mode.height > -math.inf else []


def _near_each(model: Model, readings: Readings, begins: Iterable[Values]) -> list[Likeliest]:
    return [model.likeliest_near(readings, begin) for begin in begins]


def _height(its: Likeliest) -> float:
    return its.mode.height


def _evidence(its: Likeliest) -> float:
    return its.evidence
