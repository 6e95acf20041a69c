"""From an image of any quantity to what shows, and what could have."""

import math

import numpy as np
import pytest

from helpers_ghosts import DIAGONAL, REFERENCE, read, share
from helpers_modes import plainly
from tactile_graph.errors import DataError, Degenerate, RuleError
from tactile_graph.wires import Image
from tactile_graph_likelihood.any_pad.above_noise import AboveNoise
from tactile_graph_likelihood.any_pad.observation.observed import observed, uniform
from tactile_graph_likelihood.any_pad.observation.rising import together
from tactile_graph_likelihood.any_pad.observation.shown import ceiling_of, least_that_shows
from tactile_graph_likelihood.single.density.element_terms import OFF, ON, OVER, UNDER, UNKNOWN
from tactile_graph_pads.pad import load_pad

PAD = load_pad("thesis")


def image_of(values, quantity="volt", valid=None):
    return Image(np.asarray(values, float), (1.3, 1.3), (-0.15, -0.15), quantity, valid)


def volts(rng, noise_v=2e-3, load_g=80.0):
    """An 8 x 8 block of loaded elements on a pad with noise."""
    load = np.zeros((16, 16))
    load[4:12, 4:12] = load_g * np.exp(0.4 * rng.standard_normal((8, 8)))
    siemens = (load / 100.0) ** PAD.law.power / 80e3
    clean = 5.0 * siemens / (1.0 / 33e3 + siemens.sum(axis=0))
    return clean + noise_v * rng.standard_normal(load.shape), load


def test_what_lies_under_the_noise_reads_nothing():
    rng = np.random.default_rng(1)
    shown = 0
    for _ in range(20):
        values, load = volts(rng)
        found = observed(image_of(values), PAD)
        shown += int((found.states[load == 0.0] == ON).sum())
        assert (found.states[load > 0.0] == ON).mean() > 0.95
    assert shown <= 2  # of 3840


def test_loads_are_those_of_the_pads_law():
    values, load = volts(np.random.default_rng(2), noise_v=0.0)
    found = observed(image_of(values), PAD)
    on = found.states == ON
    np.testing.assert_allclose(found.logs[on], np.log(load[on]), atol=1e-6)


def test_more_could_hide_in_a_loaded_column():
    values, load = volts(np.random.default_rng(3), noise_v=4e-3)
    found = observed(image_of(values), load_pad({"law": {"turn_on_g": 1e-3}}))
    under = (found.states == UNDER) & (load == 0.0)
    loaded = np.arange(16) // 4 % 3 > 0
    assert (found.logs[:, loaded][under[:, loaded]]).min() > (
        found.logs[:, ~loaded][under[:, ~loaded]].max() - 1e-9
    )


@pytest.mark.parametrize("quantity", ["raw", "counts", "gram", "level"])
def test_any_quantity_is_taken(quantity):
    rng = np.random.default_rng(4)
    values = 300.0 + rng.standard_normal((16, 16))
    values[5:10, 5:10] += 80.0
    found = observed(image_of(values, quantity), PAD)
    assert (found.states[5:10, 5:10] != UNDER).all()
    assert found.touched <= 27


def test_volts_that_cannot_be_the_circuits_are_taken_as_they_are():
    values = np.zeros((16, 16))
    values[4:10, 4:10] = np.random.default_rng(10).uniform(1.5, 2.5, (6, 6))
    found = observed(image_of(values), PAD)
    assert found.touched == 36
    on = found.states == ON
    np.testing.assert_allclose(found.logs[on], np.log(values[on]))


def test_an_invalid_cell_says_nothing():
    values, _ = volts(np.random.default_rng(5))
    valid = np.ones(values.shape, bool)
    valid[6, 6] = False
    assert observed(image_of(values, valid=valid), PAD).states[6, 6] == UNKNOWN


def test_elements_have_no_gap_where_the_pitch_is_not_the_pads():
    values, _ = volts(np.random.default_rng(6))
    image = Image(values, (0.5, 0.5), (0.0, 0.0), "raw")
    assert observed(image, PAD).grid[3] == 0.5
    assert observed(image_of(values), PAD).grid[3] == pytest.approx(1.0)


@pytest.mark.parametrize(("short", "long"), [(1.0, 1.03), (0.97, 1.0), (0.1, 0.103), (2.91, 3.0)])
def test_cells_may_be_wider_or_higher_alike(short, long):
    values, _ = volts(np.random.default_rng(6))
    high, wide = (
        observed(Image(values, pitch, (3.0, 5.0), "raw"), PAD)
        for pitch in ((short, long), (long, short))
    )
    assert high.grid[2] == wide.grid[2] == pytest.approx(math.sqrt(short * long))
    assert high.stretch == pytest.approx(1.0 / wide.stretch)
    assert tuple(high.grid[:2]) == tuple(wide.grid[:2]) == (3.0, 5.0)


@pytest.mark.parametrize("pitch_cm", [(1.0, 1.032), (1.032, 1.0), (1.0, 0.968)])
def test_cells_that_are_less_square_are_refused_either_way(pitch_cm):
    with pytest.raises(RuleError, match="square to 3%"):
        observed(Image(np.eye(8), pitch_cm, (0.0, 0.0), "raw"), PAD)


@pytest.mark.parametrize(
    ("image", "gap_cm", "error", "said"),
    [
        (
            Image(np.ones((4, 4)), (1.0, 2.0), (0.0, 0.0), "raw"),
            None,
            RuleError,
            "needs cells that are square to 3%, got a pitch of 1 by 2 cm",
        ),
        (image_of(np.ones((4, 4))), 1.3, RuleError, "gap_cm: must be below the pitch"),
        (image_of(np.full((4, 4), 1e101)), None, DataError, "must be finite and at most"),
        (image_of(np.full((4, 4), np.nan)), None, DataError, "must be finite and at most"),
        (image_of(np.zeros((4, 4))), None, Degenerate, "no reading rises above the noise"),
    ],
)
def test_what_is_refused(image, gap_cm, error, said):
    with pytest.raises(error, match=said):
        observed(image, PAD, gap_cm)


def test_the_least_load_lies_a_spacing_below_the_least_reading():
    logs = np.log([20.0, 22.0, 24.2, 26.62, 29.282, 100.0])
    assert least_that_shows(logs, -math.inf) == pytest.approx(math.log(20.0 / 1.1))


@pytest.mark.parametrize(("told", "found"), [(19.0, 19.0), (30.0, 20.0), (2.0, 20.0 / 1.21)])
def test_a_turn_on_that_is_told_is_taken_as_far_as_readings_allow(told, found):
    logs = np.log([20.0, 22.0, 24.2, 26.62, 29.282, 100.0])
    assert least_that_shows(logs, math.log(told)) == pytest.approx(math.log(found))


def test_where_readings_end_they_are_alike():
    rng = np.random.default_rng(7)
    logs = rng.normal(4.0, 0.5, 80)
    assert ceiling_of(np.sort(logs)) == math.inf
    cut = np.minimum(logs, 4.2) + 0.003 * rng.standard_normal(80)
    assert ceiling_of(np.sort(cut)) == pytest.approx(4.2, abs=0.03)
    image = image_of(np.exp(np.pad(cut.reshape(8, 10), 8, constant_values=-math.inf)), "raw")
    over = int((observed(image, PAD).states == OVER).sum())
    assert over == pytest.approx((logs > 4.2).sum(), abs=2)


def test_alike_readings_with_many_above_are_no_end():
    logs = np.concatenate([np.full(20, 3.0), np.linspace(3.5, 5.0, 40)])
    assert ceiling_of(logs) == math.inf


def test_on_a_large_pad_one_least_load_stands_for_all(monkeypatch):
    values, _ = volts(np.random.default_rng(8))
    seen = observed(image_of(values), PAD)
    found = uniform(seen)
    assert set(np.unique(found.states)) == {OFF, ON}
    under = seen.logs[seen.states == UNDER]
    assert found.least_log == np.median(under)
    room = "tactile_graph_likelihood.single.readings"
    monkeypatch.setattr(f"{room}.MANY", found.touched - 1)
    assert UNDER not in observed(image_of(values), PAD).states


def test_the_footprint_is_what_rises_above_the_noise():
    values, load = volts(np.random.default_rng(9))
    found = AboveNoise()(image_of(values))
    assert (found.mask.values[load > 0.0]).mean() > 0.95
    assert 4 * 2e-3 * 0.8 < found.level < 4 * 2e-3 * 2.5
    assert AboveNoise(deviations=8.0)(image_of(values)).level == pytest.approx(
        2.0 * found.level, rel=0.2
    )


def test_the_rise_is_told_in_what_noise_reaches():
    rng = np.random.default_rng(3)
    values = rng.normal(0.0, 1e-3, (16, 16))
    found = AboveNoise()(image_of(values))
    assert found.rise < 1.5
    pressed = values.copy()
    pressed[4, 7] = 3.0 * (found.level - np.median(values))
    assert AboveNoise()(image_of(pressed)).rise == pytest.approx(3.0, rel=0.1)
    assert AboveNoise()(image_of(np.zeros((16, 16)))).rise == 0.0
    alone = np.zeros((16, 16))
    alone[2, 2] = 1.0
    assert np.isfinite(AboveNoise()(image_of(alone)).rise)


def test_cells_that_noise_lets_show_lie_apart_and_those_of_an_object_together():
    values = np.zeros((16, 16))
    values[[1, 1, 9, 14], [1, 13, 7, 2]] = 1.0
    assert AboveNoise()(image_of(values)).together == 1
    values = values.copy()
    values[1, 3] = values[3, 1] = 1.0  # a void between
    assert AboveNoise()(image_of(values)).together == 3
    values = values.copy()
    values[4:9, 8:12] = 1.0
    assert AboveNoise()(image_of(values)).together == 9
    assert AboveNoise()(image_of(np.zeros((16, 16)))).together == 0


@pytest.mark.slow  # much is compiled
@pytest.mark.parametrize("shape", [(0, 0), (0, 5), (1, 1), (1, 9), (3, 2), (16, 16), (5, 40)])
@pytest.mark.parametrize("share", [0.0, 0.02, 0.1, 0.5, 1.0])
def test_how_many_lie_together_is_counted_alike_in_loops(shape, share):
    shows = np.random.default_rng(11).random(shape) < share
    ways = together.reference(shows), plainly(together)(shows), together.compiled(shows)
    assert len(set(ways)) == 1


def test_ghosts_of_a_floating_circuit_do_not_show_in_spite_of_noise():
    told = {
        "circuit": {"kind": "floating"},
        "converter": {"bits": 12},
        "scan": {"samples": 1, "noise_v": 0.001},
    }
    pad, rng = load_pad(told), np.random.default_rng(9)
    inside = np.zeros((16, 16), bool)
    inside[2:6, 2:6] = inside[2:6, 9:13] = inside[9:13, 2:6] = True
    load = np.where(inside, 80.0 * np.exp(0.3 * rng.standard_normal((16, 16))), 0.0)
    siemens = np.where(inside, pad.law.conductance_s(load), 1e-10)
    noisy = pad.volts_of(siemens) + 0.001 * rng.standard_normal((16, 16))
    step = pad.converter.step_v
    values = np.maximum(np.round(noisy / step) * step, 0.0)
    assert (values[9:13, 9:13] > 0.02).all()
    found = observed(image_of(values), pad)
    on = found.states == ON
    assert on[inside].mean() > 0.9
    assert on[~inside].mean() < 0.03
    assert np.median(np.abs(found.logs - np.log(np.maximum(load, 1.0)))[on & inside]) < 0.05


@pytest.mark.slow  # the inverse takes a while
def test_ghosts_come_out_where_bare_elements_of_a_floating_circuit_conduct_too():
    """What they read is no offset: without it the readings are no network's."""
    told = {
        "geometry": {"rows": 16, "columns": 16, "element_cm": 1.0, "gap_cm": 0.0},
        "circuit": {"kind": "floating", "bias_ohm": 1.0 / REFERENCE, "supply_v": 5.0},
        "converter": {"bits": 8, "low_v": 0.0, "high_v": 5.0},
        "scan": {"noise_v": 0.01},
    }
    shares, pad = share(DIAGONAL), load_pad(told)
    counts = read(shares, rest=2e-6)
    image = Image(np.maximum(counts.values - 2.0, 0.0) * 5.0 / 255.0, (1.0, 1.0), quantity="volt")
    untold, found = observed(counts, pad), observed(image, pad)
    assert (untold.states == ON)[shares == 0.0].mean() > 0.2
    assert (found.states == ON)[shares > 0.9].all()
    assert (found.states == ON)[shares == 0.0].mean() < 0.03
    assert not found.ghosts
