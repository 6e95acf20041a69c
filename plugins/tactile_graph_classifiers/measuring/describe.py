"""Step ``describe``: an object's footprint and load as numbers that no move or turn changes."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated, ClassVar

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


@dataclass(frozen=True, eq=False)
class Description:
    """An object as `describe` measured it.

    Parameters
    ----------
    weight : float
        Sum of the readings, in the image's own unit.
    area_cm2 : float
        Of the footprint.
    axis_ratio : float
        Of the ellipse with the footprint's second moments, 0 to 1.
    solidity : float
        Share of its convex hull that the footprint fills.
    measurements : Measurements
        All numbers by name, these among them.
    """

    weight: float
    area_cm2: float
    axis_ratio: float
    solidity: float
    measurements: Measurements
    columns_shown: ClassVar[tuple[str, ...]] = ("weight", "area_cm2", "axis_ratio", "solidity")
    provides: ClassVar[Mapping[type, str]] = {Measurements: "measurements"}

    def summary(self) -> dict[str, float]:
        """Return what tables show; all numbers are in the full record."""
        return {name: getattr(self, name) for name in self.columns_shown}


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
    ) -> Annotated[Description, Quantity.like("image")]:
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
        RuleError
            If image and mask differ in shape.
        """
        first = self._features(image, mask).measurements
        good = mask.values if image.valid is None else mask.values & image.valid
        window = _window(mask.values)
        on, load = mask.values[window], np.zeros(mask.values[window].shape)
        load[good[window]] = np.maximum(image.values[window][good[window]], 0.0)
        peak = float(load.max())
        load /= peak  # sums of squares and sixth powers of any unit stay within what numbers hold
        core = load >= CORE * outline.quantiles(load[good[window]], (0.95,))
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
        measured = Measurements(NAMES, np.array(numbers), first.quantity)
        weight, area_cm2, axis_ratio, solidity = (
            numbers[NAMES.index(name)] for name in Description.columns_shown
        )
        return Description(weight, area_cm2, axis_ratio, solidity, measured)


def _window(on: NDArray[np.bool_]) -> tuple[slice, slice]:
    """Return the least rows and columns that hold all cells that are on."""
    rows, columns = np.flatnonzero(on.any(axis=1)), np.flatnonzero(on.any(axis=0))
    return slice(rows[0], rows[-1] + 1), slice(columns[0], columns[-1] + 1)
