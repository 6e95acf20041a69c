"""Scenes of several objects that the tests of splitting, tracking and scoring share."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from tactile_graph.steps import Report
from tactile_graph.wires import Frame, Image, Mask
from tactile_graph_sources.simulate import simulate

LEVEL_V = 0.01


@dataclass(frozen=True)
class Spot:
    """Something with a place and an area, as a tracker takes it."""

    x_cm: float
    y_cm: float
    area_cm2: float = 10.0
    name: str = ""


def frames(scene: Any, n: int, seed: int, **settings: Any) -> Iterator[Frame]:
    rng = np.random.default_rng(seed)
    return simulate(scene=scene, frames=n, rng=rng, report=Report(), **settings)


def footprint(image: Image) -> Mask:
    return image.mask(image.values >= LEVEL_V)


def discs(rows: int, columns: int, *circles: tuple[float, float, float]) -> Image:
    """Return an image of 1 V wherever a cell centre lies in a circle (row, column, radius)."""
    i, j = np.mgrid[:rows, :columns]
    inside = np.zeros((rows, columns), bool)
    for row, column, radius in circles:
        inside |= (i - row) ** 2 + (j - column) ** 2 <= radius**2
    return Image(inside.astype(np.float64), (1.3, 1.3), (-0.15, -0.15), "volt")
