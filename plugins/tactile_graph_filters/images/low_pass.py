"""Step ``low_pass``: each cell replaced by the (weighted) mean of its window."""

from __future__ import annotations

from typing import Annotated, Any

import numpy as np
from annotated_types import Ge, Le
from numpy.typing import NDArray
from pydantic import AfterValidator

from tactile_graph.compiled import compiled_twin_of
from tactile_graph.steps.rules import Grid
from tactile_graph.wires import Image, Mask
from tactile_graph_filters.nan import all_finite, refuse_unbounded


def _window_mean_plain(
    values: NDArray[np.float64],
    usable: NDArray[np.float64],
    weights: NDArray[np.float64],
    out: NDArray[np.float64],
) -> None:
    """Write into ``out`` the weighted mean over each cell's window of the usable cells.

    ``usable`` is 1 where a cell counts and 0 elsewhere; ``out`` is 0 where none counts.
    """
    half_rows, half_columns = weights.shape[0] // 2, weights.shape[1] // 2
    around = ((half_rows, half_rows), (half_columns, half_columns))
    padded, counted = np.pad(values * usable, around), np.pad(usable, around)
    rows, columns = values.shape
    total = np.zeros(values.shape)
    out[...] = 0.0
    for (i, j), weight in np.ndenumerate(weights):
        window = slice(i, i + rows), slice(j, j + columns)
        with np.errstate(over="ignore", invalid="ignore"):  # found out by what comes out
            out += weight * padded[window]
        total += weight * counted[window]
    np.divide(out, total, out=out, where=total > 0)


@compiled_twin_of(_window_mean_plain)
def window_mean(values, usable, weights, out):  # type: ignore[no-untyped-def]
    """Write into ``out`` the weighted mean over each cell's window of the usable cells."""
    rows, columns = values.shape
    half_rows, half_columns = weights.shape[0] // 2, weights.shape[1] // 2
    total = np.empty(columns)
    for i in range(rows):
        wanted = out[i]
        wanted[:] = 0.0
        total[:] = 0.0
        for k in range(max(0, i - half_rows), min(rows, i + half_rows + 1)):
            for m in range(-half_columns, half_columns + 1):
                weight = weights[k - i + half_rows, m + half_columns]
                low, high = max(0, -m), min(columns, columns - m)
                if weight == 0.0 or high <= low:
                    continue
                given, counted = values[k, low + m : high + m], usable[k, low + m : high + m]
                goal, sums = wanted[low:high], total[low:high]
                for j in range(high - low):
                    goal[j] += weight * given[j] * counted[j]
                    sums[j] += weight * counted[j]
        for j in range(columns):
            if total[j] > 0:
                wanted[j] /= total[j]


def _checked(weights: list[list[float]] | None) -> list[list[float]] | None:
    if weights is not None:
        widths = {len(row) for row in weights}
        if len(widths) != 1 or len(weights) % 2 == 0 or widths.pop() % 2 == 0:
            raise ValueError("weights: must be equally long rows, an odd number each way")
        flat = [weight for row in weights for weight in row]
        if not all(0.0 <= weight < float("inf") for weight in flat) or sum(flat) <= 0.0:
            raise ValueError("weights: must not be negative, and some must be above 0")
    return weights


class LowPass:
    """Replace each cell by the mean of its window.

    Parameters
    ----------
    size : int
        Side of the window in cells, odd; 3 in the thesis.
    weights : list of list of float, optional
        Weight of each cell of the window, its sides odd; instead of ``size``. They need not add
        up to 1: what comes out is a mean.

    Raises
    ------
    ValueError
        If ``size`` is even.

    Notes
    -----
    Thesis section 3.1.6, equation 3.7, and section 4.3.3. Cells outside the image and invalid
    ones are left out of the mean, so that edges do not fade. Invalid cells stay invalid. From a
    mask comes the share of the window that is on, 0 to 1.
    """

    stateless = True

    def __init__(
        self,
        *,
        size: Annotated[int, Ge(1), Le(101)] = 3,
        weights: Annotated[list[list[float]] | None, AfterValidator(_checked)] = None,
    ) -> None:
        if size % 2 == 0:
            raise ValueError(f"size must be odd, so that the window has a central cell, got {size}")
        window = np.ones((size, size)) if weights is None else np.array(_checked(weights), float)
        self._weights = window / window.max()
        self._all: dict[tuple[int, int], NDArray[np.float64]] = {}

    def __call__(self, image: Image | Mask) -> Annotated[Image, Grid.like("image")]:
        """Return the smoothed image.

        Raises
        ------
        DataError
            If a valid cell holds NaN or infinity.
        Degenerate
            If the sum over a window is too large for a number.
        """
        valid, quantity = (
            (image.valid, image.quantity) if isinstance(image, Image) else (None, "level")
        )
        values = np.ascontiguousarray(image.values, np.float64)
        out = np.empty(values.shape)
        window_mean(values, self._usable(image.shape, valid), self._weights, out)
        if not all_finite(out) and isinstance(image, Image):
            refuse_unbounded(image, "the sum over a window")
        if valid is not None:
            out[~valid] = 0.0
        return Image(out, image.pitch_cm, image.origin_cm, quantity, valid)

    def _usable(self, shape: tuple[int, int], valid: NDArray[Any] | None) -> NDArray[np.float64]:
        if valid is not None:
            return valid.astype(np.float64)
        if shape not in self._all:
            self._all = {shape: np.ones(shape)}
        return self._all[shape]
