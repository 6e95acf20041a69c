"""The experiments of thesis section 4.3 on the simulated pad: tables 4.7 and 4.8."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from tactile_graph import Frame

Array = NDArray[np.float64]
PITCH_CM, STATED_CELL_CM = 1.3, 1.0
"""The pad's pitch, and what thesis section 4.3.8 calls a pixel."""
GROUP = 20
"""Readings of an object whose maximum a table gives: the thesis' choice in section 4.1."""
QUANTITIES = (("angle", "degrees"), ("length", "cm"), ("breadth", "cm"))
# Tables 4.7 and 4.8: (maximum, average) of angle, length and breadth.
THESIS: Mapping[str, Mapping[str, tuple[tuple[float, float], ...]]] = {
    "rectangle-1": {
        "RECTANGLE I": ((21.0, 10.6), (4.9, 3.9), (1.9, 1.1)),
        "RECTANGLE II": ((9.0, 4.8), (3.4, 1.9), (3.4, 1.7)),
    },
    "rectangle-2": {
        "RECTANGLE I": ((21.0, 10.6), (4.9, 3.8), (1.7, 1.0)),
        "RECTANGLE II": ((9.0, 4.8), (3.3, 1.6), (1.6, 1.3)),
    },
}
OBJECTS = tuple(THESIS["rectangle-1"])


class Compared(NamedTuple):
    """One number of a table beside the thesis'.

    Parameters
    ----------
    object : str
        ``RECTANGLE I`` or ``RECTANGLE II``.
    quantity, statistic, unit : str
        Such as ``length``, ``average`` and ``cm``.
    ours, thesis : float
    """

    object: str
    quantity: str
    statistic: str
    unit: str
    ours: float
    thesis: float

    @property
    def ratio(self) -> float:
        """Ours over the thesis'."""
        return self.ours / self.thesis


class ErrorTable(NamedTuple):
    """A table of the thesis beside ours.

    Parameters
    ----------
    rows : tuple of Compared
    missing : mapping
        Object -> readings without an answer, which are left out.
    n : int
        Readings of each object.
    """

    rows: tuple[Compared, ...]
    missing: Mapping[str, int]
    n: int


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

    settings: dict[str, Any] = {"scene": "rectangles", **source, "frames": 2 * n}
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
            angle_rad = _angle_rad(result, found)
            found = found.corrected if corrected else found
            row = (
                math.degrees(math.remainder(angle_rad - true.angle_rad, math.pi)),
                found.length_cm * cell_cm / PITCH_CM - true.length_cm,
                found.breadth_cm * cell_cm / PITCH_CM - true.breadth_cm,
                math.hypot(found.x_cm - true.x_cm, found.y_cm - true.y_cm),
            )
        rows[frame.truth[0].name].append(row)
    return {name: np.array(some).reshape(-1, 4) for name, some in rows.items()}


def _angle_rad(result: Any, found: Any) -> float:
    if "axis" in result:
        return float(result["axis"].angle_rad)
    return float(found.angle_rad)


def beside_thesis(pipeline: str, errors: Mapping[str, Array]) -> ErrorTable:
    """Return maximum and average of absolute errors beside the thesis' table.

    Parameters
    ----------
    pipeline : str
        ``rectangle-1`` for table 4.7, ``rectangle-2`` for table 4.8.
    errors : mapping
        From `signed_errors`.

    Notes
    -----
    "Maximum" is the mean over groups of 20 readings of each group's maximum.
    """
    rows: list[Compared] = []
    for name in OBJECTS:
        for k, (quantity, unit) in enumerate(QUANTITIES):
            for statistic, ours, thesis in zip(
                ("maximum", "average"),
                _maximum_and_average(np.abs(errors[name][:, k])),
                THESIS[pipeline][name][k],
                strict=True,
            ):
                rows.append(Compared(name, quantity, statistic, unit, ours, thesis))
    missing = {name: int(np.isnan(errors[name][:, 0]).sum()) for name in OBJECTS}
    return ErrorTable(tuple(rows), missing, len(errors[OBJECTS[0]]))


def _maximum_and_average(off: Array) -> tuple[float, float]:
    good = off[np.isfinite(off)]
    if not len(good):
        return math.nan, math.nan
    n = max(len(good) // GROUP, 1)
    largest = [float(part.max()) for part in np.array_split(good, n)]
    return float(np.mean(largest)), float(good.mean())


def table_4_7(n: int = 500, seed: int = 0, cell_cm: float = PITCH_CM) -> ErrorTable:
    """Return the errors of the first rectangular localisation beside the thesis'.

    Parameters
    ----------
    n : int
        Readings of each rectangle.
    seed : int
    cell_cm : float
        `PITCH_CM`, or `STATED_CELL_CM` to read cells as thesis section 4.3.8 does.
    """
    return _table("rectangle-1", n, seed, cell_cm)


def table_4_8(n: int = 500, seed: int = 0, cell_cm: float = PITCH_CM) -> ErrorTable:
    """Return the errors of the second rectangular localisation beside the thesis'.

    Parameters
    ----------
    n : int
        Readings of each rectangle.
    seed : int
    cell_cm : float
        `PITCH_CM`, or `STATED_CELL_CM` to read cells as thesis section 4.3.8 does.
    """
    return _table("rectangle-2", n, seed, cell_cm)


def _table(pipeline: str, n: int, seed: int, cell_cm: float) -> ErrorTable:
    from tactile_graph import load

    run = load(pipeline).runner()
    return beside_thesis(pipeline, signed_errors(run, rectangle_frames(n, seed), cell_cm))
