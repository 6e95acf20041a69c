"""Step ``bilateral``: noise smoothed away, edges kept.

Run by:
    tactile-graph run bilateral-demo --frames 3 --plot bilateral.png
"""

from collections.abc import Mapping
from pathlib import Path
from typing import Annotated

import numpy as np
from annotated_types import Ge, Gt, Le

from tactile_graph import Degenerate, Image, hookimpl
from tactile_graph.steps import Grid, Quantity


@hookimpl
def tactile_graph_steps() -> Mapping[str, str]:
    """Offer the filter."""
    return {"bilateral": f"{__name__}:bilateral"}


@hookimpl
def tactile_graph_pipelines() -> Mapping[str, Path]:
    """Offer a pipeline of it."""
    return {"bilateral-demo": Path(__file__).parent / "pipelines" / "bilateral-demo.yaml"}


def bilateral(
    image: Image,
    *,
    reach: Annotated[int, Ge(1), Le(8)] = 2,
    spread: Annotated[float, Gt(0)] = 0.1,
) -> Annotated[Image, Quantity.like("image"), Grid.like("image")]:
    """Return the mean of each cell's neighbours that read much the same (Tomasi, Manduchi 1998).

    Parameters
    ----------
    image : Image
    reach : int
        Cells the window reaches to each side.
    spread : float
        Difference, as a share of the peak, at which a neighbour's weight falls to 61 %.
    """
    values, rows, columns = image.filled(), *image.shape
    top = np.abs(values).max(initial=0.0)
    if not np.isfinite(top):
        raise Degenerate("a valid cell holds no finite number")
    level = np.pad(values / top if top > 0 else values, reach)
    there = np.pad(np.ones(image.shape) if image.valid is None else image.valid * 1.0, reach)
    total, weights = np.zeros(image.shape), np.zeros(image.shape)
    for i, j in np.ndindex(2 * reach + 1, 2 * reach + 1):
        near = level[i : i + rows, j : j + columns]
        unlike = (near - level[reach:-reach, reach:-reach]) / spread
        apart = ((i - reach) ** 2 + (j - reach) ** 2) / (reach / 1.5) ** 2
        weight = there[i : i + rows, j : j + columns] * np.exp(-(unlike**2 + apart) / 2)
        total, weights = total + weight * near, weights + weight
    return image.with_values(top * total / np.where(weights > 0, weights, 1.0))
