"""Errors of rectangle pipelines on the two rectangles of table 4.6."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from tactile_graph import Frame

Array = NDArray[np.float64]
OBJECTS = ("RECTANGLE I", "RECTANGLE II")
PITCH_CM, STATED_CELL_CM = 1.3, 1.0
"""The pad's pitch, and what thesis section 4.3.8 calls a pixel."""


def rectangle_frames(n: int, seed: int = 0, **source: Any) -> list[Frame]:
    """Return ``n`` readings of each rectangle of table 4.6.

    Parameters
    ----------
    n : int
    seed : int
    **source
        Settings of `simulate` other than the scene ``rectangles``.
    """
    from tactile_graph import load

    settings: dict[str, Any] = {"scene": "rectangles", **source, "frames": len(OBJECTS) * n}
    return list(load("rectangle-1").with_source("simulate", **settings).frames(seed))


def signed_errors(
    run: Callable[[Frame], Any],
    frames: Iterable[Frame],
    cell_cm: float = PITCH_CM,
    corrected: bool = False,
) -> dict[str, Array]:
    """Return what a pipeline finds less what is true, object by object.

    Parameters
    ----------
    run : callable
        A pipeline's runner, whose results hold ``rectangle`` and perhaps ``axis``, from which
        the thesis reads the angle.
    frames : iterable of Frame
        With the truth.
    cell_cm : float
        Length that a cell is read as: sides are scaled by it over the pitch.
    corrected : bool
        Whether to take the sides that `rectangle_from_ellipse` corrects.

    Returns
    -------
    dict
        Object -> shape (readings, 4): angle in degrees modulo 180, length, breadth, and the
        distance of the centres, in cm. NaN in a reading without an answer.
    """
    rows: dict[str, list[tuple[float, ...]]] = {name: [] for name in OBJECTS}
    for frame in frames:
        assert frame.truth is not None
        true: Any = frame.truth[0].shape
        result = run(frame)
        found = result.get("rectangle")
        row: tuple[float, ...] = (math.nan,) * 4
        if found is not None:
            off_degree = angle_error_degree(result, true)
            found = found.corrected if corrected else found
            row = (
                off_degree,
                found.length_cm * cell_cm / PITCH_CM - true.length_cm,
                found.breadth_cm * cell_cm / PITCH_CM - true.breadth_cm,
                math.hypot(found.x_cm - true.x_cm, found.y_cm - true.y_cm),
            )
        rows[frame.truth[0].name].append(row)
    return {name: np.array(some).reshape(-1, 4) for name, some in rows.items()}


def angle_error_degree(result: Any, true: Any) -> float:
    """Return by how much an angle is off, modulo 180: the axis' where there is one.

    Parameters
    ----------
    result : Result
        With a ``rectangle`` that is there, and perhaps an ``axis``.
    true : Rectangle
    """
    found = result["axis"] if "axis" in result else result["rectangle"]
    return math.degrees(math.remainder(float(found.angle_rad) - true.angle_rad, math.pi))
