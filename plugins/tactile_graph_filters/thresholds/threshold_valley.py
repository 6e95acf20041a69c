"""Step ``threshold_valley``: the level in the valley of the grey-level histogram."""

from __future__ import annotations

from typing import Annotated, Any

import numpy as np
from annotated_types import Ge, Le
from numpy.typing import NDArray

from tactile_graph.compiled import compiled_twin_of
from tactile_graph.errors import Degenerate
from tactile_graph.wires import Image
from tactile_graph_filters.thresholds.threshold import footprint
from tactile_graph_filters.thresholds.thresholded import Thresholded, grey_values


def threshold_valley(
    image: Image,
    *,
    n_bins: Annotated[int, Ge(3), Le(65536)] = 64,
    smoothing: Annotated[int, Ge(0), Le(100_000)] = 1000,
) -> Thresholded:
    """Return the footprint above the valley between the two peaks of the histogram.

    Parameters
    ----------
    image : Image
    n_bins : int
        Number of equally wide bins between the smallest and the largest value. Wider bins make
        the level coarser, narrower ones need more smoothing.
    smoothing : int
        How often the histogram may be smoothed (mean of three bins) until two peaks are left.

    Returns
    -------
    Thresholded
        ``level`` is the lower edge of the lowest bin between the peaks (of the middle one of
        equally low ones).

    Raises
    ------
    Degenerate
        If the histogram has one peak, or more than two after all smoothing, or the image has
        fewer than two grey levels.
    DataError
        If a valid cell holds NaN or infinity.

    Notes
    -----
    Thesis section 3.1.1 (Horn 1986, pages 90 and 91); smoothed until bimodal as Prewitt and
    Mendelsohn do (1966, 10.1111/j.1749-6632.1965.tb11715.x).
    """
    values = grey_values(image)
    low, high = float(values.min()), float(values.max())
    # In halves: the range of the largest numbers is none.
    edges = 2.0 * np.linspace(0.5 * low, 0.5 * high, n_bins + 1)
    counts = np.histogram(values, edges)[0].astype(np.float64)
    smooth_until_two_peaks(counts, smoothing)
    peaks = _peaks(counts)
    if len(peaks) != 2:
        n = "one peak" if len(peaks) == 1 else f"{len(peaks)} peaks"
        raise Degenerate(
            f"the histogram of {n_bins} bins from {low:g} to {high:g} has {n}"
            f" after at most {smoothing} smoothings: a valley lies between two"
        )
    level = float(edges[_valley(counts, *peaks)])
    return Thresholded(footprint(image, level), level)


def _smooth_plain(counts: NDArray[np.float64], most: int) -> None:
    """Smooth ``counts`` in place, at most so often, until at most two peaks are left."""
    for _ in range(most):
        if len(_peaks(counts)) <= 2:
            break
        padded = np.pad(counts, 1, mode="edge")
        counts[:] = (padded[:-2] + padded[1:-1] + padded[2:]) / 3.0


@compiled_twin_of(_smooth_plain)
def smooth_until_two_peaks(counts, most):  # type: ignore[no-untyped-def]
    """Smooth ``counts`` in place, at most so often, until at most two peaks are left."""
    last = counts.size - 1
    for _ in range(most):
        peaks = 0
        rising = True  # whether the last change was upwards
        for i in range(last):
            if counts[i + 1] < counts[i]:
                peaks += rising
                rising = False
            elif counts[i + 1] > counts[i]:
                rising = True
        if peaks + rising <= 2:
            break
        before = counts[0]
        for i in range(last + 1):
            after = counts[min(i + 1, last)]
            mean = (before + counts[i] + after) / 3.0
            before = counts[i]
            counts[i] = mean


def _peaks(counts: NDArray[np.float64]) -> list[int]:
    """Return the bins (the first of a level stretch) that are higher than both sides."""
    starts = np.flatnonzero(np.diff(counts, prepend=-1.0) != 0)  # of stretches of equal bins
    heights: NDArray[Any] = np.concatenate([[-1.0], counts[starts], [-1.0]])
    higher = (heights[1:-1] > heights[:-2]) & (heights[1:-1] > heights[2:])
    return [int(start) for start in starts[higher]]


def _valley(counts: NDArray[np.float64], left: int, right: int) -> int:
    """Return the lowest bin between two peaks; the middle one of equally low bins."""
    between = counts[left : right + 1]
    lowest = np.flatnonzero(between == between.min())
    return left + int(lowest[len(lowest) // 2])
