"""Hypothesis strategies of what travels on wires; they need the ``test`` extra."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from tactile_graph.errors import UsageError
from tactile_graph.plugins.registry import installed
from tactile_graph.testing.cases import RANGES
from tactile_graph.vocabulary import QUANTITIES
from tactile_graph.wires import Frame, Image, Mask, Points

try:
    from hypothesis import strategies as st
    from hypothesis.extra.numpy import arrays
except ImportError:
    raise UsageError('strategies need hypothesis: pip install "tactile-graph[test]"') from None

Strategy = st.SearchStrategy
LARGEST_CM = 1000.0


def shapes(max_side: int = 12) -> Strategy[tuple[int, int]]:
    """Draw rows and columns, from 1 on."""
    return st.tuples(st.integers(1, max_side), st.integers(1, max_side))


def pitches_cm() -> Strategy[tuple[float, float]]:
    """Draw pitches along x and y, equal ones mostly."""
    one = st.sampled_from([1.3, 1.0, 0.2, 0.05, 4.0])
    return one.map(lambda p: (p, p)) | st.tuples(one, one)


def images(
    quantity: str | None = None, max_side: int = 12, invalid: bool = True
) -> Strategy[Image]:
    """Draw images as sensors give them: of any shape, pitch and origin, up to all cells invalid.

    Parameters
    ----------
    quantity : str, optional
        Any if not given.
    max_side : int
        Rows and columns at most.
    invalid : bool
        Whether cells may be invalid.
    """
    return frames(quantity, max_side, invalid).map(lambda frame: frame.image)


@st.composite
def frames(
    draw: Any, quantity: str | None = None, max_side: int = 12, invalid: bool = True
) -> Frame:
    """Draw frames, as `images` does; cells that are no number are invalid in them."""
    kind = quantity or draw(st.sampled_from(sorted(QUANTITIES)))
    cells = st.floats(0.0, 2.0 * RANGES.get(kind, 1.0)) | st.just(0.0)
    if invalid:
        cells |= st.just(math.nan)
    values = draw(arrays(np.float64, draw(shapes(max_side)), elements=cells))
    origin = draw(st.sampled_from([(0.0, 0.0), (-0.15, 2.0)]))
    index = draw(st.integers(0, 1000))
    return Frame.of(values, draw(pitches_cm()), origin, kind, index=index, time_s=0.02 * index)


@st.composite
def masks(draw: Any, max_side: int = 12) -> Mask:
    """Draw masks of any shape and pitch, empty and full ones among them."""
    on = arrays(np.bool_, draw(shapes(max_side)))
    return Mask(draw(on), draw(pitches_cm()))


def points(max_count: int = 40, far_cm: float = LARGEST_CM) -> Strategy[Points]:
    """Draw points, also none, several at one place, and all on a line.

    Parameters
    ----------
    max_count : int
    far_cm : float
        How far from 0 a coordinate may lie.
    """
    place = st.floats(-far_cm, far_cm, allow_subnormal=False)
    anywhere = arrays(np.float64, st.tuples(st.integers(0, max_count), st.just(2)), elements=place)
    on_cells = anywhere.map(np.round)
    on_a_line = anywhere.map(lambda xy: xy[:, :1] * (1.0, 0.4))
    return (anywhere | on_cells | on_a_line).map(lambda xy: Points(np.ascontiguousarray(xy)))


@st.composite
def contacts(draw: Any, quantity: str = "volt", max_side: int = 12) -> Any:
    """Draw the contacts of images, found by ``contacts`` above a fifth of the peak."""
    image = draw(images(quantity, max_side))
    found = installed().step("filters.contacts").target
    return found(image, image.mask(image.values > 0.2 * image.peak))
