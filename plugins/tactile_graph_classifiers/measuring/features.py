"""Step ``features``: what can be measured of an object on the pad, as named numbers."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, fields
from operator import attrgetter
from typing import Annotated, ClassVar

import numpy as np

from tactile_graph.errors import DataError, Degenerate
from tactile_graph.steps.rules import Grid, Quantity, require_same_shape
from tactile_graph.wires import Image, Mask
from tactile_graph_classifiers.measuring.feature_sums import Sums, feature_sums
from tactile_graph_classifiers.measuring.measurements import Measurements


@dataclass(frozen=True)
class Features:
    """What was measured of a footprint and of the readings under it.

    Parameters
    ----------
    weight : float
        Sum of the readings, in the image's own unit, which ``quantity`` names: grams only where
        the image is in grams.
    area_cm2 : float
        Of the footprint's cells, gaps between the elements included.
    moment_xx_cm2, moment_yy_cm2, moment_xy_cm2 : float
        Second central moments of the footprint over its area (y down); they turn with the object.
    semi_major_cm, semi_minor_cm : float
        Half axes of the ellipse with these moments.
    axis_ratio : float
        The minor over the major one, 0 to 1.
    hu_1, hu_2 : float
        The first two of Hu's moments, which no move, turn or scale changes: 1/(2 pi) and 0 for a
        disc.
    perimeter_cm : float
        Outer boundary and holes' together, by Crofton's formula along four directions.
    compactness : float
        4 pi area / perimeter^2: 1 for a large disc, less for anything else; a footprint of few
        cells can exceed it.
    holes : float
        Parts of the background, joined by sides, that the footprint encloses.
    load_mean, load_sd, peak : float
        Of the readings, in the image's unit; the deviation is that of the population.
    peak_share : float
        Peak over weight.
    load_offset_cm : float
        Distance from the footprint's centroid to the centre of the readings above 0.
    quantity : str
        What the image's values mean.
    """

    weight: float
    area_cm2: float
    moment_xx_cm2: float
    moment_yy_cm2: float
    moment_xy_cm2: float
    semi_major_cm: float
    semi_minor_cm: float
    axis_ratio: float
    hu_1: float
    hu_2: float
    perimeter_cm: float
    compactness: float
    holes: float
    load_mean: float
    load_sd: float
    peak: float
    peak_share: float
    load_offset_cm: float
    quantity: str
    columns_shown: ClassVar[tuple[str, ...]] = ("weight", "area_cm2", "axis_ratio", "compactness")
    provides: ClassVar[Mapping[type, str]] = {Measurements: "measurements"}

    @property
    def measurements(self) -> Measurements:
        """The numbers by name, as classifiers take them."""
        return Measurements(NAMES, np.array(_numbers(self)), self.quantity)


NAMES: tuple[str, ...] = tuple(f.name for f in fields(Features) if f.name != "quantity")
"""The features' names, in order."""
_numbers = attrgetter(*NAMES)


class FeaturesOf:
    """Return weight, area, moments, axes, compactness, holes and load statistics of an object.

    Notes
    -----
    Thesis section 4.4 takes weight and area. The others: M.-K. Hu, Visual pattern recognition by
    moment invariants, 1962, doi:10.1109/TIT.1962.1057692; Crofton's formula after Legland, Kieu
    and Devaux, 2007, doi:10.5566/ias.v26.p83-92. A cell is a square of its pitch in the moments,
    not a point.
    """

    stateless = True

    def __call__(
        self, image: Image, mask: Annotated[Mask, Grid.like("image")]
    ) -> Annotated[Features, Quantity.like("image")]:
        """Return the features of what the mask marks.

        Parameters
        ----------
        image : Image
            Readings; in grams for a true weight.
        mask : Mask
            The object's footprint.

        Raises
        ------
        Degenerate
            If the footprint is empty, has no valid cell, or bears nothing.
        DataError
            If a cell of the footprint holds NaN or infinity.
        RuleError
            If image and mask differ in shape.
        """
        require_same_shape(image=image, mask=mask)
        on = mask.values
        good = on if image.valid is None else on & image.valid
        good.setflags(write=False)  # as a mask's own are: one compiled kernel for both
        sums = feature_sums(np.ascontiguousarray(image.values, np.float64), on, good)
        if not math.isfinite(sums[7] + sums[8]):
            raise DataError("image", "a valid cell of the footprint holds no finite number")
        if sums[0] == 0.0:
            raise Degenerate("the footprint is empty, so there is no object to measure")
        if sums[7] <= 0.0:
            raise Degenerate(
                f"the {sums[6]:g} valid readings under the footprint sum to {sums[7]:g}, so there"
                " is no weight to measure"
            )
        return _features(sums, image)


def _features(sums: Sums, image: Image) -> Features:
    n, mean_x, mean_y, xx, yy, xy, _, weight, square, peak, load_x, load_y, *rest = sums
    px, py = image.pitch_cm
    xx, yy, xy = (xx + 1.0 / 12.0) * px * px, (yy + 1.0 / 12.0) * py * py, xy * px * py
    area = n * px * py
    half, apart = 0.5 * (xx + yy), math.hypot(0.5 * (xx - yy), xy)
    major, minor = 2.0 * math.sqrt(half + apart), 2.0 * math.sqrt(max(half - apart, 0.0))
    perimeter = _perimeter_cm(px, py, *rest[:4])
    return Features(
        weight,
        area,
        xx,
        yy,
        xy,
        major,
        minor,
        minor / major,
        2.0 * half / area,
        (2.0 * apart / area) ** 2,
        perimeter,
        4.0 * math.pi * area / perimeter**2,
        rest[4],
        weight / sums[6],
        math.sqrt(square),
        peak,
        peak / weight,
        math.hypot((load_x - mean_x) * px, (load_y - mean_y) * py),
        image.quantity,
    )


def _perimeter_cm(
    px: float, py: float, rows: float, columns: float, falling: float, rising: float
) -> float:
    """Return the length of the boundary from how often lines of four directions cross it."""
    tilt = math.atan2(py, px)  # of the diagonals; each direction stands for the angles nearest it
    diagonal = px * py / math.hypot(px, py) * 0.25 * math.pi
    crossings = rows * py * tilt + columns * px * (0.5 * math.pi - tilt)
    return 0.5 * (crossings + (falling + rising) * diagonal)
