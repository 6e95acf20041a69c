"""Step ``expect``: the image an object of known outline should give, as a prior for restorers."""

from __future__ import annotations

import math
from typing import Annotated

import numpy as np
from annotated_types import Ge, Le
from numpy.typing import NDArray

from tactile_graph.errors import Degenerate
from tactile_graph.steps import Grid, Quantity
from tactile_graph.wires import Circle, Ellipse, Image, Polygon, Rectangle

FINE = 8
"""Points a side that tell how much of a cell the outline covers."""


def expect(
    image: Image,
    shape: Circle | Ellipse | Rectangle | Polygon,
    *,
    load: Annotated[float, Ge(0)] | None = None,
    known: Annotated[float, Ge(0), Le(1)] = 1.0,
) -> Annotated[Image, Grid.like("image"), Quantity.like("image")]:
    """Return the load each cell is expected to read under an object, for ``expected`` ports.

    The outline may come from a fit, or be that of the class the object was found to be of; the
    restorers weigh it by their model's ``lambda_prior``.

    Parameters
    ----------
    image : Image
        Gives grid and unit, and the load where none is given.
    shape : Circle, Ellipse, Rectangle or Polygon
        Outline of the object, in cm.
    load : float, optional
        What a wholly covered cell reads, in the image's unit: the class's. If not given, the
        image's own load is spread evenly over the outline.
    known : float
        Cells covered by less than this share, but by some of it, are left unknown: the prior
        says nothing where the edge may lie. 0 leaves none out.

    Returns
    -------
    Image
        Load times share covered; 0 off the object; invalid where nothing is known.

    Raises
    ------
    Degenerate
        If the outline covers no cell, or the load under it is not finite.

    Notes
    -----
    Thesis section 5.5.2, items 4 and 6: prior knowledge of the pressure in the potential.
    """
    covered = _covered(image, np.asarray(shape.outline_cm(), np.float64))
    if not covered.any():
        raise Degenerate("the outline covers no cell of the image, so no load can be expected")
    if load is None:
        readings = np.maximum(image.filled(0.0), 0.0)
        load = float(readings[covered > 0].sum() / covered.sum())
        if not math.isfinite(load):
            raise Degenerate("the load under the outline is no finite number")
    told = (covered == 0.0) | (covered >= known)
    return image.with_values(np.where(told, load * covered, 0.0), valid=told)


def _covered(image: Image, outline: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the share of each cell within the outline, by the even-odd rule at fine points."""
    (wide, high), (left, top) = image.pitch_cm, image.origin_cm
    x = left + wide * (np.arange(image.columns * FINE) + 0.5) / FINE
    y = top + high * (np.arange(image.rows * FINE) + 0.5) / FINE
    inside = np.zeros((len(y), len(x)), np.bool_)
    for (ax, ay), (bx, by) in zip(outline, np.roll(outline, -1, axis=0), strict=True):
        crosses = (ay > y) != (by > y)
        at = ax + (y[crosses] - ay) / (by - ay) * (bx - ax) if ay != by else y[crosses]
        inside[crosses] ^= x[None, :] < at[:, None]
    cells = inside.reshape(image.rows, FINE, image.columns, FINE)
    return np.asarray(cells.mean(axis=(1, 3)))
