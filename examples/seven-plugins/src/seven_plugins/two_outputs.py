"""Step ``otsu``: a mask and the level it was taken at, two outputs by name.

Run by:
    tactile-graph run otsu-demo --frames 3
"""

from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, NamedTuple

import numpy as np
from annotated_types import Ge

from tactile_graph import Degenerate, Image, Mask, hookimpl


@hookimpl
def tactile_graph_steps() -> Mapping[str, str]:
    """Offer the step."""
    return {"otsu": f"{__name__}:otsu"}


@hookimpl
def tactile_graph_pipelines() -> Mapping[str, Path]:
    """Offer a pipeline that reads both outputs."""
    return {"otsu-demo": Path(__file__).parent / "pipelines" / "otsu-demo.yaml"}


class Parted(NamedTuple):
    """The cells above a level, and the level, in the image's unit."""

    mask: Mask
    level: float


def otsu(image: Image, *, n_bins: Annotated[int, Ge(2)] = 64) -> Parted:
    """Return the cells above the level that parts the readings best (Otsu 1979).

    Parameters
    ----------
    image : Image
    n_bins : int
        Of the histogram.
    """
    readings = image.values[... if image.valid is None else image.valid].astype(float)
    if not readings.size or not np.isfinite(readings).all() or np.ptp(readings) == 0.0:
        raise Degenerate("readings that are all the same, or no numbers, have no two parts")
    low, span = float(readings.min()), float(np.ptp(readings))
    if not np.isfinite(span):
        raise Degenerate("the readings are too far apart for a number")
    counts, edges = np.histogram((readings - low) / span, n_bins, range=(0.0, 1.0))
    centres, below = (edges[1:] + edges[:-1]) / 2, np.cumsum(counts)
    above, first = below[-1] - below, np.cumsum(counts * centres)
    means = first / np.maximum(below, 1), (first[-1] - first) / np.maximum(above, 1)
    best = int(np.argmax(below * above * (means[1] - means[0]) ** 2))
    level = low + span * float(edges[best + 1])
    return Parted(image.mask(image.filled(low) >= level), level)
