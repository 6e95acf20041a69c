"""Images, masks and structuring elements that the filters' tests share."""

from __future__ import annotations

from typing import Any

import numpy as np
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from tactile_graph.wires import Image, Mask

PITCH, ORIGIN = (1.3, 0.7), (-0.15, 2.0)
ELEMENTS: list[Any] = [
    "cross3",
    "disc5",
    "disc7",
    "square3",
    "square21",
    "cross:9",
    "disc:13",
    [[1]],
    [[1, 0, 0]],
    [[0, 1, 1], [0, 0, 1], [0, 0, 0]],
    [[1, 0, 1, 1, 0]],
    [[1], [1], [0], [1], [1], [1], [1]],
]


def image_of(values: Any, quantity: str = "volt", valid: Any = None) -> Image:
    given = None if valid is None else np.array(valid, bool)
    return Image(np.array(values, np.float64), PITCH, ORIGIN, quantity, given)


def mask_of(values: Any) -> Mask:
    return Mask(np.array(values, bool), PITCH, ORIGIN)


def drawn(text: str) -> Mask:
    """Return the mask drawn with # for on."""
    return mask_of([[c == "#" for c in line.strip()] for line in text.strip().splitlines()])


def random_mask(seed: int, shape: tuple[int, int] = (16, 16), share: float = 0.7) -> Mask:
    return mask_of(np.random.default_rng(seed).random(shape) < share)


def same_grid(a: Image | Mask, b: Image | Mask) -> bool:
    return (a.shape, a.pitch_cm, a.origin_cm) == (b.shape, b.pitch_cm, b.origin_cm)


def masks(max_side: int = 12) -> st.SearchStrategy[Mask]:
    sides = st.integers(1, max_side)
    return st.tuples(sides, sides).flatmap(lambda shape: arrays(bool, shape)).map(mask_of)


def elements() -> st.SearchStrategy[list[list[int]]]:
    side = st.sampled_from([1, 3, 5, 7])
    cells = st.tuples(side, side).flatmap(
        lambda shape: arrays(np.int64, shape, elements=st.integers(0, 1))
    )
    return cells.filter(np.any).map(np.ndarray.tolist)
