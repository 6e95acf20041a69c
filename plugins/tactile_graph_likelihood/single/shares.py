"""What share of a fully covered element's load an outline brings to each element of a window."""

from __future__ import annotations

from tactile_graph.compiled import compiled_as_is
from tactile_graph_likelihood.geometry.covered import FOAM_REACH, Box, blurred, covered
from tactile_graph_likelihood.geometry.outlines import Values
from tactile_graph_likelihood.geometry.pressure import is_even, press
from tactile_graph_likelihood.single.element_terms import FOAM


@compiled_as_is
def foam_margin(grid: Values, noise: Values) -> float:
    """Return how far, in cm, foam carries load beyond an outline."""
    foam = (FOAM_REACH * noise[FOAM] + 2.0) * grid[2] if noise[FOAM] > 0.0 else 0.0
    margin: float = foam + grid[5]
    return margin


@compiled_as_is
def shares_of(
    kind: int, corners: int, p: Values, grid: Values, noise: Values, box: Box, rows: int,
    columns: int,
) -> Values:  # fmt: skip
    """Return coverage, weighed by the pressure and blurred by foam, shape (rows, columns) of a box.

    Parameters
    ----------
    kind, corners, p, grid, box
        As in `covered.covered`.
    noise : ndarray, shape (8,)
        As in `element_terms`; its foam, fall and lean.
    rows, columns : int
        Of the whole image.
    """
    shares = covered(kind, corners, p, grid, box)
    if not is_even(noise):
        press(kind, corners, p, grid, noise, box, shares)
    return blurred(shares, noise[FOAM], box, rows, columns) if noise[FOAM] > 0.0 else shares
