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
    *told : str
        Of which quantity the levels are, and what they are above: the same for all.
    """

    item = LevelledMask

    def __init__(self, masks: MaskStack, levels: NDArray[np.float64], *told: str) -> None:
        super().__init__(masks.values, masks.pitch_cm, masks.origin_cm, masks.counts)
        self.levels, self._told = Column(levels), told

    @classmethod
    def of(cls, values: Sequence[Any]) -> LevelledMaskStack:
        """Return masks of one shape, grid and kind of level as a stack."""
        levels = np.array([mask.level for mask in values])
        return cls(MaskStack.of(values), levels, values[0].quantity, values[0].above)

    def __getitem__(self, i: int) -> LevelledMask:
        grid, count = (self.pitch_cm, self.origin_cm), int(self.counts[i])
        return LevelledMask(self.values[i], *grid, count, self.levels[i], *self._told)

    def __iter__(self) -> Iterator[LevelledMask]:
        """Yield the mask of each frame."""
        return (self[i] for i in range(len(self)))

    def take(self, rows: Rows) -> LevelledMaskStack:
        """Return the masks of some of the frames."""
        return LevelledMaskStack(super().take(rows), self.levels.values[rows], *self._told)

    def field(self, name: str) -> Stack | None:
        """Return the levels, or what `MaskStack` knows."""
        return self.levels if name == "level" else super().field(name)
