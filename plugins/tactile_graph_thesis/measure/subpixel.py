"""Error and time of circle-3 against the number of parts each element is cut into."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tactile_graph_thesis.measure.circles import signed_circle_errors
from tactile_graph_thesis.work import Work

Array = NDArray[np.float64]
FACTORS = (1, 2, 3, 4, 5, 6, 8, 10, 12, 16)
QUICK_FACTORS = (1, 2, 4, 8)
OBJECTS = ("DISC I", "DISC II", "DISC III")
MOST_TIMED = 60
"""Readings that are timed."""
KINDS: dict[str, Callable[[int], str]] = {
    "element of 5 × 5 cells": lambda _: "disc5",
    "element of one pitch's radius": lambda factor: f"disc:{2 * factor + 1}",
}
"""How the structuring element goes with the factor: as many cells, or as many centimetres."""


class SubpixelErrors(NamedTuple):
    """Errors of circle-3 for each factor and kind of structuring element.

    Parameters
    ----------
    factors : tuple of int
        Cells a side.
    error_cm : ndarray, shape (kinds, factors, readings, 3)
        Of centre x, centre y and radius, found less true, over the discs of table 4.2.
    time_us : ndarray, shape (kinds, factors)
        Median time of a frame.
    """

    factors: tuple[int, ...]
    error_cm: Array
    time_us: Array

    @property
    def radius_cm(self) -> Array:
        """Mean size of the radius error, shape (kinds, factors)."""
        return np.asarray(np.abs(self.error_cm[..., 2]).mean(axis=-1))

    @property
    def bias_cm(self) -> Array:
        """Mean radius error, shape (kinds, factors)."""
        return np.asarray(self.error_cm[..., 2].mean(axis=-1))

    @property
    def centre_cm(self) -> Array:
        """Mean distance of the centre, shape (kinds, factors)."""
        return np.asarray(np.hypot(self.error_cm[..., 0], self.error_cm[..., 1]).mean(axis=-1))


def subpixel_errors(work: Work) -> SubpixelErrors:
    """Return the errors and times of circle-3 for rising factors.

    Parameters
    ----------
    work : Work
    """
    return work.once("subpixels", lambda: _measured(work))


def _measured(work: Work) -> SubpixelErrors:
    from tactile_graph import load

    factors = QUICK_FACTORS if work.quick else FACTORS
    base = load("circle-3")
    frames = work.frames("discs", len(OBJECTS) * work.readings)
    runners: list[Any] = []
    for element_of in KINDS.values():
        for factor in factors:
            element = element_of(factor)
            settings = {
                "fine.factor": factor,
                "eroded.element": element,
                "dilated.element": element,
            }
            runners.append(base.with_settings(settings).runner(seed=work.seed))
    errors = signed_circle_errors(frames, runners, OBJECTS)
    shape = (len(KINDS), len(factors))
    times = _times_us(runners, frames[:MOST_TIMED])
    return SubpixelErrors(factors, errors.reshape(*shape, -1, 3), times.reshape(shape))


def _times_us(runners: list[Any], frames: list[Any]) -> Array:
    """Return each runner's median time of a frame; all take turns, frame by frame."""
    spent = np.empty((len(frames), len(runners)))
    for k, frame in enumerate(frames):
        for j, runner in enumerate(runners):
            start = time.perf_counter()
            runner(frame)
            spent[k, j] = time.perf_counter() - start
    return np.asarray(1e6 * np.median(spent, axis=0))
