"""The one energy against its definition, and what a problem is made of."""

from __future__ import annotations

import numpy as np
import pytest
from pydantic import TypeAdapter, ValidationError

from helpers_modes import plainly
from helpers_mrf import RHO, counted, picture
from tactile_graph.errors import DataError, Degenerate
from tactile_graph.wires import Image, Mask
from tactile_graph_mrf.energy.model import Model
from tactile_graph_mrf.energy.problem import prepare
from tactile_graph_mrf.energy.total import energy, total

NOISES = ("gaussian", "laplace", "student_t", "poisson", "outliers")


def random_lines(problem, rng):
    return [sites & (rng.random(sites.shape) < 0.5) for sites in problem.sites]


def test_the_line_potentials_are_those_told():
    told = {"end": 2.7, "straight": 0.9, "corner": 1.8, "tee": 1.8, "cross": 2.7}
    ours = {"parallel": 1.8, "one": 0.3}
    assert {name: getattr(Model(), name) for name in told | ours} == told | ours
    assert (Model().n_levels, Model().order, Model().smoothness) == (200, 1, "quadratic")


@pytest.mark.parametrize("order", [1, 2, 3])
@pytest.mark.parametrize("smoothness", [*RHO])
def test_energy_is_the_sum_over_all_cliques(order, smoothness):
    rng = np.random.default_rng(order)
    image = Image(rng.normal(size=(5, 6)), valid=rng.random((5, 6)) > 0.2)
    region = Mask(rng.random((5, 6)) > 0.15)
    model = Model(order=order, smoothness=smoothness, n_levels=40, truncation=9.0, lambda_l=70.0)
    problem = prepare(model, image, region)
    labels = rng.integers(0, 40, (5, 6))
    lines = random_lines(problem, rng)
    wanted = counted(problem, labels, *lines)
    assert energy(problem, labels, *lines) == pytest.approx(wanted, rel=1e-12)
    none = [np.zeros_like(part) for part in lines]
    assert energy(problem, labels) == pytest.approx(counted(problem, labels, *none), rel=1e-12)


@pytest.mark.slow
@pytest.mark.parametrize("noise", NOISES)
def test_every_noise_is_counted_and_the_same_compiled(noise):
    rng = np.random.default_rng(3)
    problem = prepare(Model(noise=noise, order=3), picture(9, 7), Mask(rng.random((9, 7)) > 0.1))
    labels = rng.integers(0, 200, (9, 7))
    lines = random_lines(problem, rng)
    wanted = counted(problem, labels, *lines)
    assert energy(problem, labels, *lines) == pytest.approx(wanted, rel=1e-12)
    plain, fast = (
        call(problem.potentials, labels, *lines) for call in (plainly(total), total.compiled)
    )
    assert plain == fast


@pytest.mark.parametrize("shape", [(1, 1), (1, 7), (7, 1), (2, 2)])
def test_narrow_images_have_an_energy(shape):
    problem = prepare(Model(order=3), Image(np.arange(49.0)[: shape[0] * shape[1]].reshape(shape)))
    labels = np.zeros(shape, np.int64)
    lines = [np.zeros(part.shape, np.bool_) for part in problem.sites]
    assert energy(problem, labels) == pytest.approx(counted(problem, labels, *lines))


def test_gaussian_data_term_is_the_squared_difference_of_eq_5_7():
    problem = prepare(Model(lambda_d=0.0), picture())
    wanted = ((problem.start() - problem.observed) ** 2).sum()
    assert energy(problem, problem.start()) == pytest.approx(wanted)
    assert problem.observed.min() == 0
    assert problem.observed.max() == pytest.approx(199)


def test_lines_off_the_field_and_lines_summed_out_do_not_count():
    image = picture()
    region = Mask(np.arange(256).reshape(16, 16) % 16 < 8)
    problem = prepare(Model(), image, region)
    labels = problem.start()
    on = np.ones((16, 15), np.bool_)
    inside = on & (np.arange(15) < 7)
    assert energy(problem, labels, None, on) == energy(problem, labels, None, inside)
    marginal = prepare(Model(lines="marginal"), image)
    assert energy(marginal, labels, None, on) == energy(marginal, labels)


def test_marginal_energy_is_the_least_over_lines_at_the_price_of_straight_ones():
    image = picture(6, 5)
    marginal = prepare(Model(lines="marginal"), image)
    free = dict.fromkeys(("end", "straight", "corner", "tee", "cross", "parallel"), 0.0)
    explicit = prepare(Model(one=1.2, **free), image)
    labels = np.random.default_rng(1).integers(0, 200, (6, 5))
    lines = marginal.lines_of(labels)
    assert sum(part.sum() for part in lines) > 0
    assert energy(marginal, labels) == pytest.approx(energy(explicit, labels, *lines))


def test_a_prior_pulls_towards_the_expected_load_and_only_where_it_is_known():
    image = picture(4, 4)
    valid = np.ones((4, 4), np.bool_)
    valid[0, 0] = False
    expected = Image(np.where(valid, 0.5, 0.0), valid=valid)
    problem = prepare(Model(lambda_prior=3.0), image, None, expected)
    plain = prepare(Model(), image)
    level = (0.5 - problem.low) / problem.step
    rng = np.random.default_rng(0)
    differences = []
    for _ in range(3):
        labels = rng.integers(0, 200, (4, 4))
        prior = 3.0 * ((labels - level) ** 2)[valid].sum()
        differences.append(energy(problem, labels) - energy(plain, labels) - prior)
    assert np.ptp(differences) < 1e-6  # equal but for a constant
    assert problem.unary.centre[0, 0] == plain.unary.centre[0, 0]


def test_cells_without_data_are_sites_if_data_reach_them():
    values = picture(6, 6).values.copy()
    values[2, 2] = np.nan
    valid = np.ones((6, 6), np.bool_)
    valid[:2, :2] = False
    problem = prepare(Model(), Image(values, valid=valid))
    assert problem.in_field.all()
    assert not problem.has_data[2, 2]
    assert problem.unary.curvature[2, 2] == problem.unary.curvature[0, 0] == 0
    alone = Mask(np.isin(np.arange(36).reshape(6, 6), [0, 1, 6, 7, 35]))
    problem = prepare(Model(), Image(values, valid=valid), alone)
    assert problem.in_field.sum() == 1  # the four cells of the corner hold nothing
    assert prepare(Model(lambda_d=0.0), Image(values, valid=valid)).in_field.sum() == 31


@pytest.mark.parametrize("name", ["region", "expected"])
def test_shapes_must_agree(name):
    other = {"region": Mask(np.ones((3, 3), np.bool_)), "expected": Image(np.ones((3, 3)))}[name]
    with pytest.raises(DataError, match=rf"{name}: must have the image's shape \(16, 16\), got"):
        prepare(Model(), picture(), **{name: other})


def test_an_image_without_values_is_degenerate():
    with pytest.raises(Degenerate, match="no cell of the image holds a value"):
        prepare(Model(), Image(np.full((3, 3), np.nan)))


def test_constant_images_and_empty_regions_are_idle():
    assert prepare(Model(), Image(np.full((3, 3), 7.5))).idle
    assert prepare(Model(), Image(0.1 + np.array([[0.0, 1e-17]]))).idle
    assert prepare(Model(), picture(), Mask(np.zeros((16, 16), np.bool_))).idle
    assert not prepare(Model(), picture()).idle


@pytest.mark.parametrize("scale", [1e-280, 1.0, 1e300])
def test_values_of_any_size_have_levels(scale):
    problem = prepare(Model(), Image(np.array([[-1.0, 0.0, 1.0]]) * scale))
    np.testing.assert_allclose(problem.observed, [[0, 99.5, 199]], atol=1e-6)
    np.testing.assert_allclose(problem.restored(problem.observed).values[0, 2], scale)


def test_a_start_is_the_data_and_their_mean_where_there_are_none():
    values = np.array([[0.0, 9.0, 9.0], [9.0, 0.0, 6.0]])
    valid = np.array([[1, 1, 1], [1, 0, 1]], bool)
    start = prepare(Model(n_levels=10), Image(values, valid=valid)).start()
    np.testing.assert_array_equal(start, [[0, 9, 9], [9, 7, 6]])  # of 33 / 5
    nowhere = prepare(Model(n_levels=10), Image(values), Mask(np.zeros((2, 3), bool)))
    np.testing.assert_array_equal(nowhere.start(), np.zeros((2, 3)))


@pytest.mark.parametrize("name", ["lambda_d", "lambda_l", "lambda_prior", "one", "end"])
def test_weights_and_costs_are_told_their_bounds(name):
    high = 1e12 if name.startswith("lambda") else 1e6
    low = 0.0 if name.startswith("lambda") else -1e6
    adapter = TypeAdapter(Model)
    for value in (low, high):
        assert getattr(adapter.validate_python({name: value}), name) == value
    for value in (low - 1.0, 1.0000001 * high):
        with pytest.raises(ValidationError, match=r"should be (less|greater) than or equal to"):
            adapter.validate_python({name: value})
