"""Step ``flip_cells``: a known share of a mask's cells, drawn at random, changes state."""

from __future__ import annotations

from typing import Annotated

import numpy as np
from annotated_types import Ge, Le

from tactile_graph.steps.rules import Grid
from tactile_graph.wires import Mask


def flip_cells(
    mask: Mask,
    *,
    on: Annotated[float, Ge(0), Le(1)] = 0.0,
    off: Annotated[float, Ge(0), Le(1)] = 0.0,
    rng: np.random.Generator,
) -> Annotated[Mask, Grid.like("mask")]:
    """Return the mask with some cells switched on, some off, each independently of the others.

    Parameters
    ----------
    mask : Mask
    on : float
        Probability that a cell that is off is switched on: a contact where there is none.
    off : float
        Probability that a cell that is on is switched off: a void.
    rng : numpy.random.Generator
    """
    drawn = rng.random(mask.values.shape)
    return mask.with_values(mask.values ^ (drawn < np.where(mask.values, off, on)))
