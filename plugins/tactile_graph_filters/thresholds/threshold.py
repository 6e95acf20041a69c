"""Step ``threshold``: the cells at or above a fixed level."""

from __future__ import annotations

import math
from typing import Annotated, Any

import numpy as np
from annotated_types import Ge
from numpy.typing import NDArray

from tactile_graph.compiled import compiled_later
from tactile_graph.errors import Degenerate
from tactile_graph.steps.rules import Grid, Quantity
from tactile_graph.wires import Image, Mask
from tactile_graph_filters.nan import refuse_nan


@compiled_later
def at_least(values, level, out):  # type: ignore[no-untyped-def]
    """Write into ``out`` where ``values`` reach ``level``; return how many, or -1 if any is NaN."""
    count = numbers = 0
    for i in range(values.shape[0]):
        row, wanted = values[i], out[i]
        for j in range(values.shape[1]):
            wanted[j] = row[j] >= level
            count += row[j] >= level
            numbers += row[j] == row[j]
    return count if numbers == values.size else -1


@compiled_later
def any_at_least(values: NDArray[Any], level: float) -> bool:
    """Return whether any of ``values`` reaches ``level``, or is NaN."""
    for i in range(values.shape[0]):
        row = values[i]
        for j in range(values.shape[1]):
            if not row[j] < level:
                return True
    return False


def footprint(image: Image, level: float) -> Mask:
    """Return the valid cells of ``image`` at or above ``level``.

    Parameters
    ----------
    image : Image
    level : float
        In the image's own unit.

    Returns
    -------
    Mask

    Raises
    ------
    Degenerate
        If no cell is valid.
    DataError
        If a valid cell holds NaN: it is neither on nor off.
    """
    values, valid = image.values, image.valid
    out = np.empty(values.shape, np.bool_)
    count: int | None = at_least.call(values, level, out)
    if valid is not None:
        if not valid.any():
            raise Degenerate("no cell of the image is valid, so it has no footprint")
        np.logical_and(out, valid, out=out)
    if count == -1:
        refuse_nan(image)
    return Mask(out, image.pitch_cm, image.origin_cm, count if valid is None else None)


class Threshold:
    """Turn on the valid cells at or above a fixed level.

    Parameters
    ----------
    level_v : float, optional
        The level for images in volts; the thesis takes 0.01 V (section 4.1, figure 4.3).
    level : float, optional
        The level in the image's own unit, whatever that is.
    above : bool
        Whether a cell must exceed the level instead of reaching it.

    Raises
    ------
    ValueError
        Unless exactly one of ``level_v`` and ``level`` is given, and finite.

    Notes
    -----
    Thesis section 3.1.1 (Horn 1986, page 47). Invalid cells are never on.
    """

    stateless = True

    def __init__(
        self,
        *,
        level_v: Annotated[float | None, Ge(0), Quantity("volt", of="image")] = None,
        level: float | None = None,
        above: bool = False,
    ) -> None:
        if (level_v is None) == (level is None):
            got = "neither" if level is None else "both"
            raise ValueError(f"exactly one of level_v and level must be given, got {got}")
        at = float(level if level_v is None else level_v)  # type: ignore[arg-type]
        if not math.isfinite(at):
            raise ValueError(f"the level must be a finite number, got {at}")
        # To exceed a float is to reach the next one.
        self._level = math.nextafter(at, math.inf) if above else at
        self._empty: Mask | None = None  # what an empty pad gave last, while it stays empty

    def __call__(self, image: Image) -> Annotated[Mask, Grid.like("image")]:
        """Return the mask of the cells that are on."""
        empty = self._empty
        if (
            empty is not None
            and image.valid is None
            and _on_one_grid(image, empty)
            and not any_at_least.call(image.values, self._level)
        ):
            return empty  # a pad is empty for long: a look suffices, and nothing is made anew
        mask = footprint(image, self._level)
        self._empty = None if mask.count or image.valid is not None else mask
        return mask


def _on_one_grid(image: Image, mask: Mask) -> bool:
    return (
        image.values.shape == mask.values.shape
        and image.pitch_cm == mask.pitch_cm
        and image.origin_cm == mask.origin_cm
    )
