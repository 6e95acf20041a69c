"""Loads and the noise of the volts behind them: what shows nothing, and what rests all the same."""

import numpy as np
import pytest
import yaml

from helpers_likelihood import made
from tactile_graph import load
from tactile_graph.errors import Degenerate, RuleError
from tactile_graph.wires import Circle, Image
from tactile_graph_filters.readings.force import Force
from tactile_graph_likelihood.over_time.follow_footprint import FollowFootprint
from tactile_graph_likelihood.over_time.noise_behind import noise_behind
from tactile_graph_likelihood.single.density.element_terms import OFF, ON, UNDER
from tactile_graph_likelihood.single.readings import readings_of
from tactile_graph_pads.pad import load_pad, path_of

pytestmark = pytest.mark.usefixtures("warm_kernels")

PAD = load_pad("thesis")
LEAST = float(np.log(5.0))


def as_image(values, quantity):
    return Image(values, (1.3, 1.3), (-0.15, -0.15), quantity)


def read(load_g, rng, noise_v, disc=None, step_v=0.0, zero_v=0.0):
    """Return loads, by the noisy volts of a disc that bears so much an element, and these."""
    x, y, r = (10.0, 9.5, 3.3) if disc is None else (disc.x_cm, disc.y_cm, disc.radius_cm)
    at = 1.3 * np.arange(16) + 0.5
    share = np.clip(r + 0.5 - np.hypot(at - x, at[:, None] - y), 0.0, 1.0)
    siemens = PAD.law.conductance_s(load_g * share)
    volts = PAD.circuit.supply_v * PAD.circuit.ratio(siemens)
    volts = volts + zero_v + noise_v * rng.standard_normal(volts.shape)
    volts = as_image(step_v * np.round(volts / step_v) if step_v else volts, "volt")
    back = PAD.circuit.inverse(volts.values / PAD.circuit.supply_v).siemens
    return Force(pad="thesis")(as_image(back, "siemens")), volts


def test_untouched_elements_that_noise_loads_show_nothing():
    grams, volts = read(120.0, np.random.default_rng(1), 0.002)
    alone = readings_of(grams, 0.3, 5.0)
    bare = np.hypot(*np.meshgrid(1.3 * np.arange(16) - 9.5, 1.3 * np.arange(16) - 9.0)) > 5.0
    assert ((alone.states == ON) & bare).sum() > 5
    readings, noise = noise_behind(alone, grams, volts, PAD, LEAST)
    assert set(readings.states[bare]) == {UNDER}
    assert readings.touched == (readings.states == ON).sum() > 15
    assert (readings.logs == noise.least)[bare].all()
    assert noise.least.min() >= LEAST
    touched = (readings.states == ON).any(axis=0)
    assert noise.least[:, touched].max() > noise.least[:, ~touched].max() + 0.2
    assert (noise.width > 0.0).tolist() == (readings.states == ON).tolist()


@pytest.mark.parametrize("load_g", [120.0, 400.0])
def test_the_width_is_that_of_loads_from_frame_to_frame(load_g):
    rng, logs, widths = np.random.default_rng(2), [], []
    for _ in range(60):
        grams, volts = read(load_g, rng, 0.003)
        readings, noise = noise_behind(readings_of(grams, 0.3, 5.0), grams, volts, PAD, LEAST)
        logs.append(np.where(readings.states == ON, readings.logs, np.nan))
        widths.append(noise.width)
    always = ~np.isnan(logs).any(axis=0)
    true, told = np.std(logs, axis=0)[always], np.mean(widths, axis=0)[always]
    assert always.sum() > 15
    assert np.median(told / true) == pytest.approx(1.0, abs=0.35)
    assert (told > 0.6 * true).all()


def test_without_noise_and_where_nothing_is_bare_readings_stay():
    grams, volts = read(120.0, np.random.default_rng(3), 0.0)
    alone = readings_of(grams, 0.3, 5.0)
    readings, noise = noise_behind(alone, grams, volts, PAD, LEAST)
    assert np.where(readings.states == UNDER, OFF, readings.states).tolist() == (
        alone.states.tolist()
    )
    grams, volts = read(60.0, np.random.default_rng(3), 0.001, Circle(10.0, 10.0, 30.0))
    alone = readings_of(grams, 0.3, 5.0)
    readings, noise = noise_behind(alone, grams, volts, PAD, LEAST)
    assert readings is alone
    assert not noise.width.any()


def test_an_offset_of_two_steps_is_no_load():
    grams, volts = read(200.0, np.random.default_rng(5), 0.0005, step_v=0.00244, zero_v=0.005)
    readings, _ = noise_behind(readings_of(grams, 0.3, 5.0), grams, volts, PAD, LEAST)
    bare = np.hypot(*np.meshgrid(1.3 * np.arange(16) - 9.5, 1.3 * np.arange(16) - 9.0)) > 5.0
    assert (readings.states[bare] == UNDER).mean() > 0.95  # a few read a step more


@pytest.mark.slow
@pytest.mark.parametrize("load_g", [120.0, 400.0])
@pytest.mark.parametrize(
    ("noise_v", "step_v"), [(0.002, 0.00244), (0.005, 0.00244), (0.002, 0.039)]
)
def test_a_disc_at_rest_rests_whatever_the_noise_and_a_slide_moves(load_g, noise_v, step_v):
    rng = np.random.default_rng(4)
    step = made(FollowFootprint, pad="thesis", on_pad="whole")
    frames = [read(load_g, rng, noise_v, step_v=step_v) for _ in range(20)]
    found = [step(*frame, gap_s=0.1) for frame in frames]
    assert [f.moved for f in found] == [True] + [False] * 19
    assert found[-1].shape.x_cm == pytest.approx(10.0, abs=0.15)
    slid = read(load_g, rng, noise_v, Circle(10.5, 9.5, 3.3), step_v)
    assert step(*slid, gap_s=0.1).moved


@pytest.mark.slow
@pytest.mark.parametrize("load_g", [120, 400])
def test_the_pipeline_lets_a_disc_rest_on_a_pad_that_reads_once(load_g):
    weight_g = load_g * np.pi * 3.0**2 / 1.69
    disc = {"shape": "disc", "name": "D", "weight_g": weight_g, "radius_cm": 3.0}
    scene = {"objects": [disc], "hold": 10**6}
    on = {**yaml.safe_load(path_of("thesis").read_text()), "scan": {"noise_v": 0.005}}
    pipeline = load("circle-followed").with_source("simulate", scene=scene, frames=16, pad=on)
    found = [result["disc"] for result in pipeline.stream(seed=5)]
    assert [f.moved for f in found] == [True] + [False] * 15
    true = next(iter(pipeline.frames(5))).truth[0].shape
    assert found[-1].shape.posterior.contains(true)


def test_volts_of_another_shape_of_no_grams_or_of_noise_alone_are_refused():
    rng = np.random.default_rng(6)
    grams, volts = read(120.0, rng, 0.002)
    readings = readings_of(grams, 0.3, 5.0)
    small = as_image(volts.values[:8], "volt")
    with pytest.raises(RuleError, match="shape"):
        noise_behind(readings, grams, small, PAD, LEAST)
    raw = as_image(grams.values, "kilopascal")
    with pytest.raises(RuleError, match="in gram alone, got kilopascal"):
        noise_behind(readings, raw, volts, PAD, LEAST)
    noise = as_image(0.002 * rng.standard_normal((16, 16)), "volt")
    with pytest.raises(Degenerate, match="above the noise"):
        noise_behind(readings, grams, noise, PAD, LEAST)
