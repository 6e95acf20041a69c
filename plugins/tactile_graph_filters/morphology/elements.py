"""Structuring elements: named shapes, or a matrix of 0 and 1 from a pipeline file.

The origin of an element is its central cell (thesis section 3.1.3), so both sides are odd.
``cross3`` is the thesis' structuring element #1 (figures 3.4a and 4.9a). The drawing of its
element #2 (figures 3.4b and 4.9b) is lost; the text says that it is bigger and rounder than #1
and wipes out some 16 x 16 footprints. ``disc5`` stands for it: of the candidates measured by
``benchmarks/structuring_element.py`` it alone serves even and uneven pads.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Annotated

import numpy as np
from numpy.typing import NDArray
from pydantic import AfterValidator

from tactile_graph.errors import did_you_mean

NAMED = ("cross3", "disc3", "disc5", "disc7", "square3", "square5", "square21")
"""Names to suggest; any odd size goes with any of the three shapes."""
SHAPES = ("cross", "disc", "square")
LARGEST = 255
_NAME = re.compile(r"([a-z]+):?([0-9]+)")

Spec = str | Sequence[Sequence[int]]


@dataclass(frozen=True, eq=False)
class Element:
    """A structuring element.

    Parameters
    ----------
    name : str
        What it was called in the pipeline file; ``"matrix"`` for a matrix.
    cells : ndarray of bool, shape (odd, odd)
        Its cells around the origin in the middle.
    """

    name: str
    cells: NDArray[np.bool_]

    def __post_init__(self) -> None:
        self.cells.setflags(write=False)

    @property
    def reach(self) -> tuple[int, int]:
        """How many rows and columns it extends from its origin, to either side."""
        rows, columns = self.cells.shape
        return rows // 2, columns // 2

    @property
    def offsets(self) -> NDArray[np.int64]:
        """Its cells as (down, right) steps from the origin, shape (N, 2)."""
        return np.asarray(np.argwhere(self.cells) - np.array(self.reach))

    @property
    def reflected(self) -> Element:
        """The element turned by half a turn about its origin."""
        return Element(self.name, self.cells[::-1, ::-1].copy())

    def repeated(self, times: int) -> Element:
        """Return the element that does at once what this one does ``times`` times in a row.

        Parameters
        ----------
        times : int
            1 or more.

        Raises
        ------
        ValueError
            If it would be longer than `LARGEST`.
        """
        (down, right), (rows, columns) = self.reach, self.cells.shape
        if 1 + 2 * times * max(down, right) > LARGEST:
            raise ValueError(
                f"structuring element {self.name!r} repeated {times} times is longer than {LARGEST}"
            )
        cells = self.cells
        for _ in range(times - 1):
            wide = np.zeros((len(cells) + rows - 1, cells.shape[1] + columns - 1), np.bool_)
            for i, j in np.argwhere(self.cells):
                wide[i : i + len(cells), j : j + cells.shape[1]] |= cells
            cells = wide
        return Element(self.name, cells)


def parse_element(spec: Spec) -> Element:
    """Return the element that a name or a matrix describes.

    Parameters
    ----------
    spec : str or sequence of sequences of int
        ``cross3``, ``disc5``, ``square21``, ``disc:9`` and the like, or rows of 0 and 1.

    Returns
    -------
    Element

    Raises
    ------
    ValueError
        If the name is unknown, or a side is even or longer than `LARGEST`, or the matrix is
        ragged, holds anything but 0 and 1, or holds no 1.
    """
    return _from_name(spec) if isinstance(spec, str) else _from_matrix(spec)


def _from_name(name: str) -> Element:
    match = _NAME.fullmatch(name)
    if match is None or match[1] not in SHAPES:
        raise ValueError(
            f"unknown structuring element {name!r}{did_you_mean(name, NAMED)}"
            " (allowed: cross, disc or square with an odd size, such as disc5, or a matrix)"
        )
    size = int(match[2])
    if size % 2 == 0 or size > LARGEST:
        raise ValueError(
            f"structuring element {name!r}: its size must be odd and at most {LARGEST}, got {size}"
        )
    return Element(name, _shape(match[1], size))


def _shape(shape: str, size: int) -> NDArray[np.bool_]:
    steps = np.arange(size) - size // 2
    down, right = steps[:, None], steps[None, :]
    if shape == "cross":
        return np.asarray((down == 0) | (right == 0))
    if shape == "disc":
        # The digital disc: cells whose centre lies within (size - 1) / 2 steps, so that disc5
        # has rows of 1 3 5 3 1, as scikit-image's disk(2).
        return np.asarray(down * down + right * right <= (size // 2) ** 2)
    return np.ones((size, size), np.bool_)


def _from_matrix(rows: Sequence[Sequence[int]]) -> Element:
    widths = sorted({len(row) for row in rows})
    if len(widths) != 1:
        raise ValueError(f"structuring element: its rows must be equally long, got {widths}")
    if len(rows) % 2 == 0 or widths[0] % 2 == 0:
        raise ValueError(
            "structuring element: its sides must be odd, so that it has a central cell,"
            f" got {len(rows)} x {widths[0]}"
        )
    if max(len(rows), widths[0]) > LARGEST:
        raise ValueError(f"structuring element: its sides must be at most {LARGEST}")
    strange = sorted({str(cell) for row in rows for cell in row if cell not in (0, 1)})
    if strange:
        raise ValueError(f"structuring element: must hold 0 and 1, got {', '.join(strange)}")
    cells = np.array(rows, np.bool_)
    if not cells.any():
        raise ValueError("structuring element: must hold at least one 1, got none")
    return Element("matrix", cells)


def _checked(spec: str | list[list[int]]) -> str | list[list[int]]:
    parse_element(spec)
    return spec


ElementSetting = Annotated[str | list[list[int]], AfterValidator(_checked)]
"""A step's ``element`` setting: checked when the pipeline is loaded, written down as given."""
