"""Step ``newtons``: the force on each cell."""

from typing import Annotated

import numpy as np
from tactile_graph import Degenerate, Image
from tactile_graph.steps import Grid, Quantity

STANDARD_GRAVITY = 9.80665e-3  # newtons that a gram weighs


def newtons(
    image: Annotated[Image, Quantity("gram")],
) -> Annotated[Image, Quantity("newton"), Grid.like("image")]:
    """Return the force on each cell."""
    if not np.isfinite(image.filled()).all():
        raise Degenerate("a reading is no number")
    return image.with_values(STANDARD_GRAVITY * image.filled(), quantity="newton")
