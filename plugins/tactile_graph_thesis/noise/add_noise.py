"""Step ``add_noise``: Gaussian noise of a known size on every cell of an image."""

from __future__ import annotations

from typing import Annotated

import numpy as np
from annotated_types import Ge

from tactile_graph.steps.rules import Quantity
from tactile_graph.wires import Image
from tactile_graph_filters.nan import require_finite


def add_noise(
    image: Image, *, sd: Annotated[float, Ge(0)] = 0.01, rng: np.random.Generator
) -> Annotated[Image, Quantity.like("image")]:
    """Return the image with independent Gaussian noise on every cell.

    Parameters
    ----------
    image : Image
    sd : float
        Standard deviation, in the image's own unit. Values may become negative.
    rng : numpy.random.Generator

    Raises
    ------
    DataError
        If a valid cell holds NaN or infinity.

    Notes
    -----
    Thesis section 6.1.3 asks for such a test: measurements corrupted by known noise.
    """
    require_finite(image)
    return image.with_values(image.values + sd * rng.standard_normal(image.values.shape))
