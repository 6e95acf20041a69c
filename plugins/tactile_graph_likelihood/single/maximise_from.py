"""Climbs one after another: what begins far off needs elements that feel beyond their edge."""

from __future__ import annotations

import math

from tactile_graph.compiled import compiled_as_is
from tactile_graph_likelihood.geometry.outlines import Values
from tactile_graph_likelihood.large_pads.rims import touched_beside
from tactile_graph_likelihood.large_pads.solid import LARGE_PAD
from tactile_graph_likelihood.single.covered_whole import inside_of, nothing_inside
from tactile_graph_likelihood.single.element_terms import FOAM, STRAYS
from tactile_graph_likelihood.single.maximise import climbed
from tactile_graph_likelihood.single.problem import Problem, read_by

ROUNDS = 25
ROUGH, ENOUGH = 0.5, 0.2  # gain in log posterior at which the first and second climb end
STRIDE = 1.5  # pitches that an edge moves a round on a large pad: rows it never felt lie beyond
SOFT = 0.05  # share of its load that an element takes from its surroundings in the first climb
NO_STRAYS = 1e-12


@compiled_as_is
def climbed_twice(problem: Problem, stride: float, p: Values, root: Values) -> float:
    """Climb with elements that feel a little beyond their edge, then with the true ones.

    Otherwise a touched element that is not covered would not pull at all.
    """
    soft, strict = problem.grid.copy(), problem.noise.copy()
    soft[4], soft[5] = SOFT, problem.grid[2]
    strict[STRAYS] = NO_STRAYS
    nothing = nothing_inside(0)
    climbed(read_by(problem, soft, strict), nothing, p, ROUNDS, ROUGH, stride, root)
    top, _ = climbed(problem, inside_of(problem, p), p, ROUNDS, ENOUGH, stride, root)
    return top


@compiled_as_is
def climbed_from(problem: Problem, block: int, p: Values, root: Values) -> float:
    """Climb; with true elements at once from where blocks have brought a large outline.

    Parameters
    ----------
    problem, p, root
        As in `climb.climbed`.
    block : int
        As `coarse.coarsened` gives it.

    Returns
    -------
    float
        The log posterior at the top.
    """
    stride = STRIDE if problem.states.size > LARGE_PAD else math.inf
    if block > 1 and problem.noise[FOAM] <= 0.0:
        top, _ = climbed(problem, inside_of(problem, p), p, ROUNDS, ENOUGH, stride, root)
        if not touched_beside(problem, p):
            return top
    return climbed_twice(problem, stride, p, root)
