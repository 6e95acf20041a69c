"""The posteriors of outlines that were found together, and how well the frame fits them."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from tactile_graph.compiled import compiled_as_is
from tactile_graph.errors import Degenerate
from tactile_graph.wires import Shape
from tactile_graph_likelihood.geometry.outlines import ELLIPSE, FREE, Values, packed, unknowns
from tactile_graph_likelihood.several.joint_posterior import MIDDLE, WIDTH, JointProblem
from tactile_graph_likelihood.several.maximise_jointly import settle
from tactile_graph_likelihood.several.scene import Configuration, Scene
from tactile_graph_likelihood.single.element_terms import (
    LEAST,
    ON,
    ROOT_TWO_PI,
    SIGMA,
    SPAN,
    SQRT_HALF,
    STRAYS,
    UNKNOWN,
    VOIDS,
)
from tactile_graph_likelihood.single.goodness_of_fit import (
    DENSITY,
    SURE,
    moments_of_strays,
    moments_of_term,
)
from tactile_graph_likelihood.single.posterior import Posterior


@compiled_as_is
def goodness_of_load(problem: JointProblem, fitted: int) -> tuple[float, float]:
    """Return how surprising an image is, and how much neighbours' gains are alike.

    Parameters
    ----------
    problem : JointProblem
        Its load is that of all outlines together.
    fitted : int
        How many numbers were fitted.

    Returns
    -------
    (float, float)
        As of `goodness_of_fit`, but of the patterns only how alike neighbours are, not over the
        residuals' own variance.
    """
    expected, logs, states, noise = problem.load, problem.logs, problem.states, problem.noise
    rows, cols = states.shape
    sigma, present, strays = noise[SIGMA], 1.0 - noise[VOIDS], noise[STRAYS]
    level = math.log((1.0 - strays) * present / (sigma * ROOT_TWO_PI))
    stray, bare = math.log(strays / SPAN), math.log(1.0 - strays)
    mean_bare, var_bare = moments_of_strays(strays)
    got = mean = variance = pairs = product = 0.0
    residuals = np.zeros((rows + 1, cols + 1))
    for i in range(rows):
        for j in range(cols):
            on = states[i, j] == ON
            if states[i, j] == UNKNOWN:
                continue
            if expected[i, j] <= 0.0:
                got += stray if on else bare
                mean += mean_bare
                variance += var_bare
                continue
            mu = math.log(expected[i, j])
            z = min(max((mu - noise[LEAST]) / sigma, -40.0), 40.0)
            tail, density = 0.5 * math.erfc(-SQRT_HALF * z), DENSITY * math.exp(-0.5 * z * z)
            off, one, spread = moments_of_term(z, tail, density, level, present, bare)
            if on:
                u = (logs[i, j] - mu) / sigma
                got += math.log(math.exp(level - 0.5 * u * u) + strays / SPAN)
                residuals[i, j] = u if z > SURE else 0.0
            else:
                got += off
            mean += one
            variance += spread
    for i in range(rows):
        for j in range(cols):
            for other in (residuals[i + 1, j], residuals[i, j + 1]):
                if residuals[i, j] != 0.0 and other != 0.0:
                    pairs += 1.0
                    product += residuals[i, j] * other
    alike = product / math.sqrt(pairs) if pairs > 0.0 else 0.0
    return (got - 0.5 * fitted - mean) / math.sqrt(variance), alike


def posteriors(scene: Scene, found: Configuration) -> tuple[list[Posterior], float, float]:
    """Return each outline's posterior, and the two numbers of `goodness_of_load`.

    Raises
    ------
    Degenerate
        If an outline has no posterior: too few of its points are possible.

    Notes
    -----
    Points are sampled around each outline beside the others, then spread by what the others'
    own uncertainty adds to its covariance, from the information of all together.
    """
    counts = [unknowns.call(int(k), int(n)) + 1 for k, n, _ in zip(*found.outlines, strict=True)]
    surprise, alike = goodness_of_load.call(scene.beside(found, ()), sum(counts))
    matrix = np.empty((found.count * WIDTH, found.count * WIDTH))
    settle.call(scene.problem, found.outlines, 0, 0.0, matrix)
    together = np.asarray(np.linalg.inv(matrix), dtype=np.float64)
    out = []
    for k, n in enumerate(counts):
        some = scene.sampled(found, k)
        if some.equal_points <= 1.0:
            raise Degenerate(f"object {k + 1} of {found.count}: no outlines near the likeliest one")
        here = slice(k * WIDTH, k * WIDTH + n)
        alone = np.asarray(np.linalg.inv(matrix[here, here]), dtype=np.float64)
        points = some.points.copy()
        mean = np.asarray(some.weights @ points, dtype=np.float64)
        off = np.asarray((points - mean) @ _wider(alone, together[here, here]).T, dtype=np.float64)
        points = mean + off
        covariance = (off * some.weights[:, None]).T @ off
        covariance /= max(1.0 - float(some.weights @ some.weights), 0.05)
        kind, corners, top = int(found.kinds[k]), int(found.corners[k]), found.points[k, :n]
        own = (some.log_evidence, some.equal_points, surprise, alike)
        out.append(
            Posterior(kind, corners, mean, covariance, points, some.weights, top.copy(), *own)
        )
    return out, surprise, alike


def _wider(alone: Values, together: Values) -> Values:
    """Return what turns points of one covariance into points of another."""
    return np.asarray(np.linalg.cholesky(together) @ np.linalg.inv(np.linalg.cholesky(alone)))


def configuration_of(shapes: Sequence[Shape], scene: Scene) -> Configuration:
    """Return shapes as outlines of the kinds that are looked for, not yet maximised."""
    fallback = next((k for k in scene.kinds if k[0] == ELLIPSE), scene.kinds[0])
    kinds, corners, points = [], [], np.zeros((len(shapes), WIDTH))
    for row, shape in zip(points, shapes, strict=True):
        kind, n, p = packed(shape)
        if kind == FREE or (kind, n) not in scene.kinds:
            kind, n = fallback
            radius = math.sqrt(shape.area_cm2 / math.pi)
            p = np.array([shape.x_cm, shape.y_cm, radius, radius, 0.0])
            p = p[: unknowns.call(kind, n)]
        row[: len(p)] = p
        row[unknowns.call(kind, n)] = scene.problem.prior[MIDDLE]
        kinds.append(kind)
        corners.append(n)
    return Configuration(np.array(kinds), np.array(corners), points, 0.0)
