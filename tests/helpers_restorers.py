"""Images and exhaustive minima for the tests of the deterministic restorers."""

from __future__ import annotations

import itertools
from functools import cache

import numpy as np

from tactile_graph.wires import Image
from tactile_graph_mrf.energy.model import Model
from tactile_graph_mrf.energy.problem import prepare
from tactile_graph_mrf.energy.total import energy


def square(sigma: float = 15.0, size: int = 16, seed: int = 1) -> Image:
    """A raised square with noise, levels 0 to 199."""
    values = np.full((size, size), 40.0)
    values[size // 4 : 3 * size // 4, size // 4 : 3 * size // 4] = 160.0
    noise = sigma * np.random.default_rng(seed).standard_normal(values.shape)
    values = np.clip(np.rint(values + noise), 0, 199)
    return Image(values)


def tiny(seed: int) -> Image:
    """Nine cells of levels 0 to 3, both ends among them."""
    values = np.random.default_rng(seed).integers(0, 4, (3, 3)).astype(float)
    values.flat[0], values.flat[8] = 0.0, 3.0
    return Image(values)


def tiny_model(**changes: object) -> Model:
    """A model of four levels on which smoothness and data are a match."""
    return Model(
        **{"n_levels": 4, "lambda_d": 0.7, "truncation": 1.5, "lines": "none", **changes}  # type: ignore[arg-type]
    )


@cache
def least_energy(model: Model, seed: int) -> float:
    """The least energy of all 4^9 labellings without lines, counted term by term."""
    problem = prepare(model, tiny(seed))
    x = np.array([*itertools.product(range(4), repeat=9)]).reshape(-1, 3, 3)
    unary, rho = problem.own_costs(), problem.pairwise.smooth
    i, j = np.indices((3, 3))
    costs = unary[i, j, x].sum(axis=(1, 2))
    for (di, dj), weight in zip(
        problem.pairwise.offsets.tolist(), problem.pairwise.weights.tolist(), strict=True
    ):
        a = x[:, : 3 - di, max(-dj, 0) : 3 - max(dj, 0)]
        b = x[:, di:, max(dj, 0) : 3 - max(-dj, 0)]
        costs += weight * rho[np.abs(a - b)].sum(axis=(1, 2))
    best = int(costs.argmin())
    assert np.isclose(costs[best], energy(problem, x[best]))
    return float(costs[best])


def never_rises(trace: tuple[float, ...]) -> bool:
    """Whether a trace of energies falls or stays, but for rounding."""
    steps = np.diff(trace)
    return bool((steps <= 1e-9 * np.abs(trace[:-1])).all())


def own_energy(model: Model, image: Image, restored: object) -> float:
    """The model's energy of a restored image, labels read back from its values."""
    problem = prepare(model, image)
    values = restored.image.values  # type: ignore[attr-defined]
    labels = np.rint((values - problem.low) / problem.step).astype(np.int64)
    labels = np.where(problem.in_field, labels, 0)
    lines = restored.lines  # type: ignore[attr-defined]
    return energy(problem, labels, lines.horizontal, lines.vertical)
