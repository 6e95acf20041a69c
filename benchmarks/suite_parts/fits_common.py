"""What the families of fits share: point sets of known shapes, and fits with one signature."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tactile_graph import Points
from tactile_graph.plugins.registry import installed
from tactile_graph.wires.frame import TrueObject

Values = NDArray[np.float64]
Fit = Callable[[Values], list[Any]]
POINTS = 60
NOISE_CM = 0.15


@dataclass(frozen=True)
class Case:
    """Point sets that one shape was drawn from, with noise."""

    name: str
    sets: tuple[Values, ...]
    truth: tuple[TrueObject, ...]


def ours(*names: str) -> dict[str, Fit]:
    """Return steps by name, as fits."""
    steps = {name: installed().load("steps", name) for name in names}
    return {name: lambda xy, step=step: [step(Points(xy))] for name, step in steps.items()}


def opencv_box(function: Callable[..., Any], kind: type, share: float) -> Fit:
    """Return OpenCV's fit of a turned box as a fit of a shape; ``share`` of its sides counts."""

    def fit(xy: Values) -> list[Any]:
        (x, y), (a, b), turn = function(xy.astype(np.float32))
        if not np.isfinite(x + y + a + b) or min(a, b) <= 0.0:
            return []
        angle = np.radians(-turn if a >= b else -turn - 90.0)
        sides = float(max(a, b)) * share, float(min(a, b)) * share
        return [kind(float(x), float(y), *sides, float(angle))]

    return fit
