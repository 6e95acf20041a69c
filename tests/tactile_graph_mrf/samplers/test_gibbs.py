"""The Gibbs sampler with annealing as a step: seeds, extremes, skips, energies."""

from __future__ import annotations

import inspect

import numpy as np
import pytest

from helpers_modes import answered_by
from helpers_mrf import picture
from tactile_graph import loads
from tactile_graph.errors import PipelineError
from tactile_graph.wires import Image, Mask
from tactile_graph_mrf.energy.line_field import Restored
from tactile_graph_mrf.energy.model import Model
from tactile_graph_mrf.energy.problem import prepare
from tactile_graph_mrf.energy.total import energy
from tactile_graph_mrf.samplers import annealing
from tactile_graph_mrf.samplers.gibbs import gibbs
from tactile_graph_mrf.samplers.sweep import anneal


def restore(image, *ports, seed=1, **settings):
    return gibbs(image, *ports, rng=np.random.default_rng(seed), **settings)


def recomputed(restored: Restored, image, model, *ports):
    """The energy of a restoration, from its image and lines alone."""
    problem = prepare(model, image, *ports)
    labels = np.rint((restored.image.values - problem.low) / problem.step).astype(np.int64)
    lines = restored.lines
    return energy(problem, np.where(problem.in_field, labels, 0), lines.horizontal, lines.vertical)


MODELS = [
    Model(),
    Model(lines="none"),
    Model(lines="marginal"),
    Model(order=3, noise="outliers", smoothness="huber"),
    Model(noise="laplace", lines="none", order=2, smoothness="truncated_quadratic"),
]


@pytest.mark.slow
@pytest.mark.parametrize("model", MODELS, ids=str)
def test_the_energy_given_is_the_energy_of_what_is_given(model):
    image = picture()
    restored = restore(image, model=model, n_sweeps=30)
    assert restored.energy == pytest.approx(recomputed(restored, image, model), rel=1e-9)
    assert restored.energy == pytest.approx(restored.trace[-1], rel=1e-9)
    assert restored.sweeps == len(restored.trace) <= 30


def test_defaults_are_the_thesis():
    settings = inspect.signature(gibbs).parameters
    assert settings["temperature"].default == 5.0
    assert settings["cooling"].default == 0.9
    assert settings["n_sweeps"].default == 110
    assert settings["start"].default == "random"
    assert Model().n_levels == 200


@pytest.mark.slow
@pytest.mark.parametrize("model", MODELS, ids=str)
def test_same_seed_same_bits_compiled_or_not(model):
    pytest.importorskip("numba")
    image = picture(7, 6)
    runs = []
    for mode in ("plain", "compiled", "compiled"):
        with answered_by(mode):
            runs.append(restore(image, model=model, n_sweeps=6, energy_scale=0.003))
    for other in runs[1:]:
        assert (runs[0].image.values == other.image.values).all()
        assert (runs[0].lines.horizontal == other.lines.horizontal).all()
        assert (runs[0].lines.vertical == other.lines.vertical).all()
        assert other.trace == pytest.approx(runs[0].trace, rel=1e-12)
    assert runs[1].trace == runs[2].trace
    assert restore(image, seed=2, model=model, n_sweeps=6).trace != runs[0].trace


@pytest.mark.slow  # much is compiled
def test_the_bits_do_not_depend_on_how_numbers_are_drawn_in_blocks(monkeypatch):
    image = picture()
    whole = restore(image, n_sweeps=30)
    monkeypatch.setattr(annealing, "BLOCK", 3000)
    assert restore(image, n_sweeps=30).trace == whole.trace


@pytest.mark.parametrize("temperature", [1e-6, 5.0, 1e12])
@pytest.mark.parametrize("weight", [0.0, 1.0, 1e12])
@pytest.mark.parametrize("n_levels", [2, pytest.param(4096, marks=pytest.mark.slow)])
def test_extremes_stay_finite_and_within_the_range(temperature, weight, n_levels):
    image = picture(6, 6)
    for lines, smoothness in (
        ("explicit", "quadratic"),
        ("marginal", "quadratic"),
        ("none", "truncated_absolute"),
    ):
        model = Model(
            n_levels=n_levels, lambda_d=weight, lambda_l=weight, lines=lines, smoothness=smoothness
        )
        restored = restore(image, model=model, temperature=temperature, n_sweeps=4)
        values = restored.image.values
        assert np.isfinite([restored.energy, *restored.trace]).all()
        assert image.values.min() <= values.min()
        assert values.max() <= image.values.max() * (1 + 1e-12)


@pytest.mark.parametrize("noise", ["laplace", "student_t", "poisson", "outliers"])
@pytest.mark.parametrize("sigma", [1e-6, 1e6])
def test_extremes_of_the_noise_stay_finite(noise, sigma):
    model = Model(noise=noise, sigma=sigma, freedom=1e-3, outlier_share=1e-12, lambda_d=1e12)
    assert np.isfinite(restore(picture(5, 5), model=model, n_sweeps=4).trace).all()


@pytest.mark.slow
def test_missing_cells_are_inferred_and_become_valid():
    image = picture()
    values = image.values.copy()
    values[8, 8] = np.nan
    valid = np.ones((16, 16), np.bool_)
    valid[7, 7] = False
    values[7, 7] = 0.0
    model = Model(lines="none", lambda_d=1.0)
    restored = restore(Image(values, valid=valid), model=model)
    assert abs(restored.image.values[8, 8] - 1) < 0.25
    assert abs(restored.image.values[7, 7] - 1) < 0.25
    assert restored.image.valid is not None
    assert restored.image.valid.all()


def test_a_constant_image_and_an_empty_region_are_not_swept():
    flat = Image(np.full((4, 4), 3.0), quantity="gram")
    restored = restore(flat)
    assert restored.sweeps == 0
    assert (restored.image.values == 3.0).all()
    assert restored.image.quantity == "gram"
    assert restored.lines.count == 0
    image = picture()
    untouched = restore(image, Mask(np.zeros((16, 16), np.bool_)))
    assert untouched.sweeps == 0
    assert (untouched.image.values == image.values).all()


@pytest.mark.slow
def test_outside_the_region_nothing_changes_and_inside_it_is_as_if_the_pad_ended_there():
    image = picture(8, 12)
    on = np.zeros((8, 12), np.bool_)
    on[:, :6] = True
    restored = restore(image, Mask(on), n_sweeps=40)
    assert (restored.image.values[~on] == image.values[~on]).all()
    assert not restored.lines.vertical[:, 5:].any()
    # A random start draws for the whole grid, so let both start at the observations.
    part = Image(image.values[:, :6].copy())
    alone = restore(part, n_sweeps=40, start="observed")
    within = restore(image, Mask(on.copy()), n_sweeps=40, start="observed")
    np.testing.assert_array_equal(within.image.values[:, :6], alone.image.values)
    assert within.energy == pytest.approx(alone.energy)


@pytest.mark.slow
def test_annealing_stops_once_nothing_can_change_and_loses_nothing_by_it(monkeypatch):
    image = picture()
    stopped = restore(image, n_sweeps=400)
    assert stopped.sweeps < 150
    assert stopped.trace[-1] == stopped.trace[-2]
    compiled_sweeps = anneal.call
    monkeypatch.setattr(anneal, "call", lambda *args: (compiled_sweeps(*args)[0], False))
    blocks = restore(image, n_sweeps=400)  # goes on, if at all, with the same state
    assert (blocks.image.values == stopped.image.values).all()


@pytest.mark.slow
def test_the_energy_scale_is_a_temperature():
    image = picture()
    scaled = restore(image, n_sweeps=20, temperature=500.0, energy_scale=100.0)
    assert scaled.trace == restore(image, n_sweeps=20).trace


@pytest.mark.slow
def test_slow_annealing_beats_the_thesis_schedule_with_lines():
    image = picture()
    hasty = restore(image)
    slow = restore(image, temperature=3e4, cooling=0.99, n_sweeps=1000)
    assert slow.energy < 0.5 * hasty.energy
    inside = np.zeros((16, 16), np.bool_)
    inside[4:12, 4:12] = True
    h, v = inside[:-1] != inside[1:], inside[:, :-1] != inside[:, 1:]
    assert (slow.lines.horizontal == h).mean() > 0.98
    assert (slow.lines.vertical == v).mean() > 0.98


TEXT = """
pipeline: lines
source: {step: simulate, with: {frames: 1}}
nodes:
  restored: {step: gibbs, in: frame, with: {n_sweeps: 5, model: {lambda_d: 2, WITH}}}
outputs: [restored]
"""


@pytest.mark.slow
def test_it_runs_from_yaml_with_its_model_as_a_mapping():
    pipeline = loads(TEXT.replace("WITH", "lines: marginal"))
    frame = next(iter(pipeline.frames(seed=1)))
    restored = pipeline.run(frame, seed=3)["restored"]
    assert isinstance(restored, Restored)
    assert restored.image.quantity == frame.image.quantity
    assert restored.sweeps == 5
    model = Model(lambda_d=2.0, lines="marginal")
    assert restored.energy == pytest.approx(recomputed(restored, frame.image, model), rel=1e-6)
    assert pipeline.run(frame, seed=3)["restored"].trace == restored.trace
    assert pipeline.run(frame, seed=4)["restored"].trace != restored.trace


@pytest.mark.parametrize(
    ("setting", "message"),
    [
        ("lamda_l: 1", r"model\.lamda_l: unknown setting 'lamda_l'; did you mean 'lambda_l'\?"),
        ("order: 4", r"model\.order: must be one of 1 \| 2 \| 3, got 4"),
        ("n_levels: 1", r"model\.n_levels: must be >= 2, got 1"),
        ("sigma: -1", r"<text>:5:86: node 'restored', model\.sigma: must be > 0.0, got -1"),
    ],
)
def test_wrong_model_settings_are_refused(setting, message):
    with pytest.raises(PipelineError, match=message):
        loads(TEXT.replace("WITH", setting))
