"""``Answer``: what any step found, as places, lengths and axes, read off its fields' units."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import fields, is_dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tactile_graph.wires import Points, Polygon

Values = NDArray[np.float64]


class Answer(NamedTuple):
    """The geometry in a step's output.

    Parameters
    ----------
    places : ndarray, shape (K, 2)
        ``x_cm`` and ``y_cm`` of each record.
    lengths : ndarray, shape (M,)
        Other fields in cm.
    axes : ndarray, shape (A,)
        Fields ``angle_rad``: as seen, known up to half turns.
    cloud : ndarray, shape (N, 2)
        Points and corners, in no order.
    """

    places: Values
    lengths: Values
    axes: Values
    cloud: Values


class Off(NamedTuple):
    """How far an answer is from another, in cm; an angle counts by its arc."""

    most_cm: float
    size_cm: float


def answer_of(value: Any) -> Answer:
    """Return the geometry in a value."""
    found = list(_found(value))
    places = [v for kind, v in found if kind == "place"]
    clouds = [v for kind, v in found if kind == "cloud"]
    return Answer(
        np.array(places, dtype=np.float64).reshape(-1, 2),
        np.array([v for kind, v in found if kind == "length"], dtype=np.float64),
        np.array([v for kind, v in found if kind == "axis"], dtype=np.float64),
        np.concatenate([np.empty((0, 2)), *clouds]).astype(np.float64),
    )


def _found(value: Any) -> Iterator[tuple[str, Any]]:
    if isinstance(value, (Points, Polygon)):
        yield "cloud", value.xy_cm
        return
    names: tuple[str, ...] = getattr(value, "_fields", ())
    if is_dataclass(value) and not isinstance(value, type):
        names = tuple(f.name for f in fields(value))
    if "x_cm" in names and "y_cm" in names:
        yield "place", (value.x_cm, value.y_cm)
    for name in names:
        item = getattr(value, name)
        if not isinstance(item, float):
            yield from _found(item)
        elif name == "angle_rad":
            yield "axis", item
        elif name.endswith("_cm") and name not in ("x_cm", "y_cm"):
            yield "length", item


def off_by(got: Answer, want: Answer, size_cm: float) -> Off | None:
    """Return how far ``got`` is from ``want``; None where they do not have the same parts.

    Parameters
    ----------
    got, want : Answer
    size_cm : float
        Extent of what was measured: the answer counts as at least that large.
    """
    parts = zip(got[:3], want[:3], strict=True)
    if any(a.shape != b.shape for a, b in parts) or (len(got.cloud) == 0) != (len(want.cloud) == 0):
        return None
    size = max(size_cm, float(np.abs(want.lengths).max(initial=0.0)))
    most = [
        float(np.hypot(*(got.places - want.places).T).max(initial=0.0)),
        float(np.abs(got.lengths - want.lengths).max(initial=0.0)),
        size * float(np.abs(np.sin(got.axes - want.axes)).max(initial=0.0)),
        _apart(got.cloud, want.cloud),
    ]
    return Off(max(most), size)


def _apart(a: Values, b: Values) -> float:
    """Return the largest distance from a point of either set to the nearest of the other."""
    if len(a) == 0:
        return 0.0
    d = np.hypot(a[:, None, 0] - b[None, :, 0], a[:, None, 1] - b[None, :, 1])
    return float(max(d.min(axis=0).max(), d.min(axis=1).max()))


def half_extent(xy: Values) -> float:
    """Return half the larger side of the points' bounding box."""
    if len(xy) == 0:
        return 0.0
    low, high = xy.min(axis=0), xy.max(axis=0)
    return float((0.5 * high - 0.5 * low).max())


def largest(xy: Values) -> float:
    """Return the size of the largest coordinate."""
    return float(np.abs(xy).max(initial=0.0))
