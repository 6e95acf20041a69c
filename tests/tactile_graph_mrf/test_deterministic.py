"""What holds for every deterministic restorer alike."""

import itertools

import numpy as np
import pytest

from helpers_restorers import (
    least_energy,
    never_rises,
    own_energy,
    square,
    tiny,
    tiny_model,
)
from tactile_graph.errors import Degenerate
from tactile_graph.wires import Image, Mask
from tactile_graph_mrf.descent.gnc import gnc
from tactile_graph_mrf.descent.graph_cuts import graph_cuts
from tactile_graph_mrf.descent.mean_field import mean_field
from tactile_graph_mrf.descent.restore import restore
from tactile_graph_mrf.descent.trw import trw
from tactile_graph_mrf.energy.model import Model
from tactile_graph_mrf.energy.problem import prepare
from tactile_graph_mrf.energy.total import energy

pytestmark = pytest.mark.slow

pytest.importorskip("maxflow", reason="graph_cuts needs PyMaxflow")

TRUNCATED = Model(smoothness="truncated_quadratic", lines="none")
# Shipped pipelines use none of the last two, and much of them is compiled.
RARE = [pytest.param(step, marks=pytest.mark.slow) for step in (mean_field, trw)]
ALL = [gnc, restore, graph_cuts, *RARE]


def coarse(**changes):
    return Model(n_levels=24, lines="marginal", truncation=4.0, lambda_l=20.0, **changes)


@pytest.mark.parametrize("step", ALL)
def test_the_energy_given_is_the_models_own(step):
    image, model = square(), coarse()
    restored = step(image, model=model)
    assert restored.energy == pytest.approx(own_energy(model, image, restored), rel=1e-12)
    assert restored.sweeps == len(restored.trace)
    assert restored.energy == pytest.approx(min(restored.trace))


@pytest.mark.parametrize("step", ALL)
def test_the_same_image_gives_the_same_bits(step):
    model = coarse()
    one, two = step(square(), model=model), step(square(), model=model)
    assert one.image.values.tobytes() == two.image.values.tobytes()
    assert one.trace == pytest.approx(two.trace, rel=1e-12)  # sums, compiled or not


@pytest.mark.parametrize("step", [gnc, restore, graph_cuts, RARE[0]])
def test_explicit_lines_are_found_around_the_square(step):
    model = Model(n_levels=40, lambda_l=100.0)
    image = square(5.0)
    restored = step(image, model=model)
    assert restored.energy == pytest.approx(own_energy(model, image, restored), rel=1e-12)
    assert restored.lines.horizontal[3, 4:12].all()
    assert restored.lines.vertical[4:12, 11].all()
    assert restored.lines.count == 32


@pytest.mark.parametrize("step", ALL)
def test_a_constant_image_is_given_back_unswept(step):
    model = coarse()
    restored = step(Image(np.full((5, 4), 2.5)), model=model)
    assert (restored.image.values == 2.5).all()
    assert restored.trace == ()
    assert restored.lines.count == 0


@pytest.mark.parametrize("step", ALL)
def test_missing_cells_are_inferred_and_nothing_is_nan(step):
    noisy = square(5.0)
    valid = np.ones(noisy.shape, bool)
    valid[6:8, 6:8] = False
    image = Image(np.where(valid, noisy.values, 0.0), valid=valid)
    restored = step(image, model=coarse())
    assert restored.image.valid.all()
    assert np.isfinite(restored.image.values).all()
    assert np.abs(restored.image.values[6:8, 6:8] - 160.0).max() < 20.0


@pytest.mark.parametrize("step", ALL)
def test_cells_outside_the_region_stay_as_they_were(step):
    image = square()
    region = np.zeros(image.shape, bool)
    region[2:9, 3:11] = True
    restored = step(image, Mask(region), model=coarse())
    assert np.array_equal(restored.image.values[~region], image.values[~region])
    assert not np.array_equal(restored.image.values[region], image.values[region])


@pytest.mark.parametrize("step", ALL)
def test_an_image_without_values_is_refused_in_words(step):
    image = Image(np.zeros((4, 4)), valid=np.zeros((4, 4), bool))
    with pytest.raises(Degenerate, match="no cell of the image holds a value"):
        step(image, model=coarse())


@pytest.mark.parametrize("step", ALL)
@pytest.mark.parametrize("weight", [0.0, 1e12])
def test_extreme_smoothness_is_survived(step, weight):
    """Without smoothness the data stay; with all of it one level is left."""
    image = square(size=8)
    model = Model(n_levels=24, lambda_d=weight, lines="none")
    restored = step(image, model=model)
    level = (image.values.max() - image.values.min()) / 23
    if weight == 0.0:
        assert np.abs(restored.image.values - image.values).max() <= 0.501 * level
    elif step in (restore, graph_cuts):
        assert np.ptp(restored.image.values) == 0.0
    assert np.isfinite(restored.energy)


@pytest.mark.parametrize("step", ALL)
@pytest.mark.parametrize("shape", [(1, 1), (1, 7), (7, 1), (2, 2)])
def test_small_grids_are_restored(step, shape):
    values = np.arange(float(np.prod(shape))).reshape(shape)
    restored = step(Image(values), model=coarse(lambda_d=0.1))
    assert np.isfinite(restored.image.values).all()


@pytest.mark.parametrize("step", [gnc, restore, RARE[0]])
@pytest.mark.parametrize("noise", ["laplace", "student_t", "poisson", "outliers"])
def test_every_noise_is_restored_to_less_than_the_observation_costs(step, noise):
    image = square(5.0, size=8)
    model = Model(n_levels=40, noise=noise, sigma=2.0, lines="marginal", lambda_l=100.0)
    problem = prepare(model, image)
    restored = step(image, model=model)
    assert restored.energy < energy(problem, problem.start())


@pytest.mark.parametrize("order", [1, 2, 3])
def test_restore_never_raises_the_energy_whatever_the_order(order):
    for lines, sigma in itertools.product(("none", "explicit", "marginal"), (10.0, 40.0)):
        model = Model(n_levels=50, order=order, lines=lines, lambda_l=200.0)
        restored = restore(square(sigma, 10), model=model)
        assert never_rises(restored.trace), (lines, sigma)


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("kind", ["quadratic", "truncated_quadratic", "absolute"])
@pytest.mark.parametrize("step", [restore, graph_cuts, *RARE])
def test_nine_cells_come_near_the_minimum_of_all_labellings(step, kind, seed):
    """None may be below it; convex cuts reach it, and the others on these images within 3 %."""
    image, model = tiny(seed), tiny_model(smoothness=kind)
    least = least_energy(model, seed)
    reached = step(image, model=model).energy
    assert reached >= least - 1e-9
    if step is graph_cuts and kind != "truncated_quadratic":
        assert reached == pytest.approx(least)
    assert reached <= 1.03 * least


def test_restore_is_within_a_thousandth_of_what_is_proved_least():
    """16 by 16 cells, 200 levels, truncated parabola: lambda 4, truncation 30."""
    for sigma in (10.0, 40.0):
        image = square(sigma)
        proof = trw(image, model=TRUNCATED, n_sweeps=10)
        reached = restore(image, model=TRUNCATED).energy
        assert proof.bound <= proof.energy + 1e-6
        assert reached <= 1.001 * proof.bound
