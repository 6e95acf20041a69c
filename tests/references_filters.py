"""What kernels of tactile_graph_filters are held against: the same answers, vectorised."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray


def expand(values: NDArray[Any], factor: int, out: NDArray[Any]) -> None:
    """Write each cell of ``values`` into factor x factor cells of ``out``."""
    rows, columns = values.shape
    out.reshape(rows, factor, columns, factor)[...] = values[:, None, :, None]


def to_volts(
    counts: NDArray[Any],
    zero: float,
    step: float,
    first: float,
    last: float,
    out: NDArray[np.float64],
) -> int:
    """Write ``(counts - zero) * step`` into ``out``; return how many are within first and last."""
    np.subtract(counts, zero, out=out)
    np.multiply(out, step, out=out)
    return int(np.count_nonzero((counts >= first) & (counts <= last)))


def measure(
    values: NDArray[np.float64], usable: NDArray[np.bool_], above: float
) -> tuple[float, float, float, float, float, float]:
    """Return number, sum, maximum and moments (x, y, in cells) of the usable cells above.

    Last comes the sum of those not above that read less than zero.
    """
    on = usable & ~(values <= above)  # NaN stays in, to be found out by its sum
    load = values[on]
    y, x = np.nonzero(on)
    peak = float(load.max()) if load.size else 0.0
    # Infinity, and sums too large, to be found out too.
    with np.errstate(invalid="ignore", over="ignore"):
        below = float(values[usable & (values <= above) & (values < 0.0)].sum())
        return float(load.size), float(load.sum()), peak, float(x @ load), float(y @ load), below


def floored(grams: NDArray[np.float64], floor_g: float) -> bool:
    """Put loads below ``floor_g`` to 0, in place; return whether no load is NaN or infinite."""
    finite = bool(np.isfinite(grams).all())
    grams[grams < floor_g] = 0.0
    return finite


def at_least(values: NDArray[Any], level: float, out: NDArray[np.bool_]) -> int:
    """Write into ``out`` where ``values`` reach ``level``; return how many, or -1 if any is NaN."""
    np.greater_equal(values, level, out=out)
    return -1 if np.isnan(values).any() else int(np.count_nonzero(out))
