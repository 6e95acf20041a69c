"""A number that may stand for no reading, as -1 or 65535: the same cells hold it in every frame."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

FULL_SCALE = 65535.0
FEWEST_FRAMES = 2


class Steady:
    """Watches frames for such a number, until one speaks against it, as the first one mostly does.

    It is below 0, where all other readings are not, or what 16 bits hold at most.
    """

    def __init__(self) -> None:
        self.is_over = False
        self._number = 0.0
        self._cells: NDArray[np.bool_] | None = None
        self._n = 0

    def see(self, frame: NDArray[Any]) -> None:
        """Look at a frame's readings as they stand in the file."""
        if self.is_over:
            return
        odd = (frame < 0.0) | (frame == FULL_SCALE)
        found = frame[odd]
        if self._cells is None:
            self._cells, self._number = odd, float(found[0]) if found.size else 0.0
        same = np.array_equal(odd, self._cells) and bool((found == self._number).all())
        self.is_over = not (same and 0 < found.size < frame.size)
        self._n += 1

    @property
    def told(self) -> str:
        """What to tell of the number once all frames were seen; empty where there is none."""
        if self.is_over or self._cells is None or self._n < FEWEST_FRAMES:
            return ""
        n, number = int(self._cells.sum()), f"{self._number:.17g}"
        cells = "1 cell that reads" if n == 1 else f"{n} cells that read"
        return f"{cells} {number} in every frame (give missing={number} if there is no sensor)"
