"""An independent count of the energy, and sums over all states of tiny fields."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise, product
from typing import Any

import numpy as np
from scipy.stats import chi2

from tactile_graph.wires import Image
from tactile_graph_mrf.energy.model import Model
from tactile_graph_mrf.energy.problem import Problem, prepare

RHO = {
    "quadratic": lambda d, t: d * d,
    "truncated_quadratic": lambda d, t: min(d * d, t * t),
    "absolute": lambda d, t: d,
    "truncated_absolute": lambda d, t: min(d, t),
    "huber": lambda d, t: d * d if d <= t else 2 * t * d - t * t,
    "geman_mcclure": lambda d, t: d * d * t * t / (t * t + d * d),
}


def picture(rows: int = 16, columns: int = 16, noise: float = 0.08, seed: int = 0) -> Image:
    """A plate in the middle of the pad, with Gaussian noise."""
    values = np.zeros((rows, columns))
    values[rows // 4 : rows - rows // 4, columns // 4 : columns - columns // 4] = 1.0
    return Image(values + noise * np.random.default_rng(seed).normal(size=values.shape))


def line_between(lines_h: Any, lines_v: Any, a: tuple[int, int], b: tuple[int, int]) -> bool:
    """Whether the line between two cells that share a side is on."""
    (i, j), (m, _n) = sorted([a, b])
    return bool(lines_h[i, j] if m == i + 1 else lines_v[i, j])


def ways(a: tuple[int, int], b: tuple[int, int]) -> list[list[tuple[int, int]]]:
    """All shortest ways from cell to cell by steps to a side."""
    if a == b:
        return [[a]]
    found = []
    for axis in range(2):
        if a[axis] != b[axis]:
            step = list(a)
            step[axis] += 1 if b[axis] > a[axis] else -1
            found += [[a, *rest] for rest in ways((step[0], step[1]), b)]
    return found


def counted(problem: Problem, labels: Any, lines_h: Any, lines_v: Any) -> float:
    """The energy from its definition, pair by pair; explicit or no lines, whole field."""
    model, (rows, columns) = problem.model, problem.shape
    own = problem.own_costs()
    cells = [(i, j) for i, j in product(range(rows), range(columns)) if problem.in_field[i, j]]
    energy = sum(own[i, j, labels[i, j]] for i, j in cells)
    reach = {1: 1, 2: 2, 3: 4}[model.order]
    for n, a in enumerate(cells):
        for b in cells[:n]:
            far = (a[0] - b[0]) ** 2 + (a[1] - b[1]) ** 2
            if far > reach:
                continue
            cut = all(
                any(line_between(lines_h, lines_v, p, q) for p, q in pairwise(w))
                for w in ways(a, b)
            )
            if not cut:
                rho = RHO[model.smoothness](abs(int(labels[a]) - int(labels[b])), model.truncation)
                energy += model.lambda_d * rho / far
    return float(energy + model.lambda_l * patterns(problem, lines_h, lines_v))


def patterns(problem: Problem, lines_h: Any, lines_v: Any) -> float:
    """V_l of Eq. 5.22, corner by corner."""
    model, field = problem.model, problem.in_field
    rows, columns = problem.shape
    cost = model.one * (np.sum(lines_h) + np.sum(lines_v))
    cost += model.parallel * (lines_h[:-1] & lines_h[1:]).sum()
    cost += model.parallel * (lines_v[:, :-1] & lines_v[:, 1:]).sum()
    for i, j in product(range(rows - 1), range(columns - 1)):
        if not field[i : i + 2, j : j + 2].all():
            continue
        up, down, left, right = lines_v[i, j], lines_v[i + 1, j], lines_h[i, j], lines_h[i, j + 1]
        n = int(up) + int(down) + int(left) + int(right)
        two = model.straight if bool(up) == bool(down) else model.corner
        cost += (0.0, model.end, two, model.tee, model.cross)[n]
    return float(cost)


def label_states(n_cells: int, n_levels: int) -> np.ndarray:
    """Every labelling, shape (states, cells)."""
    return np.array(list(product(range(n_levels), repeat=n_cells)), np.int64)


def line_states(rows: int, columns: int) -> Iterator[tuple[np.ndarray, np.ndarray]]:
    """Every line field of a grid."""
    n = (rows - 1) * columns
    for bits in product((False, True), repeat=n + rows * (columns - 1)):
        lines = np.array(bits)
        yield lines[:n].reshape(rows - 1, columns), lines[n:].reshape(rows, columns - 1)


def label_energies(problem: Problem, states: np.ndarray) -> np.ndarray:
    """The energy of each labelling without lines."""
    rows, columns = problem.shape
    cells = np.arange(rows * columns)
    own = problem.own_costs().reshape(rows * columns, -1)
    energies = own[cells, states].sum(axis=1)
    reach = {1: 1, 2: 2, 3: 4}[problem.model.order]
    for a, b in product(cells, cells):
        far = (a // columns - b // columns) ** 2 + (a % columns - b % columns) ** 2
        if a < b and far <= reach:
            energies += problem.pairwise.smooth[np.abs(states[:, a] - states[:, b])] / far
    return energies


def assert_fits(counts: np.ndarray, chances: np.ndarray) -> None:
    """Chi-square of counts against chances, bins expected below 5 put together; p > 1e-4."""
    expected = chances / chances.sum() * counts.sum()
    rare = expected < 5
    counts = np.append(counts[~rare], counts[rare].sum())
    expected = np.append(expected[~rare], expected[rare].sum())
    full = expected > 1e-9
    assert counts[~full].sum() == 0
    misfit = ((counts[full] - expected[full]) ** 2 / expected[full]).sum()
    assert misfit < chi2.isf(1e-4, max(full.sum() - 1, 1)), (misfit, full.sum())


def tiny(rows: int = 3, columns: int = 3, n_levels: int = 4, **settings: Any) -> Problem:
    """A field whose observations are whole levels, the least 0 and the greatest L - 1."""
    rng = np.random.default_rng(5)
    values = rng.integers(0, n_levels, (rows, columns)).astype(float)
    values[0, 0], values[-1, -1] = 0.0, n_levels - 1.0
    settings = {"sigma": 0.8, "truncation": 1.5, "lambda_d": 0.7, "lambda_l": 0.6, **settings}
    return prepare(Model(n_levels=n_levels, **settings), Image(values))
