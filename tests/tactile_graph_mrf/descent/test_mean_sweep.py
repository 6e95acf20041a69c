"""Sweeps and free energy of the mean field against means over every state of tiny fields."""

from __future__ import annotations

from itertools import product

import numpy as np
import pytest

from helpers_mrf import patterns
from tactile_graph.wires import Image, Mask
from tactile_graph_mrf.descent.mean_field import MeanField
from tactile_graph_mrf.descent.mean_sweep import mean_costs, softened
from tactile_graph_mrf.energy.model import Model
from tactile_graph_mrf.energy.problem import Problem, prepare

pytestmark = pytest.mark.usefixtures("plain_kernels")

L = 3
COSTS = {"end": 2.7, "straight": 0.9, "corner": 1.3, "tee": 2.1, "cross": 3.3, "parallel": 1.7}
EXPLICIT = {"lines": "explicit", "lambda_l": 0.4, "one": 0.3, **COSTS}
HOLE = np.array([[1, 1, 1], [1, 0, 1]], bool)
FIELDS = [
    ((2, 3), None, EXPLICIT),
    ((3, 2), None, EXPLICIT),
    ((2, 3), HOLE, EXPLICIT),
    ((2, 3), HOLE, {"lines": "none", "order": 2}),
    ((3, 2), None, {"lines": "none", "order": 3, "smoothness": "truncated_quadratic"}),
    ((2, 3), None, {"lines": "marginal", "lambda_l": 0.5}),
    ((2, 3), None, {"lines": "none", "noise": "student_t", "smoothness": "huber"}),
]
NAMES = ["lines", "upright", "lines and a hole", "order 2", "order 3", "marginal", "heavy tails"]


def field_of(shape, region, settings) -> Problem:
    image = Image(np.random.default_rng(6).normal(size=shape))
    model = Model(n_levels=L, lambda_d=0.7, truncation=1.2, **settings)
    return prepare(model, image, None if region is None else Mask(region))


class States:
    """The energy of every state: an axis for each cell of the field, then for each line."""

    def __init__(self, problem: Problem) -> None:
        self.cells = [tuple(at) for at in np.argwhere(problem.in_field).tolist()]
        lined = problem.model.lines == "explicit"
        self.sites = [
            (kind, tuple(at))
            for kind, sites in enumerate(problem.sites)
            for at in np.argwhere(sites).tolist()
            if lined
        ]
        n, m = len(self.cells), len(self.sites)
        self.energy = np.zeros((L,) * n + (2,) * m)
        own = problem.own_costs()
        for k, at in enumerate(self.cells):
            self.energy += self._along(own[at], k)
        step = problem.pairwise.smooth[np.abs(np.subtract.outer(range(L), range(L)))]
        for (a, p), (b, q) in product(enumerate(self.cells), repeat=2):
            far = (p[0] - q[0]) ** 2 + (p[1] - q[1]) ** 2
            if a < b and far <= {1: 1, 2: 2, 3: 4}[problem.model.order]:
                pair = self._along(step / far, a, b)
                between = (0 if q[0] > p[0] else 1, p)
                if between in self.sites:
                    pair = pair * self._along(np.array([1.0, 0.0]), n + self.sites.index(between))
                self.energy += pair
        if lined:
            for on in product((0, 1), repeat=m):
                lines = [np.zeros(sites.shape, bool) for sites in problem.sites]
                for (kind, at), one in zip(self.sites, on, strict=True):
                    lines[kind][at] = bool(one)
                self.energy[(..., *on)] += problem.model.lambda_l * patterns(problem, *lines)

    def _along(self, values, *axes):
        shape = [1] * self.energy.ndim
        for axis, n in zip(axes, values.shape, strict=True):
            shape[axis] = n
        return values.reshape(shape)

    def mean(self, chances, but=None):
        """The mean energy of independent sites; of each value of the site ``but``."""
        left = self.energy
        for axis in reversed(range(left.ndim)):
            if axis != but:
                left = np.tensordot(left, chances[axis], (axis, 0))
        return left


def random_start(problem: Problem, states: States, seed: int):
    """A mean field with random chances, and the same as a list of distributions."""
    rng = np.random.default_rng(seed)
    mean = MeanField(problem)
    cells = mean.chances.cells
    cells[:] = rng.dirichlet(np.ones(L), problem.shape)
    levels = np.arange(L)
    mean.chances.felt[:] = cells @ problem.pairwise.smooth[np.abs(levels[:, None] - levels)]
    chances = [cells[at].copy() for at in states.cells]
    for kind, at in states.sites:
        share = rng.random()
        mean.chances[2 + kind][at] = share
        chances.append(np.array([1.0 - share, share]))
    return mean, chances


@pytest.mark.parametrize("temperature", [0.4, 3.0])
@pytest.mark.parametrize("field", FIELDS, ids=NAMES)
def test_a_sweep_gives_each_site_what_the_others_mean_for_it(field, temperature):
    problem = field_of(*field)
    states = States(problem)
    mean, chances = random_start(problem, states, 3)
    most = 0.0
    for axis, old in enumerate(list(chances)):
        cost = states.mean(chances, axis)
        weights = np.exp(-(cost - cost.min()) / temperature)
        chances[axis] = weights / weights.sum()
        change = np.abs(chances[axis] - old)
        most = max(most, change.sum() if axis < len(states.cells) else change[1])
    assert mean.sweep(temperature) == pytest.approx(most, abs=1e-9)
    n = len(states.cells)
    for at, wanted in zip(states.cells, chances[:n], strict=True):
        np.testing.assert_allclose(mean.chances.cells[at], wanted, atol=1e-9)
    for (kind, at), (_, wanted) in zip(states.sites, chances[n:], strict=True):
        assert mean.chances[2 + kind][at] == pytest.approx(wanted, abs=1e-9)


@pytest.mark.parametrize("field", FIELDS, ids=NAMES)
def test_the_free_energy_is_the_mean_over_all_states_less_the_entropy(field):
    problem = field_of(*field)
    states = States(problem)
    mean, chances = random_start(problem, states, 4)
    entropy = -sum((p * np.log(p)).sum() for p in chances)
    for temperature in (0.0, 1.7):
        wanted = states.mean(chances) - temperature * entropy
        assert mean.free_energy(temperature) == pytest.approx(float(wanted), rel=1e-9)


def test_sums_go_as_far_as_the_smoothness_grows():
    image = Image(np.arange(6.0)[None, :])
    for told, reach in (
        ({"smoothness": "truncated_quadratic", "truncation": 1.5}, 2),
        ({"smoothness": "quadratic"}, 5),
        ({"lambda_d": 0.0}, 0),
    ):
        assert MeanField(prepare(Model(n_levels=6, **told), image))._reach == reach


def test_the_likeliest_state_has_a_line_where_it_is_likelier_than_not():
    problem = field_of((2, 3), HOLE, EXPLICIT)
    mean, _ = random_start(problem, States(problem), 5)
    mean.chances.down[0] = 0.5, 0.51
    labels, across, down = mean.likeliest()
    np.testing.assert_array_equal(labels[HOLE], mean.chances.cells[HOLE].argmax(axis=1))
    assert labels[1, 1] == 0
    assert down[0].tolist() == [False, True]
    np.testing.assert_array_equal(across, mean.chances.across > 0.5)


def test_however_much_the_labels_cost_their_chances_add_up_to_one():
    chance = np.empty(4)
    softened.loops(1e6 + np.array([2.0, 0.0, 5000.0, np.log(3.0)]), 1.0, chance)
    weights = np.array([np.exp(-2.0), 1.0, 0.0, 1.0 / 3.0])
    np.testing.assert_allclose(chance, weights / weights.sum(), rtol=1e-9)


@pytest.mark.parametrize("reach", [0, 3, 8])
def test_mean_costs_are_sums_over_all_labels(reach: int) -> None:
    smooth = np.minimum(np.arange(9.0), reach) ** 2
    chance = np.random.default_rng(0).dirichlet(np.ones(9))
    nearer = np.concatenate([smooth[:0:-1], smooth]) - smooth[reach]
    found = np.empty(9)
    mean_costs(chance, smooth[reach], nearer, reach, found)
    apart = np.abs(np.subtract.outer(range(9), range(9)))
    np.testing.assert_allclose(found, smooth[apart] @ chance, rtol=1e-13, atol=1e-13)
