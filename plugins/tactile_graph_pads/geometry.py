"""``Geometry``: where the elements of a pad lie."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, ClassVar

import numpy as np
from annotated_types import Ge, Gt
from numpy.typing import NDArray

from tactile_graph.wires.checked import checked_pitch


@dataclass(frozen=True)
class Geometry:
    """Rows and columns of equal elements with gaps between them.

    The first element's top left corner is the pad's (0, 0). An image of the pad counts half a
    gap around each element as belonging to it, so it starts half a gap before that corner.
    Defaults are those of thesis section 2.1.1.

    Parameters
    ----------
    rows, columns : int
        Number of elements down and across.
    element_cm : float
        Side of one element, the same both ways.
    gap_cm : float
        Distance between the edges of neighbours.
    """

    rows: Annotated[int, Ge(1)] = 16
    columns: Annotated[int, Ge(1)] = 16
    element_cm: Annotated[float, Gt(0)] = 1.0
    gap_cm: Annotated[float, Ge(0)] = 0.3
    key_hints: ClassVar[dict[str, str]] = dict.fromkeys(
        ("element_cm", "gap_cm"),
        "it is one number for both ways, as elements of a pad file are square",
    )
    __pydantic_config__: ClassVar[dict[str, str]] = {"extra": "forbid"}

    def __post_init__(self) -> None:
        try:
            checked_pitch(self.pitch_cm)
        except ValueError as error:
            raise ValueError(f"geometry: element_cm + gap_cm: {error}") from None

    @property
    def shape(self) -> tuple[int, int]:
        """Rows and columns."""
        return self.rows, self.columns

    @property
    def pitch_cm(self) -> float:
        """Distance of neighbouring centres."""
        return self.element_cm + self.gap_cm

    @property
    def origin_cm(self) -> tuple[float, float]:
        """Top left corner of the first cell of an image of this pad."""
        return (-0.5 * self.gap_cm, -0.5 * self.gap_cm)

    @property
    def size_cm(self) -> tuple[float, float]:
        """Width and height of the array, from the first element's edge to the last one's."""
        return (
            self.columns * self.pitch_cm - self.gap_cm,
            self.rows * self.pitch_cm - self.gap_cm,
        )

    @property
    def element_area_cm2(self) -> float:
        """Sensitive area of one element."""
        return self.element_cm**2

    @property
    def x_cm(self) -> NDArray[np.float64]:
        """Element centres along x, shape (columns,)."""
        return np.asarray(0.5 * self.element_cm + self.pitch_cm * np.arange(self.columns))

    @property
    def y_cm(self) -> NDArray[np.float64]:
        """Element centres along y (down), shape (rows,)."""
        return np.asarray(0.5 * self.element_cm + self.pitch_cm * np.arange(self.rows))
