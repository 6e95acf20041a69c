"""Bare elements that outlines enclose: those of one hollow object rather than between several."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from tactile_graph_likelihood.geometry.pieces import components
from tactile_graph_likelihood.several.joint.scene import laid
from tactile_graph_likelihood.several.pad import Found, OnPad
from tactile_graph_likelihood.single.density.element_terms import ON

MIDDLE = 3
"""Elements of a hollow: hardly ever are as many left bare between objects that touch."""

COVERED = 0.5
"""Share of an element from which on it is no hollow's, but a void under an outline."""


def enclose(found: OnPad) -> bool:
    """Return whether outlines, touching one after the other, enclose a bare middle."""
    return any(part.outlines.count > 1 and enclosed_by(part) >= MIDDLE for part in found.parts)


def enclosed_by(part: Found) -> int:
    """Return the elements of the largest hollow that touched elements of a part enclose."""
    problem = part.scene.problem
    inner = within(problem.states == ON)
    if np.count_nonzero(inner) < MIDDLE:
        return 0
    inner &= laid(problem, part.outlines).share < COVERED
    return int(np.bincount(components.call(inner, 1).ravel())[1:].max(initial=0))


def within(on: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Return which elements cannot be left for the pad's edge by bare ones side by side."""
    from scipy.ndimage import binary_fill_holes

    return np.asarray(binary_fill_holes(on) & ~on, np.bool_)
