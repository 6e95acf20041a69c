"""Images, masks and their differences as small PNGs within an SVG, one pixel a cell."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from tactile_graph.wires import Image, Mask
from tactile_graph.wires.cells_png import HEAT, PALE, TWO_WAYS, YES_NO, data_uri, levels


def heat_uri(image: Image, low: float, high: float) -> str:
    """Return an image in colours from ``low`` to ``high``."""
    return data_uri(levels(image.values, low, high, image.valid), HEAT)


def pale_uri(image: Image) -> str:
    """Return an image in pale grey, to lie beneath lines; light touches still show."""
    values = np.sqrt(np.maximum(image.filled(0.0), 0.0))
    high = float(values.max()) if values.size else 1.0
    return data_uri(levels(values, 0.0, high, image.valid), PALE)


def mask_uri(mask: Mask) -> str:
    """Return a mask in dark and light."""
    return data_uri(mask.values.astype(np.uint8), YES_NO)


def change_uri(values: NDArray[np.float64]) -> str:
    """Return differences: blue where less, orange where more, pale where the same."""
    finite = values[np.isfinite(values)]
    most = float(np.abs(finite).max()) if finite.size else 0.0
    return data_uri(levels(values, -(most or 1.0), most or 1.0), TWO_WAYS)
