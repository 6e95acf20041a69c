"""Masks of several frames, each with the level that made it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tactile_graph.wires.stacks import Column, MaskStack, Rows, Stack
from tactile_graph_filters.thresholds.noise_level import LevelledMask


class LevelledMaskStack(MaskStack):
    """Masks of one shape and grid that know their levels.

    Parameters
    ----------
    masks : MaskStack
    levels : ndarray of float64, shape (n,)
        Takes ownership: it becomes read-only.
    quantity : str
        That the levels are of.
    above : sequence of str
        What each level is above.
    """

    item = LevelledMask

    def __init__(
        self, masks: MaskStack, levels: NDArray[np.float64], quantity: str, above: Sequence[str]
    ) -> None:
        super().__init__(masks.values, masks.pitch_cm, masks.origin_cm, masks.counts)
        self.levels, self._quantity, self._above = Column(levels), quantity, np.array(above, object)

    @classmethod
    def of(cls, values: Sequence[Any]) -> LevelledMaskStack:
        """Return masks of one shape, grid and kind of level as a stack."""
        levels = np.array([mask.level for mask in values])
        return cls(
            MaskStack.of(values), levels, values[0].quantity, [mask.above for mask in values]
        )

    def __getitem__(self, i: int) -> LevelledMask:
        grid, count = (self.pitch_cm, self.origin_cm), int(self.counts[i])
        told = self._quantity, self._above[i]
        return LevelledMask(self.values[i], *grid, count, self.levels[i], *told)

    def __iter__(self) -> Iterator[LevelledMask]:
        """Yield the mask of each frame."""
        return (self[i] for i in range(len(self)))

    def take(self, rows: Rows) -> LevelledMaskStack:
        """Return the masks of some of the frames."""
        levels, above = self.levels.values[rows], list(self._above[rows])
        return LevelledMaskStack(super().take(rows), levels, self._quantity, above)

    def field(self, name: str) -> Stack | None:
        """Return the levels, or what `MaskStack` knows."""
        return self.levels if name == "level" else super().field(name)
