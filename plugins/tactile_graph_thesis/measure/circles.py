"""Errors of circle pipelines on discs whose place and radius are known."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tactile_graph import Frame

Array = NDArray[np.float64]


def circle_errors(frames: Sequence[Frame], runners: Sequence[Any], objects: Sequence[str]) -> Array:
    """Return errors of centre x, centre y and radius, shape (runners, objects, readings, 3).

    Parameters
    ----------
    frames : sequence of Frame
        As many of each object.
    runners : sequence of callable
        From a frame to a result with an output ``circle``.
    objects : sequence of str
        Names of the true discs, in the order wanted.

    Notes
    -----
    Errors are absolute, in cm. A reading without an answer counts as an error of its object's
    own radius.
    """
    return np.abs(signed_circle_errors(frames, runners, objects))


def signed_circle_errors(
    frames: Sequence[Frame], runners: Sequence[Any], objects: Sequence[str]
) -> Array:
    """Return the same with the sign: found less true; without an answer, less the radius.

    Parameters
    ----------
    frames, runners, objects
        As in `circle_errors`.
    """
    place = {name: k for k, name in enumerate(objects)}
    found: list[list[list[tuple[float, ...]]]] = [[[] for _ in objects] for _ in runners]
    for frame in frames:
        assert frame.truth is not None
        true = frame.truth[0]
        for runner, rows in zip(runners, found, strict=True):
            rows[place[true.name]].append(_error(runner(frame).get("circle"), true.shape))
    return np.array(found)


def _error(circle: Any, true: Any) -> tuple[float, ...]:
    if circle is None:
        return (-true.radius_cm,) * 3
    return (
        circle.x_cm - true.x_cm,
        circle.y_cm - true.y_cm,
        circle.radius_cm - true.radius_cm,
    )
