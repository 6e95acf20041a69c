"""``Points``: positions on the pad."""

from __future__ import annotations

from typing import Any, NoReturn

import numpy as np
from numpy.typing import NDArray

from tactile_graph.wires.native import NATIVE, native


class Points:
    """Positions in pad coordinates. Takes ownership: the array becomes read-only.

    Parameters
    ----------
    xy_cm : ndarray of float64, shape (N, 2)
        x right and y down from the top left corner of the pad.
    """

    __slots__ = ("xy_cm",)
    xy_cm: NDArray[np.float64]

    def __init__(self, xy_cm: NDArray[np.float64]) -> None:
        if xy_cm.dtype not in NATIVE:
            xy_cm = native(xy_cm)
        xy_cm.setflags(False)  # type: ignore[call-arg]  # by keyword it takes twice as long
        _set_xy(self, xy_cm)

    def __setattr__(self, name: str, value: object) -> NoReturn:
        raise AttributeError(f"Points is frozen: cannot set {name!r}")

    def __reduce__(self) -> tuple[type[Points], tuple[Any, ...]]:
        """Copy and pickle by what it is made of: another process's points are as frozen."""
        return Points, (self.xy_cm,)

    @property
    def count(self) -> int:
        """Number of points."""
        return len(self.xy_cm)

    def __repr__(self) -> str:
        return f"<Points {self.count}>"


_slots: Any = vars(Points)
_set_xy = _slots["xy_cm"].__set__


class _OpenPoints(Points):  # as of images
    __slots__ = ()
    __init__ = object.__init__
    __setattr__ = object.__setattr__  # type: ignore[assignment]


def quick_points(xy_cm: NDArray[np.float64]) -> Points:
    """Return ``Points(xy_cm)`` in half the time."""
    xy_cm.setflags(False)  # type: ignore[call-arg]
    points: Any = _OpenPoints()
    points.xy_cm = xy_cm
    points.__class__ = Points
    return points  # type: ignore[no-any-return]
