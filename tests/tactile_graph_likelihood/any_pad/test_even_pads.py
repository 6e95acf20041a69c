"""Pads whose elements are nearly alike, or whose gap nobody said."""

import math
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from tactile_graph.wires import Image
from tactile_graph_likelihood.any_pad.locate import LocateDisc
from tactile_graph_likelihood.any_pad.observation.observed import GAP, observed
from tactile_graph_likelihood.any_pad.pad_effects.gap import sized
from tactile_graph_likelihood.any_pad.pad_effects.turn_on import chance_of_an_even_pad
from tactile_graph_likelihood.any_pad.pad_effects.unheld import unheld
from tactile_graph_likelihood.settings import LocateSettings
from tactile_graph_likelihood.single.any_pressure import EVEN

sys.path.insert(0, str(Path(__file__).parents[3] / "benchmarks"))
from second_simulator import KINDS, MORE_KINDS, Bench

STEP = LocateDisc()


def many(test):
    """Mark a test that looks at many frames."""
    return pytest.mark.slow(pytest.mark.usefixtures("warm_kernels")(test))


def frames_of(kind, n=24, seed=6):
    bench = Bench({**KINDS, **MORE_KINDS}[kind], np.random.default_rng(seed))
    return list(bench.frames(n))


def begun(frame):
    """Return readings of a frame, the fits of a disc and its first outline."""
    readings = observed(frame.image, STEP._pad, None)
    fits, even = STEP._any_pad.begun(readings)
    return readings, fits, even


@many
@pytest.mark.parametrize("kind", ["even", "even, gap 0", "even, grams", "even, pitch 1.3 cm"])
def test_an_even_pads_radius_is_right_and_as_sure_as_it_says(kind):
    off, over, held = [], [], []
    for frame in frames_of(kind):
        true, found = frame.truth[0].shape, STEP(frame.image)
        off.append(found.radius_cm - true.radius_cm)
        over.append(off[-1] / found.radius_std_cm)
        held.append(found.posterior.contains(true))
        assert found.fits
    assert np.mean(np.abs(off)) < 0.06
    assert math.sqrt(np.mean(np.square(over))) < 2.2
    assert np.mean(held) > 0.6


@many
@pytest.mark.parametrize(("kind", "gap_cm"), [("even, little noise", 0.3), ("even, gap 0", 0.0)])
def test_the_gap_is_found_where_nobody_said_it(kind, gap_cm):
    found = []
    for frame in frames_of(kind, 12):
        readings, fits, even = begun(frame)
        readings, _ = fits.cleared(readings, even)
        assert readings.length_std_cm > 0.0
        found.append(float(readings.grid[2] - readings.grid[3]))
    assert np.median(found) == pytest.approx(gap_cm, abs=0.05)


def test_a_gap_that_was_said_is_believed():
    image = Image(np.eye(6), (1.0, 1.0), (0.0, 0.0), "kilopascal")
    assert observed(image, STEP._pad).gap.middle_cm == GAP
    assert observed(image, STEP._pad, 0.2).gap is None


@many
def test_where_readings_scatter_a_pads_own_gap_is_left_alone():
    for frame in frames_of("noise 0.2 mV", 6):
        readings, fits, even = begun(frame)
        assert readings.gap.is_told
        assert sized(fits.fit(EVEN), readings, even) == (readings, even)


@many
@pytest.mark.parametrize(
    ("kind", "most", "least"), [("even", 1.0, 0.8), ("saturation 60 g", 0.1, 0.0)]
)
def test_an_even_face_is_told_from_readings_that_a_limit_holds(kind, most, least):
    freed = []
    for frame in frames_of(kind, 36):
        readings, fits, even = begun(frame)
        if readings.unheld is not None:
            freed.append(unheld(fits.fit(EVEN), readings, even)[0].unheld is None)
    assert len(freed) > 12
    assert least <= np.mean(freed) <= most


@many
def test_a_face_with_voids_that_a_limit_holds_is_none_of_an_even_pad():
    noisy, freed = replace(KINDS["saturation 60 g"], saturation_g=30.0, noise_v=3e-3), []
    pads = (Bench(noisy, np.random.default_rng(seed)) for seed in (5, 6, 7, 8))
    for frame in (frame for pad in pads for frame in pad.frames(30)):
        readings, fits, even = begun(frame)
        if readings.unheld is not None:
            freed.append(unheld(fits.fit(EVEN), readings, even)[0].unheld is None)
    assert len(freed) > 12
    assert not any(freed)


@many
def test_readings_without_a_limit_are_as_they_were():
    readings, fits, even = begun(frames_of("noise 0.2 mV", 1)[0])
    assert readings.unheld is None
    assert unheld(fits.fit(EVEN), readings, even) == (readings, even)


@pytest.mark.parametrize("touched", [10, 60])
def test_the_less_readings_scatter_the_more_probable_is_an_even_pad(touched):
    chances = [chance_of_an_even_pad(scatter, touched) for scatter in (0.0, -0.4, -1.0, -2.0, -3.0)]
    assert chances == sorted(chances)
    assert chances[1] < 0.1
    assert chances[3] > 0.9


@many
def test_counts_leave_lengths_less_certain_than_a_calibrated_pad():
    settings, values = LocateSettings(gap_cm=0.0), frames_of("calibrated", 1)[0].image.values
    images = (Image(values, (1.0, 1.0), (0.0, 0.0), unit) for unit in ("kilopascal", "counts"))
    calibrated, counts = (LocateDisc(settings)(image).radius_std_cm for image in images)
    assert counts == pytest.approx(math.hypot(calibrated, 0.05), rel=0.05)


@many
@pytest.mark.parametrize("gap_cm", [0.5, 0.55, 0.65])
def test_a_told_gap_of_half_a_pitch_or_more_is_one_that_may_be(gap_cm):
    kind = replace(MORE_KINDS["even"], element_cm=1.0 - gap_cm, gap_cm=gap_cm, noise_g=0.2)
    geometry = {"element_cm": 1.0 - gap_cm, "gap_cm": gap_cm}
    step = LocateDisc(LocateSettings(pad={"geometry": geometry}))
    frames = Bench(kind, np.random.default_rng(6)).frames(12)
    off = [step(frame.image).radius_cm - frame.truth[0].shape.radius_cm for frame in frames]
    assert np.mean(np.abs(off)) < 0.06
