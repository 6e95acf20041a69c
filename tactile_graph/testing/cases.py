"""What a step is tried on: an ordinary frame, and all that sensors and other steps make of one.

A case is plain arrays; `Case.image`, `Case.mask` and `Case.points` make new values of them at each
call, so that a step that writes into what it is given spoils no other trial.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tactile_graph.wires import Image, Mask, Points

PITCH_CM = (1.3, 1.3)
SHAPE = (8, 9)
"""Rows and columns of the ordinary pad."""
RANGES = {
    "counts": 500.0,
    "volt": 1.0,
    "siemens": 1e-3,
    "gram": 30.0,
    "kilopascal": 10.0,
    "raw": 500.0,
    "level": 8.0,
    "binary": 1.0,
}
"""What a well pressed cell of each quantity holds."""
ORDINARY = "an ordinary frame"


@dataclass(frozen=True)
class Case:
    """One situation a step may meet.

    Parameters
    ----------
    name : str
        As it is told: ``a NaN in a valid cell``.
    values : ndarray, shape (rows, columns)
        A well pressed cell holds 1, unless ``scaled`` is False.
    on : ndarray of bool, shape (rows, columns)
        The mask.
    xy_cm : ndarray of float64, shape (N, 2)
        The points.
    pitch_cm : (float, float)
    valid : ndarray of bool, shape (rows, columns), optional
        Where the cells are good; everywhere if not given.
    scaled : bool
        Whether values are brought to the range of their quantity.
    number : float, optional
        What every number of every other record becomes: of circles, axes, features.
    """

    name: str
    values: NDArray[Any]
    on: NDArray[np.bool_]
    xy_cm: NDArray[np.float64]
    pitch_cm: tuple[float, float] = PITCH_CM
    valid: NDArray[np.bool_] | None = None
    scaled: bool = True
    number: float | None = None

    def image(self, quantity: str) -> Image:
        """Return the image, its values in the range of the quantity."""
        values = self.values.copy()
        if self.scaled:
            values = values * RANGES.get(quantity, 1.0)
        valid = None if self.valid is None else self.valid.copy()
        return Image(values, self.pitch_cm, (0.0, 0.0), quantity, valid)

    def mask(self) -> Mask:
        """Return the mask, on the image's grid."""
        return Mask(self.on.copy(), self.pitch_cm)

    def points(self) -> Points:
        """Return the points."""
        return Points(self.xy_cm.copy())


def ordinary() -> Case:
    """Return two objects on a small pad, noise of 1 % on the cells under them."""
    values = _pressed(SHAPE, 3.4, 3.1, 2.3) + 0.7 * _pressed(SHAPE, 7.2, 5.6, 1.5)
    rng = np.random.default_rng(1)
    values = values * (1.0 + 0.01 * rng.standard_normal(SHAPE))
    return Case(ORDINARY, values, values > 0.3, _outline(rng))


def all_cases() -> Iterator[Case]:
    """Yield every case, the ordinary one first."""
    usual = ordinary()
    yield usual
    yield from _grids(usual)
    yield from _cells(usual)
    yield from _types(usual)
    yield from _pitches(usual)
    yield from _masks(usual)
    yield from _points(usual)
    yield from _numbers(usual)


def _pressed(
    shape: tuple[int, int], column: float, row: float, radius: float
) -> NDArray[np.float64]:
    """Return the load of a soft disc, in cells: 1 within, down to 0 over a cell at the rim."""
    y, x = np.mgrid[: shape[0], : shape[1]] + 0.5
    return np.asarray(np.clip(radius + 0.5 - np.hypot(x - column, y - row), 0.0, 1.0))


def _outline(rng: np.random.Generator) -> NDArray[np.float64]:
    """Return 24 points around a turned oval, scattered by 0.03 cm."""
    t = np.arange(24) * (2.0 * math.pi / 24)
    u, v = 3.0 * np.cos(t), 2.0 * np.sin(t)
    cos, sin = math.cos(0.4), math.sin(0.4)
    xy = np.column_stack([5.0 + u * cos - v * sin, 5.2 - u * sin - v * cos])
    return np.asarray(xy + rng.normal(0.0, 0.03, xy.shape))


def _grids(usual: Case) -> Iterator[Case]:
    none = np.empty((0, 2))
    for name, rows, columns in (
        ("an image without cells", 0, 0),
        ("an image without columns", 5, 0),
        ("a single cell", 1, 1),
        ("a single row", 1, 9),
        ("a single column", 8, 1),
        ("two by two cells", 2, 2),
    ):
        values = usual.values[2 : 2 + rows, :columns] if rows < 8 else usual.values[:, 3:4]
        # The mask of a few cells is all of them: an empty mask is a case of its own.
        yield replace(
            usual,
            name=name,
            values=np.maximum(values, 0.2),
            on=np.ones(values.shape, dtype=np.bool_),
            xy_cm=none if not values.size else usual.xy_cm[: values.size],
        )


def _cells(usual: Case) -> Iterator[Case]:
    nothing = np.zeros(SHAPE)
    off = np.zeros(SHAPE, dtype=np.bool_)
    yield replace(usual, name="nothing pressed", values=nothing, on=off, xy_cm=np.empty((0, 2)))
    yield replace(usual, name="every cell the same", values=nothing + 1.0, on=~off)
    yield replace(usual, name="negative values", values=-usual.values)
    holes = np.ones(SHAPE, dtype=np.bool_)
    holes[2, 3] = holes[5, :] = False
    kept = np.where(holes, usual.values, 0.0)
    yield replace(usual, name="some cells invalid", values=kept, on=usual.on & holes, valid=holes)
    yield replace(usual, name="all cells invalid", values=nothing, on=off, valid=off)
    for name, number in (("NaN", math.nan), ("infinity", math.inf)):
        values = usual.values.copy()
        values[2, 3] = number
        yield replace(usual, name=f"{name} in a valid cell", values=values)
    yield replace(usual, name="NaN in every cell", values=nothing + math.nan)
    for size in (1e100, 1e300, 1e-100, 1e-300):
        name = f"values of {size:g}"
        yield replace(usual, name=name, values=usual.values * size, scaled=False)


def _types(usual: Case) -> Iterator[Case]:
    for kind, size in (
        (np.bool_, 1.0),
        (np.uint8, 200.0),
        (np.int64, 500.0),
        (np.float16, 1.0),
        (np.float32, 1.0),
    ):
        values = np.where(usual.values > 0.3, usual.values * size, 0.0).astype(kind)
        name = f"values of type {np.dtype(kind).name}"
        yield replace(usual, name=name, values=values, scaled=False)


def _pitches(usual: Case) -> Iterator[Case]:
    for name, x_cm, y_cm in (
        ("an unequal pitch", 0.5, 1.7),
        ("a very unequal pitch", 0.02, 50.0),
        ("a pitch of 1e-6 by 1e6 cm", 1e-6, 1e6),
        ("a tiny pitch of 1e-6 cm", 1e-6, 1e-6),
        ("a huge pitch of 1e6 cm", 1e6, 1e6),
    ):
        scale = (x_cm / PITCH_CM[0], y_cm / PITCH_CM[1])
        yield replace(usual, name=name, pitch_cm=(x_cm, y_cm), xy_cm=usual.xy_cm * scale)


def _masks(usual: Case) -> Iterator[Case]:
    off = np.zeros(SHAPE, dtype=np.bool_)
    one = off.copy()
    one[3, 3] = True
    line = off.copy()
    line[3, 1:7] = True
    for name, on in (
        ("an empty mask", off),
        ("a full mask", ~off),
        ("a mask of one cell", one),
        ("a mask of one row", line),
    ):
        yield replace(usual, name=name, on=on)


def _points(usual: Case) -> Iterator[Case]:
    xy = usual.xy_cm
    for name, some in (
        ("no points", xy[:0]),
        ("one point", xy[:1]),
        ("two points", xy[:2]),
        ("three points", xy[:3]),
        ("all points in one place", np.tile(xy[:1], (9, 1))),
        ("points on a line", np.outer(np.arange(9.0), (1.3, 0.4)) + 1.0),
    ):
        yield replace(usual, name=name, xy_cm=some)


def _numbers(usual: Case) -> Iterator[Case]:
    """Yield cases of points and records: one NaN point, or all numbers huge, tiny, no number."""
    xy = usual.xy_cm.copy()
    xy[3, 1] = math.nan
    yield replace(usual, name="NaN in points and records", xy_cm=xy, number=math.nan)
    xy = usual.xy_cm.copy()
    xy[3, 1] = math.inf
    yield replace(usual, name="infinity in points and records", xy_cm=xy, number=math.inf)
    for size in (1e100, 1e300, 1e-100, 1e-300):
        name = f"points and records of {size:g}"
        yield replace(usual, name=name, xy_cm=usual.xy_cm * size, number=size)
    yield replace(usual, name="records of zeros", number=0.0)
    yield replace(usual, name="records of negative numbers", number=-3.0)
