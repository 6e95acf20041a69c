"""Step ``inpaint``: invalid cells filled from the valid ones around them."""

from __future__ import annotations

from typing import Annotated, Any, Literal

import numpy as np
from numpy.typing import NDArray

from tactile_graph.errors import Degenerate
from tactile_graph.steps.rules import Grid, Quantity
from tactile_graph.wires import Image
from tactile_graph_filters.nan import require_finite

DENSE_UP_TO = 400


def inpaint(
    image: Image, *, method: Literal["smooth", "nearest"] = "smooth"
) -> Annotated[Image, Quantity.like("image"), Grid.like("image")]:
    """Return the image with every invalid cell filled, and all cells valid.

    Parameters
    ----------
    image : Image
    method : str
        ``smooth``: each filled cell is the mean of its up to four neighbours, filled ones
        included, weighted by the inverse square of their distance (a discrete Laplace equation:
        no value outside the range of those around the hole). ``nearest``: the nearest valid
        cell's value, the first in reading order of equally near ones.

    Returns
    -------
    Image

    Raises
    ------
    Degenerate
        If no cell is valid.
    DataError
        If a valid cell holds NaN or infinity.

    Notes
    -----
    What is filled in is a guess; sums over the image then include it.
    """
    require_finite(image)
    if image.valid is None:
        return image
    holes = ~image.valid
    if holes.all():
        raise Degenerate("no cell of the image is valid, so there is nothing to fill from")
    values = np.array(image.values, np.float64)
    if holes.any():
        fill = _smooth if method == "smooth" else _nearest
        values[holes] = fill(image, holes)
    return Image(values, image.pitch_cm, image.origin_cm, image.quantity)


def _smooth(image: Image, holes: NDArray[np.bool_]) -> NDArray[Any]:
    """Return the solution of the Laplace equation in the holes, in reading order."""
    number = np.full(holes.shape, -1)
    number[holes] = np.arange(np.count_nonzero(holes))
    pitch_x, pitch_y = image.pitch_cm
    weight_x, weight_y = 1.0, (pitch_x / pitch_y) ** 2
    diagonal, given = np.zeros(holes.shape), np.zeros(holes.shape)
    pairs: list[NDArray[Any]] = []
    weights: list[NDArray[Any]] = []
    lower, upper = np.s_[1:], np.s_[:-1]
    for weight, a, b in (
        (weight_y, np.s_[upper, :], np.s_[lower, :]),
        (weight_x, np.s_[:, upper], np.s_[:, lower]),
    ):
        for here, there in ((a, b), (b, a)):
            diagonal[here] += weight
            given[here] += np.where(holes[there], 0.0, weight * image.values[there])
            both = holes[here] & holes[there]
            pairs.append(np.stack([number[here][both], number[there][both]]))
            weights.append(np.full(int(both.sum()), -weight))
    i, j = np.concatenate(pairs, axis=1)
    return _solve(diagonal[holes], i, j, np.concatenate(weights), given[holes])


def _solve(
    diagonal: NDArray[Any],
    i: NDArray[Any],
    j: NDArray[Any],
    off: NDArray[Any],
    given: NDArray[Any],
) -> NDArray[Any]:
    n = diagonal.size
    if n <= DENSE_UP_TO:
        matrix = np.diag(diagonal)
        matrix[i, j] = off
        return np.asarray(np.linalg.solve(matrix, given))
    from scipy.sparse import coo_array, diags_array
    from scipy.sparse.linalg import spsolve

    sparse = coo_array((off, (i, j)), shape=(n, n)).tocsc() + diags_array(diagonal, format="csc")
    return np.asarray(spsolve(sparse.tocsc(), given))


def _nearest(image: Image, holes: NDArray[np.bool_]) -> NDArray[Any]:
    """Return the value of the valid cell nearest to each hole, in reading order."""
    good, bad = np.argwhere(~holes), np.argwhere(holes)
    pitch = np.array(image.pitch_cm[::-1])
    filled = np.empty(len(bad))
    for n, cell in enumerate(bad):
        steps = (good - cell) * pitch
        filled[n] = image.values[tuple(good[int(np.argmin((steps * steps).sum(axis=1)))])]
    return filled
