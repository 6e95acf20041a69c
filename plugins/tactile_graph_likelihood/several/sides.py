"""Outlines whose long sides lie in a wrong gap: no climb leaves one, as no element feels it."""

from __future__ import annotations

import math

import numpy as np

from tactile_graph_likelihood.geometry.outlines import Values, sizes
from tactile_graph_likelihood.several.joint.joint_posterior import JointProblem
from tactile_graph_likelihood.several.joint.maximise_jointly import likeliest_of
from tactile_graph_likelihood.several.joint.scene import Configuration

TURNS = 4
"""Sides that may be moved, one after another."""


def sides_moved(problem: JointProblem, found: Configuration) -> Configuration:
    """Return one outline of two sizes, its sides a pitch further in or out where that is likelier.

    Parameters
    ----------
    problem : JointProblem
        Beside the others.
    found : Configuration
        One outline.

    Returns
    -------
    Configuration
        ``found`` itself where nothing is likelier; else yet to be brought to its mode.
    """
    kind, corners = int(found.kinds[0]), int(found.corners[0])
    if sizes.call(kind) < 2:
        return found
    begun = point = found.points[0]
    for _ in range(TURNS):
        ways = with_other_sides(point, float(problem.grid[2]))
        best = likeliest_of.call(problem, kind, corners, ways)
        if best == 0:
            break
        point = ways[best]
    if point is begun:
        return found
    return Configuration(found.kinds, found.corners, point[None].copy(), 0.0)


def with_other_sides(point: Values, pitch: float) -> Values:
    """Return an outline's numbers, and those with each of its four sides a pitch in or out."""
    ways, cos, sin = np.tile(point, (9, 1)), math.cos(point[4]), math.sin(point[4])
    every = [(m, end, off) for m in range(2) for end in (-1.0, 1.0) for off in (-0.5, 0.5)]
    for way, (m, end, off) in zip(ways[1:], every, strict=True):
        across, down = (cos, -sin) if m == 0 else (sin, cos)
        way[2 + m] += off * pitch
        way[:2] += end * off * pitch * np.array([across, down])
    return ways
