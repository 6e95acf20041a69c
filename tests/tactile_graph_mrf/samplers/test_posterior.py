"""Mean, spread and line probabilities against sums over all states."""

from __future__ import annotations

from collections import Counter

import numpy as np
import pytest

from helpers_mrf import label_energies, label_states, line_states, picture, tiny
from tactile_graph.wires import Image, Mask
from tactile_graph_mrf.energy.model import Model
from tactile_graph_mrf.energy.problem import prepare
from tactile_graph_mrf.energy.total import energy
from tactile_graph_mrf.samplers.posterior import posterior

pytestmark = pytest.mark.slow  # much is compiled, which no shipped pipeline uses


def sampled(problem, n_samples=4000, **settings):
    return posterior(
        problem.image,
        rng=np.random.default_rng(7),
        model=problem.model,
        energy_scale=0.5,
        n_samples=n_samples,
        **settings,
    )


@pytest.mark.parametrize("noise", ["gaussian", "laplace"])
def test_mean_and_deviation_are_those_of_the_posterior_within_the_stated_size(noise):
    problem = tiny(lines="none", noise=noise)
    states = label_states(9, 4)
    energies = label_energies(problem, states)
    chances = np.exp(-0.5 * (energies - energies.min()))
    chances /= chances.sum()
    mean = chances @ states
    deviation = np.sqrt(chances @ states**2 - mean**2)
    got = sampled(problem)
    assert 500 < got.effective_samples <= 4000
    error = np.abs(got.mean.values.ravel() - mean)
    assert (error < 4.5 * deviation / np.sqrt(got.effective_samples)).all()
    np.testing.assert_allclose(got.deviation.values.ravel(), deviation, rtol=0.1)


@pytest.mark.parametrize("lambda_l", [0.0, 1.0])
@pytest.mark.parametrize("lines", ["none", "explicit", "marginal"])
def test_cells_that_nothing_smooths_have_each_its_own_posterior(lines, lambda_l):
    problem = tiny(3, 4, 5, lines=lines, lambda_d=0.0, lambda_l=lambda_l, sigma=1.5)
    level = np.arange(5)
    chances = np.exp(-0.5 * (level - problem.observed.reshape(-1, 1)) ** 2)
    chances /= chances.sum(axis=1, keepdims=True)
    mean = chances @ level
    deviation = np.sqrt(chances @ level**2 - mean**2)
    got = sampled(problem)
    error = np.abs(got.mean.values.ravel() - mean)
    assert (error < 4.5 * deviation / np.sqrt(4000)).all()
    np.testing.assert_allclose(got.deviation.values.ravel(), deviation, rtol=0.1)


@pytest.mark.parametrize("lines", ["explicit", "marginal"])
def test_line_probabilities_are_those_of_the_posterior(lines):
    free = dict.fromkeys(("end", "straight", "corner", "tee", "cross", "parallel"), 0.0)
    settings = {**free, "one": 1.0, "lambda_l": 1.3} if lines == "marginal" else {}
    problem = tiny(2, 3, 3, **settings)
    states = label_states(6, 3).reshape(-1, 2, 3)
    total = on = 0.0
    for h, v in line_states(2, 3):
        weight = sum(np.exp(-0.5 * energy(problem, x, h, v)) for x in states)
        total += weight
        on = on + weight * np.concatenate([h.ravel(), v.ravel()])
    problem = tiny(2, 3, 3, lines=lines, **settings)
    got = sampled(problem)
    chances = np.concatenate([got.horizontal_probability.ravel(), got.vertical_probability.ravel()])
    np.testing.assert_allclose(chances, on / total, atol=4.5 * 0.5 / got.effective_samples**0.5)
    assert (got.lines.vertical == (got.vertical_probability > 0.5)).all()


def test_same_seed_same_bits_and_the_trace_is_one_energy_a_sample():
    problem = prepare(Model(), picture())
    one, two = (sampled(problem, 20) for _ in range(2))
    assert one.trace == two.trace
    assert len(one.trace) == one.samples == 20
    assert (one.mean.values == two.mean.values).all()
    assert sampled(problem, 20, n_between=3).trace != one.trace


def test_the_scale_left_out_is_that_of_the_likelihood():
    image = picture()
    model = Model(sigma=5.0, lambda_d=0.0, lines="none")
    got = posterior(image, rng=np.random.default_rng(0), model=model)
    step = np.ptp(image.values) / 199
    middle = (image.values > 0.1) & (image.values < 0.9)
    assert np.median(got.deviation.values[middle]) == pytest.approx(5 * step, rel=0.05)
    assert got.effective_samples > 200  # of 500 all independent: the worst of 257 estimates


def test_nothing_to_sample_has_no_spread():
    flat = posterior(Image(np.ones((3, 3))), rng=np.random.default_rng(0))
    assert flat.samples == flat.effective_samples == 0
    assert not flat.deviation.values.any()
    assert (flat.mean.values == 1).all()


def test_regions_and_missing_cells():
    image = picture(8, 8)
    on = np.zeros((8, 8), np.bool_)
    on[:4] = True
    valid = np.ones((8, 8), np.bool_)
    valid[1, 1] = False
    values = np.where(valid, image.values, 0.0)
    got = posterior(
        Image(values, valid=valid), Mask(on), rng=np.random.default_rng(0), n_samples=400
    )
    assert (got.mean.values[4:] == values[4:]).all()
    assert not got.deviation.values[4:].any()
    assert got.deviation.values[1, 1] > np.median(got.deviation.values[:4])
    assert not got.horizontal_probability[3:].any()
    assert Counter(got.mean.valid.ravel().tolist()) == {True: 64}
