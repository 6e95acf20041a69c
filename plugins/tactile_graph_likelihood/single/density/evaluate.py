"""What a search and a sampler ask of a point: element by element, or by the outline's rim.

``whole`` says which. Where up to 1500 elements are touched it is None, and nothing of what wide
outlines need is compiled. Else it is a `CoveredWhole`: of no rows where looking at each element
costs no more.
"""

from __future__ import annotations

from tactile_graph.compiled import compiled_as_is
from tactile_graph_likelihood.geometry.outlines import Values
from tactile_graph_likelihood.large_pads.by_rim import (
    information_by_rim,
    log_likelihood_by_rim,
)
from tactile_graph_likelihood.large_pads.covered_whole import CoveredWhole
from tactile_graph_likelihood.single.density.information import Information, information
from tactile_graph_likelihood.single.density.log_posterior import log_likelihood
from tactile_graph_likelihood.single.density.problem import Problem


@compiled_as_is
def log_likelihood_at(problem: Problem, whole: CoveredWhole | None, p: Values) -> float:
    """Return the log likelihood of an image, over that of a bare pad, at a point, shape (K,)."""
    if whole is None:
        return log_likelihood(problem, p)
    if whole.runs.shape[0] == 0:
        return log_likelihood(problem, p)
    return log_likelihood_by_rim(problem, whole, p)


@compiled_as_is
def information_at(
    problem: Problem, whole: CoveredWhole | None, p: Values, out: Information
) -> float:
    """Write the slope of the log likelihood at a point, and an information matrix.

    Returns
    -------
    float
        The log likelihood.
    """
    if whole is None:
        return information(problem, p, out)
    if whole.runs.shape[0] == 0:
        return information(problem, p, out)
    information_by_rim(problem, whole, p, out)
    return log_likelihood_by_rim(problem, whole, p)
