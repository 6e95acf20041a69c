"""Regions: cells that no line parts, and which of them stand above what is around them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from tactile_graph.compiled import compiled_as_is
from tactile_graph.errors import DataError
from tactile_graph.wires import Image, Mask
from tactile_graph_mrf.energy.line_field import LineField

Flags = NDArray[np.bool_]


@dataclass(frozen=True, eq=False)
class Regions:
    """What a line field parts an image into; ports that take a mask take the raised cells.

    Parameters
    ----------
    labels : ndarray of int32, shape (rows, columns)
        Region of each cell, from 1, in reading order of the regions' first cells.
    raised : ndarray of bool, shape (N + 1,)
        Which regions stand above their surroundings; the first is no region.
    mask : Mask
        Cells of objects: raised ones, and voids within them.
    """

    labels: NDArray[np.int32]
    raised: Flags
    mask: Mask
    columns_shown: ClassVar[tuple[str, ...]] = ("count", "area_cm2")
    provides: ClassVar[Mapping[type, str]] = {Mask: "mask"}

    def __post_init__(self) -> None:
        self.labels.setflags(write=False)
        self.raised.setflags(write=False)

    @property
    def count(self) -> int:
        """Number of cells of objects."""
        return self.mask.count

    @property
    def area_cm2(self) -> float:
        """Area of the objects."""
        return self.mask.area_cm2


@compiled_as_is
def label_regions(horizontal: Any, vertical: Any) -> NDArray[np.int32]:
    """Return the region of each cell, shape (rows, columns), from 1 in reading order.

    Two cells that share a side with no line on it are in one region.
    """
    rows, columns = vertical.shape[0], horizontal.shape[1]
    labels = np.zeros((rows, columns), np.int32)
    stack = np.empty(rows * columns, np.int64)
    count = 0
    for start in range(rows * columns):
        if labels[start // columns, start % columns] != 0:
            continue
        count += 1
        labels[start // columns, start % columns] = count
        stack[0] = start
        waiting = 1
        while waiting > 0:
            waiting -= 1
            i, j = stack[waiting] // columns, stack[waiting] % columns
            for side in range(4):
                k, m = i + (side == 0) - (side == 1), j + (side == 2) - (side == 3)
                if k < 0 or m < 0 or k == rows or m == columns or labels[k, m] != 0:
                    continue
                on = horizontal[min(i, k), j] if k != i else vertical[i, min(j, m)]
                if not on:
                    labels[k, m] = count
                    stack[waiting] = k * columns + m
                    waiting += 1
    return labels


def standing(
    values: NDArray[np.float64],
    lines: LineField,
    labels: NDArray[np.int32],
    least_step: float = 0.0,
) -> Flags:
    """Return which regions stand above what lies across their lines, shape (N + 1,).

    The steps across all lines between a region and others are added up, each as seen from
    within. For any set of raised regions the sum over its outline of (inside - outside) is the
    sum of these over its regions: taking those above 0 gives the outline of most contrast.
    ``least_step`` is what the mean step must exceed, as a share of the range of the values.
    """
    n = int(labels.max(initial=0)) + 1
    rise, count = np.zeros(n), np.zeros(n)
    for on, step, here, there in (
        (lines.horizontal, values[:-1] - values[1:], labels[:-1], labels[1:]),
        (lines.vertical, values[:, :-1] - values[:, 1:], labels[:, :-1], labels[:, 1:]),
    ):
        outer = on & (here != there)
        for side, sign in ((here[outer], 1.0), (there[outer], -1.0)):
            np.add.at(rise, side, sign * step[outer])
            np.add.at(count, side, 1.0)
    least = least_step * float(np.ptp(values)) if values.size else 0.0
    rounding = 1e-12 * float(np.abs(values).max(initial=0.0))
    return np.asarray(rise > (least + rounding) * count)


def require_grid(lines: LineField, image: Image) -> None:
    """Refuse lines that are not between the cells of the image."""
    shape = lines.vertical.shape[0], lines.horizontal.shape[1]
    if shape != image.shape:
        raise DataError("lines", f"must have the image's shape {image.shape}, got {shape}")
