"""``heavier_side``: where an object bears more than elsewhere: its load's centre off its own."""

from __future__ import annotations

import math
from typing import Annotated, NamedTuple

import numpy as np

from tactile_graph.errors import Degenerate
from tactile_graph.steps.rules import Grid, require_same_shape
from tactile_graph.wires import Image, Mask
from tactile_graph.wires.shapes import Circle, Ellipse, Polygon, Rectangle


class HeavierSide(NamedTuple):
    """The vector from an object's geometric centre to the centre of its load.

    ``dx_cm`` and ``dy_cm`` are in pad coordinates (y down), ``angle_rad`` is the direction as
    seen, in (-pi, pi], 0 where the two centres are one. ``noise_cm`` is the standard deviation each
    way that the scatter of the readings alone would give; ``clear`` says whether the vector is
    longer than so many of these as asked for.
    """

    dx_cm: float
    dy_cm: float
    distance_cm: float
    angle_rad: float
    noise_cm: float
    clear: bool
    load_x_cm: float
    load_y_cm: float

    @property
    def angle_deg(self) -> float:
        """Direction in degrees, (-180, 180]."""
        return math.degrees(self.angle_rad)


def heavier_side(
    image: Image,
    mask: Annotated[Mask, Grid.like("image")],
    shape: Circle | Ellipse | Rectangle | Polygon | None = None,
    *,
    clear_from: float = 2.5,
) -> HeavierSide:
    """Return where the centre of the load lies from the geometric centre.

    Parameters
    ----------
    image : Image
        Readings; best in grams, since volts do not add up.
    mask : Mask
        The footprint, on the same grid. Readings outside it and below 0 do not count.
    shape : Circle, Ellipse, Rectangle or Polygon, optional
        Its centre is the geometric centre; by default the mean of the footprint's cells, which
        voids shift.
    clear_from : float
        From how many standard deviations on a side counts as clearly heavier.

    Returns
    -------
    HeavierSide

    Raises
    ------
    RuleError
        If image and mask differ in shape.
    Degenerate
        If the footprint is empty or bears no load.

    Notes
    -----
    The standard deviation is that of the load's centre for readings shuffled over the footprint,
    (s / m) sqrt(v / n) for n readings of mean m and standard deviation s in cells of
    variance v along the axis, the larger of both. On a tilted block the pressure is linear over the
    footprint: a centre of load off by e along a side L means pressures of 1 -+ 6 e / L at the ends.
    """
    require_same_shape(image=image, mask=mask)
    on = mask.values if image.valid is None else mask.values & image.valid
    rows, columns = np.nonzero(on)
    if len(rows) == 0:
        raise Degenerate("no valid cell is on: no side is heavier")
    load = np.maximum(image.values[rows, columns], 0.0)
    peak = float(load.max())
    if not 0.0 < peak < math.inf:
        raise Degenerate(f"the footprint's {len(rows)} cells bear no load: no side is heavier")
    load = load / peak  # squares of very large and very small ones are no numbers
    total = float(load.sum())
    xs, ys = image.x_cm[columns], image.y_cm[rows]
    x, y = float(load @ xs) / total, float(load @ ys) / total
    at_x, at_y = (xs.mean(), ys.mean()) if shape is None else (shape.x_cm, shape.y_cm)
    dx, dy = x - float(at_x), y - float(at_y)
    distance = math.hypot(dx, dy)
    uneven = float(load.std()) / float(load.mean())
    noise = uneven * math.sqrt(max(float(xs.var()), float(ys.var())) / len(rows))
    angle = math.atan2(-dy, dx) if distance > 0.0 else 0.0
    return HeavierSide(dx, dy, distance, angle, noise, distance > clear_from * noise, x, y)
