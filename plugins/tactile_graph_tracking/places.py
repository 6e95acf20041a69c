"""Where things lie: the centres of contacts or shapes, checked."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tactile_graph.errors import DataError


def placed(thing: Any) -> Any:
    """Return what of a thing has a place: itself, or the shape that was decided on."""
    return thing if hasattr(thing, "x_cm") else getattr(thing, "shape", thing)


def places_cm(things: Sequence[Any], where: str) -> NDArray[np.float64]:
    """Return the centres, shape (N, 2), x and y in cm.

    Parameters
    ----------
    things : sequence
        Contacts, shapes, or anything else with ``x_cm`` and ``y_cm``, or with a ``shape`` that has
        them.
    where : str
        Who asks, for the message.

    Raises
    ------
    DataError
        If one has no centre, or a centre that is no number.
    """
    xy = np.empty((len(things), 2))
    for i, thing in enumerate(things):
        try:
            held = placed(thing)
            xy[i] = held.x_cm, held.y_cm
        except (AttributeError, TypeError, ValueError):
            kind = type(thing).__name__
            raise DataError(
                where, f"item {i + 1} must have x_cm and y_cm that are numbers, got a {kind}"
            ) from None
        if not (math.isfinite(xy[i, 0]) and math.isfinite(xy[i, 1])):
            got = f"({xy[i, 0]}, {xy[i, 1]})"
            raise DataError(where, f"item {i + 1}: its centre must be finite, got {got}")
    return xy
