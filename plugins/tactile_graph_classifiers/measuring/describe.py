"""Step ``describe``: an object's footprint and load as numbers that no move or turn changes."""

from __future__ import annotations

from typing import Annotated

import numpy as np
from numpy.typing import NDArray

from tactile_graph.steps.rules import Grid, Quantity
from tactile_graph.wires import Image, Mask
from tactile_graph_classifiers.measuring import load_spread, outline
from tactile_graph_classifiers.measuring.features import NAMES as FEATURES
from tactile_graph_classifiers.measuring.features import FeaturesOf
from tactile_graph_classifiers.measuring.measurements import Measurements

CORE = 0.5
"""Readings from this share of the 95 % quantile on are the core of a footprint."""
NAMES = (
    *FEATURES,
    *outline.NAMES,
    "core_cm2",
    "core_load",
    *(f"core_{name}" for name in outline.NAMES),
    *load_spread.NAMES,
)


class Describe:
    """Return what `features` measures, and outline, core and spread of the load besides.

    Notes
    -----
    All but the three second moments of `features` stay as they are when the object is moved or
    turned; those without a unit do so, too, when all readings are multiplied. The core, the cells
    that read most, says of the shape what hangs less on how hard it was pressed. A reading below
    0 counts as 0.
    """

    stateless = True

    def __init__(self) -> None:
        self._features = FeaturesOf()

    def __call__(
        self, image: Image, mask: Annotated[Mask, Grid.like("image")]
    ) -> Annotated[Measurements, Quantity.like("image")]:
        """Return the numbers of what the mask marks.

        Parameters
        ----------
        image : Image
            Readings, in any unit.
        mask : Mask
            The object's footprint, of one part or several.

        Raises
        ------
        Degenerate
            If the footprint is empty, has no valid cell, or bears nothing.
        DataError
            If a cell of the footprint holds NaN or infinity.
        ValueError
            If image and mask differ in shape.
        """
        first = self._features(image, mask).measurements
        good = mask.values if image.valid is None else mask.values & image.valid
        window = _window(mask.values)
        on, load = mask.values[window], np.zeros(mask.values[window].shape)
        load[good[window]] = np.maximum(image.values[window][good[window]], 0.0)
        peak = float(load.max())
        load /= peak  # sums of squares and sixth powers of any unit stay within what numbers hold
        core = load >= CORE * np.quantile(load[good[window]], 0.95)
        core &= load > 0.0
        area = np.count_nonzero(core) * image.pitch_cm[0] * image.pitch_cm[1]
        numbers = [
            *first.values.tolist(),
            *outline.outline_numbers(on, image.pitch_cm),
            area,
            float(load[core].sum() / load.sum()),
            *outline.outline_numbers(core, image.pitch_cm),
            *load_spread.spread_numbers(load, on, image.pitch_cm),
        ]
        return Measurements(NAMES, np.array(numbers), first.quantity)


def _window(on: NDArray[np.bool_]) -> tuple[slice, slice]:
    """Return the least rows and columns that hold all cells that are on."""
    rows, columns = np.flatnonzero(on.any(axis=1)), np.flatnonzero(on.any(axis=0))
    return slice(rows[0], rows[-1] + 1), slice(columns[0], columns[-1] + 1)
