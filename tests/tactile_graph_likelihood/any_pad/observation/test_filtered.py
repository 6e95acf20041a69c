"""Images that were smoothed, median-filtered or enlarged: told by their noise, or by copies."""

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from helpers_modes import plainly
from tactile_graph.wires import Image
from tactile_graph_likelihood.any_pad.locate import LocateDisc
from tactile_graph_likelihood.any_pad.observation.filtered import (
    has_copies,
    has_shared_noise,
    is_filtered,
)
from tactile_graph_likelihood.any_pad.observation.observed import observed
from tactile_graph_likelihood.any_pad.uncertainty.widened import CENTRE_STD, SIZE_STD, as_filtered
from tactile_graph_likelihood.single.density.element_terms import ON, UNDER
from tactile_graph_pads.pad import load_pad

sys.path.insert(0, str(Path(__file__).parents[4] / "benchmarks"))
from second_simulator import KINDS, Bench

PAD = load_pad("thesis")
LEAST = 4.0


def scene(rng, loads=None):
    """Return noise around a block of touched elements, and which are."""
    values, states = rng.standard_normal((16, 16)), np.full((16, 16), UNDER, np.uint8)
    loads = 100.0 * rng.lognormal(size=(6, 6)) if loads is None else loads
    block = slice(3, 3 + len(loads))
    values[block, block], states[block, block] = loads, ON
    return values, states


def smoothed(values):
    wide = np.pad(values, 1, mode="edge")
    rows, columns = values.shape
    return sum(wide[i : i + rows, j : j + columns] for i in range(3) for j in range(3)) / 9.0


def doubled(image):
    values = image.values.repeat(2, 0).repeat(2, 1)
    pitch_cm = tuple(0.5 * pitch for pitch in image.pitch_cm)
    return Image(values, pitch_cm, image.origin_cm, image.quantity)


def frames(n=3, kind="noise 1 mV", seed=3):
    return Bench(KINDS[kind], np.random.default_rng(seed)).frames(n)


def test_smoothed_noise_is_alike_among_neighbours():
    rng = np.random.default_rng(1)
    for _ in range(3):
        values, states = scene(rng)
        asked = plainly(has_shared_noise)
        assert not asked(values, states, 0.0, LEAST)
        assert asked(smoothed(values), states, 0.0, LEAST / 3.0)


@pytest.mark.parametrize("share", [0.5, 2.0])
def test_zeros_that_drift_along_rows_and_columns_are_no_filter(share):
    rng = np.random.default_rng(2)
    values, states = scene(rng)
    slope = np.linspace(-share, share, 16)
    by_line = share * rng.standard_normal((16, 1))
    drifted = values + slope + slope[:, None] ** 2 + by_line
    assert not plainly(has_shared_noise)(drifted, states, 0.0, 3.0 * LEAST)


def test_enlarged_and_median_filtered_images_have_copies():
    rng = np.random.default_rng(4)
    values, states = scene(rng, rng.lognormal(size=(3, 3)).repeat(2, 0).repeat(2, 1))
    assert plainly(has_copies)(values, states)
    loads = rng.lognormal(size=(12, 12))
    near = np.lib.stride_tricks.sliding_window_view(loads, (3, 3))
    values, states = scene(rng, np.median(near, axis=(2, 3)))
    assert plainly(has_copies)(values, states)


@pytest.mark.parametrize("spread", [0.0, 0.4, 1.0, 3.0])
def test_steps_of_a_converter_are_no_copies(spread):
    rng = np.random.default_rng(5)
    for _ in range(3):
        values, states = scene(rng, np.round(20.0 + spread * rng.standard_normal((6, 6))))
        assert not plainly(has_copies)(values, states)


def test_few_elements_tell_nothing():
    values, states = np.ones((3, 3)), np.full((3, 3), UNDER, np.uint8)
    assert not plainly(is_filtered)(values, states, 0.0, LEAST)
    states[0, :2] = ON
    assert not plainly(is_filtered)(values, states, 0.0, LEAST)


@pytest.mark.usefixtures("plain_kernels")
def test_an_enlarged_image_is_told_and_its_answer_less_sure():
    (frame,) = frames(1)
    plain, found = observed(frame.image, PAD), observed(doubled(frame.image), PAD)
    assert not plain.filtered
    assert found.filtered


@pytest.mark.slow
@pytest.mark.usefixtures("warm_kernels")
def test_regions_of_enlarged_images_hold_the_truth():
    locate, held = LocateDisc(), []
    for frame in frames(12):
        found = locate.posterior(doubled(frame.image))
        held.append(found.contains(frame.truth[0].shape))
        assert found.filtered
    assert np.mean(held) >= 0.8


@pytest.mark.slow
@pytest.mark.usefixtures("warm_kernels")
@pytest.mark.parametrize("kind", ["8 bits", "foam 0.6 cells", "gains correlated", "drift 5 mV"])
def test_no_pad_as_it_is_read_counts_as_filtered(kind):
    assert not any(observed(frame.image, PAD).filtered for frame in frames(24, kind))


@pytest.mark.slow
@pytest.mark.usefixtures("warm_kernels")
def test_only_deviations_are_wider():
    (frame,) = frames(1)
    found = LocateDisc().posterior(frame.image)
    wider = as_filtered(found, 1.3)
    added = np.diag(wider.covariance - found.covariance)[:3]
    np.testing.assert_allclose(
        added, [(1.3 * std) ** 2 for std in (CENTRE_STD, CENTRE_STD, SIZE_STD)]
    )
    assert wider.filtered
    assert wider.fits == found.fits
    for share in (0.99, 1.01):  # of a deviation at the edge of what fits
        usual_cm = found.centre_std_cm / 3.5 / share
        edge = as_filtered(replace(found, usual_std_cm=usual_cm), 1.3)
        assert edge.fits == (share < 1.0)


@pytest.mark.slow  # is compiled
def test_loops_and_machine_code_agree():
    rng = np.random.default_rng(6)
    for _ in range(20):
        values, states = scene(rng)
        values = smoothed(values) if rng.random() < 0.5 else np.round(values, 1)
        given = values, states, 0.0, LEAST
        assert plainly(is_filtered)(*given) == is_filtered.compiled(*given)
