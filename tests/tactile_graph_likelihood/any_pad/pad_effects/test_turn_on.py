"""Where readings begin: a law without its bend, and exponent or gains told apart."""

import math
from dataclasses import replace

import numpy as np
import pytest

from tactile_graph.wires import Image
from tactile_graph_likelihood.any_pad.observation.observed import observed
from tactile_graph_likelihood.any_pad.pad_effects.from_frame import contrast_of
from tactile_graph_likelihood.any_pad.pad_effects.turn_on import (
    Edge,
    chance_of_a_bend,
    contrast_by,
    edge_of,
    straightened,
    unbent,
)
from tactile_graph_likelihood.single.density.element_terms import CONTRAST, ON, UNDER
from tactile_graph_likelihood.single.noise import SPREADS, Noise
from tactile_graph_pads.pad import Pad, load_pad

PAD = load_pad("thesis")
STRAIGHT = replace(PAD, law=replace(PAD.law, turn_on_bend=0.0))
ARM = math.log(10.0)


def frame(least_g: float, pad: Pad = STRAIGHT, noise_s: float = 1e-9) -> Image:
    """Loads from some grams on, as a pad's law and some noise turn them into conductances."""
    rng = np.random.default_rng(3)
    load = np.zeros((16, 16))
    load[4:12, 4:12] = least_g * np.exp(np.linspace(0.0, 3.0, 64)).reshape(8, 8)
    siemens = pad.law.conductance_s(load) + noise_s * rng.standard_normal(load.shape)
    return Image(siemens, (1.3, 1.3), (-0.15, -0.15), "siemens")


def test_unbent_readings_are_those_of_the_law_without_a_bend() -> None:
    image = frame(3.0)
    bent, straight = observed(image, PAD), observed(image, STRAIGHT)
    found = unbent(bent)
    assert found is not None
    np.testing.assert_allclose(found[0].logs, straight.logs, atol=1e-6)
    assert found[0].least_log == pytest.approx(straight.least_log)
    assert found[0].turn_on is not None
    assert found[0].turn_on.hidden == pytest.approx(straight.turn_on.hidden)  # type: ignore[union-attr]
    assert unbent(found[0]) is None


def test_density_is_by_how_much_the_bend_draws_loads_together() -> None:
    bent = observed(frame(3.0), PAD)
    its, denser = unbent(bent)  # type: ignore[misc]
    low = (bent.states == ON) & (bent.logs < ARM)
    step, turn_on = 1e-6, bent.turn_on
    assert turn_on is not None
    logs = bent.logs + step
    moved = logs - turn_on.bend * np.minimum(logs - turn_on.log_load, 0.0) ** 2
    slope = (moved - its.logs)[low] / step
    assert denser == pytest.approx(float(np.log(slope).sum()), rel=1e-4)
    assert denser > 1.0


def test_the_told_law_is_left_where_another_explains_far_more() -> None:
    assert chance_of_a_bend(-3.0) > 0.98
    assert chance_of_a_bend(2.5) == pytest.approx(0.5)
    assert chance_of_a_bend(9.0) < 0.02 < chance_of_a_bend(6.0)
    assert chance_of_a_bend(1e9) < 1e-20


def test_half_a_bend_lies_between() -> None:
    bent = observed(frame(3.0), PAD)
    half, straight = straightened(bent, 0.5), straightened(bent, 1.0)
    np.testing.assert_allclose(half.logs, 0.5 * (bent.logs + straight.logs))
    low = (bent.states == ON) & (bent.logs < ARM)
    assert (half.logs[low] < bent.logs[low]).all()
    assert edge_of(half) is None
    assert edge_of(straight) is not None
    again = straightened(half, 1.0)
    np.testing.assert_allclose(again.logs, straight.logs, atol=1e-12)
    assert again.turn_on == pytest.approx(straight.turn_on)
    assert again.least_log == pytest.approx(straight.least_log)


def test_where_nothing_reads_less_than_the_turn_on_the_law_is_as_told() -> None:
    assert unbent(observed(frame(12.0), PAD)) is None
    assert unbent(observed(frame(3.0), STRAIGHT)) is None


@pytest.mark.parametrize(("least_g", "off"), [(10.5, 0.0), (20.0, math.log(2.0))])
def test_an_edge_lies_where_readings_begin(least_g: float, off: float) -> None:
    edge = edge_of(observed(frame(least_g), PAD))
    assert edge is not None
    assert edge.off == pytest.approx(off, abs=0.1)
    assert edge.arm == pytest.approx(ARM)


def test_no_edge_is_seen_under_noise_nor_under_the_laws_own_turn_on() -> None:
    assert edge_of(observed(frame(3.0), PAD)) is None
    assert edge_of(observed(frame(3.0), STRAIGHT)) is not None
    noisy = observed(frame(12.0, noise_s=4e-7), PAD)
    assert (noisy.states == UNDER).any()
    assert edge_of(noisy) is None


@pytest.mark.parametrize(
    ("exponent", "gains", "turn_on"),
    [(1.0, 1.0, 1.0), (1.0, 0.4, 1.0), (0.68, 1.0, 1.0), (1.37, 1.0, 1.0), (1.0, 1.0, 4.0)],
)
def test_what_is_not_as_told_is_found(exponent: float, gains: float, turn_on: float) -> None:
    """Exponent, gains and turn-on over what is told, one of them other than that."""
    off = ARM - exponent * (ARM - math.log(turn_on))
    found = contrast_by(math.log(exponent * gains), Edge(off, 0.1, ARM), 80)
    assert found == pytest.approx(exponent, abs=0.07)


def test_a_bend_in_doubt_counts_for_as_much_as_it_is_probable() -> None:
    """Readings go on below the told turn-on: by a law without a bend they tell its exponent."""
    bent, noise, log_sigma = observed(frame(5.0), PAD), Noise(), math.log(0.7)
    told, straight, partly = (
        contrast_of(noise, log_sigma, straightened(bent, share) if share else bent).power
        for share in (0.0, 1.0, 0.75)
    )
    assert 1.0 < told < straight < 1.5
    assert partly == pytest.approx(0.25 * told + 0.75 * straight)


def test_readings_without_a_law_that_scatter_little_leave_its_exponent_open() -> None:
    """An even pad, or a law that draws loads together: only their quantity says which."""
    noise, readings = Noise(), observed(frame(5.0), PAD)
    lawless = readings._replace(turn_on=None)
    few, many = (contrast_of(noise, math.log(x * noise.sigma), lawless) for x in (0.3, 1.5))
    assert 0.5 < few.power < 1.0 < many.power
    assert few.std > 0.4
    assert many.std == SPREADS[CONTRAST]
    assert contrast_of(noise, math.log(0.3 * noise.sigma), readings).std == SPREADS[CONTRAST]


def test_what_cannot_be_an_edge_is_no_error() -> None:
    assert 0.3 < contrast_by(0.0, Edge(9.0, 0.1, ARM), 4) < 3.0
