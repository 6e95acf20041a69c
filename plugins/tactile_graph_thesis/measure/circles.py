"""Errors of circle pipelines on discs whose place and radius are known: tables 4.3 to 4.5."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tactile_graph import Frame

Array = NDArray[np.float64]
PIPELINES = {"table-4.3": "circle-1", "table-4.4": "circle-2", "table-4.5": "circle-3"}
"""Which pipeline a table of the thesis belongs to."""


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


def grouped(errors: Array, group: int) -> Array:
    """Return the readings of each object in groups, shape (..., groups, group, 3).

    Parameters
    ----------
    errors : ndarray, shape (..., readings, 3)
    group : int
        Readings that are left over are left out.
    """
    n = errors.shape[-2] // group
    kept = errors[..., : n * group, :]
    return kept.reshape(*errors.shape[:-2], n, group, errors.shape[-1])


def max_and_average(errors: Array, group: int) -> Array:
    """Return maximum and average errors as the thesis tabulates them, shape (..., 6).

    Parameters
    ----------
    errors : ndarray, shape (..., readings, 3)
        Absolute errors.
    group : int
        The maximum is the mean over groups of so many readings of each group's maximum.
    """
    largest, mean = grouped(errors, group).max(axis=-2).mean(axis=-2), errors.mean(axis=-2)
    return np.stack([largest, mean], axis=-1).reshape(*errors.shape[:-2], 6)
