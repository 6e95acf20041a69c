"""``Similarity``: moving, turning and scaling, of points and of what was found in them."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tactile_graph_stress.answer import Answer

Values = NDArray[np.float64]


@dataclass(frozen=True)
class Similarity:
    """Scale, then turn (counter-clockwise as seen), then shift."""

    scale: float = 1.0
    turn_rad: float = 0.0
    x_cm: float = 0.0
    y_cm: float = 0.0

    def of(self, xy: Values) -> Values:
        """Return points, shape (N, 2), mapped."""
        return np.asarray(self.around(xy) + np.array([self.x_cm, self.y_cm]))

    def around(self, xy: Values) -> Values:
        """Return points mapped but for the shift."""
        if self.turn_rad == 0.0:
            return np.asarray(xy * self.scale)
        cos, sin = math.cos(self.turn_rad), math.sin(self.turn_rad)
        # y runs down: what turns counter-clockwise as seen turns the other way in (x, y).
        return np.asarray(self.scale * xy @ np.array([[cos, -sin], [sin, cos]]))

    def of_answer(self, answer: Answer) -> Answer:
        """Return an answer mapped: places like points, lengths by the scale, axes by the turn."""
        return Answer(
            self.of(answer.places),
            answer.lengths * self.scale,
            answer.axes + self.turn_rad,
            self.of(answer.cloud),
        )
