"""Outlines on pads of more than 1024 elements, by a law or a circuit that nobody has told."""

import numpy as np
import pytest

from tactile_graph import Image, load
from tactile_graph.wires import Circle

pytestmark = [pytest.mark.slow, pytest.mark.usefixtures("warm_kernels")]

SIDE, PITCH_CM, FINE = 40, 0.5, 10


def pressed(rng: np.random.Generator, exponent: float) -> tuple[np.ndarray, Circle]:
    """Return a divider's volts on a pad without gaps, under a disc of 6 to 9 pitches."""
    radius = PITCH_CM * rng.uniform(6.0, 9.0)
    x, y = rng.uniform(radius, SIDE * PITCH_CM - radius, 2)
    places = (np.arange(SIDE * FINE) + 0.5) * PITCH_CM / FINE
    inside = (places - x) ** 2 + (places[:, None] - y) ** 2 <= radius**2
    share = inside.reshape(SIDE, FINE, SIDE, FINE).mean(axis=(1, 3))
    load_g = 400.0 * share * np.exp(0.3 * rng.standard_normal(share.shape))
    load_g *= rng.random(share.shape) > 0.05
    siemens = np.where(load_g > 10.0, (load_g / 100.0) ** exponent / 80e3, 0.0)
    volts = 5.0 * siemens / (1.0 / 33e3 + siemens.sum(axis=0))
    return volts + 5e-4 * rng.standard_normal(share.shape), Circle(float(x), float(y), radius)


def test_a_law_of_another_exponent_leaves_the_truth_within_the_region() -> None:
    pipeline, rng = load("locate-circle"), np.random.default_rng(31)
    held = errors = 0.0
    for _ in range(20):
        volts, true = pressed(rng, 1.15)
        found = pipeline.run(Image(volts, (PITCH_CM,) * 2, quantity="volt"))["circle"]
        held += found.fits and found.posterior.contains(true)
        errors += (found.radius_cm - true.radius_cm) / 20
    assert held >= 14
    assert abs(errors) < 0.03 * PITCH_CM


def test_counts_of_a_divider_are_not_flagged_for_its_own_pattern() -> None:
    pipeline, rng = load("locate-circle"), np.random.default_rng(32)
    held = fits = 0
    for _ in range(12):
        volts, true = pressed(rng, 1.463)
        counts = np.round(np.clip(volts, 0.0, 5.0) / 5.0 * 4095.0)
        found = pipeline.run(Image(counts, (PITCH_CM,) * 2))["circle"]
        held += found.posterior.contains(true)
        fits += found.fits
    assert fits >= 11
    assert held >= 9
