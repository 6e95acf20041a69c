import numpy as np
import pytest

from helpers_modes import plainly
from helpers_restorers import square, tiny, tiny_model
from tactile_graph.errors import Degenerate
from tactile_graph_mrf.descent.mean_field import MeanField, mean_field
from tactile_graph_mrf.descent.mean_sweep import mean_sweep
from tactile_graph_mrf.energy.model import Model
from tactile_graph_mrf.energy.problem import prepare
from tactile_graph_mrf.energy.total import energy

pytestmark = pytest.mark.slow  # much is compiled, which no shipped pipeline uses


@pytest.mark.slow
@pytest.mark.parametrize("temperature", [0.05, 1.0, 100.0])
@pytest.mark.parametrize("lines", ["none", "explicit", "marginal"])
def test_no_sweep_raises_the_free_energy(lines, temperature):
    model = tiny_model(smoothness="quadratic", lines=lines, lambda_l=0.8)
    mean = MeanField(prepare(model, tiny(2)))
    free = [mean.free_energy(temperature)]
    for _ in range(6):
        mean.sweep(temperature)
        free.append(mean.free_energy(temperature))
    assert (np.diff(free) <= 1e-9 * np.abs(free[:-1])).all()
    assert free[-1] < free[0]


def test_the_free_energy_of_a_hard_state_is_the_energy():
    model = tiny_model(smoothness="quadratic", lines="explicit", lambda_l=0.8)
    problem = prepare(model, tiny(3))
    mean = MeanField(problem)
    for _ in range(10):
        mean.sweep(1e-6)
    assert mean.free_energy(0.0) == pytest.approx(energy(problem, *mean.likeliest()))


def test_without_smoothness_the_chances_are_the_data_terms():
    """exp(-(x - g)² / T), normalised, whatever T."""
    problem = prepare(tiny_model(smoothness="quadratic", lambda_d=0.0), tiny(0))
    for temperature in (1e-6, 0.7, 1e12):
        mean = MeanField(problem)
        mean.sweep(temperature)
        cost = (np.arange(4) - problem.observed[..., None]) ** 2 / temperature
        wanted = np.exp(-cost) / np.exp(-cost).sum(axis=2, keepdims=True)
        np.testing.assert_allclose(mean.chances.cells, wanted, atol=1e-12)


def test_explicit_lines_above_order_one_are_refused():
    with pytest.raises(ValueError, match="explicit lines need order 1 in mean_field, got order 2"):
        mean_field(square(), model=Model(order=2))


def test_what_would_not_fit_is_refused_before_it_is_tried():
    with pytest.raises(Degenerate, match="at most 40000000 in all; take fewer levels or a crop"):
        mean_field(square(size=128), model=Model(n_levels=4096))


def test_a_sweep_is_the_same_compiled_and_plain():
    pytest.importorskip("numba")
    problem = prepare(tiny_model(smoothness="quadratic", lines="explicit", lambda_l=0.8), tiny(4))
    kept = []
    for kernel in (plainly(mean_sweep), mean_sweep.compiled):
        mean = MeanField(problem)
        mean._kernel = kernel
        for _ in range(3):
            mean.sweep(2.0)
        kept.append(mean)
    np.testing.assert_allclose(kept[0].chances.cells, kept[1].chances.cells, rtol=1e-12)
    np.testing.assert_allclose(kept[0].chances.down, kept[1].chances.down, rtol=1e-12)
