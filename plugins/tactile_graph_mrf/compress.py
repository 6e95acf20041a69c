"""Step ``compress``: readings by their logarithm, which makes uneven elements even noise."""

from __future__ import annotations

from typing import Annotated, NamedTuple

import numpy as np
from annotated_types import Ge, Gt, Le
from numpy.typing import NDArray

from tactile_graph.errors import Degenerate
from tactile_graph.steps.rules import Grid, Quantity
from tactile_graph.wires import Image

SPARE_SHARE = 0.01
"""Of all cells so many, and one more, may be broken and read far below 0."""
LEAST_CELLS = 32
"""Of fewer, none is called broken: too few others say how far below 0 noise reaches."""


class Compressed(NamedTuple):
    """An image on a logarithmic scale, and whether there is anything in it."""

    image: Annotated[Image, Grid.like("image"), Quantity("level")]
    stands_out: bool


def compress(
    image: Image,
    *,
    share: Annotated[float, Gt(0), Le(100)] = 0.005,
    times: Annotated[float, Ge(1)] = 4.0,
) -> Compressed:
    """Return the readings on a scale that is even near 0 and logarithmic above.

    Elements differ by a factor, which no Gaussian noise of one width is like (Eq. 5.14); their
    logarithms differ by a term. No level in the image's unit enters: multiplying all readings
    by a number changes nothing.

    Parameters
    ----------
    image : Image
        Tared: no load reads about 0.
    share : float
        Share of the peak from which on the scale is logarithmic; large values leave it even.
        One level of 200 by default.
    times : float
        What the peak must be of the lowest reading below 0 to stand out of the noise.

    Returns
    -------
    Compressed
        ``image`` holds asinh(reading / s), s being the share of the peak, or the lowest reading's
        size if that is more, so that noise is never spread over the scale. ``stands_out`` is
        False for an empty pad: noise is as far below 0 as above.

    Raises
    ------
    Degenerate
        If no cell is valid.

    Notes
    -----
    Cells that are not finite become invalid, as those are that were; they hold 0. So do a few that
    read far below 0 while no other does: broken, they say nothing of the noise.
    """
    values = np.asarray(image.values, np.float64)
    usable = np.isfinite(values)
    if image.valid is not None:
        usable = usable & image.valid
    if usable.size and not usable.any():
        raise Degenerate("no cell of the image is valid, so nothing says whether there is a load")
    noise, broken_below = _below_zero(values[usable], times)
    usable = usable & (values >= broken_below)
    seen = values[usable]
    peak = float(seen.max()) if seen.size else 0.0
    if peak <= 0.0:
        return Compressed(image.with_values(np.zeros(values.shape), "level"), False)
    scale = max(share * peak, noise, np.finfo(np.float64).tiny)
    out = np.zeros(values.shape)
    out[usable] = np.arcsinh(seen / scale)
    made = image.with_values(out, "level")
    if not usable.all():
        made = Image(out, image.pitch_cm, image.origin_cm, "level", usable)
    return Compressed(made, peak > times * noise)


def _below_zero(seen: NDArray[np.float64], times: float) -> tuple[float, float]:
    """Return how far noise reaches below 0, and below which reading a cell is broken.

    Broken is a cell that reads more than so many times as far below 0 as all but the few below it.
    """
    if seen.size == 0:
        return 0.0, -np.inf
    n_spare = 1 + int(SPARE_SHARE * seen.size) if seen.size >= LEAST_CELLS else 0
    lowest = np.sort(np.partition(seen, n_spare)[: n_spare + 1]).tolist()
    for this, following in zip(lowest[:-1][::-1], lowest[1:][::-1], strict=True):
        if this < times * min(0.0, following):
            return max(0.0, -following), following
    return max(0.0, -lowest[0]), -np.inf
