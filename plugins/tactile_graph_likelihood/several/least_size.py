"""Outlines narrower than the search takes any to be."""

from __future__ import annotations

from tactile_graph_likelihood.geometry.outline_prior import SMALLEST
from tactile_graph_likelihood.geometry.outlines import sizes
from tactile_graph_likelihood.several.joint.joint_posterior import JointProblem
from tactile_graph_likelihood.several.joint.scene import Configuration
from tactile_graph_likelihood.several.pad import OnPad
from tactile_graph_likelihood.single.model import SMALLEST_PITCHES

NEAR = 1.2
"""Times the search's least size: an outline no larger may be held by it."""


def freed(problem: JointProblem, found: OnPad) -> tuple[JointProblem, OnPad]:
    """Return the problem and outlines without the search's least size, where it may hold one.

    Then sizes go down to those of a single outline. A search that took outlines so small would
    find more that are none.
    """
    if least_size(found.outlines) > NEAR * float(problem.prior[SMALLEST]):
        return problem, found

    def without(its: JointProblem) -> JointProblem:
        prior = its.prior.copy()
        prior[SMALLEST] = min(SMALLEST_PITCHES * float(its.grid[2]), prior[SMALLEST])
        return its._replace(prior=prior)

    return without(problem), found.on(without)


def least_size(found: Configuration) -> float:
    """Return the least radius, half axis or half side of some outlines, in cm."""
    ends = [2 + sizes.call(int(kind)) for kind in found.kinds]
    return min(float(p[2:end].min()) for p, end in zip(found.points, ends, strict=True))
