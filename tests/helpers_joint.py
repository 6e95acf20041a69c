"""Two discs that touch, and the problem of what they leave on a pad."""

from __future__ import annotations

import numpy as np

from helpers_likelihood import GRID, NOISE
from tactile_graph_likelihood.geometry.outlines import DISC
from tactile_graph_likelihood.several.joint.joint_posterior import (
    JointProblem,
    Outlines,
    add_outline,
)
from tactile_graph_likelihood.single.density.element_terms import OFF, ON

PRIOR = np.array([0.0, 0.0, 20.5, 20.5, 1.0, 12.0, 1.0, 0.0, 0.0, 4.5, 1.5])
DISCS = np.array([[6.0, 6.0, 2.6, 4.5, 0.0, 0.0], [11.4, 6.2, 2.6, 4.5, 0.0, 0.0]])


def problem_of_discs(seed=None):
    """Return the problem of both discs on a bare pad; with a seed, of uneven gains and voids."""
    problem = JointProblem(
        GRID, np.zeros((16, 16)), np.zeros((16, 16), np.uint8), NOISE.vector(1.3), PRIOR,
        np.zeros((16, 16)), np.zeros((16, 16)),
    )  # fmt: skip
    for k in range(2):
        add_outline.call(problem, Outlines(np.full(2, DISC), np.zeros(2, np.int64), DISCS), k)
    load = problem.load.copy()
    if seed is not None:
        rng = np.random.default_rng(seed)
        load *= np.exp(0.48 * rng.standard_normal(load.shape)) * (rng.random(load.shape) > 0.16)
    states = np.where(load > 5.0, ON, OFF).astype(np.uint8)
    logs = np.log(np.where(load > 5.0, load, 1.0))
    return problem._replace(logs=logs, states=states, load=0.0 * load, share=0.0 * load)
