"""Step ``load``: total load, force, contact area, peak and centre of pressure of an image."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tactile_graph.compiled import compiled_later
from tactile_graph.errors import Degenerate
from tactile_graph.steps.rules import require_same_shape
from tactile_graph.wires import Image, Mask
from tactile_graph_filters.nan import refuse_unbounded
from tactile_graph_filters.thresholds.noise_level import noise_level

NEWTON_PER_GRAM = 9.80665e-3
"""Weight of one gram under standard gravity."""
NEWTON_PER_KILOPASCAL_CM2 = 0.1
MANY_CELLS, LARGE_SHARE, LARGE_AREA = 0.25, 0.1, 0.5
"""Of all cells so many must count, and those that do not stand out make up so much of the total, or
of the area where noise lies around zero, before it is told."""

SURELY = 0.25
"""Share of the cells beside a footprint, beyond half of them, that read more than zero where all of
them rest above it; between, the centre goes over from all cells' to the footprint's."""

NOISE, NEARLY_ALL = 5.0, 0.9
"""Times the sum of all valid readings' sizes, over the root of their number, that a total must be
for a load that no footprint shows: four standard deviations of a sum of normal noise. On pads of
few cells so much of it at least, as noise is hardly ever of one sign."""

CUT_OFF = 0.1
"""Share of the valid cells that must read zero where noise lost what is less."""


class Load(NamedTuple):
    """What an image says as a whole.

    ``force_n`` is None where the quantity is no force or pressure; ``x_cm`` and ``y_cm`` are
    None where nothing is loaded, which ``loaded`` says for conditions. ``n_left_out`` counts the
    cells without a valid reading: broken ones, and those loaded beyond what a calibration covers.
    Where it is not 0 the total is a lower bound.
    """

    loaded: bool
    total: float
    force_n: float | None
    contact_area_cm2: float
    peak: float
    x_cm: float | None
    y_cm: float | None
    n_left_out: int = 0


# Within the class both would be fields of it.
Load.image_unit = ("total", "peak")  # type: ignore[attr-defined]
Load.field_quantities = {"force_n": ("gram", "kilopascal")}  # type: ignore[attr-defined]


@compiled_later
def measure(values, usable, above):  # type: ignore[no-untyped-def]
    """Return number, sum, maximum and moments (x, y, in cells) of the usable cells above.

    Last comes the sum of those not above that read less than zero.
    """
    n = total = peak = moment_x = moment_y = below = 0.0
    for i in range(values.shape[0]):
        for j in range(values.shape[1]):
            value = values[i, j]
            if usable[i, j] and not value <= above:
                peak = value if n == 0.0 else max(peak, value)
                n += 1.0
                total += value
                moment_x += j * value
                moment_y += i * value
            elif usable[i, j] and value < 0.0:
                below += value
    return n, total, peak, moment_x, moment_y, below


@compiled_later
def measure_within(values, usable, on, above):  # type: ignore[no-untyped-def]
    """Return what `measure` does, then number, sum and moments of those cells on a footprint.

    Then how many usable cells lie beside the footprint, and how many of those read more than 0.
    """
    n = total = peak = moment_x = moment_y = below = 0.0
    its_n = its = its_x = its_y = 0.0
    n_beside = n_above = 0.0
    for i in range(values.shape[0]):
        for j in range(values.shape[1]):
            value = values[i, j]
            if not usable[i, j]:
                continue
            if not on[i, j]:
                n_beside += 1.0
                n_above += value > 0.0
            if not value <= above:
                peak = value if n == 0.0 else max(peak, value)
                n += 1.0
                total += value
                moment_x += j * value
                moment_y += i * value
                if on[i, j]:
                    its_n += 1.0
                    its += value
                    its_x += j * value
                    its_y += i * value
            elif value < 0.0:
                below += value
    whole, its_own = (n, total, peak, moment_x, moment_y, below), (its_n, its, its_x, its_y)
    return *whole, *its_own, n_beside, n_above


def counts_cells_at_rest(image: Image, value: Load) -> str:
    """Return what to say where much of total or area is of cells that do not stand out; or empty.

    Of an area only where cells read less than zero: then noise lies around it, and is no load.
    """
    n_counted = value.contact_area_cm2 / image.cell_area_cm2
    valid = True if image.valid is None else image.valid
    many = MANY_CELLS * image.values.size
    if value.total <= 0.0 or np.count_nonzero(valid & (image.values > 0.0)) <= many:
        return ""
    level = noise_level(image)
    on = (image.values >= level) & valid
    if not on.any():  # a load on the whole pad leaves none to tell it from
        return _seems_empty(image, valid)
    share = 1.0 - float(image.values[on].sum()) / value.total
    what, so = "total", ", and draws the centre along" if n_counted > many else ""
    so += (
        "; if nothing lies on them, the step 'tare' takes off what they read at rest, and 'above' "
    )
    so += "leaves them out"
    if share <= LARGE_SHARE:
        share = 1.0 - np.count_nonzero(on) / n_counted if n_counted > many else 0.0
        what, so = "contact area", ", as noise around zero does; 'above' leaves them out, or a "
        so += "footprint at the port 'mask'"
        if share <= LARGE_AREA or not (valid & (image.values < 0.0)).any():
            return ""
    return (
        f"{share:.0%} of the {what} is of cells that do not stand out of the others, below "
        f"{level:.3g} {image.unit}{so}"
    )


def _seems_empty(image: Image, valid: NDArray[np.bool_] | bool) -> str:
    """Return what to say where no cell stands out, as of noise that a device cuts off at zero."""
    values = image.values[valid]
    at_rest = np.count_nonzero(values == 0.0)
    if values.min() < 0.0 or at_rest < CUT_OFF * values.size:
        return ""
    return (
        f"no cell stands out of the others: the total is of {values.size - at_rest} of "
        f"{values.size} cells that read a little, as noise does that ends at zero; if nothing lies "
        "on them, 'above' leaves them out"
    )


class LoadOf:
    """Return total load, force, contact area, peak and centre of pressure of the valid cells.

    Parameters
    ----------
    above : float
        Cells that do not read more than this, in the image's unit, count for nothing.

    Notes
    -----
    The force of an image in grams is that of the weight under standard gravity, 9.80665 m/s^2;
    in kilopascals it is pressure times cell area (pitch by pitch), summed. The centre is the
    mean of the cell centres weighted by the readings. All cells count, as in the sums that makers
    of pads print: what an untouched cell reads is part of them, of which it is told.

    With a footprint the area is that of its cells, and the total still that of all cells. The
    centre goes over from that of all cells to that of the footprint's where more than half of those
    beside it read something at rest, or is the footprint's where one reads less than zero, as of
    noise around it. What is below zero counts for the total then, too, so that noise
    adds nothing to it, and an image is loaded where its footprint is, or the total is more than
    noise sums up to.
    """

    stateless = True
    notice = staticmethod(counts_cells_at_rest)

    def __init__(self, *, above: float = 0.0) -> None:
        self._above = above
        self._all: dict[tuple[int, int], NDArray[Any]] = {}

    def __call__(self, image: Image, mask: Mask | None = None) -> Load:
        """Return the load of the image.

        Parameters
        ----------
        image : Image
        mask : Mask, optional
            The footprint, on the same grid.

        Raises
        ------
        RuleError
            If image and mask differ in shape.
        DataError
            If a valid cell holds NaN or infinity.
        Degenerate
            If no cell is valid, or the load, or its moment, is too large for a number.
        """
        values = np.ascontiguousarray(image.values, np.float64)
        usable = self._usable(image)
        left_out = 0 if image.valid is None else int(np.count_nonzero(~image.valid))
        if left_out == values.size > 0:
            raise Degenerate("no cell of the image is valid, so its load is not known")
        if mask is None:
            n, total, peak, moment_x, moment_y, _ = measure(values, usable, self._above)
            loaded, weight = total > 0.0, total
        else:
            on = mask.values
            if on.shape != values.shape:
                require_same_shape(image=image, mask=mask)
            measured = measure_within(values, usable, on, self._above)
            _, total, peak, moment_x, moment_y, below, *its_own = measured
            n, its, its_x, its_y, n_beside, n_above = its_own
            loaded, weight = total > 0.0, total
            around_zero = below < 0.0 and self._above <= 0.0
            if around_zero:
                share = min(NOISE / math.sqrt(values.size - left_out), NEARLY_ALL)
                loaded = its > 0.0 or total + below > share * (total - below)
                total += below
            if its > 0.0 and around_zero:
                weight, moment_x, moment_y = its, its_x, its_y
            elif its > 0.0 and self._above <= 0.0 and n_above > 0.5 * n_beside:
                share = min(n_above / n_beside - 0.5, SURELY) / SURELY
                moment_x = (1.0 - share) * moment_x / weight + share * its_x / its
                moment_y = (1.0 - share) * moment_y / weight + share * its_y / its
                weight = 1.0
        if not math.isfinite(total + moment_x + moment_y):
            refuse_unbounded(image, "the load, or its moment")
        if loaded:
            (x, y), (pitch_x, pitch_y) = image.origin_cm, image.pitch_cm
            x_cm: float | None = x + (moment_x / weight + 0.5) * pitch_x
            y_cm: float | None = y + (moment_y / weight + 0.5) * pitch_y
        else:
            x_cm = y_cm = None
        force_n = force_of(total, image)
        area_cm2 = n * image.cell_area_cm2
        return Load(loaded, total, force_n, area_cm2, peak, x_cm, y_cm, left_out)

    def _usable(self, image: Image) -> NDArray[Any]:
        if image.valid is not None:
            return image.valid
        if image.shape not in self._all:
            self._all = {image.shape: _kept(np.ones(image.shape, np.bool_))}
        return self._all[image.shape]


def _kept(cells: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Return cells that nobody writes, as an image's own are: one compiled kernel for all."""
    cells.setflags(write=False)
    return cells


def force_of(total: float, image: Image) -> float | None:
    """Return the force in newton of a sum of readings; None where these are no force.

    Parameters
    ----------
    total : float
        Sum of readings of ``image``, in its unit.
    image : Image

    Returns
    -------
    float or None
    """
    if image.quantity == "gram":
        return total * NEWTON_PER_GRAM
    if image.quantity == "kilopascal":
        return total * image.cell_area_cm2 * NEWTON_PER_KILOPASCAL_CM2
    return None
