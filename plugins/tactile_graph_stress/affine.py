"""``Affine``: the values of an image scaled and shifted, and what was restored from them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tactile_graph.wires import Image

Values = NDArray[np.float64]


@dataclass(frozen=True)
class Affine:
    """Scale, then shift."""

    scale: float = 1.0
    shift: float = 0.0

    def of(self, values: Values) -> Values:
        """Return values mapped."""
        return np.asarray(values * self.scale + self.shift)


def restored_values(value: Any) -> Values | None:
    """Return the values of the image in a restorer's output: ``image``, else ``mean``."""
    for name in ("image", "mean"):
        image = getattr(value, name, None)
        if isinstance(image, Image):
            return np.asarray(image.values, dtype=np.float64)
    return None
