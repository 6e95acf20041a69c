"""``Frame``: one image of a pad in time, and, if known, what truly lay there."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from tactile_graph.errors import did_you_mean
from tactile_graph.wires.image import QUANTITIES, Image
from tactile_graph.wires.shapes import Shape


@dataclass(frozen=True, slots=True)
class TrueObject:
    """An object that truly lay on the pad when the frame was taken."""

    shape: Shape
    weight_g: float | None = None
    name: str = ""


@dataclass(frozen=True, slots=True, eq=False)
class Frame:
    """One image with its place in time.

    Parameters
    ----------
    image : Image
    index : int
        Number of the frame in its source, from 0.
    time_s : float
        When it was taken, in the source's own clock; None where the source keeps none.
    truth : tuple of TrueObject, optional
        What truly lay on the pad; None where nobody knows.
    device_time_s : float, optional
        The device's own time stamp, where it sends one.
    gap : bool
        True where frames were lost just before this one.
    label : str
        Which sensor or file the frame comes from, where a source has several.
    doubtful : bool
        True where the source cannot tell whether the values lie where they belong.
    """

    image: Image
    index: int = 0
    time_s: float | None = None
    truth: tuple[TrueObject, ...] | None = None
    device_time_s: float | None = None
    gap: bool = False
    label: str = ""
    doubtful: bool = False
    provides: ClassVar[Mapping[type, str]] = {Image: "image"}

    @classmethod
    def of(
        cls,
        values: NDArray[Any],
        pitch_cm: float | tuple[float, float] = 1.0,
        origin_cm: tuple[float, float] = (0.0, 0.0),
        quantity: str = "raw",
        **rest: Any,
    ) -> Frame:
        """Return a frame around a copy of ``values``, shape (rows, columns).

        Cells that are NaN or infinite become invalid and hold 0.
        """
        copy = np.array(values, dtype=np.float64)
        if copy.ndim != 2 or 0 in copy.shape:
            raise ValueError(f"a frame takes values of shape (rows, columns), got {copy.shape}")
        finite = np.isfinite(copy)
        valid = None if finite.all() else finite
        if valid is not None:
            copy[~valid] = 0.0  # a NaN left in place would spread through the first sum
        x, y = (float(p) for p in np.broadcast_to(pitch_cm, 2))
        if not (0.0 < x < np.inf and 0.0 < y < np.inf):
            raise ValueError(f"a pitch must be > 0 cm, got {pitch_cm}")
        if quantity not in QUANTITIES:
            hint = did_you_mean(quantity, QUANTITIES) or f"; allowed: {', '.join(QUANTITIES)}"
            raise ValueError(f"unknown quantity {quantity!r}{hint}")
        return cls(Image(copy, (x, y), origin_cm, quantity, valid), **rest)

    def with_index(self, index: int) -> Frame:
        """Return the same frame under another number."""
        return replace(self, index=index)

    def _repr_html_(self) -> str:
        from tactile_graph.wires.notebook import frame_html

        return frame_html(self)
