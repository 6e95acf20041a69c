"""Objects on a small pad read by circuits with and without isolation; shares no code with pads."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from tactile_graph.wires import Image

Array = NDArray[np.float64]
SIDE, FINE = 16, 8
PLACES = (np.arange(SIDE * FINE) + 0.5) / FINE
REFERENCE = 3e-4
DIAGONAL = [(4.2, 4.1, 2.3), (11.3, 10.8, 2.6)]


def network(siemens: Array) -> Array:
    """Return what each row conducts to each column while all other lines float."""
    rows = len(siemens)
    laplacian = np.diag(np.r_[siemens.sum(axis=1), siemens.sum(axis=0)])
    laplacian[:rows, rows:], laplacian[rows:, :rows] = -siemens, -siemens.T
    inverse = np.linalg.pinv(laplacian)
    ends = np.diag(inverse)
    return np.asarray(1.0 / (ends[:rows, None] + ends[rows:] - 2.0 * inverse[:rows, rows:]))


def alone(siemens: Array) -> Array:
    """Return what elements conduct that are read each by itself."""
    return siemens


def divider(siemens: Array) -> Array:
    """Return what elements seem to conduct that shadow each other within a column."""
    return siemens / (1.0 + siemens.sum(axis=0) / REFERENCE)


def share(lying: Sequence[tuple[float, float, float]]) -> Array:
    """Return the share of each element of 1 cm that discs (x, y, radius) cover."""
    y, x = np.meshgrid(PLACES, PLACES, indexing="ij")
    over = sum((np.hypot(x - cx, y - cy) <= r for cx, cy, r in lying), np.zeros(x.shape))
    return np.asarray(np.minimum(over, 1).reshape(SIDE, FINE, SIDE, FINE).mean(axis=(1, 3)))


def read(
    shares: Array,
    rest: float = 3e-7,
    gains: float = 0.25,
    seed: int = 0,
    circuit: Callable[[Array], Array] = network,
) -> Image:
    """Return 8 bits of a pad whose elements conduct ``rest`` bare, and 0.1 mS covered whole."""
    rng = np.random.default_rng(seed)
    siemens = circuit(rest + 1e-4 * shares * np.exp(rng.normal(0.0, gains, shares.shape)))
    ratio = siemens / (siemens + REFERENCE)
    return Image(np.rint(2.0 + 255.0 * ratio + rng.normal(0.0, 0.5, ratio.shape)), (1.0, 1.0))
