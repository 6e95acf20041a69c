"""Outlines side by side that fill their convex hull: one object of another shape, maybe."""

from __future__ import annotations

import math

import numpy as np

from tactile_graph_likelihood.geometry.outlines import unknowns
from tactile_graph_likelihood.several.joint.scene import Configuration, laid
from tactile_graph_likelihood.several.pad import Found, OnPad
from tactile_graph_likelihood.single.density.element_terms import ON, UNKNOWN

TELLING = 36
"""Touched elements from which on two discs side by side leave a notch between them that shows."""

NOTCH, HARDLY = 0.02, 0.5
"""Of a hull's elements, the bare ones that are hardly covered up to which there is no notch, and
the share that says so; two equal discs leave an eighth of theirs."""

ALIKE = math.log(2.0)
"""Logarithms up to which outlines' loads may be those of one object: one that lies over its edge
takes less."""


def fill_their_hull(found: OnPad) -> bool:
    """Return whether outlines side by side, alike in load, fill the convex hull of what is touched.

    What lies there may be one object of a shape that was not looked for.
    """
    return any(part.outlines.count > 1 and _fills(part) for part in found.parts)


def _fills(part: Found) -> bool:
    from scipy.spatial import ConvexHull, QhullError

    problem = part.scene.problem
    on = problem.states == ON
    if np.count_nonzero(on) < TELLING or _spread(part.outlines) > ALIKE:
        return False
    try:
        sides = ConvexHull(np.argwhere(on)).equations
    except QhullError:  # all in one line
        return False
    offsets = np.tensordot(sides[:, :2], np.indices(on.shape), 1) + sides[:, 2:, None]
    within = (offsets < 1e-9).all(axis=0) & (problem.states != UNKNOWN)
    bare = within & ~on & (laid(problem, part.outlines).share < HARDLY)
    return bool(np.count_nonzero(bare) <= NOTCH * np.count_nonzero(within))


def _spread(found: Configuration) -> float:
    """Return how far the logarithms of outlines' loads are apart."""
    kinds = zip(found.kinds.tolist(), found.corners.tolist(), strict=True)
    loads = [p[unknowns.call(*kind)] for kind, p in zip(kinds, found.points, strict=True)]
    return float(max(loads) - min(loads))
