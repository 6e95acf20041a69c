"""Likelier outlines by another climb, where a frame says that the first may have missed one."""

from __future__ import annotations

import math

from tactile_graph_likelihood.any_pad.observation.clump import clump_of, without_lone
from tactile_graph_likelihood.any_pad.pad_effects.from_frame import half_extents
from tactile_graph_likelihood.geometry.outlines import RECTANGLE, Values, sizes
from tactile_graph_likelihood.single.model import Likeliest, Model
from tactile_graph_likelihood.single.readings import Readings

GROWN = 1.3
"""By how much a round outline is larger that goes on beyond the pad's edge."""


def around_clump(model: Model, readings: Readings, found: Likeliest) -> Likeliest:
    """Return a likelier outline around what hangs together, where some elements lie apart."""
    return _near_that_of(model, readings, clump_of(readings), found)


def among_strays(model: Model, readings: Readings, found: Likeliest) -> Likeliest:
    """Return a likelier outline near that of what has touched neighbours."""
    return _near_that_of(model, readings, without_lone(readings), found)


def beyond_the_edge(model: Model, readings: Readings, found: Likeliest) -> Likeliest:
    """Return a likelier round outline where one reaches beyond the pad's edge."""
    if model.kind == RECTANGLE:
        return found
    grown = grown_beyond(model.kind, readings, model.point_of(found))
    return found if grown is None else _likelier(model, readings, grown, found)


def _near_that_of(
    model: Model, readings: Readings, some: Readings | None, found: Likeliest
) -> Likeliest:
    """Return a likelier outline near that of some of the readings."""
    if some is None:
        return found
    its = model.likeliest(some)
    if its.mode.height == -math.inf:
        return found
    return _likelier(model, readings, model.point_of(its), found)


def _likelier(model: Model, readings: Readings, begin: Values, found: Likeliest) -> Likeliest:
    """Return the outline near a point, if it is likelier than what was found."""
    near = model.likeliest_near(readings, begin)
    return near if near.mode.height > found.mode.height else found


def grown_beyond(kind: int, readings: Readings, p: Values) -> Values | None:
    """Return a round outline larger by what may lie beyond the pad's edge, shape (K,).

    Its rim on the pad stays where it is: of what the edge cuts off the touched elements' moments
    make a smaller outline. None where it lies on the pad whole.
    """
    left, top = readings.grid[:2].tolist()
    (x, y), (width, height) = p[:2].tolist(), readings.size_cm
    wide, high = half_extents(kind, p)
    right = float(x + wide > left + width) - float(x - wide < left)
    down = float(y + high > top + height) - float(y - high < top)
    if right == 0.0 and down == 0.0:
        return None
    grown, more = p.copy(), (GROWN - 1.0) / math.hypot(right, down)
    grown[2 : 2 + sizes.call(kind)] *= GROWN
    grown[0] = min(max(x + more * wide * right, left), left + width)
    grown[1] = min(max(y + more * high * down, top), top + height)
    return grown
