"""The posteriors of outlines that were found together, and where a search for them may begin."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from tactile_graph.errors import Degenerate
from tactile_graph.wires import Shape
from tactile_graph_likelihood.geometry.outlines import ELLIPSE, FREE, Values, packed, unknowns
from tactile_graph_likelihood.several.joint_posterior import MIDDLE, WIDTH
from tactile_graph_likelihood.several.maximise_jointly import log_mass
from tactile_graph_likelihood.several.misfit import misfit_of_load
from tactile_graph_likelihood.several.scene import Found, Scene
from tactile_graph_likelihood.single.posterior import Posterior


def posteriors(scene: Scene, found: Found) -> tuple[list[Posterior], float, float]:
    """Return each outline's posterior, and the two numbers of the misfit.

    Raises
    ------
    Degenerate
        If an outline has no posterior: too few of its points are possible.

    Notes
    -----
    Points are sampled around each outline beside the others, then spread by what the others'
    own uncertainty adds to its covariance, from the information of all together.
    """
    load = scene.beside(found, ()).load
    counts = [unknowns.call(int(k), int(n)) + 1 for k, n, _ in zip(*found.arrays, strict=True)]
    surprise, alike = misfit_of_load.call(load, sum(counts), scene.logs, scene.states, scene.noise)
    matrix = np.empty((found.count * WIDTH, found.count * WIDTH))
    log_mass.call(
        *found.arrays, scene.bare, scene.bare, scene.grid, scene.logs, scene.states, scene.noise,
        scene.prior, matrix,
    )  # fmt: skip
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


def started(shapes: Sequence[Shape], scene: Scene) -> Found:
    """Return shapes as outlines of the kinds that are looked for, not yet climbed."""
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
        row[unknowns.call(kind, n)] = scene.prior[MIDDLE]
        kinds.append(kind)
        corners.append(n)
    return Found(np.array(kinds), np.array(corners), points, 0.0)
