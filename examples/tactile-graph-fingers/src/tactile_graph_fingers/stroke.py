"""``Stroke``: a straight stroke of a finger."""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from tactile_graph.draw.display import Area, Drawn, Label, Outline
from tactile_graph.wires.measure import Measure


@dataclass(frozen=True)
class Stroke:
    """A straight stroke of a finger, from (x0, y0) to (x1, y1)."""

    x0_cm: float
    y0_cm: float
    x1_cm: float
    y1_cm: float
    breadth_cm: float = 0.8
    columns_shown: ClassVar[tuple[str, ...]] = ("x_cm", "y_cm", "length_cm")
    error_measures: ClassVar[tuple[Measure, ...]] = (Measure("length_cm"),)

    @property
    def x_cm(self) -> float:
        """Its middle, x."""
        return 0.5 * (self.x0_cm + self.x1_cm)

    @property
    def y_cm(self) -> float:
        """Its middle, y."""
        return 0.5 * (self.y0_cm + self.y1_cm)

    @property
    def length_cm(self) -> float:
        """How long it is."""
        return math.hypot(self.x1_cm - self.x0_cm, self.y1_cm - self.y0_cm)

    def drawing(self) -> Iterator[Drawn]:
        """Yield the band it covers, the line along it, and how long that is."""
        ends = np.array([[self.x0_cm, self.y0_cm], [self.x1_cm, self.y1_cm]])
        along = ends[1] - ends[0]
        aside = 0.5 * self.breadth_cm * np.array([-along[1], along[0]]) / (self.length_cm or 1.0)
        yield Area(np.vstack([ends + aside, ends[::-1] - aside]))
        yield Outline(ends, closed=False)
        yield Label(self.x_cm, self.y_cm - 1.0, f"{self.length_cm:.1f} cm")
