"""``LineField``: edges between neighbouring cells, and ``Restored``, what a restorer gives."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tactile_graph.draw.display import Rim
from tactile_graph.wires import Image, Points


@dataclass(frozen=True, eq=False)
class LineField:
    """Lines that are on, one site between any two cells that share a side (thesis fig. 5.5).

    Ports that take points take the middles of the lines: a line is an element of the line field,
    which stands between two cells.

    Parameters
    ----------
    horizontal : ndarray of bool, shape (rows - 1, columns)
        ``[i, j]`` is the horizontal line between cells (i, j) and (i + 1, j).
    vertical : ndarray of bool, shape (rows, columns - 1)
        ``[i, j]`` is the vertical line between cells (i, j) and (i, j + 1).
    pitch_cm, origin_cm : (float, float)
        Of the image the lines belong to.
    """

    horizontal: NDArray[np.bool_]
    vertical: NDArray[np.bool_]
    pitch_cm: tuple[float, float] = (1.0, 1.0)
    origin_cm: tuple[float, float] = (0.0, 0.0)
    columns_shown: ClassVar[tuple[str, ...]] = ("count", "length_cm")
    provides: ClassVar[Mapping[type, str]] = {Points: "middles"}

    def __post_init__(self) -> None:
        self.horizontal.setflags(write=False)
        self.vertical.setflags(write=False)

    @property
    def count(self) -> int:
        """Number of lines that are on."""
        return int(np.count_nonzero(self.horizontal) + np.count_nonzero(self.vertical))

    @property
    def length_cm(self) -> float:
        """Total length of the lines that are on."""
        across, down = np.count_nonzero(self.horizontal), np.count_nonzero(self.vertical)
        return float(across * self.pitch_cm[0] + down * self.pitch_cm[1])

    @property
    def segments_cm(self) -> NDArray[np.float64]:
        """Both ends of each line that is on, shape (count, 2, 2): line, end, (x, y)."""
        i, j = np.nonzero(self.horizontal)
        across = np.stack([np.stack([j, i + 1], 1), np.stack([j + 1, i + 1], 1)], 1)
        i, j = np.nonzero(self.vertical)
        down = np.stack([np.stack([j + 1, i], 1), np.stack([j + 1, i + 1], 1)], 1)
        ends = np.concatenate([across, down]).astype(np.float64)
        return np.asarray(self.origin_cm + ends * np.asarray(self.pitch_cm))

    def drawing(self) -> tuple[Rim]:
        """Return the lines that are on, for pictures."""
        return (Rim(self.segments_cm),)

    @property
    def middles(self) -> Points:
        """The middle of each line that is on."""
        return Points(self.segments_cm.mean(axis=1))

    @classmethod
    def none(cls, image: Image) -> LineField:
        """Return the field of ``image``'s grid with every line off."""
        return cls.of(image, *no_lines(image.shape))

    @classmethod
    def of(
        cls, image: Image, horizontal: NDArray[np.bool_], vertical: NDArray[np.bool_]
    ) -> LineField:
        """Return these lines on the grid of ``image``."""
        return cls(horizontal, vertical, image.pitch_cm, image.origin_cm)


def no_lines(shape: tuple[int, int]) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
    """Return horizontal and vertical lines of a grid of ``shape`` cells, all off."""
    rows, columns = shape
    return (
        np.zeros((max(rows - 1, 0), columns), np.bool_),
        np.zeros((rows, max(columns - 1, 0)), np.bool_),
    )


class Restored(NamedTuple):
    """What every restorer gives.

    ``energy`` is that of image and lines as `tactile_graph_mrf.energy.total.energy` counts it, in
    squared levels; ``trace`` holds one energy per sweep done, the last sweep last.
    """

    image: Image
    lines: LineField
    energy: float
    trace: tuple[float, ...]
    sweeps: int
